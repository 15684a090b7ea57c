//! Layouts: the coordinates of a surface that is opened along a cut, in the space of its metric.
//!
//! ```
//! use ricci::embed::{Layout, LayoutOptions};
//! use ricci::{Class, Control, Solution, Surface, geometry::Space, mesh::shapes};
//! # fn main() -> ricci::Result<()> {
//! let (mesh, lengths) = shapes::flat_torus([0.0, 1.0], 4, 4)?.build()?;
//! let torus = Surface::intrinsic(mesh, lengths, Space::E2)?;
//! let flat = Solution::initial_of(torus, Class::yamabe(Space::E2))?;
//! let layout = Layout::of_solution(&flat, &LayoutOptions::default(), &Control::new())?;
//! let [x, y] = layout.modulus().unwrap();
//! assert!(x.abs() < 1e-14 && (y - 1.0).abs() < 1e-14);
//! # Ok(())
//! # }
//! ```

use super::pieces::LayoutPieces;
use crate::archive::stored;
use crate::error::{Error, Result};
use crate::geometry::complex::{norm, quick_norm};
use crate::geometry::model::{distance as hyperbolic_distance, poincare};
use crate::geometry::modulus::modulus;
use crate::geometry::motion::precise_point;
use crate::geometry::predicates::{orientation, winding};
use crate::geometry::triangle_flatness::{
    TriangleFlatness, TriangleOrientation, is_surely_upright, largest_coordinate,
};
use crate::geometry::{DoubleDouble, Motion, PlaneIsometry, Space};
use crate::mesh::{FaceId, HalfedgeId, Mesh, PerFace, PerHalfedge, VertexId};
use crate::metric::CommonSubdivision;
use crate::parallel;
use crate::topology::{CutGraph, corner_walk, number_corners};
use std::cmp::Ordering;
use std::sync::Arc;

/// Relative rounding error of one step from face to face: a direction is turned by an angle and made a unit vector again, a few ulp.
const STEP_ROUNDING: f64 = 4.0 * f64::EPSILON;
/// Distance in H² by which the two sides of a seam may differ however exact the metric is: in a cover that is drawn or written in f64,
/// copies of the layout need not meet more exactly.
pub const MEETING: f64 = 1e-8;

/// A surface, opened along a cut, in the model space of its metric: E², H² or S². Orientation is the surface's (of a sphere seen from
/// outside).
///
/// The triangles that are laid out are those of [`Layout::mesh`]: the metric's own triangulation, or its common subdivision with the surface
/// as it came. A triangle of the subdivision, a *piece*, lies in its *final face*, a triangle of the metric's triangulation: the corners of
/// the piece are combinations of the face's corners, as vectors, with the weights of the subdivision, brought back to the plane, the
/// hyperboloid or the sphere. So the map from the input is projective on every piece: with the homogeneous weights q of the corners
/// ([`CommonSubdivision::weight`]) and their ambient coordinates P, it is q P that is linear.
#[derive(Debug, Clone, PartialEq)]
pub struct Layout {
    /// The space.
    pub space: Space,
    /// The cut along which the surface is opened.
    pub cut: CutGraph,
    /// Per half-edge, the index into `points` of the corner at its origin, in its face. Corners around a vertex share an index unless cut
    /// or boundary edges separate them. A half-edge outside the surface has the index of the corner at its origin in the face across the
    /// edge.
    pub corner_index: PerHalfedge<u32>,
    /// Ambient coordinates `[x, y, w]` of the vertices of the opened surface: of the plane `w = 1`, of the hyperboloid
    /// `w² = 1 + x² + y²` ([`crate::geometry::model`] has other models), of the unit sphere `x² + y² + w² = 1`.
    pub points: Vec<[f64; 3]>,
    /// Plane coordinates of these vertices: in E² their own, in H² those of the Poincaré disk, in S² the stereographic projection from the
    /// south pole.
    pub coordinates: Vec<[f64; 2]>,
    /// One seam per segment of the cut, in the same order.
    pub seams: Vec<Seam>,
    /// Triangles that are not counterclockwise. Of a metric's own triangulation: clockwise or without area, by exact arithmetic. Of a
    /// subdivision: those whose area is below −[`crate::geometry::triangle_flatness::LEAST_RELATIVE_AREA`] · longest edge², by more than
    /// rounding explains.
    pub flipped: Vec<FaceId>,
    /// Triangles of a subdivision whose area differs from zero by no more than that.
    pub degenerate: Vec<FaceId>,
    /// Triangles in final faces whose lengths break the triangle inequality, ascending. They are laid out with angles (π, 0, 0), and the
    /// layout does not represent the metric there.
    pub broken: Vec<FaceId>,
    /// Largest distance between the place of a corner by its face and the place that it got, also across the cut by the seams' pairings: it
    /// consists of the metric's deviation from constant curvature off the cones and of rounding, both magnified by e^radius in H². See
    /// [`Layout::consistency`].
    pub disagreement: f64,
    /// Largest difference, as a vector, between an edge by its face and the edge in the layout, relative to the longest side of the final
    /// face.
    pub local_consistency: f64,
    /// Largest distance of a point from the origin.
    pub radius: f64,
    /// Diagonal of the bounding box of `coordinates`; infinite for a vertex at the south pole of the sphere.
    pub diameter: f64,
    /// Area of the surface, by formulas without angles; for the given half of a double, half of the double's area.
    pub area: f64,
    /// Lengths in the layout over lengths in the metric.
    pub scale: f64,
    /// The low parts of x and y in double-double precision, beside `points`, at corners of final faces; empty if only the f64s are known.
    pub(super) remainders: Vec<[f64; 2]>,
    /// The triangles that are laid out.
    pub(super) pieces: LayoutPieces,
    /// The surface as it came and the cut on it, where the cut runs along its edges.
    pub(super) input: Option<(Arc<Mesh>, CutGraph)>,
    /// Per half-edge: 0 if not cut, k + 1 on the left side of seam k, −(k + 1) on its right side.
    pub(super) side: PerHalfedge<i32>,
    /// Upper bound of the number of final faces between the origin and the farthest piece.
    pub(super) n_steps: usize,
    /// The frames of the final faces' first half-edges, in double-double precision; empty if the layout was computed in f64.
    pub(super) frames: Vec<Motion<DoubleDouble>>,
    /// Per triangle, the number of its final face's frame in `frames`.
    pub(super) patch: PerFace<u32>,
}

