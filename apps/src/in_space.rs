//! The layout of a metric in its model space, on the surface as it was given.

use ricci::embed::{RefinedSpaceLayout, SpaceLayout};
use ricci::flow::Solution;
use ricci::geometry::Space;
use ricci::mesh::HalfedgeId;
use ricci::metric::Refinement;

/// In H² the two sides of a seam may always differ by this, a distance: what copies of the layout are to meet to.
pub const MEETING: f64 = 1e-8;

/// Rounding of one step of the development: a unit direction and a point are rotated and added, a few ulp each.
const STEP_ROUNDING: f64 = 4.0 * f64::EPSILON;

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

/// Half-edges of the refinement on the left side of the cut, with the number of their segment.
pub fn seams(whole: &SpaceLayout, refinement: &Refinement) -> Vec<(HalfedgeId, usize)> {
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
