//! A closed surface of genus 1 or more in its metric of constant curvature, laid out on the surface as it was given.

use super::needs::{Needs, known, told};
use crate::failure::Failure;
use crate::input::Input;
use crate::job::GAUSS_BONNET;
use crate::laid::{Laid, is_carried_back};
use crate::report::{Attempts, Checks, Seconds, timed};
use ricci::Control;
use ricci::canonical::Quotient;
use ricci::embed::layout::MEETING;
use ricci::embed::{
    DeckElement, DeckGroup, DirichletDomain, Layout, UnrollOptions, dirichlet_domain, unroll,
};
use ricci::flow::Report;
use ricci::flow::Solution;
use ricci::geometry::{Space, largest, worse};
use ricci::mesh::{FaceId, PerEdge, PerVertex};
use ricci::metric::{Curvature, Scheme};
use ricci::topology::HomotopyBasis;
use std::cmp::Ordering;
use std::f64::consts::PI;
use std::sync::Arc;

/// The origin in ambient coordinates: the base point.
pub const ORIGIN: [f64; 3] = [0.0, 0.0, 1.0];
/// Largest residual of the group's relation and of the layout's side pairings, relative to the largest matrix on the way: half of
/// the digits of a double.
const RELATION: f64 = 1e-8;
/// What rounding may do to the area per vertex, beside the curvature that the flow has left.
const AREA_ROUNDING: f64 = 1e-12;
/// Largest rotation of a deck transformation of a torus, radians: the default tolerance of a flow.
const TURNING: f64 = 1e-10;
/// Largest difference of the areas of Dirichlet domain and surface, relative: corners are known to 1e-8 of the domain's size.
const DOMAIN_AREA: f64 = 1e-7;

/// A uniformized surface.
pub struct Uniformized {
    pub report: Report,
    /// max |K| to twice the digits of doubles.
    pub angle_defect: f64,
    pub metric: Solution,
    pub scheme: Scheme,
    pub lengths: PerEdge<f64>,
    pub curvature: Curvature,
    /// The curvature asked for: 0 everywhere.
    pub target: PerVertex<f64>,
    /// The layout of the metric's triangulation.
    pub layout: Layout,
    /// The same on the surface as it was given: where an output needs it or it costs little, or why there is none.
    pub laid: Option<Result<Laid, String>>,
    /// τ of a flat torus.
    pub modulus: Option<[f64; 2]>,
    pub basis: HomotopyBasis,
    pub deck: DeckGroup,
    /// The Dirichlet domain of the base point, where an output needs it, or why there is none.
    pub domain: Option<Result<DirichletDomain, String>>,
    /// The copies of a cover, the identity alone where none was asked for; or why there are none.
    pub elements: Result<Vec<DeckElement>, String>,
    pub failed: Attempts,
    pub left_out: Vec<&'static str>,
    pub seconds: Seconds,
}

impl Uniformized {
    /// A quotient laid out on the surface as it was given. `taken`: seconds until it was found.
    pub fn new(
        input: &Input,
        quotient: Quotient,
        taken: f64,
        needs: Needs,
        control: &Control,
    ) -> Result<Uniformized, Failure> {
        let Quotient { report, angle_defect, metric, layout, basis, deck } = quotient;
        let mut seconds = Seconds::new(input, &report.seconds);
        seconds.layout = taken - report.seconds.total;
        // What goes wrong from here on is no fault of the input.
        let failed = |error: ricci::Error| match error {
            ricci::Error::Cancelled => Failure::Cancelled,
            error => Failure::Failed(error.to_string()),
        };
        let lengths = metric.metric().lengths(metric.mesh()).map_err(failed)?;
        let curvature = metric.curvature().map_err(failed)?;
        let errors = curvature.at.iter().map(|k| k.abs()).sum();
        let laid = match is_carried_back(&metric, needs.refinement) {
            true => {
                let mut on_surface = || -> ricci::Result<Laid> {
                    let refinement = Arc::new(timed(&mut seconds.refine, || metric.refinement(control))?);
                    timed(&mut seconds.layout, || {
                        let refined = layout.refined(&refinement, metric.metric(), control)?;
                        let mut laid = Laid::new(input, &metric, refined, errors)?;
                        if needs.on_input {
                            let (cones, root) = (Some(Vec::new()), Some(basis.base));
                            let options = UnrollOptions {
                                cones,
                                root,
                                refinement: Some(refinement),
                                ..UnrollOptions::default()
                            };
                            laid.on_input = unroll(&metric, &options, control)?.on_input();
                        }
                        Ok(laid)
                    })
                };
                Some(told(on_surface())?)
            }
            false => None,
        };
        let form = || dirichlet_domain(&deck, ORIGIN, layout.area, control);
        let domain = match needs.domain {
            true => Some(told(timed(&mut seconds.layout, form))?),
            false => None,
        };
        let one =
            DeckElement { word: Default::default(), motion: ricci::geometry::Motion::identity(deck.space) };
        Ok(Uniformized {
            target: PerVertex::filled(input.mesh().n_vertices(), 0.0),
            report,
            angle_defect,
            lengths,
            curvature,
            scheme: metric.scheme()?,
            metric,
            layout,
            laid,
            modulus: deck.modulus(),
            basis,
            deck,
            domain,
            elements: Ok(vec![one]),
            failed: Attempts::default(),
            left_out: Vec::new(),
            seconds,
        })
    }

