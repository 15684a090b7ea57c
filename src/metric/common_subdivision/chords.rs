//! Final edges inside intrinsic faces, and where a straight line through such a face crosses them.
//!
//! Final edges cut an intrinsic face into parts. The map to the final triangulation is projective on each part, and the final edges are
//! straight lines in the face: *chords*, each of which cuts off a corner or ends in one ([`Strands`]). The chords that end in a corner
//! are the *fan* of that corner. A straight line from one place on the border of the face to another crosses the chords that separate
//! the two places: first, outward, those that cut off the corner near which it starts; then some of the fan; then, inward, those that
//! cut off the corner near which it ends.
//!
//! ```text
//!            2               All vectors are combinations of those of the corners. A line from A to B and a chord from C to D meet in
//!           / \                  P = |CDB| A + |CDA| B = |ABD| C + |ABC| D     up to a factor,
//!          D   \             where |XYZ| is a determinant. For places on the sides it is a sum of products of positive numbers, or
//!         /·\   \            it has one difference, of two places on one side.
//!     A  / · \   \
//!       0——C———B——1
//! ```

use super::data::Crossing;
use super::geodesic::place;
use super::order::{OnEdge, TIP, before, between};
use crate::geometry::vector::{cross, dot};
use crate::mesh::normal::Strands;
use crate::mesh::{Curves, FaceId, HalfedgeId, Mesh};

/// The final edges on the intrinsic triangulation.
pub(super) struct FaceChords<'a> {
    pub mesh: &'a Mesh,
    /// The intrinsic edges on the final triangulation.
    pub curves: Curves,
    /// Their crossings with final edges, each with its homogeneous weight: points on an intrinsic edge and on a final edge.
    pub crossings: Vec<(Crossing, f64)>,
    /// Homogeneous weights of the vertices.
    pub weight: Vec<f64>,
}

/// A place on the border of a face.
#[derive(Debug, Clone, Copy)]
pub(super) enum BorderPlace {
    Corner(usize),
    /// On the side k → k + 1, where this many chords cross it nearer to k.
    Side(usize, i64),
}

/// A point where a line meets the border of a face.
#[derive(Debug, Clone, Copy)]
pub(super) struct Station {
    pub border: BorderPlace,
    /// Its place on the line.
    pub line: OnEdge,
    /// The point as a vector: weights of the corners of the face.
    pub vector: [f64; 3],
}

/// The crossing of a line with a final half-edge, from the left of the half-edge to its right.
#[derive(Debug, Clone, Copy)]
pub(super) struct Passing {
    pub halfedge: HalfedgeId,
    /// Its place on the line.
    pub line: OnEdge,
    /// Its place on the half-edge.
    pub across: OnEdge,
    /// Homogeneous weight.
    pub weight: f64,
}

/// An end of a chord: weights of the corners, place on the final half-edge, homogeneous weight.
type ChordEnd = ([f64; 3], OnEdge, f64);

