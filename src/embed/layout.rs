//! Layout of a flat cone metric in the plane.

use super::corner::number_corners;
use super::develop::{Development, develop};
use super::seam::Seam;
use crate::control::Control;
use crate::error::{Error, Result, check_size};
use crate::geometry::predicates::orientation;
use crate::geometry::triangle::half_differences;
use crate::geometry::{PlaneIsometry, Space, worse};
use crate::mesh::{FaceId, HalfedgeId, Mesh, PerEdge, PerFace, PerHalfedge, VertexId};
use crate::metric::Metric;
use crate::topology::{CutGraph, check_lengths, cut};
use std::cmp::Ordering;

/// A surface, opened along a cut, in the plane E²: counterclockwise where the mesh is.
#[derive(Debug, Clone, PartialEq)]
pub struct Layout {
    /// Per half-edge, the index into `coordinates` of the corner at its origin, in its face. Corners around a
    /// vertex share an index unless cut or boundary edges separate them. A half-edge outside the surface has
    /// the index of the corner at its origin in the face across the edge.
    pub corner_index: PerHalfedge<u32>,
    /// Plane coordinates of the vertices of the opened surface, in units of the lengths. The smallest
    /// triangle lies at the origin.
    pub coordinates: Vec<[f64; 2]>,
    /// One seam per segment of the cut, in the same order.
    pub seams: Vec<Seam>,
    /// Faces that are not counterclockwise in these coordinates: clockwise or without area, by exact
    /// arithmetic.
    pub flipped: Vec<FaceId>,
    /// Faces whose lengths break the triangle inequality: no such triangle exists, they are laid out with
    /// angles (π, 0, 0), and the layout does not represent the metric there.
    pub broken: Vec<FaceId>,
    /// Largest disagreement between an edge vector derived in its face and the one between the placed
    /// vertices, relative to `diameter`. It measures how far the metric is from flat off the cones, and
    /// rounding.
    pub consistency: f64,
    /// The same disagreement relative to the length of the edge itself.
    pub local_consistency: f64,
    /// Diagonal of the layout's bounding box.
    pub diameter: f64,
    /// Sum of the areas of the triangles with the given lengths.
    pub area: f64,
    /// Per half-edge: 0 if not cut, k + 1 on the left side of seam k, −(k + 1) on its right side.
    pub(super) side: PerHalfedge<i32>,
}

/// Lay a flat cone metric out in the plane, O(E log E).
///
/// `lengths`: one per edge, flat at every vertex that is inside the opened surface; what is missing to that
/// shows in [`Layout::consistency`] and [`Layout::broken`]. `cut` opens the surface into a disk
/// ([`crate::topology::cut_graph`]).
///
/// Errors: [`Error::Size`], [`Error::EdgeLength`], [`Error::Layout`] if the cut does not leave a disk,
/// [`Error::Cancelled`].
pub fn layout(mesh: &Mesh, lengths: &PerEdge<f64>, cut: &CutGraph, control: &Control) -> Result<Layout> {
    check_lengths(mesh, lengths)?;
    let differences = |f| half_differences(mesh.opposite_edges(f).map(|e| lengths[e]));
    lay_out(mesh, lengths, &PerFace::from_fn(mesh.n_faces(), differences), cut, control)
}

/// [`layout`] of a metric (E²), from its variables: triangles keep their shape where circles of very different sizes meet,
/// which rounded lengths do not. Errors: as [`layout`] and [`Metric::lengths`]; [`Error::Layout`] in another space.
pub fn layout_of(mesh: &Mesh, metric: &Metric, cut: &CutGraph, control: &Control) -> Result<Layout> {
    if metric.space != Space::E2 {
        return Err(Error::Layout(format!("a metric in {} has no layout in the plane", metric.space)));
    }
    lay_out(mesh, &metric.lengths(mesh)?, &metric.differences(mesh)?, cut, control)
}

fn lay_out(
    mesh: &Mesh,
    lengths: &PerEdge<f64>,
    differences: &PerFace<[f64; 3]>,
    cut: &CutGraph,
    control: &Control,
) -> Result<Layout> {
    check_cut(mesh, cut)?;
    let (corner_index, n_corners) = number_corners(mesh, &cut.is_cut);
    let Development { coordinates, direction, area, broken } =
        develop(mesh, lengths, differences, &cut.is_cut, &corner_index, n_corners, control)?;
    let at = |h: HalfedgeId| coordinates[corner_index[h] as usize];
    let diameter = bounding_diagonal(&coordinates);
    if !(diameter.is_finite() && diameter > 0.0) {
        return Err(Error::Layout("the lengths are too large or too small for doubles: rescale them".into()));
    }

    let (mut worst, mut worst_local) = (0.0_f64, 0.0_f64);
    for h in mesh.halfedges().filter(|&h| !mesh.is_outside(h)) {
        let ([ax, ay], [bx, by], l) = (at(h), at(mesh.next(h)), lengths[h.edge()]);
        let off = (bx - ax - l * direction[h][0]).hypot(by - ay - l * direction[h][1]);
        worst = worse(worst, off);
        worst_local = worse(worst_local, off / l);
    }

    let fit = |segment: &Vec<_>| Seam::fit(mesh, lengths, segment, &direction, at, diameter);
    let mut layout = Layout {
        seams: cut.segments.iter().map(fit).collect(),
        flipped: Vec::new(),
        broken,
        consistency: worst / diameter,
        local_consistency: worst_local,
        diameter,
        area,
        side: seam_sides(mesh, cut),
        corner_index,
        coordinates,
    };
    layout.flipped = layout.find_flipped(mesh);
    control.check()?;
    Ok(layout)
}