/// The isometry between the two sides of a segment of the cut.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Seam {
    /// The isometry that carries the opened surface onto its neighbour across the left side of the segment: the image of its right side
    /// onto that of its left side.
    pub pairing: Motion<DoubleDouble>,
    /// The largest distance, at an edge of the segment, between this isometry and the edge's own: relative to the layout's diameter in E²,
    /// a distance elsewhere.
    pub residual: f64,
}
stored!(row Seam { pairing: Motion<DoubleDouble>, residual: f64 });

/// Largest rotation, in radians, of an isometry that counts as a translation. On flat tori, whose sides are paired by translations,
/// rounding in double-double precision leaves about 1e-30, and positions in f64 show no rotation below 1e-16.
const LEAST_ROTATION: f64 = 1e-24;

impl Seam {
    /// In E², the isometry `z ↦ e^{iθ} z + t` from the left side to the right side; a translation has θ = 0 exactly.
    pub fn isometry(&self) -> PlaneIsometry {
        let isometry = PlaneIsometry::from(self.pairing.inverse());
        let is_translation = isometry.rotation.abs() < LEAST_ROTATION;
        PlaneIsometry { rotation: if is_translation { 0.0 } else { isometry.rotation }, ..isometry }
    }
}

/// The layout on the faces of the surface as it came, on each of which the map is made linear between its corners.
#[derive(Debug, Clone, PartialEq)]
pub struct OnInput {
    /// Per half-edge of the input, the index into `points` of the corner at its origin ([`Layout::corner_index`]).
    pub corner_index: PerHalfedge<u32>,
    /// Per vertex of the opened input, its index in [`Layout::points`] and [`Layout::coordinates`].
    pub points: Vec<u32>,
    /// Their plane coordinates.
    pub coordinates: Vec<[f64; 2]>,
    /// Faces of the input that are not counterclockwise in these coordinates, by exact arithmetic: there the map folds.
    pub flipped: Vec<FaceId>,
    /// The cut on the input.
    pub cut: CutGraph,
}

impl Layout {
    /// The triangles that are laid out.
    pub fn mesh(&self) -> &Mesh {
        self.pieces.mesh()
    }

    /// The common subdivision that is laid out; `None` if the metric's own triangulation is.
    pub fn common_subdivision(&self) -> Option<&Arc<CommonSubdivision>> {
        self.pieces.common_subdivision()
    }

    /// Plane coordinates of the corner at the origin of `h`, in its face.
    pub fn uv(&self, h: HalfedgeId) -> [f64; 2] {
        self.coordinates[self.corner_index[h] as usize]
    }

