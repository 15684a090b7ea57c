//! The layout of a metric in its model space, on the surface as it was given.

use crate::input::Input;
use crate::laid::{Laid, Placed, STEP_ROUNDING};
use crate::report::{Seconds, timed};
use ricci::Control;
use ricci::embed::{RefinedSpaceLayout, SpaceLayout, refine_space_layout, unroll_refined_in_space};
use ricci::flow::Solution;
use ricci::geometry::Space;
use ricci::mesh::{HalfedgeId, VertexId};
use ricci::metric::Refinement;

/// In H² the two sides of a seam may always differ by this, a distance: what copies of the layout are to meet to.
pub const MEETING: f64 = 1e-8;

/// Crossings per edge up to which the common refinement is formed for the summary alone: it then costs no more than the flow.
const FEW: usize = 16;

/// Whether to carry a layout back to the given triangulation: where an output needs that, or where it costs little.
pub fn is_carried_back(metric: &Solution, needed: bool) -> bool {
    needed || metric.crossings().is_ok_and(|n| n <= FEW * metric.mesh().n_edges())
}

/// A surface in the model space of its metric.
pub struct InSpace {
    /// The layout of the common refinement.
    pub refined: RefinedSpaceLayout,
    /// Plane coordinates of its points: of the plane, in H² of the Poincaré disk.
    pub coordinates: Vec<[f64; 2]>,
    /// Half-edges of the refinement on the left side of the cut, with the number of their segment.
    pub seams: Vec<(HalfedgeId, usize)>,
}

/// Carry the layout of a metric's triangulation back to the given one. `errors`: the sum of |K − K̄| over the vertices.
pub fn in_space(
    input: &Input,
    metric: &Solution,
    whole: &SpaceLayout,
    errors: f64,
    seconds: &mut Seconds,
    control: &Control,
) -> ricci::Result<Laid> {
    let refinement = timed(&mut seconds.refine, || metric.refinement(control))?;
    let lay = || refine_space_layout(whole, &refinement, metric.mesh(), control);
    let refined = timed(&mut seconds.layout, lay)?;
    let seams = seams(whole, &refinement);
    laid(input, metric, refinement, (refined, seams), errors)
}

/// Lay out the given half of the double that a metric lives on. `cones`: vertices inside that the cut has to pass.
pub fn half_in_space(
    input: &Input,
    metric: &Solution,
    cones: &[VertexId],
    errors: f64,
    seconds: &mut Seconds,
    control: &Control,
) -> ricci::Result<Laid> {
    let refinement = timed(&mut seconds.refine, || metric.refinement(control))?;
    let lay = || unroll_refined_in_space(&refinement, metric.mesh(), metric.metric(), cones, control);
    let (refined, cut) = timed(&mut seconds.layout, lay)?;
    let numbered =
        |(k, segment): (usize, &Vec<HalfedgeId>)| -> Vec<_> { segment.iter().map(|&h| (h, k)).collect() };
    let seams = cut.segments.iter().enumerate().flat_map(numbered).collect();
    laid(input, metric, refinement, (refined, seams), errors)
}

fn laid(
    input: &Input,
    metric: &Solution,
    refinement: Refinement,
    (refined, seams): (RefinedSpaceLayout, Vec<(HalfedgeId, usize)>),
    errors: f64,
) -> ricci::Result<Laid> {
    let quality = refined.quality(&refinement, input.mesh(), input.surface.lengths())?;
    let positions = match input.positions() {
        Some(positions) => Some(refinement.from_input_vertices(positions)?),
        None => None,
    };
    let consistency_limit = consistency_limit(refined.space, refined.radius, errors, metric.mesh().n_faces());
    let place = InSpace { coordinates: refined.coordinates(), seams, refined };
    Ok(Laid {
        mesh: refinement.mesh.clone(),
        weight: refinement.weight.clone(),
        refinement: Some(refinement),
        positions,
        packed: None,
        degenerate: place.refined.degenerate.clone(),
        modulus: None,
        placed: Placed::Space(Box::new(place)),
        quality,
        scale: 1.0,
        consistency_limit,
    })
}

/// What curvature errors and rounding allow [`consistency`] to be.
pub fn consistency_limit(space: Space, radius: f64, errors: f64, n_faces: usize) -> f64 {
    // A vertex with curvature error δ turns what lies beyond it by δ: in E² that moves it by at most δ of the diameter, in H² a point at
    // distance r by sinh(r) δ.
    let off = errors + STEP_ROUNDING * n_faces as f64;
    if space == Space::H2 { MEETING.max(radius.sinh() * off) } else { off }
}

/// The disagreement of corners: relative to the diameter in E², a distance in H².
pub fn consistency(space: Space, disagreement: f64, radius: f64) -> f64 {
    if space == Space::E2 { disagreement / (2.0 * radius) } else { disagreement }
}

fn seams(whole: &SpaceLayout, refinement: &Refinement) -> Vec<(HalfedgeId, usize)> {
    let number = |h: HalfedgeId| {
        let side = whole.side(refinement.final_halfedge(h)?);
        (side > 0).then(|| (h, side as usize - 1))
    };
    refinement.mesh.halfedges().filter_map(number).collect()
}

impl InSpace {
    /// Largest disagreement of corners.
    pub fn consistency(&self) -> f64 {
        consistency(self.refined.space, self.refined.disagreement, self.refined.radius)
    }

    /// The diagonal of the coordinates' bounding box.
    pub fn extent(&self) -> f64 {
        let side = |k: usize| {
            let x = self.coordinates.iter().map(|p| p[k]);
            x.clone().fold(f64::NEG_INFINITY, f64::max) - x.fold(f64::INFINITY, f64::min)
        };
        side(0).hypot(side(1))
    }
}
