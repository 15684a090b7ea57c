//! Crossings of the edges of the input, straight on the surface, with those of an intrinsic triangulation of it.
//!
//! An edge a → b of the input runs through a strip of intrinsic triangles. Points are vectors of R³, and a line is the intersection of
//! the surface of all points with a plane through 0: points are (x, y, 1) in E², on the hyperboloid in H², on the sphere in S². Each
//! edge ij that is crossed has a frame of coordinates, with i at (0, 0, 1) and j on the x axis:
//!
//! ```text
//!         a ·  y_a > 0               The coordinates of a are carried forward from frame to frame, those of b backward, by turns
//!            ·                       about a common vertex of two edges and shifts along an edge. The line from a to b meets ij at
//!     i ——————·—————— j  → x             P = −y_b A + y_a B = w_i I + w_j J,
//!              ·                     w_j = x_P/S(l), w_i = x'_P/S(l), where x' is measured from j toward i
//!               ·  b  y_b < 0        and S(l) = l, sinh l, sin l.
//! ```
//!
//! Rounding of the sides and angles moves the crossings by a few ulp of the length of the edge, as rounding of the intrinsic lengths
//! does anyway.

use super::order::{OnEdge, restore_order, restore_order_across};
use super::triangulations::IntrinsicTriangulation;
use crate::geometry::{Space, triangle};
use crate::mesh::{Curves, EdgeId, FaceId, HalfedgeId, PerEdge, PerFace, PerHalfedge};
use crate::parallel;

/// Smallest weight of an end. A crossing lies strictly between the ends of its edge; where rounding has put it on an end or beyond,
/// this weight, the rounding of a weight near 1, moves it back inside.
const LEAST: f64 = f64::EPSILON;

/// A crossing of an edge of the input with an intrinsic half-edge, from the left of the half-edge to its right.
#[derive(Debug, Clone, Copy)]
pub(super) struct Straight {
    /// Weights of the positions of the ends of the input's edge.
    pub edge: OnEdge,
    /// Weights of the positions of the origin and tip of the half-edge.
    pub across: OnEdge,
    /// The quotient of the two vectors of the crossing, that with the weights `across` by that with the weights `edge`: 1 in E².
    pub ratio: f64,
}

/// The motions from frame to frame in the intrinsic triangulation.
struct Frames<'a> {
    intrinsic: &'a IntrinsicTriangulation<'a>,
    curvature: f64,
    /// Per edge: S(l) and C(l), that is l and 1, sinh l and cosh l, sin l and cos l.
    shift: PerEdge<[f64; 2]>,
    /// Per half-edge: cosine and sine of the angle of its face at its origin.
    turn: PerHalfedge<[f64; 2]>,
}

/// All crossings, in the order of `curves`. Those of each edge of the input are in order along it, and those of each intrinsic edge
/// along that.
pub(super) fn straight(
    intrinsic: &IntrinsicTriangulation,
    geometry: Space,
    curves: &Curves,
) -> Vec<Straight> {
    let frames = Frames::new(intrinsic, geometry, curves);
    let crossing = curves.that_cross();
    let mut found = vec![Vec::new(); crossing.len()];
    parallel::fill(&mut found, |k| frames.along(curves, crossing[k]));
    let mut all = found.concat();
    let crossed = || intrinsic.mesh.edges().flat_map(|e| curves.crossings(e)).map(|at| at.halfedge);
    let turned = |h: HalfedgeId, [x, y]: OnEdge| if h.0 & 1 == 0 { [x, y] } else { [y, x] };
    let mut places: Vec<OnEdge> = crossed().zip(&all).map(|(h, s)| turned(h, s.across)).collect();
    restore_order_across(intrinsic.mesh, curves, &mut places);
    crossed().zip(&mut all).zip(places).for_each(|((h, s), place)| s.across = turned(h, place));
    all
}

