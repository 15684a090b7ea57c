//! Seams: how the two sides of a cut segment lie to each other.

use crate::geometry::{PlaneIsometry, worse};
use crate::mesh::{HalfedgeId, Mesh, PerEdge, PerHalfedge};

/// A segment of the cut and the plane isometry `z ↦ e^{iθ} z + t` that carries its left side onto its right
/// side.
#[derive(Debug, Clone, PartialEq)]
pub struct Seam {
    /// The segment's half-edges in order; their faces lie on the left side, their twins' on the right.
    pub halfedges: Vec<HalfedgeId>,
    /// Rotation angle θ ∈ (−π, π], radians.
    pub rotation: f64,
    /// Translation t, in units of the layout.
    pub translation: [f64; 2],
    /// Largest distance between the image of a left vertex and its right partner, relative to the layout's
    /// diameter.
    pub residual: f64,
}

impl Seam {
    /// The isometry from the left side to the right side.
    pub fn isometry(&self) -> PlaneIsometry {
        PlaneIsometry { rotation: self.rotation, translation: self.translation }
    }

    /// Fit the isometry of one segment.
    ///
    /// `direction`: unit direction of each half-edge in its own face's frame. The rotation is fitted to
    /// these, weighed with the edge lengths, so that it keeps its accuracy on seams that are tiny against
    /// their coordinates; the translation is then the least-squares one over the segment's vertices.
    pub(crate) fn fit(
        mesh: &Mesh,
        lengths: &PerEdge<f64>,
        segment: &[HalfedgeId],
        direction: &PerHalfedge<[f64; 2]>,
        at: impl Fn(HalfedgeId) -> [f64; 2],
        diameter: f64,
    ) -> Seam {
        let vectors = segment.iter().map(|&h| {
            let [l, r] = [direction[h], direction[h.twin()]];
            let length = lengths[h.edge()];
            (l.map(|x| length * x), r.map(|x| -x))
        });
        // Left and right position of the origin of h, and of its tip.
        let origin = |h: HalfedgeId| (at(h), at(mesh.next(h.twin())));
        let tip = |h: HalfedgeId| (at(mesh.next(h)), at(h.twin()));
        let points =
            || segment.first().map(|&h| origin(h)).into_iter().chain(segment.iter().map(|&h| tip(h)));
        let g = PlaneIsometry::fit(vectors, points());
        let residual = points().map(|(p, q)| {
            let image = g.apply(p);
            (image[0] - q[0]).hypot(image[1] - q[1])
        });
        Seam {
            halfedges: segment.to_vec(),
            rotation: g.rotation,
            translation: g.translation,
            residual: residual.fold(0.0, worse) / diameter,
        }
    }
}
