//! A closed surface of genus 1 or more in its metric of constant curvature, laid out on the surface as it was given.

use super::args::CanonicalArgs;
use crate::failure::Failure;
use crate::in_space::{InSpace, MEETING, in_space};
use crate::input::Input;
use crate::job::GAUSS_BONNET;
use crate::laid::{Laid, Placed};
use crate::report::{Attempts, Checks, Seconds, timed};
use ricci::Control;
use ricci::canonical::{Quotient, QuotientOptions, uniformize_quotient};
use ricci::embed::{DeckElement, DeckGroup, DirichletDomain, SpaceLayout, dirichlet_domain};
use ricci::flow::Report;
use ricci::geometry::modulus::modulus;
use ricci::geometry::{Space, largest, worse};
use ricci::mesh::{PerEdge, PerVertex, VertexId};
use ricci::metric::{Curvature, SurfaceMetric};
use ricci::topology::HomotopyBasis;
use std::cmp::Ordering;
use std::f64::consts::PI;

/// The origin in ambient coordinates: the base point.
pub const ORIGIN: [f64; 3] = [0.0, 0.0, 1.0];
/// A relation residual beyond this is no relation.
const RELATION: f64 = 1e-8;
/// Rounding of the area, per vertex.
const AREA_ROUNDING: f64 = 1e-12;
/// Deck transformations of a torus turn by this at most, radians.
const TURNING: f64 = 1e-10;
/// The Dirichlet domain has the surface's area to this, relative: corners are known to 1e-8 of its size.
const DOMAIN_AREA: f64 = 1e-7;

/// A uniformized surface.
pub struct Uniformized {
    pub report: Report,
    /// max |K| to twice the digits of doubles.
    pub angle_defect: f64,
    pub metric: SurfaceMetric,
    pub lengths: PerEdge<f64>,
    pub curvature: Curvature,
    /// The curvature asked for: 0 everywhere.
    pub target: PerVertex<f64>,
    /// The layout, always one in space.
    pub laid: Laid,
    pub basis: HomotopyBasis,
    pub deck: DeckGroup,
    /// The Dirichlet domain of the base point, or why there is none.
    pub domain: Result<DirichletDomain, String>,
    /// The copies of a cover; the identity alone where none was asked for.
    pub elements: Vec<DeckElement>,
    pub failed: Attempts,
    pub left_out: Vec<&'static str>,
    pub seconds: Seconds,
}

/// The base vertex that was asked for, if it is one.
pub fn base(input: &Input, args: &CanonicalArgs) -> Result<Option<VertexId>, Failure> {
    let n = input.mesh.n_vertices();
    match args.base {
        Some(v) if v as usize >= n => {
            Err(Failure::Usage(format!("--base {v}: there is no such vertex, they are 0 to {}", n - 1)))
        }
        base => Ok(base.map(VertexId)),
    }
}

/// Uniformize a closed surface of genus 1 or more.
pub fn uniformized(input: &Input, args: &CanonicalArgs, control: &Control) -> Result<Uniformized, Failure> {
    let options = QuotientOptions {
        scheme: args.solve.scheme.into(),
        base: base(input, args)?,
        flow: args.solve.options(args.common.threads()),
    };
    let mut total = 0.0;
    let quotient = timed(&mut total, || {
        uniformize_quotient(&input.mesh, &input.lengths, input.geometry, &options, control)
    })?;
    let Quotient { report, angle_defect, metric, layout, basis, deck } = quotient;
    let mut seconds = Seconds {
        read: input.seconds_read,
        build: input.seconds_build,
        assemble: report.seconds.assemble,
        analyse: report.seconds.analyse,
        factor: report.seconds.factor,
        solve: report.seconds.solve,
        flip: report.seconds.flip,
        layout: total - report.seconds.total,
        ..Seconds::default()
    };
    // What goes wrong from here on is no fault of the input.
    let failed = |error: ricci::Error| match error {
        ricci::Error::Cancelled => Failure::Cancelled,
        error => Failure::Failed(error.to_string()),
    };
    let lengths = metric.metric().lengths(metric.mesh()).map_err(failed)?;
    let curvature = metric.curvature().map_err(failed)?;
    let errors = curvature.at.iter().map(|k| k.abs()).sum();
    let area = layout.area;
    let mut laid = in_space(input, &metric, layout, errors, &mut seconds, control).map_err(failed)?;
    if let ([a, b], Space::E2) = (deck.generators.as_slice(), deck.space) {
        laid.modulus = modulus([a, b].map(|g| {
            let [x, y, _] = g.rounded().origin();
            [x, y]
        }));
    }
    let domain = match timed(&mut seconds.layout, || dirichlet_domain(&deck, ORIGIN, area, control)) {
        Err(ricci::Error::Cancelled) => return Err(Failure::Cancelled),
        domain => domain.map_err(|error| error.to_string()),
    };
    let one = DeckElement { word: Default::default(), motion: ricci::geometry::Motion::identity(deck.space) };
    Ok(Uniformized {
        target: PerVertex::filled(input.mesh.n_vertices(), 0.0),
        report,
        angle_defect,
        metric,
        lengths,
        curvature,
        laid,
        basis,
        deck,
        domain,
        elements: vec![one],
        failed: Attempts::default(),
        left_out: Vec::new(),
        seconds,
    })
}

