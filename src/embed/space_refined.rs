//! Layout of a common refinement in a model space.

use super::corner::number_corners;
use super::quality::{Quality, refined_quality};
use super::shape::Shape;
use super::space_layout::{SpaceLayout, distance_from_origin};
use crate::control::Control;
use crate::error::{Result, check_size};
use crate::geometry::model::{distance, klein, poincare};
use crate::geometry::motion::precise_point;
use crate::geometry::triangle::area;
use crate::geometry::{Motion, Space, Twofold};
use crate::mesh::{FaceId, Mesh, PerEdge, PerFace, PerHalfedge};
use crate::metric::Refinement;
use crate::parallel;

/// A common refinement, opened along a cut, in the model space of the final metric.
///
/// A piece lies in its final face: its corners are the combinations of the face's corners, as vectors, that the refinement names,
/// brought back to the plane, the hyperboloid or the sphere. So the map from the input is projective on every piece.
#[derive(Debug, Clone, PartialEq)]
pub struct RefinedSpaceLayout {
    /// The space.
    pub space: Space,
    /// Per half-edge of [`Refinement::mesh`], the index into `points` of the corner at its origin, in its face.
    pub corner_index: PerHalfedge<u32>,
    /// Ambient coordinates ([`SpaceLayout::points`]) of the vertices of the opened refinement.
    pub points: Vec<[f64; 3]>,
    /// Whether an edge of the refinement lies on the cut.
    pub is_cut: PerEdge<bool>,
    /// Triangles with an area below −[`super::refined::FLAT`] · longest edge², seen from within.
    pub flipped: Vec<FaceId>,
    /// Triangles whose area is within that of zero.
    pub degenerate: Vec<FaceId>,
    /// As [`SpaceLayout::disagreement`].
    pub disagreement: f64,
    /// Largest distance of a point from the origin.
    pub radius: f64,
    /// Isometries that bring final faces (first corner from the origin, first side from the x axis) to where they lie …
    pub(super) frames: Vec<Motion<Twofold>>,
    /// … and per triangle of the refinement the number of its own.
    pub(super) patch: PerFace<u32>,
}

/// Lay a refinement out on the layout of its final triangulation, opened where that is; O(pieces).
///
/// Errors: [`crate::Error::Size`] for the layout of another triangulation; [`crate::Error::Cancelled`].
pub fn refine_space_layout(
    layout: &SpaceLayout,
    r: &Refinement,
    mesh: &Mesh,
    control: &Control,
) -> Result<RefinedSpaceLayout> {
    control.check()?;
    check_size("corner_index", layout.corner_index.len(), mesh.n_halfedges())?;
    let need = r.final_face.iter().map(|f| f.index() + 1).fold(0, usize::max);
    check_size("final faces", mesh.n_faces().min(need), need)?;
    let on_cut = |h| r.final_halfedge(h).is_some_and(|h| layout.cut.is_cut[h.edge()]);
    let is_cut = PerEdge::from_fn(r.mesh.n_edges(), |e: crate::mesh::EdgeId| on_cut(e.halfedge()));
    let (corner_index, n_corners) = number_corners(&r.mesh, &is_cut);
    let patch = r.final_face.iter().map(|f| f.0).collect::<Vec<_>>().into();
    let frames = layout.frames.to_vec();
    let mut refined = RefinedSpaceLayout::empty(layout.space, corner_index, n_corners, is_cut, frames, patch);
    refined.place(r, |f, _| layout.face_points(mesh, r.final_face[f]));
    control.check()?;
    refined.measure(r);
    refined.disagreement = layout.disagreement;
    control.check()?;
    Ok(refined)
}

/// The point of the plane, hyperboloid or sphere in the direction of a combination of points; at a corner, the corner itself.
pub(super) fn combination(space: Space, corners: [[f64; 3]; 3], weights: [f64; 3]) -> [f64; 3] {
    if let Some(corner) = weights.iter().position(|&w| w == 1.0) {
        return corners[corner];
    }
    let [x, y, w] = [0, 1, 2].map(|i| (0..3).map(|k| weights[k] * corners[k][i]).sum::<f64>());
    // −⟨P, P⟩ = Σ w_i² + Σ 2 w_i w_j cosh d_ij, and cosh d − 1 is half the square of the difference.
    let norm = match space {
        Space::E2 => w,
        Space::S2 => (x * x + y * y + w * w).sqrt(),
        Space::H2 => {
            let pairs = [[0, 1], [1, 2], [2, 0]].map(|[i, j]| {
                let half = (0.5 * distance(corners[i], corners[j])).sinh();
                4.0 * weights[i] * weights[j] * half * half
            });
            let sum: f64 = weights.iter().sum();
            (sum * sum + pairs.iter().sum::<f64>()).sqrt()
        }
    };
    let (x, y) = (x / norm, y / norm);
    // On the hyperboloid to the last digit.
    let w = if space == Space::H2 { 1.0f64.hypot(x.hypot(y)) } else { w / norm };
    [x, y, w]
}

/// A point of a face with this frame, by the weights of the face's corners: combined about the origin, where products of the vectors have
/// their digits.
pub(super) fn in_face(
    space: Space,
    frame: &Motion<Twofold>,
    corners: [[f64; 3]; 3],
    weights: [f64; 3],
) -> [Twofold; 3] {
    if let Some(corner) = weights.iter().position(|&w| w == 1.0) {
        return precise_point(space, corners[corner]);
    }
    let home = frame.inverse();
    let near = corners.map(|p| home.apply(precise_point(space, p)).map(f64::from));
    frame.apply(precise_point(space, combination(space, near, weights)))
}

