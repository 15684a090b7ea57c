//! Layout of a metric of constant curvature in its model space: E², H² or S².

use super::corner::number_corners;
use super::layout::{check_cut, seam_sides};
use super::space_develop::Faces;
use crate::control::Control;
use crate::error::Result;
use crate::geometry::motion::precise_point;
use crate::geometry::predicates::winding;
use crate::geometry::triangle::area_from;
use crate::geometry::{Motion, Space, Twofold, worse};
use crate::mesh::{FaceId, HalfedgeId, Mesh, PerEdge, PerFace, PerHalfedge, VertexId};
use crate::metric::Metric;
use crate::parallel;
use crate::topology::{CutGraph, check_vertex};
use std::cmp::Ordering;

/// A surface, opened along a cut, in the model space of its metric; the root vertex lies at the origin.
///
/// Points are ambient coordinates `[x, y, w]`: of the plane `w = 1`, of the hyperboloid `w² = 1 + x² + y²`
/// ([`crate::geometry::model`] has other models), of the unit sphere `x² + y² + w² = 1`. Orientation is the surface's (seen from outside
/// the sphere).
#[derive(Debug, Clone, PartialEq)]
pub struct SpaceLayout {
    /// The space.
    pub space: Space,
    /// The vertex at the origin.
    pub root: VertexId,
    /// Along which the surface is opened.
    pub cut: CutGraph,
    /// Per half-edge, the index into `points` of the corner at its origin, in its face; see [`super::Layout::corner_index`].
    pub corner_index: PerHalfedge<u32>,
    /// Ambient coordinates of the vertices of the opened surface.
    pub points: Vec<[f64; 3]>,
    /// Per segment of the cut, the isometry that carries the opened surface onto its neighbour across the left side of the segment:
    /// the image of the segment's right side onto that of its left side.
    pub pairings: Vec<Motion<Twofold>>,
    /// Faces whose images are not counterclockwise, by exact arithmetic on the points.
    pub flipped: Vec<FaceId>,
    /// Faces whose lengths break the triangle inequality, ascending.
    pub broken: Vec<FaceId>,
    /// Largest distance between where a face has its corner and where the corner lies, also across the cut by the side pairings: how far the
    /// metric is from constant curvature, and rounding, both magnified by e^radius in H².
    pub disagreement: f64,
    /// Largest distance of a point from the origin.
    pub radius: f64,
    /// Sum of the areas of the triangles, by formulas without angles.
    pub area: f64,
    /// Per face, the isometry that brings its first corner from the origin, with its first side along x, to where it lies.
    pub frames: PerFace<Motion<Twofold>>,
    /// Per half-edge: 0 if not cut, k + 1 on the left side of segment k, −(k + 1) on its right side.
    side: PerHalfedge<i32>,
}

/// Lay a metric of constant curvature out in its space, outwards from `root`, O(E log E).
///
/// Faces are added in the order in which their far corner is away from the root, and every corner is placed from the nearer end of the
/// side it is reached through: errors grow with e^distance in H². `cut`: where to open the surface; `None` for one without cones,
/// whose cut is then the locus where that order meets itself (nearly a Dirichlet domain: small, round about the root; no cut at all
/// on a sphere). Cones inside have to lie on a given cut ([`crate::topology::cut_graph`]).
///
/// Errors: [`crate::Error::Argument`] for a root that is no vertex; [`crate::Error::Layout`] for a cut that does not leave a disk, a surface
/// of several components, lengths beyond what doubles can place; those of [`Metric::lengths`]; [`crate::Error::Cancelled`].
pub fn layout_in_space(
    mesh: &Mesh,
    metric: &Metric,
    root: VertexId,
    cut: Option<&CutGraph>,
    control: &Control,
) -> Result<SpaceLayout> {
    check_vertex(mesh, root)?;
    cut.map_or(Ok(()), |cut| check_cut(mesh, cut))?;
    let faces = Faces::new(mesh, metric)?;
    let grown = faces.grow(root, cut, control)?;
    let cut = match cut {
        Some(cut) => cut.clone(),
        None => CutGraph::around(mesh, PerEdge::from_fn(mesh.n_edges(), |e| !grown.crossed[e])),
    };
    let (corner_index, n_corners) = number_corners(mesh, &cut.is_cut);
    let points = faces.place(&grown, &corner_index, n_corners);
    control.check()?;
    let mut layout = SpaceLayout {
        space: metric.space,
        root,
        pairings: cut.segments.iter().map(|segment| pairing(&faces, &grown.frames, segment)).collect(),
        flipped: Vec::new(),
        broken: mesh.faces().filter(|&f| faces.is_broken(f)).collect(),
        disagreement: 0.0,
        radius: points.iter().map(|&p| distance_from_origin(metric.space, p)).fold(0.0, f64::max),
        area: mesh
            .faces()
            .fold(Twofold::default(), |sum, f| sum + area_from(metric.space, faces.differences[f]).into())
            .high,
        side: seam_sides(mesh, &cut),
        frames: grown.frames,
        corner_index,
        points,
        cut,
    };
    layout.flipped = mesh.faces().filter(|&f| !is_counterclockwise(layout.face_points(mesh, f))).collect();
    layout.disagreement = layout.worst_corner(&faces);
    control.check()?;
    Ok(layout)
}