impl Uniformized {
    /// The layout in space; its own kind of [`Laid`].
    pub fn place(&self) -> Option<&InSpace> {
        match &self.laid.placed {
            Placed::Space(place) => Some(place),
            Placed::Plane(_) => None,
        }
    }

    /// The layout of the final triangulation.
    pub fn whole(&self) -> Option<&SpaceLayout> {
        self.place().and_then(|place| place.whole.as_ref())
    }

    /// max |K| of the metric.
    pub fn curvature_error(&self) -> f64 {
        largest(self.curvature.at.iter())
    }

    /// The area of the layout's triangles, by formulas without angles.
    pub fn area(&self) -> f64 {
        self.whole().map_or(self.curvature.area, |whole| whole.area)
    }

    /// What the result is held against.
    pub fn checks(&self) -> Checks {
        let mut checks = Checks::default();
        checks.add("gauss_bonnet", self.curvature.gauss_bonnet, GAUSS_BONNET);
        checks.add("max_curvature_error", self.curvature_error(), self.report.tolerance);
        checks.add("broken_triangles", self.curvature.broken.len() as f64, 0.0);
        let meeting = if self.deck.space == Space::H2 { MEETING } else { self.laid.consistency_limit };
        checks.add("layout_consistency", self.laid.consistency(), meeting);
        checks.add("flipped_triangles", self.laid.flipped().len() as f64, 0.0);
        checks.add(
            "relation_residual",
            worse(self.deck.relation_residual, self.deck.side_residual),
            RELATION,
        );
        let n = self.curvature.at.len() as f64;
        if self.deck.space == Space::H2 {
            let exact = 4.0 * PI * (self.deck.group.genus as f64 - 1.0);
            let limit = n * (self.curvature_error() + AREA_ROUNDING);
            checks.add("area", (self.area() - exact).abs(), limit);
            // The generators, and the elements of the sides of the layout and of the Dirichlet domain.
            let sides = self.deck.sides.iter().chain(self.domain.iter().flat_map(|d| &d.sides));
            let motions = self.deck.generators.iter().chain(sides.map(|g| &g.motion));
            let not = motions
                .filter(|g| f64::from(g.half_trace()).abs().partial_cmp(&1.0) != Some(Ordering::Greater));
            checks.add("not_hyperbolic", not.count() as f64, 0.0);
        } else {
            let turning = self.deck.generators.iter().map(|g| g.rotation_angle()).fold(0.0, worse);
            checks.add("turning", turning, TURNING);
        }
        checks.add("unconverged", f64::from(u8::from(!self.report.converged)), 0.0);
        checks.add("without_domain", f64::from(u8::from(self.domain.is_err())), 0.0);
        if let Ok(domain) = &self.domain {
            let area = self.area();
            checks.add("domain_area", (domain.area - area).abs() / area, DOMAIN_AREA);
        }
        checks
    }
}
