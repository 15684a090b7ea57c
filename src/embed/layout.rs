//! A surface, opened along a cut, in the space of its metric.
//!
//! ```
//! use ricci::embed::{UnrollOptions, unroll};
//! use ricci::{Class, Control, Solution, Surface, geometry::Space, mesh::shapes};
//! # fn main() -> ricci::Result<()> {
//! let (mesh, lengths) = shapes::flat_torus([0.0, 1.0], 4, 4)?.build()?;
//! let torus = Surface::intrinsic(mesh, lengths, Space::E2)?;
//! let flat = Solution::initial_of(torus, Class::yamabe(Space::E2))?;
//! let layout = unroll(&flat, &UnrollOptions::default(), &Control::new())?;
//! let [x, y] = layout.modulus().unwrap();
//! assert!(x.abs() < 1e-14 && (y - 1.0).abs() < 1e-14);
//! # Ok(())
//! # }
//! ```

use super::pieces::Pieces;
use super::shape::{Shape, Standing, extent, is_surely_upright};
use crate::error::{Error, Result};
use crate::geometry::complex::{norm, quick_norm};
use crate::geometry::model::{distance as hyperbolic_distance, klein, poincare};
use crate::geometry::modulus::modulus;
use crate::geometry::motion::precise_point;
use crate::geometry::predicates::{orientation, winding};
use crate::geometry::{DoubleDouble, Motion, PlaneIsometry, Space};
use crate::mesh::{FaceId, HalfedgeId, Mesh, PerFace, PerHalfedge, VertexId};
use crate::metric::Refinement;
use crate::parallel;
use crate::topology::{CutGraph, corner_walk, number_corners};
use std::cmp::Ordering;
use std::sync::Arc;

/// Relative rounding error of one step of a development: a direction is turned by an angle and made a unit vector again, a few ulp.
const STEP_ROUNDING: f64 = 4.0 * f64::EPSILON;
/// Distance in H² by which the two sides of a seam may differ however exact the metric is: copies of the layout need to meet no better, in
/// a cover that is drawn or written in doubles.
pub const MEETING: f64 = 1e-8;

/// A surface, opened along a cut, in the model space of its metric: E², H² or S². Orientation is the surface's (of a sphere seen from
/// outside).
///
/// What is laid out is [`Layout::mesh`]: the metric's own triangulation, or a common refinement of it with the surface as it came. Then a
/// *piece*, a triangle of the refinement, lies in its *final face*, a triangle of the metric's: its corners are the combinations of the
/// face's corners, as vectors, that the refinement names, brought back to the plane, the hyperboloid or the sphere. So the map from the
/// input is projective on every piece: with the homogeneous weights q of its corners ([`Refinement::weight`]) and their ambient coordinates
/// P it is q P that is linear.
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
    /// Plane coordinates of these vertices: in E² their own, in H² of the Poincaré disk, in S² by stereographic projection from the south
    /// pole.
    pub coordinates: Vec<[f64; 2]>,
    /// One seam per segment of the cut, in the same order.
    pub seams: Vec<Seam>,
    /// Triangles that are not counterclockwise. Of a metric's own triangulation: clockwise or without area, by exact arithmetic. Of a
    /// refinement: those with an area below −[`super::shape::LEAST_SHARE`] · longest edge², and by more than rounding explains.
    pub flipped: Vec<FaceId>,
    /// Triangles of a refinement whose area differs from zero by no more than this.
    pub degenerate: Vec<FaceId>,
    /// Triangles in final faces whose lengths break the triangle inequality, ascending: they are laid out with angles (π, 0, 0), and the
    /// layout does not represent the metric there.
    pub broken: Vec<FaceId>,
    /// Largest distance between where a face has its corner and where the corner lies, also across the cut by the seams' pairings: how far
    /// the metric is from constant curvature off the cones, and rounding, both magnified by e^radius in H². See [`Layout::consistency`].
    pub disagreement: f64,
    /// Largest difference between an edge as its face has it and as it lies, relative to the longest side of the final face.
    pub local_consistency: f64,
    /// Largest distance of a point from the origin.
    pub radius: f64,
    /// Diagonal of the bounding box of `coordinates`; infinite for a vertex at the south pole of the sphere.
    pub diameter: f64,
    /// Area of the surface, by formulas without angles; of a double's given half, half of the double's.
    pub area: f64,
    /// Lengths in the layout over lengths in the metric.
    pub scale: f64,
    /// What the doubles of `points` miss of x and y at corners of final faces; none where no more is known.
    pub(super) remainders: Vec<[f64; 2]>,
    pub(super) pieces: Pieces,
    /// The surface as it came and the cut on it, where the cut runs along its edges.
    pub(super) input: Option<(Arc<Mesh>, CutGraph)>,
    /// Per half-edge: 0 if not cut, k + 1 on the left side of seam k, −(k + 1) on its right side.
    pub(super) side: PerHalfedge<i32>,
    /// Number of final faces between the origin and the farthest piece, at most.
    pub(super) n_steps: usize,
    /// The frames of the final faces' first half-edges, with twice the digits; none where doubles were enough.
    pub(super) frames: Vec<Motion<DoubleDouble>>,
    /// Per triangle, the number of its final face's frame in `frames`.
    pub(super) patch: PerFace<u32>,
}