impl FaceChords<'_> {
    /// The number of chords that cross a half-edge nearer to its origin than this place on it.
    pub fn rank(&self, h: HalfedgeId, at: OnEdge) -> i64 {
        let crossings = &self.crossings[self.curves.numbers(h.edge())];
        let along = if h.0 & 1 == 0 { at } else { [at[1], at[0]] };
        let rank = crossings.partition_point(|(c, _)| before(c[0].weights, along));
        (if h.0 & 1 == 0 { rank } else { crossings.len() - rank }) as i64
    }

    /// The number of chords that cross a half-edge.
    pub fn count(&self, h: HalfedgeId) -> i64 {
        self.curves.numbers(h.edge()).len() as i64
    }

    /// Append the crossings of the line from one place on the border of a face to another.
    pub fn pass(&self, f: FaceId, from: Station, to: Station, passed: &mut Vec<Passing>) {
        let sides = self.mesh.face_halfedges(f);
        let n = sides.map(|h| self.count(h));
        let Strands { arc, fan } = Strands::new(n);
        let before = |k: usize| (k + 2) % 3;
        // The number of chords that cut off corner k and lie between that corner and the place.
        let around = |k: usize, at: Station| match at.border {
            BorderPlace::Corner(corner) if corner == k => 0,
            BorderPlace::Side(side, rank) if side == k => rank.min(arc[k]),
            BorderPlace::Side(side, rank) if side == before(k) => (n[side] - rank).min(arc[k]),
            _ => arc[k],
        };
        let arc_at = |k: usize, m: i64| {
            let (halfedge, first) = self.end(sides, k, m, None);
            (halfedge, first, self.end(sides, before(k), n[before(k)] - 1 - m, Some(halfedge)).1)
        };
        for k in 0..3 {
            for m in around(k, from)..around(k, to) {
                let (halfedge, first, second) = arc_at(k, m);
                passed.push(self.meet(halfedge, [first, second], [from, to]));
            }
        }
        if let Some(k) = (0..3).find(|&k| fan[k] > 0) {
            // The number of chords of the fan that lie between the side k → k + 1 and the place. It has no meaning at corner k, in
            // which all of them end.
            let (far, skip) = ((k + 1) % 3, arc[(k + 1) % 3]);
            let beyond = |at: Station| match at.border {
                BorderPlace::Corner(corner) if corner == k => None,
                BorderPlace::Corner(corner) => Some(if corner == far { 0 } else { fan[k] }),
                BorderPlace::Side(side, rank) if side == far => Some((rank - skip).clamp(0, fan[k])),
                BorderPlace::Side(side, _) => Some(if side == k { 0 } else { fan[k] }),
            };
            if let (Some(a), Some(b)) = (beyond(from), beyond(to)) {
                let mut meet = |m: i64| {
                    let (halfedge, second) = self.end(sides, far, skip + m, None);
                    let mut corner = [0.0; 3];
                    corner[k] = 1.0;
                    let first = (corner, TIP, self.weight[self.mesh.origin(sides[k]).index()]);
                    let passing = self.meet(halfedge, [first, second], [from, to]);
                    passed.push(if a < b { passing } else { passing.turned() });
                };
                (a..b).for_each(&mut meet);
                (b..a).rev().for_each(meet);
            }
        }
        for k in 0..3 {
            for m in (around(k, to)..around(k, from)).rev() {
                let (halfedge, first, second) = arc_at(k, m);
                passed.push(self.meet(halfedge, [first, second], [from, to]).turned());
            }
        }
    }

    /// The final half-edge that the side k → k + 1 crosses at this position, from left to right, and the end of its chord there. The
    /// place of the end is given along that half-edge, or along `halfedge` if there is one.
    fn end(
        &self,
        sides: [HalfedgeId; 3],
        k: usize,
        position: i64,
        halfedge: Option<HalfedgeId>,
    ) -> (HalfedgeId, ChordEnd) {
        let side = sides[k];
        let odd = side.0 & 1 == 1;
        let along = if odd { self.count(side) - 1 - position } else { position } as usize;
        let crossed = self.curves.crossings(side.edge())[along].halfedge;
        let crossed = if odd { crossed.twin() } else { crossed };
        let (crossing, weight) = self.crossings[self.curves.numbers(side.edge()).start + along];
        let turned = |[x, y]: OnEdge, odd: bool| if odd { [y, x] } else { [x, y] };
        let mut vector = [0.0; 3];
        [vector[k], vector[(k + 1) % 3]] = turned(crossing[0].weights, odd);
        let place = turned(crossing[1].weights, halfedge.unwrap_or(crossed).0 & 1 == 1);
        (crossed, (vector, place, weight))
    }

    /// The crossing of the line between two stations with the chord between two ends.
    fn meet(&self, halfedge: HalfedgeId, [c, d]: [ChordEnd; 2], [from, to]: [Station; 2]) -> Passing {
        let (a, b) = (from.vector, to.vector);
        let line = place([determinant(c.0, d.0, b).abs(), determinant(c.0, d.0, a).abs()]);
        let chord = place([determinant(a, b, d.0).abs(), determinant(a, b, c.0).abs()]);
        // Both combinations are the same vector up to a factor, which the sums of their components give.
        let whole = |v: [f64; 3]| v[0] + v[1] + v[2];
        let factor =
            (line[0] * whole(a) + line[1] * whole(b)) / (chord[0] * whole(c.0) + chord[1] * whole(d.0));
        let image = [0, 1].map(|k| chord[0] * c.2 * c.1[k] + chord[1] * d.2 * d.1[k]);
        let total = image[0] + image[1];
        Passing {
            halfedge,
            line: between(from.line, to.line, line[1]),
            across: image.map(|x| x / total),
            weight: factor * total,
        }
    }
}

impl Passing {
    /// The same crossing for a line that comes from the other side.
    fn turned(self) -> Passing {
        let [x, y] = self.across;
        Passing { halfedge: self.halfedge.twin(), across: [y, x], ..self }
    }
}

fn determinant(a: [f64; 3], b: [f64; 3], c: [f64; 3]) -> f64 {
    dot(a, cross(b, c))
}