    /// Plane coordinates of a face's corners, in its corner order.
    pub fn face_uv(&self, f: FaceId) -> [[f64; 2]; 3] {
        self.mesh().face_halfedges(f).map(|h| self.uv(h))
    }

    /// Ambient coordinates of the corner at the origin of `h`, in its face.
    pub fn corner(&self, h: HalfedgeId) -> [f64; 3] {
        self.points[self.corner_index[h] as usize]
    }

    /// Ambient coordinates of a face's corners, in its corner order.
    pub fn face_points(&self, f: FaceId) -> [[f64; 3]; 3] {
        self.mesh().face_halfedges(f).map(|h| self.corner(h))
    }

    /// The layout on the faces of the surface as it came; `None` where the cut does not run along its edges.
    pub fn on_input(&self) -> Option<OnInput> {
        let (input, cut) = self.input.as_ref()?;
        let flipped = |uv: &(dyn Fn(HalfedgeId) -> [f64; 2] + Sync)| {
            faces_where(input, |f| !is_left_turn(input.face_halfedges(f).map(uv)))
        };
        // The input itself is laid out: its corners are those of the layout.
        if std::ptr::eq(&**input, self.mesh()) && cut.is_cut == self.cut.is_cut {
            return Some(OnInput {
                corner_index: self.corner_index.clone(),
                points: (0..self.points.len() as u32).collect(),
                coordinates: self.coordinates.clone(),
                flipped: if self.space == Space::E2 {
                    self.flipped.clone()
                } else {
                    flipped(&|h| self.uv(h))
                },
                cut: cut.clone(),
            });
        }
        let (corner_index, n) = number_corners(input, &cut.is_cut);
        let mut points = vec![0; n];
        for f in self.mesh().faces() {
            let face = input.face_halfedges(self.pieces.input_face(f));
            for (k, h) in self.mesh().face_halfedges(f).into_iter().enumerate() {
                if let Some(corner) = self.pieces.input_place((f, k), h).corner() {
                    points[corner_index[face[corner]] as usize] = self.corner_index[h];
                }
            }
        }
        let coordinates: Vec<_> = points.iter().map(|&k| self.coordinates[k as usize]).collect();
        let flipped = flipped(&|h| coordinates[corner_index[h] as usize]);
        Some(OnInput { corner_index, points, coordinates, flipped, cut: cut.clone() })
    }

    /// Plane coordinates of the corners of the input's own faces (F × 3 points, in its face and corner order): [`Layout::on_input`].
    pub fn corner_uv(&self) -> Option<Vec<[[f64; 2]; 3]>> {
        let (input, on_input) = (&self.input.as_ref()?.0, self.on_input()?);
        let point = |h: HalfedgeId| on_input.coordinates[on_input.corner_index[h] as usize];
        Some(input.faces().map(|f| input.face_halfedges(f).map(point)).collect())
    }

    /// The side of the seam on which a half-edge lies: 0 if it is not cut, k + 1 on the left side of seam k, −(k + 1) on its right side.
    pub fn side(&self, h: HalfedgeId) -> i32 {
        self.side[h]
    }

    /// The isometry that carries the opened surface onto its neighbour across `h`; the identity unless the edge is cut.
    pub fn neighbour(&self, h: HalfedgeId) -> Motion<DoubleDouble> {
        let side = self.side[h];
        match self.seams.get((side.unsigned_abs() as usize).wrapping_sub(1)) {
            Some(seam) if side > 0 => seam.pairing,
            Some(seam) => seam.pairing.inverse(),
            None => Motion::identity(self.space),
        }
    }

    /// The isometry that carries the image of `h` in its face onto its image in the face across: the inverse of [`Layout::neighbour`].
    pub fn transition(&self, h: HalfedgeId) -> Motion<DoubleDouble> {
        self.neighbour(h.twin())
    }

    /// Holonomy of a walk from face to face: the composition of the transitions across the half-edges `crossed`, in the order of the walk.
    /// Each half-edge lies in the face that the walk leaves.
    pub fn holonomy(&self, crossed: impl IntoIterator<Item = HalfedgeId>) -> Motion<DoubleDouble> {
        let cut = crossed.into_iter().filter(|&h| self.side[h] != 0);
        cut.fold(Motion::identity(self.space), |total, h| self.transition(h).compose(&total))
    }