impl Layout {
    /// Coordinates of the corner at the origin of `h`, in its face.
    pub fn corner_uv(&self, h: HalfedgeId) -> [f64; 2] {
        self.coordinates[self.corner_index[h] as usize]
    }

    /// Coordinates of a face's corners, in its corner order.
    pub fn face_uv(&self, mesh: &Mesh, f: FaceId) -> [[f64; 2]; 3] {
        mesh.face_halfedges(f).map(|h| self.corner_uv(h))
    }

    /// Change of frame from the face of `h` to the face across: carries the image of `h` in the one onto its
    /// image in the other. The identity unless the edge is cut.
    pub fn transition(&self, h: HalfedgeId) -> PlaneIsometry {
        let side = self.side[h];
        let seam = self.seams.get((side.unsigned_abs() as usize).wrapping_sub(1)).map(Seam::isometry);
        match seam {
            Some(g) if side > 0 => g,
            Some(g) => g.inverse(),
            None => PlaneIsometry::IDENTITY,
        }
    }

    /// Holonomy of a walk from face to face: the composition of the transitions across `crossed`, first one
    /// first. Each half-edge lies in the face that the walk leaves.
    pub fn holonomy(&self, crossed: impl IntoIterator<Item = HalfedgeId>) -> PlaneIsometry {
        let mut total = PlaneIsometry::IDENTITY;
        for h in crossed {
            if self.side[h] != 0 {
                total = self.transition(h).compose(&total);
            }
        }
        total
    }

    /// Holonomy of one counterclockwise turn around an interior vertex; its rotation is the curvature there
    /// mod 2π. `None` on the boundary.
    pub fn vertex_holonomy(&self, mesh: &Mesh, v: VertexId) -> Option<PlaneIsometry> {
        let mut turn: Vec<_> = mesh.outgoing(v).collect();
        turn.reverse();
        (!mesh.is_boundary_vertex(v)).then(|| self.holonomy(turn.into_iter().map(|h| mesh.prev(h))))
    }

    /// Scale the layout so that its triangles' areas add up to `area` (finite, positive); returns the factor
    /// on lengths.
    pub fn scale_to_area(&mut self, mesh: &Mesh, area: f64) -> Result<f64> {
        let factor = (area / self.area).sqrt();
        if !(factor.is_finite() && factor > 0.0) {
            let need = "the layout's area and the one asked for must be finite and positive";
            return Err(Error::Argument { what: "area", value: area.to_string(), need });
        }
        self.coordinates.as_flattened_mut().iter_mut().for_each(|x| *x *= factor);
        for seam in &mut self.seams {
            seam.translation = seam.translation.map(|x| factor * x);
        }
        self.diameter *= factor;
        self.area = area;
        self.flipped = self.find_flipped(mesh);
        Ok(factor)
    }

    fn find_flipped(&self, mesh: &Mesh) -> Vec<FaceId> {
        let turns_left = |f: &FaceId| {
            let [a, b, c] = self.face_uv(mesh, *f);
            orientation(a, b, c) == Ordering::Greater
        };
        mesh.faces().filter(|f| !turns_left(f)).collect()
    }
}

/// Per half-edge, the seam on whose left (positive) or right side it lies: [`Layout::side`].
pub(super) fn seam_sides(mesh: &Mesh, cut: &CutGraph) -> PerHalfedge<i32> {
    let mut side = PerHalfedge::filled(mesh.n_halfedges(), 0);
    for (k, segment) in cut.segments.iter().enumerate() {
        for &h in segment {
            (side[h], side[h.twin()]) = (k as i32 + 1, -(k as i32) - 1);
        }
    }
    side
}

/// The cut opens the surface into a disk; every cut edge lies in exactly one segment, once, and inside the surface.
pub(super) fn check_cut(mesh: &Mesh, cut: &CutGraph) -> Result<()> {
    check_size("is_cut", cut.is_cut.len(), mesh.n_edges())?;
    if !cut::is_disk(mesh, &cut.is_cut) {
        return Err(Error::Layout("the cut does not open the surface into a disk".into()));
    }
    let mut left = cut.is_cut.clone();
    for &h in cut.segments.iter().flatten() {
        if h.index() >= mesh.n_halfedges() || !std::mem::replace(&mut left[h.edge()], false) {
            return Err(Error::Layout(format!("half-edge {h} of a segment is not cut, or in two segments")));
        }
    }
    let wrong = mesh.edges().find(|&e| left[e] || (cut.is_cut[e] && mesh.is_boundary_edge(e)));
    wrong.map_or(Ok(()), |e| Err(Error::Layout(format!("cut edge {e} is in no segment, or on the boundary"))))
}

/// Diagonal of the points' bounding box.
pub(super) fn bounding_diagonal(points: &[[f64; 2]]) -> f64 {
    let extent = |k: usize| {
        let range = points
            .iter()
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[lo, hi], p| [lo.min(p[k]), hi.max(p[k])]);
        range[1] - range[0]
    };
    extent(0).hypot(extent(1))
}