    /// The Dirichlet domain, if there is one.
    pub fn domain(&self) -> Result<&DirichletDomain, Failure> {
        known(&self.domain)
    }

    /// The layout on the surface as it was given, if there is one.
    pub fn laid(&self) -> Result<&Laid, Failure> {
        known(&self.laid)
    }

    /// The copies of a cover, if they can be made.
    pub fn copies(&self) -> Result<&[DeckElement], Failure> {
        self.elements.as_deref().map_err(|why| Failure::Failed(why.clone()))
    }

    /// Faces of the layout, of the given surface if that is laid out, that are not counterclockwise.
    pub fn flipped(&self) -> &[FaceId] {
        self.laid().map_or(&self.layout.flipped, Laid::flipped)
    }

    /// How far the corners of the layout disagree, and what curvature errors and rounding allow.
    fn consistency(&self) -> [f64; 2] {
        let layout = self.laid().map_or(&self.layout, |laid| &laid.layout);
        [layout.consistency(), layout.consistency_limit(self.curvature.at.iter().map(|k| k.abs()).sum())]
    }

    /// max |K| of the metric.
    pub fn curvature_error(&self) -> f64 {
        largest(self.curvature.at.iter())
    }

    /// The area of the layout's triangles, by formulas without angles.
    pub fn area(&self) -> f64 {
        self.layout.area
    }

    /// What the result is held against.
    pub fn checks(&self) -> Checks {
        let mut checks = Checks::default();
        checks.add("gauss_bonnet", self.curvature.gauss_bonnet, GAUSS_BONNET);
        checks.add("max_curvature_error", self.curvature_error(), self.report.allowed_error());
        checks.add("broken_triangles", self.curvature.broken.len() as f64, 0.0);
        let [consistency, limit] = self.consistency();
        let meeting = if self.deck.space == Space::H2 { MEETING } else { limit };
        checks.add("layout_consistency", consistency, meeting);
        checks.add("flipped_triangles", self.flipped().len() as f64, 0.0);
        checks.add("relation_residual", self.deck.relation_residual, RELATION);
        checks.add("side_residual", self.deck.side_residual, RELATION);
        let n = self.curvature.at.len() as f64;
        if self.deck.space == Space::H2 {
            let exact = 4.0 * PI * (self.deck.group.genus as f64 - 1.0);
            let limit = n * (self.curvature_error() + AREA_ROUNDING);
            checks.add("area", (self.area() - exact).abs(), limit);
            // The generators, and the elements of the sides of the layout and of the Dirichlet domain.
            let sides = self.deck.sides.iter().chain(self.domain().into_iter().flat_map(|d| &d.sides));
            let motions = self.deck.generators.iter().chain(sides.map(|g| &g.motion));
            let not = motions
                .filter(|g| f64::from(g.half_trace()).abs().partial_cmp(&1.0) != Some(Ordering::Greater));
            checks.add("not_hyperbolic", not.count() as f64, 0.0);
        } else {
            let turning = self.deck.generators.iter().map(|g| g.rotation_angle()).fold(0.0, worse);
            checks.add("turning", turning, TURNING);
        }
        checks.add("unconverged", f64::from(u8::from(!self.report.converged())), 0.0);
        if let Some(laid) = &self.laid {
            checks.add("without_refinement", f64::from(u8::from(laid.is_err())), 0.0);
        }
        if let Ok(domain) = self.domain() {
            let area = self.area();
            checks.add("domain_area", (domain.area - area).abs() / area, DOMAIN_AREA);
        }
        checks
    }
}