    /// Holonomy of one counterclockwise turn around an interior vertex; its rotation is the curvature there mod 2π. `None` on the
    /// boundary.
    pub fn vertex_holonomy(&self, v: VertexId) -> Option<Motion<DoubleDouble>> {
        let mesh = self.mesh();
        let mut turn: Vec<_> = mesh.outgoing(v).collect();
        turn.reverse();
        (!mesh.is_boundary_vertex(v)).then(|| self.holonomy(turn.into_iter().map(|h| mesh.prev(h))))
    }

    /// The vertices of the lift of an edge path that starts at the corner at the origin of `corner` (a half-edge of a face), in ambient
    /// coordinates: the start, then the end of each edge, also where the path leads into copies of the layout.
    ///
    /// A loop that starts at [`super::DeckGroup::corner`] ends where its element carries the start.
    ///
    /// # Errors
    /// [`Error::Argument`] for edges that do not follow one another, or a path that does not start at that corner.
    pub fn lift(&self, corner: HalfedgeId, path: &[HalfedgeId]) -> Result<Vec<[f64; 3]>> {
        let mut copy = Motion::identity(self.space);
        let place = |copy: &Motion<DoubleDouble>, at: HalfedgeId| {
            copy.apply(precise_point(self.space, self.corner(at))).map(f64::from)
        };
        let walk = corner_walk(self.mesh(), corner, path)?;
        let mut points = vec![place(&copy, corner)];
        for (crossed, at) in walk {
            copy = crossed.into_iter().fold(copy, |copy, h| copy.compose(&self.neighbour(h)));
            points.push(place(&copy, at));
        }
        Ok(points)
    }

    /// Largest disagreement of the layout with the metric or of the two sides of a seam: relative to the layout's diameter in E², a
    /// distance in H² and S².
    pub fn consistency(&self) -> f64 {
        if self.space == Space::E2 { self.disagreement / self.diameter } else { self.disagreement }
    }

    /// The largest [`Layout::consistency`] that rounding and curvature errors explain. `curvature_errors`: the sum of their absolute values
    /// over the vertices.
    pub fn consistency_limit(&self, curvature_errors: f64) -> f64 {
        // A vertex with curvature error δ turns the part of the layout beyond it by δ: in E² this moves points by at most δ of the
        // diameter, in H² a point at distance r by sinh(r) δ.
        let off = curvature_errors + STEP_ROUNDING * self.n_steps as f64;
        if self.space == Space::H2 { MEETING.max(self.radius.sinh() * off) } else { off }
    }

    /// The modulus of a flat torus, `[Re τ, Im τ]` reduced ([`crate::geometry::modulus`]); `None` for another surface, or one with cones.
    pub fn modulus(&self) -> Option<[f64; 2]> {
        let mesh = self.mesh();
        let is_torus = self.space == Space::E2 && mesh.is_closed() && mesh.euler() == 0;
        if !is_torus {
            return None;
        }
        let pairings: Vec<PlaneIsometry> = self.seams.iter().map(Seam::isometry).collect();
        if pairings.iter().any(|g| g.rotation.abs() > MOST_ROTATION) {
            return None;
        }
        // Any two that are not parallel generate the lattice.
        let least = LEAST_PERIOD * self.diameter;
        let mut periods = pairings.iter().map(|g| g.translation).filter(|&t| norm(t) > least);
        let first = periods.next()?;
        periods.find_map(|t| modulus([first, t]))
    }

    /// Sets the lists of flipped and degenerate triangles.
    pub(super) fn find_flat(&mut self) {
        let mesh = self.pieces.mesh();
        if self.pieces.common_subdivision().is_none() {
            self.flipped = match self.space {
                Space::E2 => faces_where(mesh, |f| !is_left_turn(self.face_uv(f))),
                // In H² the sign of the determinant is the orientation in the Klein disk.
                _ => faces_where(mesh, |f| {
                    let [p, q, r] = self.face_points(f);
                    winding(p, q, r) != Ordering::Greater
                }),
            };
            return;
        }
        let extent = largest_coordinate(&self.coordinates);
        let mut orientation = vec![TriangleOrientation::Upright; mesh.n_faces()];
        parallel::fill(&mut orientation, |f| self.orientation(f.into(), extent));
        let faces = |wanted| mesh.faces().filter(|f| orientation[f.index()] == wanted).collect();
        (self.flipped, self.degenerate) =
            (faces(TriangleOrientation::Flipped), faces(TriangleOrientation::Degenerate));
    }

