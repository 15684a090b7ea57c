//! A circle domain with what is said about it.

use crate::failure::Failure;
use crate::input::Input;
use crate::laid::Laid;
use crate::report::{Attempts, Checks, Seconds};
use ricci::canonical::CircleDomain;
use ricci::geometry::worse;
use ricci::mesh::PerVertex;

/// Largest deviation of a loop from its circle, a share of the radius.
const ROUND: f64 = 1e-9;
/// Gauss–Bonnet must hold to this: [`crate::solved`] has the same.
const GAUSS_BONNET: f64 = 1e-10;

pub struct Found {
    pub domain: CircleDomain,
    /// The input with the edges halved that the domain has halved.
    pub halved: Input,
    pub laid: Laid,
    /// |Σ K + λ area − 2πχ| of the surface with its disks.
    pub gauss_bonnet: f64,
    pub failed: Attempts,
    /// Vertices and faces of the layout's file beyond those of the input.
    pub added: [usize; 2],
    pub seconds: Seconds,
}

impl Found {
    /// `taken`: seconds until the domain was found.
    pub fn new(input: &Input, domain: CircleDomain, taken: f64) -> Result<Found, Failure> {
        let failed = |error: ricci::Error| Failure::Failed(error.to_string());
        let halved = input.halved(&domain.split).map_err(failed)?;
        let curvature = domain.metric.metric().curvature(domain.metric.mesh()).map_err(failed)?;
        let mut seconds = Seconds::new(input, &domain.report.seconds);
        seconds.layout = (taken - domain.report.seconds.total).max(0.0);
        let laid = laid(&halved, &domain).map_err(failed)?;
        let gauss_bonnet = curvature.gauss_bonnet;
        Ok(Found { domain, halved, laid, gauss_bonnet, failed: Attempts::default(), added: [0; 2], seconds })
    }

    /// What the result is held against.
    pub fn checks(&self, tolerance: f64) -> Checks {
        let (domain, layout) = (&self.domain, &self.laid.layout);
        let mut checks = Checks::default();
        checks.add("gauss_bonnet", self.gauss_bonnet, GAUSS_BONNET);
        checks.add("max_curvature_error", domain.report.domain_curvature_error, tolerance);
        checks.add("roundness", domain.circles.iter().map(|c| c.deviation).fold(0.0, worse), ROUND);
        checks.add("overlapping_circles", domain.overlapping().len() as f64, 0.0);
        let errors = domain.report.domain_curvature_error * domain.metric.mesh().n_vertices() as f64;
        checks.add("layout_consistency", layout.consistency(), layout.consistency_limit(errors));
        checks.add("flipped_triangles", layout.flipped.len() as f64, 0.0);
        checks.add("unconverged", f64::from(u8::from(!domain.report.converged)), 0.0);
        checks
    }
}

/// The layout on the input with its halved edges.
fn laid(halved: &Input, domain: &CircleDomain) -> ricci::Result<Laid> {
    let layout = domain.layout.clone();
    let quality = layout.quality(halved.mesh(), halved.surface.lengths())?;
    let refinement = layout.refinement();
    let positions = match (refinement, halved.positions()) {
        (Some(r), Some(positions)) => Some(r.from_input_vertices(positions)?),
        _ => None,
    };
    Ok(Laid {
        weight: refinement.map_or_else(|| PerVertex::from(Vec::new()), |r| r.weight.clone()),
        positions,
        on_input: None,
        packed: None,
        degenerate: layout.degenerate.clone(),
        modulus: domain.torus_modulus,
        quality,
        layout,
    })
}