/// How the two sides of a segment of the cut lie to each other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Seam {
    /// The isometry that carries the opened surface onto its neighbour across the left side of the segment: the image of its right side
    /// onto that of its left side.
    pub pairing: Motion<DoubleDouble>,
    /// The largest distance, at an edge of the segment, between this isometry and the edge's own: relative to the layout's diameter in E²,
    /// a distance elsewhere.
    pub residual: f64,
}

/// Rotation in radians below which an isometry counts as a translation. Rounding of numbers with twice the digits leaves about 1e-30 on
/// flat tori, whose sides are paired by translations, and positions in doubles show no rotation below 1e-16.
const LEAST_ROTATION: f64 = 1e-24;

impl Seam {
    /// In E², the isometry `z ↦ e^{iθ} z + t` from the left side to the right side; a translation has θ = 0 exactly.
    pub fn isometry(&self) -> PlaneIsometry {
        let isometry = PlaneIsometry::from(self.pairing.inverse());
        let is_translation = isometry.rotation.abs() < LEAST_ROTATION;
        PlaneIsometry { rotation: if is_translation { 0.0 } else { isometry.rotation }, ..isometry }
    }
}

/// The layout on the surface as it came: where its corners lie if the map is made linear on its own faces.
#[derive(Debug, Clone, PartialEq)]
pub struct OnInput {
    /// Per half-edge of the input, the index into `points` of the corner at its origin ([`Layout::corner_index`]).
    pub corner_index: PerHalfedge<u32>,
    /// Which of [`Layout::points`], and so of [`Layout::coordinates`], the vertices of the opened input are.
    pub points: Vec<u32>,
    /// Their plane coordinates.
    pub coordinates: Vec<[f64; 2]>,
    /// Faces of the input that are not counterclockwise in these coordinates, by exact arithmetic: there the map folds.
    pub flipped: Vec<FaceId>,
    /// The cut on the input.
    pub cut: CutGraph,
}

impl Layout {
    /// What is laid out.
    pub fn mesh(&self) -> &Mesh {
        self.pieces.mesh()
    }

