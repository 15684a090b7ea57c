//! Layout of a common refinement in the plane.

use super::corner::number_corners;
use super::layout::{Layout, bounding_diagonal, check_cut, seam_sides};
use super::quality::{Quality, cross, minus, refined_quality};
use super::refined_develop::{Faces, Placed, place};
use super::seam::Seam;
pub use super::shape::FLAT;
use super::shape::{Shape, extent};
use crate::control::Control;
use crate::error::{Error, Result};
use crate::geometry::worse;
use crate::mesh::{FaceId, Mesh, PerEdge, PerFace, PerHalfedge, VertexId};
use crate::metric::{Metric, Refinement};
use crate::topology::{CutGraph, cut_graph};

/// Shortest edge that a cut reckons with, relative to the longest: crossings may coincide.
const SHORTEST: f64 = 1e-12;

/// A common refinement, opened along a cut, in the plane E².
///
/// Within a triangle the map from the input is projective: with the homogeneous weights q of its corners
/// ([`Refinement::weight`]) and their coordinates (x, y), it is (q x, q y, q) that is linear.
#[derive(Debug, Clone, PartialEq)]
pub struct RefinedLayout {
    /// Corners, coordinates and seams on [`Refinement::mesh`]. `flipped` are the triangles with an area below −[`FLAT`] · longest
    /// edge², `broken` those in final faces that break the triangle inequality; `local_consistency` is relative to the longest
    /// side of the final face, `area` that of the pieces.
    pub layout: Layout,
    /// Triangles whose area is within [`FLAT`] · longest edge² of zero.
    pub degenerate: Vec<FaceId>,
}

/// A short cut along edges of the refinement that opens it into a disk and passes the cones ([`cut_graph`]), lengths being those
/// of the final metric (E²) on the final triangulation `mesh`.
///
/// Errors: those of [`cut_graph`] and [`Metric::lengths`]; [`Error::Layout`] in another space.
pub fn refined_cut(
    r: &Refinement,
    mesh: &Mesh,
    metric: &Metric,
    cones: &[VertexId],
    control: &Control,
) -> Result<CutGraph> {
    control.check()?;
    let mut lengths = Faces::new(mesh, metric)?.refined_lengths(r);
    let least = SHORTEST * lengths.iter().copied().fold(0.0, f64::max);
    lengths.iter_mut().for_each(|l| *l = l.max(least));
    cut_graph(&r.mesh, &lengths, cones, control)
}

/// Lay a refinement out with its final metric (E²) on the final triangulation `mesh`, O(E log E).
///
/// `cut` opens the refinement into a disk with the metric's cones on its border. Every piece lies where its final face does.
/// Errors: [`Error::Layout`] in another space, for another cut, for lengths beyond doubles; those of [`Metric::lengths`];
/// [`Error::Cancelled`].
pub fn layout_refined(
    r: &Refinement,
    mesh: &Mesh,
    metric: &Metric,
    cut: &CutGraph,
    control: &Control,
) -> Result<RefinedLayout> {
    let faces = Faces::new(mesh, metric)?;
    check_cut(&r.mesh, cut)?;
    let (corner_index, n_corners) = number_corners(&r.mesh, &cut.is_cut);
    let Placed { coordinates, vectors } = place(r, &faces, &cut.is_cut, &corner_index, n_corners, control)?;
    let diameter = bounding_diagonal(&coordinates);
    if !(diameter.is_finite() && diameter > 0.0) {
        return Err(Error::Layout("the lengths are too large or too small for doubles: rescale them".into()));
    }

    let (mut worst, mut worst_local, mut area) = (0.0_f64, 0.0_f64, 0.0);
    let at = |h| coordinates[corner_index[h] as usize];
    for f in r.mesh.faces() {
        let longest = faces.longest(r.final_face[f]);
        for h in r.mesh.face_halfedges(f) {
            let edge = minus(at(r.mesh.next(h)), at(h));
            let off = minus(edge, vectors[h]);
            let off = off[0].hypot(off[1]);
            worst = worse(worst, off);
            worst_local = worse(worst_local, off / longest);
        }
        let [_, b, c] = r.mesh.face_halfedges(f);
        area += 0.5 * cross(vectors[b], vectors[c]);
    }
    let norm = |[x, y]: [f64; 2]| x.hypot(y);
    let direction = |&v: &[f64; 2]| if norm(v) > 0.0 { v.map(|x| x / norm(v)) } else { [0.0; 2] };
    let directions: PerHalfedge<[f64; 2]> = vectors.iter().map(direction).collect::<Vec<_>>().into();
    let lengths = faces.refined_lengths(r);
    let fit = |segment: &Vec<_>| Seam::fit(&r.mesh, &lengths, segment, &directions, at, diameter);
    let broken = |&f: &FaceId| faces.triangles[r.final_face[f]].excess > 0.0;
    let mut refined = RefinedLayout {
        layout: Layout {
            seams: cut.segments.iter().map(fit).collect(),
            flipped: Vec::new(),
            broken: r.mesh.faces().filter(broken).collect(),
            consistency: worst / diameter,
            local_consistency: worst_local,
            diameter,
            area,
            side: seam_sides(&r.mesh, cut),
            corner_index,
            coordinates,
        },
        degenerate: Vec::new(),
    };
    refined.find_flat(&r.mesh);
    control.check()?;
    Ok(refined)
}

impl RefinedLayout {
    /// Scale the layout so that its triangles' areas add up to `area`; returns the factor on lengths ([`Layout::scale_to_area`]).
    pub fn scale_to_area(&mut self, r: &Refinement, area: f64) -> Result<f64> {
        let factor = self.layout.scale_to_area(&r.mesh, area)?;
        self.find_flat(&r.mesh);
        Ok(factor)
    }

    fn find_flat(&mut self, mesh: &Mesh) {
        let extent = extent(&self.layout.coordinates);
        let shape: PerFace<Shape> =
            PerFace::from_fn(mesh.n_faces(), |f| Shape::of(self.layout.face_uv(mesh, f)));
        self.layout.flipped = mesh.faces().filter(|&f| shape[f].is_flipped(extent)).collect();
        self.degenerate = mesh.faces().filter(|&f| shape[f].is_degenerate(extent)).collect();
    }

    /// How the vertex-linear maps from the input's pieces to the layout's distort, with the Euclidean `lengths` of the input's edges
    /// on the input's triangulation (of a double: those of the double or of the surface itself).
    ///
    /// Triangles that are degenerate on either side are named, and left out of the mean and the extremes. Errors: [`Error::Size`],
    /// [`Error::EdgeLength`], [`Error::TriangleInequality`].
    pub fn quality(&self, r: &Refinement, input: &Mesh, lengths: &PerEdge<f64>) -> Result<Quality> {
        let image = |f| {
            let to = self.layout.face_uv(&r.mesh, f).map(|p| p.map(|x| x / self.layout.diameter));
            let shape = Shape::of(to);
            let area = 0.5 * cross(minus(to[1], to[0]), minus(to[2], to[0])).abs();
            (to, area, shape.share.abs() > shape.flat(extent(&to).max(1.0)))
        };
        refined_quality(r, input, lengths, image)
    }
}