    /// The orientation of a triangle of a subdivision; `extent`: the largest coordinate of the whole layout, at which corners in E² are
    /// rounded. In H² and S² the triangle is moved to the origin first.
    pub(super) fn orientation(&self, f: FaceId, extent: f64) -> TriangleOrientation {
        if self.space == Space::E2 {
            return TriangleFlatness::of(self.face_uv(f)).orientation(extent);
        }
        let points = self.face_points(f);
        if self.space == Space::H2 && is_surely_upright(points) {
            return TriangleOrientation::Upright;
        }
        let (flatness, extent) = TriangleFlatness::in_curved_space(points, self.moved_to_origin(points));
        flatness.orientation(extent)
    }

    /// The points moved by an isometry that brings the first of them to the origin.
    pub(super) fn moved_to_origin(&self, points: [[f64; 3]; 3]) -> [[f64; 3]; 3] {
        let home = Motion::to_origin(self.space, precise_point(self.space, points[0]));
        points.map(|p| home.apply(precise_point(self.space, p)).map(f64::from))
    }

    /// The frame of the first half-edge of a triangle's final face, for a layout that was computed in double-double precision
    /// ([`super::LayoutOpening::MetricEdges`]).
    pub(super) fn frame(&self, f: FaceId) -> Result<Motion<DoubleDouble>> {
        let frame = self.frames.get(*self.patch.get(f.index()).unwrap_or(&u32::MAX) as usize);
        frame
            .copied()
            .ok_or_else(|| Error::Layout(format!("face {f} has no frame in double-double precision")))
    }
}

/// Largest translation of a seam, in diameters of the layout, that counts as none: such a seam leads to a vertex and back. The bound is far
/// above the rounding of coordinates and far below the length of an edge.
const LEAST_PERIOD: f64 = 1e-9;
/// Largest rotation of a side pairing, in radians, on a surface without cones. The bound is far above the tolerance of a flow to curvature
/// 0 and far below the curvature of a cone that a caller asks for.
const MOST_ROTATION: f64 = 1e-6;

pub(super) fn faces_where(mesh: &Mesh, is_so: impl Fn(FaceId) -> bool + Sync) -> Vec<FaceId> {
    let mut found = vec![false; mesh.n_faces()];
    parallel::fill(&mut found, |f| is_so(f.into()));
    mesh.faces().filter(|f| found[f.index()]).collect()
}

pub(super) fn is_left_turn([a, b, c]: [[f64; 2]; 3]) -> bool {
    orientation(a, b, c) == Ordering::Greater
}

/// The distance of a point in ambient coordinates from the origin.
pub fn distance_from_origin(space: Space, [x, y, w]: [f64; 3]) -> f64 {
    let r = x.hypot(y);
    match space {
        Space::E2 => r,
        Space::H2 => r.asinh(),
        Space::S2 => r.atan2(w),
    }
}

/// The largest distance of points in ambient coordinates from the origin.
pub(super) fn radius(space: Space, points: &[[f64; 3]]) -> f64 {
    let far = points.iter().map(|&p| match space {
        // This grows with the distance, which is found from it at the end.
        Space::E2 | Space::H2 => quick_norm([p[0], p[1]]),
        Space::S2 => distance_from_origin(space, p),
    });
    let far = far.fold(0.0, f64::max);
    if space == Space::H2 { far.asinh() } else { far }
}

/// The distance of two points in ambient coordinates; in H² both have to be near the origin.
pub fn distance(space: Space, p: [f64; 3], q: [f64; 3]) -> f64 {
    match space {
        Space::E2 => (p[0] - q[0]).hypot(p[1] - q[1]),
        Space::H2 => hyperbolic_distance(p, q),
        Space::S2 => {
            let chord = (0..3).map(|i| (p[i] - q[i]) * (p[i] - q[i])).sum::<f64>().sqrt();
            2.0 * (0.5 * chord).min(1.0).asin()
        }
    }
}

/// The plane coordinates of a point in ambient coordinates ([`Layout::coordinates`]).
pub(super) fn flat(space: Space, p: [f64; 3]) -> [f64; 2] {
    if space == Space::E2 { [p[0], p[1]] } else { poincare(p) }
}

/// The diagonal of the points' bounding box.
pub fn bounding_diagonal(points: &[[f64; 2]]) -> f64 {
    let extent = |k: usize| {
        let range = points
            .iter()
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[lo, hi], p| [lo.min(p[k]), hi.max(p[k])]);
        range[1] - range[0]
    };
    extent(0).hypot(extent(1))
}