    /// The common refinement that is laid out; `None` where that is the metric's own triangulation.
    pub fn refinement(&self) -> Option<&Arc<Refinement>> {
        self.pieces.refinement()
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

    /// On which side of which seam a half-edge lies: 0 if it is not cut, k + 1 on the left side of seam k, −(k + 1) on its right side.
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

    /// Change of frame from the face of `h` to the face across: carries the image of `h` in the one onto its image in the other. The
    /// inverse of [`Layout::neighbour`].
    pub fn transition(&self, h: HalfedgeId) -> Motion<DoubleDouble> {
        self.neighbour(h.twin())
    }

    /// Holonomy of a walk from face to face: the composition of the transitions across `crossed`, first one first. Each half-edge
    /// lies in the face that the walk leaves.
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

    /// The largest [`Layout::consistency`] that rounding and curvature errors explain; these are given by the sum of their absolute values
    /// over the vertices.
    pub fn consistency_limit(&self, curvature_errors: f64) -> f64 {
        // A vertex with curvature error δ turns what lies beyond it by δ: in E² that moves it by at most δ of the diameter, in H² a point
        // at distance r by sinh(r) δ.
        let off = curvature_errors + STEP_ROUNDING * self.n_steps as f64;
        if self.space == Space::H2 { MEETING.max(self.radius.sinh() * off) } else { off }
    }

    /// The modulus of a flat torus, `[Re τ, Im τ]` reduced ([`crate::geometry::modulus`]); `None` for another surface, or one with cones.
    pub fn modulus(&self) -> Option<[f64; 2]> {
        let mesh = self.mesh();
        let is_torus = self.space == Space::E2 && mesh.is_closed() && mesh.euler() == 0;
        let pairings: Vec<PlaneIsometry> = match is_torus {
            true => self.seams.iter().map(Seam::isometry).collect(),
            false => return None,
        };
        if pairings.iter().any(|g| g.rotation.abs() > TURNS) {
            return None;
        }
        // Any two that are not parallel generate the lattice.
        let least = LEAST_PERIOD * self.diameter;
        let mut periods = pairings.iter().map(|g| g.translation).filter(|&t| norm(t) > least);
        let first = periods.next()?;
        periods.find_map(|t| modulus([first, t]))
    }

    /// Finds the triangles that are flipped or degenerate.
    pub(super) fn find_flat(&mut self) {
        let mesh = self.pieces.mesh();
        if self.pieces.refinement().is_none() {
            self.flipped = match self.space {
                Space::E2 => faces_where(mesh, |f| !is_left_turn(self.face_uv(f))),
                // The sign of the determinant is in H² the orientation in the Klein disk.
                _ => faces_where(mesh, |f| {
                    let [p, q, r] = self.face_points(f);
                    winding(p, q, r) != Ordering::Greater
                }),
            };
            return;
        }
        let size = extent(&self.coordinates);
        let mut standing = vec![Standing::Upright; mesh.n_faces()];
        parallel::fill(&mut standing, |f| self.standing(f.into(), size));
        let faces = |so: Standing| mesh.faces().filter(|f| standing[f.index()] == so).collect();
        (self.flipped, self.degenerate) = (faces(Standing::Flipped), faces(Standing::Degenerate));
    }

    /// How a triangle lies; `size`: as [`Layout::shape`] has it.
    fn standing(&self, f: FaceId, size: f64) -> Standing {
        if self.space == Space::H2 && is_surely_upright(self.face_points(f)) {
            return Standing::Upright;
        }
        let (shape, extent) = self.shape(f, size);
        Standing::of(&shape, extent)
    }

    /// The shape of a triangle, and the size of the coordinates at which its corners have been rounded: in E² `size`, the one of the whole
    /// layout. In H² and S² the triangle is first moved to the origin, where doubles are densest.
    pub(super) fn shape(&self, f: FaceId, size: f64) -> (Shape, f64) {
        if self.space == Space::E2 {
            return (Shape::of(self.face_uv(f)), size);
        }
        let points = self.face_points(f);
        shape_of(points, self.brought_home(points))
    }

    /// Points moved by an isometry that brings the first of them to the origin.
    pub(super) fn brought_home(&self, points: [[f64; 3]; 3]) -> [[f64; 3]; 3] {
        let home = Motion::to_origin(self.space, precise_point(self.space, points[0]));
        points.map(|p| home.apply(precise_point(self.space, p)).map(f64::from))
    }

    /// The frame of the first half-edge of a triangle's final face, of a layout with frames of twice the digits ([`super::layout_about`]).
    pub(super) fn frame(&self, f: FaceId) -> Result<Motion<DoubleDouble>> {
        let frame = self.frames.get(*self.patch.get(f.index()).unwrap_or(&u32::MAX) as usize);
        frame.copied().ok_or_else(|| Error::Layout(format!("face {f} has no frame of twice the digits")))
    }
}

/// [`Layout::shape`] in H² and S² of a triangle with these corners, which are `home` where it has been moved to the origin.
pub(super) fn shape_of(corners: [[f64; 3]; 3], home: [[f64; 3]; 3]) -> (Shape, f64) {
    let far = corners.map(|[x, y, _]| x.hypot(y)).into_iter().fold(1.0, f64::max);
    (Shape::of(home.map(klein)), far)
}

/// Length, in diameters of the layout, below which the translation of a seam counts as none: the seam then leads to a vertex and back. It
/// is far above the rounding of coordinates and far below an edge.
const LEAST_PERIOD: f64 = 1e-9;
/// Rotation in radians above which a side pairing shows that the surface has cones. It is far above the tolerance of a flow to curvature 0
/// and far below the curvature of a cone that somebody asked for.
const TURNS: f64 = 1e-6;

fn faces_where(mesh: &Mesh, is_so: impl Fn(FaceId) -> bool + Sync) -> Vec<FaceId> {
    let mut found = vec![false; mesh.n_faces()];
    parallel::fill(&mut found, |f| is_so(f.into()));
    mesh.faces().filter(|f| found[f.index()]).collect()
}

fn is_left_turn([a, b, c]: [[f64; 2]; 3]) -> bool {
    orientation(a, b, c) == Ordering::Greater
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

/// The largest distance of points in ambient coordinates from the origin.
pub(super) fn radius(space: Space, points: &[[f64; 3]]) -> f64 {
    let far = points.iter().map(|&p| match space {
        // It grows with the distance in the plane of x and y.
        Space::E2 | Space::H2 => quick_norm([p[0], p[1]]),
        Space::S2 => distance_from_origin(space, p),
    });
    let far = far.fold(0.0, f64::max);
    if space == Space::H2 { far.asinh() } else { far }
}

/// Distance of two points in ambient coordinates, near the origin in H².
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

pub(super) fn flat(space: Space, p: [f64; 3]) -> [f64; 2] {
    if space == Space::E2 { [p[0], p[1]] } else { poincare(p) }
}

/// Diagonal of the points' bounding box.
pub fn bounding_diagonal(points: &[[f64; 2]]) -> f64 {
    let extent = |k: usize| {
        let range = points
            .iter()
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[lo, hi], p| [lo.min(p[k]), hi.max(p[k])]);
        range[1] - range[0]
    };
    extent(0).hypot(extent(1))
}
