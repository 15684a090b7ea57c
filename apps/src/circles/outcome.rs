//! A circle domain on the surface as it was given.

use crate::failure::Failure;
use crate::input::Input;
use crate::report::PhaseSeconds;
use crate::surface_layout::SurfaceLayout;
use ricci::canonical::CircleDomain;
use ricci::mesh::PerVertex;
use ricci::moduli::ModulusBounds;

pub struct CirclesOutcome {
    pub input: Input,
    pub domain: CircleDomain,
    /// The input with the edges halved that the domain has halved.
    pub halved: Input,
    pub laid: SurfaceLayout,
    /// |Σ K + λ area − 2πχ| of the surface with its disks.
    pub gauss_bonnet: f64,
    /// The limit of max |K|.
    pub tolerance: f64,
    /// Proven bounds of the modulus of an annulus.
    pub modulus: Option<ModulusBounds>,
}

impl CirclesOutcome {
    /// `taken`: the seconds until the domain was found.
    pub fn new(
        input: Input,
        domain: CircleDomain,
        tolerance: f64,
        taken: f64,
        seconds: &mut PhaseSeconds,
    ) -> Result<CirclesOutcome, Failure> {
        let failed = |error: ricci::Error| Failure::Failed(error.to_string());
        let halved = input.halved(&domain.split).map_err(failed)?;
        let curvature = domain.metric.metric().curvature(domain.metric.mesh()).map_err(failed)?;
        seconds.add_flow(&domain.report.seconds);
        seconds.layout = (taken - domain.report.seconds.total).max(0.0);
        let laid = layout_on(&halved, &domain).map_err(failed)?;
        let gauss_bonnet = curvature.gauss_bonnet;
        Ok(CirclesOutcome { input, domain, halved, laid, gauss_bonnet, tolerance, modulus: None })
    }
}

/// The layout of a domain on the input with its halved edges.
fn layout_on(halved: &Input, domain: &CircleDomain) -> ricci::Result<SurfaceLayout> {
    let layout = domain.layout.clone();
    let quality = layout.quality(halved.mesh(), halved.surface.lengths())?;
    let subdivision = layout.common_subdivision();
    let positions = match (subdivision, halved.positions()) {
        (Some(r), Some(positions)) => Some(r.from_vertices(0, positions)?),
        _ => None,
    };
    Ok(SurfaceLayout {
        weight: subdivision.map_or_else(|| PerVertex::from(Vec::new()), |r| r.weight.clone()),
        positions,
        on_input: None,
        own_faces: None,
        packed: None,
        degenerate: layout.degenerate.clone(),
        modulus: domain.torus_modulus,
        quality,
        turned_by_straight_sides: layout.turned_by_straight_sides(&layout.coordinates),
        layout,
    })
}