/// Whether three points in ambient coordinates run counterclockwise, by exact arithmetic: the sign of their determinant, which in H² is
/// the orientation of their images in the Klein disk.
pub fn is_counterclockwise([p, q, r]: [[f64; 3]; 3]) -> bool {
    winding(p, q, r) == Ordering::Greater
}

/// Distance of a point in ambient coordinates from the origin.
pub fn distance_from_origin(space: Space, [x, y, w]: [f64; 3]) -> f64 {
    let r = x.hypot(y);
    match space {
        Space::E2 => r,
        Space::H2 => r.asinh(),
        Space::S2 => r.atan2(w),
    }
}

/// The isometry that carries the right side of a segment onto its left side, from the edge nearest to the origin.
fn pairing(faces: &Faces, frames: &PerFace<Motion<Twofold>>, segment: &[HalfedgeId]) -> Motion<Twofold> {
    let frame = |h: HalfedgeId| faces.frame(frames, h);
    let far = |h: HalfedgeId| [h, h.twin()].map(|h| frame(h).displacement()).into_iter().fold(0.0, f64::max);
    match segment.iter().min_by(|&&g, &&h| far(g).total_cmp(&far(h))) {
        Some(&h) => faces.across(&frame(h), h.twin()).compose(&frame(h.twin()).inverse()),
        None => Motion::identity(faces.space),
    }
}

impl SpaceLayout {
    /// Ambient coordinates of the corner at the origin of `h`, in its face.
    pub fn corner(&self, h: HalfedgeId) -> [f64; 3] {
        self.points[self.corner_index[h] as usize]
    }

    /// Ambient coordinates of a face's corners, in its corner order.
    pub fn face_points(&self, mesh: &Mesh, f: FaceId) -> [[f64; 3]; 3] {
        mesh.face_halfedges(f).map(|h| self.corner(h))
    }

    /// On which side of which segment of the cut a half-edge lies: 0 if it is not cut, k + 1 on the left side of segment k, −(k + 1)
    /// on its right side.
    pub fn side(&self, h: HalfedgeId) -> i32 {
        self.side[h]
    }

    /// The isometry that carries the opened surface onto its neighbour across `h`; the identity unless the edge is cut.
    pub fn neighbour(&self, h: HalfedgeId) -> Motion<Twofold> {
        let side = self.side[h];
        match self.pairings.get((side.unsigned_abs() as usize).wrapping_sub(1)) {
            Some(g) if side > 0 => *g,
            Some(g) => g.inverse(),
            None => Motion::identity(self.space),
        }
    }

    /// Scale a layout in E² (nothing else has a scale): lengths by `factor`.
    pub fn scale(&mut self, factor: f64) {
        if self.space != Space::E2 {
            return;
        }
        self.points.iter_mut().for_each(|[x, y, _]| (*x, *y) = (factor * *x, factor * *y));
        self.pairings
            .iter_mut()
            .chain(self.frames.iter_mut())
            .for_each(|m| m.b = m.b.map(|x| x * factor.into()));
        (self.disagreement, self.radius) = (factor * self.disagreement, factor * self.radius);
        self.area *= factor * factor;
    }

    /// Largest distance between a corner as its face has it, and where it lies in this face's layout or, across a cut, its neighbour's.
    fn worst_corner(&self, faces: &Faces) -> f64 {
        let mesh = faces.mesh;
        let mut worst = vec![0.0; mesh.n_faces()];
        parallel::fill(&mut worst, |f| {
            let off = |h: HalfedgeId| {
                let frame = faces.frame(&self.frames, h);
                let home = frame.inverse();
                let own = home.apply(precise_point(self.space, self.corner(h))).map(f64::from);
                // The neighbour's copy of this corner, by frames: products of vectors would lose e^{2r}, those of isometries e^r.
                let across = mesh.next(h.twin());
                let other = (self.side[h] != 0)
                    .then(|| home.compose(&self.neighbour(h)).compose(&faces.frame(&self.frames, across)))
                    .map_or(0.0, |g| g.displacement());
                worse(distance_from_origin(self.space, own), other)
            };
            mesh.face_halfedges(f.into()).map(off).into_iter().fold(0.0, worse)
        });
        worst.into_iter().fold(0.0, worse)
    }
}