impl<'a> Frames<'a> {
    /// In the faces that these curves run through.
    fn new(intrinsic: &'a IntrinsicTriangulation<'a>, geometry: Space, curves: &Curves) -> Frames<'a> {
        let (mesh, lengths) = (intrinsic.mesh, intrinsic.lengths);
        let mut is_crossed = PerFace::filled(mesh.n_faces(), false);
        for h in mesh.edges().flat_map(|e| curves.crossings(e)).map(|at| at.halfedge) {
            [h, h.twin()].into_iter().filter_map(|h| mesh.face(h)).for_each(|f| is_crossed[f] = true);
        }
        let crossed: Vec<FaceId> = mesh.faces().filter(|&f| is_crossed[f]).collect();
        let mut turns = vec![[[0.0; 2]; 3]; crossed.len()];
        parallel::fill(&mut turns, |k| {
            let angles = triangle::angles(geometry, mesh.opposite_edges(crossed[k]).map(|e| lengths[e])).at;
            angles.map(|angle| [angle.cos(), angle.sin()])
        });
        let mut turn = PerHalfedge::filled(mesh.n_halfedges(), [1.0, 0.0]);
        for (&f, turns) in crossed.iter().zip(turns) {
            mesh.face_halfedges(f).into_iter().zip(turns).for_each(|(h, way)| turn[h] = way);
        }
        let shift = PerEdge::from_fn(mesh.n_edges(), |e| {
            let l: f64 = lengths[e];
            match geometry {
                Space::E2 => [l, 1.0],
                Space::H2 => [l.sinh(), l.cosh()],
                Space::S2 => [l.sin(), l.cos()],
            }
        });
        Frames { intrinsic, curvature: geometry.curvature(), shift, turn }
    }

    /// The crossings of one edge a → b of the input, in order along it.
    fn along(&self, curves: &Curves, e: EdgeId) -> Vec<Straight> {
        let strip = curves.crossings(e);
        let (Some(first), Some(last)) = (strip.first(), strip.last()) else { return Vec::new() };
        let mesh = self.intrinsic.mesh;
        // The line starts at the third corner of the first face and ends at that of the last one.
        let x = first.halfedge;
        let ([c, s], [sine, cosine]) = (self.turn[x], self.shift[mesh.prev(x).edge()]);
        let mut a = [sine * c, sine * s, cosine];
        let side = mesh.next(last.halfedge.twin());
        let ([c, s], [sine, cosine]) = (self.turn[side], self.shift[side.edge()]);
        let mut from_b = vec![[sine * c, -sine * s, cosine]; strip.len()];
        for k in (1..strip.len()).rev() {
            from_b[k - 1] = self.backward(from_b[k], strip[k - 1].halfedge, strip[k].halfedge);
        }
        let mut all = Vec::with_capacity(strip.len());
        for (k, crossing) in strip.iter().enumerate() {
            all.push(self.meeting(crossing.halfedge, a, from_b[k]));
            if let Some(next) = strip.get(k + 1) {
                a = self.forward(a, crossing.halfedge, next.halfedge);
            }
        }
        let mut places: Vec<OnEdge> = all.iter().map(|s| s.edge).collect();
        restore_order(&mut places);
        all.iter_mut().zip(places).for_each(|(s, place)| s.edge = place);
        all
    }

    /// A point in the frame of `y`, a side of the face on the right of `x`, from its coordinates in the frame of `x`.
    fn forward(&self, p: [f64; 3], x: HalfedgeId, y: HalfedgeId) -> [f64; 3] {
        let t = x.twin();
        if y == self.intrinsic.mesh.next(t) {
            // They start at the same vertex.
            let [c, s] = self.turn[y];
            return rotate(p, [c, -s]);
        }
        // They end at the same vertex.
        let at_tip = rotate(self.shifted(p, self.shift[x.edge()]), self.turn[t]);
        self.shifted(at_tip, back(self.shift[y.edge()]))
    }

    /// A point in the frame of `x` from its coordinates in the frame of `y`, the inverse of [`Frames::forward`].
    fn backward(&self, p: [f64; 3], x: HalfedgeId, y: HalfedgeId) -> [f64; 3] {
        let t = x.twin();
        if y == self.intrinsic.mesh.next(t) {
            return rotate(p, self.turn[y]);
        }
        let [c, s] = self.turn[t];
        let at_tip = rotate(self.shifted(p, self.shift[y.edge()]), [c, -s]);
        self.shifted(at_tip, back(self.shift[x.edge()]))
    }

    /// A point in the frame that starts farther along the x axis, by the length whose S and C are given.
    fn shifted(&self, [x, y, t]: [f64; 3], [sine, cosine]: [f64; 2]) -> [f64; 3] {
        [x * cosine - t * sine, y, t * cosine + self.curvature * x * sine]
    }

    /// The point where the line from a to b crosses the half-edge in whose frame they are.
    fn meeting(&self, h: HalfedgeId, a: [f64; 3], b: [f64; 3]) -> Straight {
        let [sine, cosine] = self.shift[h.edge()];
        let edge = place([-b[1], a[1]]);
        let [x, _, t] = [0, 1, 2].map(|i| edge[0] * a[i] + edge[1] * b[i]);
        let along = [t * sine - x * cosine, x];
        let whole = (along[0] + along[1]) / sine;
        let ratio =
            if self.curvature == 0.0 || !(whole > 0.0 && whole < f64::INFINITY) { 1.0 } else { whole };
        Straight { edge, across: place(along), ratio }
    }
}

/// A point in the frame whose x axis has this direction (cosine, sine).
fn rotate([x, y, t]: [f64; 3], [c, s]: [f64; 2]) -> [f64; 3] {
    [c * x + s * y, c * y - s * x, t]
}

/// S and C of the same length in the opposite direction.
fn back([sine, cosine]: [f64; 2]) -> [f64; 2] {
    [-sine, cosine]
}

/// The point with weights in this proportion. Both weights are positive without rounding; one that is not becomes [`LEAST`]. Where
/// neither is a positive number, the point is not known in f64; the middle of the edge then stands for it, which the order along the
/// edge corrects ([`super::order::restore_order`]).
pub(super) fn place(weights: [f64; 2]) -> OnEdge {
    let [x, y] = weights.map(|w| if w > 0.0 && w < f64::INFINITY { w } else { 0.0 });
    match x + y {
        total if total > 0.0 && total < f64::INFINITY => match [x / total, y / total] {
            [0.0, _] => [LEAST, 1.0 - LEAST],
            [_, 0.0] => [1.0 - LEAST, LEAST],
            place => place,
        },
        _ => [0.5, 0.5],
    }
}