impl RefinedSpaceLayout {
    /// Nothing placed yet.
    pub(super) fn empty(
        space: Space,
        corner_index: PerHalfedge<u32>,
        n_corners: usize,
        is_cut: PerEdge<bool>,
        frames: Vec<Motion<Twofold>>,
        patch: PerFace<u32>,
    ) -> RefinedSpaceLayout {
        RefinedSpaceLayout {
            space,
            corner_index,
            points: vec![[f64::NAN; 3]; n_corners],
            is_cut,
            flipped: Vec::new(),
            degenerate: Vec::new(),
            disagreement: 0.0,
            radius: 0.0,
            frames,
            patch,
        }
    }

    /// Place every corner by the first triangle that has it; `corners`: where a triangle has the corners of its final face, whose frame
    /// is given.
    pub(super) fn place(
        &mut self,
        r: &Refinement,
        corners: impl Fn(FaceId, &Motion<Twofold>) -> [[f64; 3]; 3],
    ) {
        for f in r.mesh.faces() {
            let frame = self.frames[self.patch[f] as usize];
            let corners = corners(f, &frame);
            for (h, weights) in r.mesh.face_halfedges(f).into_iter().zip(r.final_barycentric(f)) {
                let point = &mut self.points[self.corner_index[h] as usize];
                if point[0].is_nan() {
                    *point = in_face(self.space, &frame, corners, weights).map(f64::from);
                }
            }
        }
    }

    /// Find what is flipped, degenerate, and farthest out.
    pub(super) fn measure(&mut self, r: &Refinement) {
        let shapes = self.shapes(r);
        let faces =
            |pick: fn(&(Shape, f64)) -> bool| r.mesh.faces().filter(|f| pick(&shapes[f.index()])).collect();
        self.flipped = faces(|(shape, extent)| shape.is_flipped(*extent));
        self.degenerate = faces(|(shape, extent)| shape.is_degenerate(*extent));
        let far = self.points.iter().map(|&p| distance_from_origin(self.space, p));
        self.radius = far.fold(0.0, f64::max);
    }
    /// Ambient coordinates of a triangle's corners, in its corner order.
    pub fn face_points(&self, r: &Refinement, f: FaceId) -> [[f64; 3]; 3] {
        r.mesh.face_halfedges(f).map(|h| self.points[self.corner_index[h] as usize])
    }

    /// Plane coordinates of all points: in E² their own, in H² of the Poincaré disk, in S² by stereographic projection from the south
    /// pole.
    pub fn coordinates(&self) -> Vec<[f64; 2]> {
        self.points.iter().map(|&p| flat(self.space, p)).collect()
    }

    /// Shapes of all triangles as they are about their own place, where doubles are as dense as they can be, each with what its
    /// coordinates have been rounded at.
    fn shapes(&self, r: &Refinement) -> Vec<(Shape, f64)> {
        let mut shapes = vec![(Shape { share: 0.0, longest: 0.0 }, 0.0); r.mesh.n_faces()];
        parallel::fill(&mut shapes, |f| {
            let f = FaceId::from(f);
            let points = self.face_points(r, f);
            let near = self.brought_home(f, points);
            let plane = points.map(|[x, y, _]| x.hypot(y)).into_iter().fold(0.0, f64::max);
            let extent = if self.space == Space::E2 { plane } else { plane.max(1.0) };
            let image = near.map(|p| if self.space == Space::E2 { [p[0], p[1]] } else { klein(p) });
            (Shape::of(image), extent)
        });
        shapes
    }

    /// Points of a triangle moved by the isometry that brings the first corner of its final face to the origin.
    fn brought_home(&self, f: FaceId, points: [[f64; 3]; 3]) -> [[f64; 3]; 3] {
        let home = self.frames[self.patch[f] as usize].inverse();
        points.map(|p| home.apply(precise_point(self.space, p)).map(f64::from))
    }

    /// How the vertex-linear maps from the input's pieces to [`RefinedSpaceLayout::coordinates`] distort, with the Euclidean `lengths` of
    /// the input's edges; areas are those of the space.
    ///
    /// Triangles that are degenerate on either side are named, and left out of the mean and the extremes. Errors: [`crate::Error::Size`],
    /// [`crate::Error::EdgeLength`], [`crate::Error::TriangleInequality`].
    pub fn quality(&self, r: &Refinement, input: &Mesh, lengths: &PerEdge<f64>) -> Result<Quality> {
        let flat_out = self.degenerate.iter().chain(&self.flipped);
        let mut is_flat = PerFace::filled(r.mesh.n_faces(), false);
        flat_out.for_each(|&f| is_flat[f] = true);
        let image = |f| {
            let points = self.face_points(r, f);
            let sound = !is_flat[f];
            let area = match self.space {
                Space::E2 => {
                    let [a, b, c] = points.map(|p| [p[0], p[1]]);
                    0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])).abs()
                }
                Space::H2 => {
                    let [a, b, c] = self.brought_home(f, points);
                    area(Space::H2, [distance(b, c), distance(c, a), distance(a, b)])
                }
                Space::S2 => {
                    area(Space::S2, [[1, 2], [2, 0], [0, 1]].map(|[i, j]| spherical(points[i], points[j])))
                }
            };
            (points.map(|p| flat(self.space, p)), area, sound)
        };
        refined_quality(r, input, lengths, image)
    }
}

fn flat(space: Space, p: [f64; 3]) -> [f64; 2] {
    if space == Space::E2 { [p[0], p[1]] } else { poincare(p) }
}

/// Angle between two unit vectors.
fn spherical(p: [f64; 3], q: [f64; 3]) -> f64 {
    let half = (0..3).map(|i| (p[i] - q[i]) * (p[i] - q[i])).sum::<f64>().sqrt() * 0.5;
    2.0 * half.min(1.0).asin()
}
