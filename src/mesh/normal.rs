//! Normal coordinates: the given triangulation of a surface as curves on the triangulation that edge flips have made of it.
//!
//! Every edge of the given triangulation is a curve from vertex to vertex, pulled tight between the vertices. On another triangulation of
//! the same vertices the curves are determined, up to sliding, by the number of times that they cross each of its edges [GiSC21, §3]:
//!
//! ```text
//!            k           n_e ≥ 0: crossings of edge e;  n_e = −1: e is itself one of the curves;  below, n⁺ = max(n, 0)
//!           /|\          fan_k = max(0, n⁺_ij − n⁺_jk − n⁺_ki)      curves that leave corner k and cross the side ij;
//!          / | \             at most one of a triangle's three fans is not empty
//!         /\ | /\        arc_i = (max(0, n⁺_ij + n⁺_ki − n⁺_jk) − fan_j − fan_k)/2     curves that cut off corner i
//!        /  \|/  \       along ij, from i: arc_i curves to ki, then fan_k to corner k, then arc_j to jk
//!       i —————— j
//! ```
//!
//! *Roundabouts* identify the curves: for each half-edge h, the first curve counterclockwise from h (h included) that leaves its origin,
//! as a number in the given triangulation's order around that vertex. Flips do not change the order in which curves leave a vertex.
//!
//! A flip changes one coordinate and two roundabouts. All are integers, so nothing is rounded.
//!
//! ```
//! use ricci::mesh::{EdgeId, Mesh, NormalCoordinates};
//! let mut mesh = Mesh::from_faces(4, &[[0, 1, 2], [0, 2, 3]])?;
//! let mut given = NormalCoordinates::new(&mesh);
//! given.record(&mesh, EdgeId(2)); // just before the flip
//! mesh.flip(EdgeId(2));
//! assert_eq!((given.crossings(EdgeId(2)), given.crossings(EdgeId(0))), (1, -1));
//! # Ok::<(), ricci::Error>(())
//! ```

use super::halfedge::Mesh;
use super::ids::{EdgeId, HalfedgeId, VertexId};
use crate::archive::{in_range, invalid, stored};
use crate::error::{Error, Result, check_size};
use std::sync::Arc;

/// Largest coordinate that is stored, 6e17; beyond it the coordinates are marked as out of range. Sums of up to 16 coordinates then fit
/// in an i64, and a curve with so many crossings could not be traced anyway.
const MOST: i64 = i64::MAX / 16;

/// The given triangulation as curves on the current one. Clones share their arrays until one of them follows another flip.
#[derive(Debug, Clone, PartialEq)]
pub struct NormalCoordinates {
    now: Arc<CurveCoordinates>,
    given: Arc<GivenOrder>,
    /// The first edge whose coordinate left the range.
    overflow: Option<EdgeId>,
}
stored!(sections NormalCoordinates { now, given, overflow } check NormalCoordinates::check_parts);

/// The part of the coordinates that flips change.
#[derive(Debug, Clone, PartialEq)]
struct CurveCoordinates {
    /// For each edge its coordinate n.
    crossings: Vec<i64>,
    /// For each half-edge its roundabout, below the given degree of its origin.
    first: Vec<u32>,
}
stored!(sections CurveCoordinates { crossings, first });

/// The given triangulation's half-edges in order around the vertices, which identify the curves.
#[derive(Debug, PartialEq)]
struct GivenOrder {
    /// For each vertex the start of its half-edges in `halfedges`, and the end of the last.
    start: Vec<u32>,
    /// The half-edges counterclockwise around each vertex; on the boundary the one outside is last.
    halfedges: Vec<HalfedgeId>,
}
stored!(sections GivenOrder { start, halfedges });

impl GivenOrder {
    /// The start and the end of a vertex's half-edges.
    #[inline]
    fn around(&self, v: VertexId) -> [i64; 2] {
        [v.index(), v.index() + 1].map(|v| i64::from(self.start[v]))
    }
}

/// The values of [`NormalCoordinates`] that one flip changes, for undoing it.
#[derive(Debug, Clone, Copy)]
pub(super) struct EdgeCoordinates {
    crossings: i64,
    first: [u32; 2],
    overflow: Option<EdgeId>,
}

/// The numbers of curves that pass through a triangle in each way, given the crossings of the sides k → k + 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Strands {
    /// The curves that cut off corner k.
    pub arc: [i64; 3],
    /// The curves that leave corner k through the opposite side.
    pub fan: [i64; 3],
}

impl Strands {
    /// The strands for the normal coordinates of the sides k → k + 1.
    pub fn new(sides: [i64; 3]) -> Strands {
        let n = sides.map(|n| n.max(0));
        // Sides k → k + 1 and k + 2 → k meet at corner k, and side k + 1 → k + 2 is opposite.
        let near = |k: usize| n[k] + n[(k + 2) % 3];
        let fan = [0, 1, 2].map(|k| (n[(k + 1) % 3] - near(k)).max(0));
        let arc =
            [0, 1, 2].map(|k| ((near(k) - n[(k + 1) % 3]).max(0) - fan[(k + 1) % 3] - fan[(k + 2) % 3]) / 2);
        Strands { arc, fan }
    }
}

impl NormalCoordinates {
    /// Checks that these are curves on a mesh of this size.
    ///
    /// # Errors
    /// [`Error::Size`].
    pub(crate) fn check_size(&self, mesh: &Mesh) -> Result<()> {
        check_size("normal coordinates", self.now.crossings.len(), mesh.n_edges())?;
        check_size("roundabouts", self.given.start.len(), mesh.n_vertices() + 1)
    }

    /// Checks that the arrays of an archive fit each other: every vertex has an edge, and every number is in range.
    fn check_parts(&self) -> Result<()> {
        let (CurveCoordinates { crossings, first }, GivenOrder { start, halfedges }) =
            (&*self.now, &*self.given);
        check_size("curve coordinates", first.len(), 2 * crossings.len())?;
        check_size("half-edges around vertices", halfedges.len(), first.len())?;
        let ends = start.first() == Some(&0) && start.last() == Some(&(halfedges.len() as u32));
        if !ends || start.windows(2).any(|pair| pair[0] >= pair[1]) {
            return Err(invalid("order around vertices", "a list of half-edges for each vertex"));
        }
        in_range("half-edge", halfedges.iter().map(|h| h.index()), halfedges.len())
    }

    /// The coordinates of a triangulation on itself: every edge is a curve.
    pub fn new(mesh: &Mesh) -> NormalCoordinates {
        let mut first = vec![0; mesh.n_halfedges()];
        let mut start = Vec::with_capacity(mesh.n_vertices() + 1);
        let mut given: Vec<HalfedgeId> = Vec::with_capacity(mesh.n_halfedges());
        for v in mesh.vertices() {
            let begin = given.len();
            start.push(begin as u32);
            given.extend(mesh.outgoing(v));
            given[begin..].reverse();
            for (k, h) in given[begin..].iter().enumerate() {
                first[h.index()] = k as u32;
            }
        }
        start.push(given.len() as u32);
        NormalCoordinates {
            now: Arc::new(CurveCoordinates { crossings: vec![-1; mesh.n_edges()], first }),
            given: Arc::new(GivenOrder { start, halfedges: given }),
            overflow: None,
        }
    }

    /// Follows one flip; to be called with the triangulation just before [`Mesh::flip`] of this edge. O(1), except for the first flip of
    /// a clone, which then gets arrays of its own.
    ///
    /// Does nothing for an edge that [`Mesh::flip`] cannot flip. A coordinate that leaves the range is reported by
    /// [`NormalCoordinates::check`].
    pub fn record(&mut self, mesh: &Mesh, e: EdgeId) {
        // Names as in Mesh::flip: h = a → b, faces (a, b, c) and (b, a, d); afterwards h = d → c.
        let h = e.halfedge();
        let t = h.twin();
        if mesh.face(h).is_none() || mesh.face(t).is_none() || mesh.face(h) == mesh.face(t) {
            return;
        }
        let [bc, ca, ad, db] = mesh.quadrilateral(h);
        let CurveCoordinates { crossings, first } = Arc::make_mut(&mut self.now);
        let n = |h: HalfedgeId| crossings[h.edge().index()];
        let ab = n(h);
        let Strands { arc: [a, b, c], fan: [from_a, from_b, from_c] } = Strands::new([ab, n(bc), n(ca)]);
        let Strands { arc: [b_below, a_below, d], fan: [also_b, also_a, from_d] } =
            Strands::new([ab, n(ad), n(db)]);

        // Along ab, above: a curves to side ca, from_c to c, b to bc; below: a_below to ad, from_d to d, b_below to db.
        let left_of_c = (a_below - a).clamp(0, from_c);
        let right_of_d = (b - b_below).clamp(0, from_d);
        let joined = (a + from_c).min(a_below + from_d) > a.max(a_below);
        let across = (a + b_below - ab.max(0)).max(0) + (b + a_below - ab.max(0)).max(0);
        let fans = from_a + from_b + also_a + also_b;
        let dc = if joined { -1 } else { c + d + fans + across + i64::from(ab < 0) };
        if dc > MOST {
            self.overflow.get_or_insert(e);
        }
        let at_c = i64::from(first[ca.index()]) + i64::from(n(ca) < 0) + left_of_c;
        let at_d = i64::from(first[db.index()]) + i64::from(n(db) < 0) + right_of_d;
        let degree = |h: HalfedgeId| {
            let [begin, end] = self.given.around(mesh.origin(h));
            end - begin
        };
        let (cd, dc_first) = (at_c % degree(ca), at_d % degree(db));
        crossings[e.index()] = dc.min(MOST);
        (first[h.index()], first[t.index()]) = (dc_first as u32, cd as u32);
    }

    /// The values that a flip of this edge will change.
    pub(super) fn coordinates(&self, e: EdgeId) -> EdgeCoordinates {
        let h = e.halfedge();
        EdgeCoordinates {
            crossings: self.crossings(e),
            first: [h, h.twin()].map(|h| self.now.first[h.index()]),
            overflow: self.overflow,
        }
    }

    /// Undoes the last recorded flip, which was one of this edge, with the coordinates before it.
    pub(super) fn restore(&mut self, e: EdgeId, before: EdgeCoordinates) {
        let h = e.halfedge();
        let now = Arc::make_mut(&mut self.now);
        now.crossings[e.index()] = before.crossings;
        [now.first[h.index()], now.first[h.twin().index()]] = before.first;
        self.overflow = before.overflow;
    }

    /// The coordinate n of an edge: the number of curves that cross it, −1 if it is a curve itself. Never 0: inside a triangle of the
    /// given triangulation there is no other edge.
    pub fn crossings(&self, e: EdgeId) -> i64 {
        self.now.crossings[e.index()]
    }

    /// The coordinates of the sides of the face of `h`, from `h` on.
    pub fn sides(&self, mesh: &Mesh, h: HalfedgeId) -> [i64; 3] {
        [h, mesh.next(h), mesh.prev(h)].map(|h| self.crossings(h.edge()))
    }

    /// The given half-edge that leaves the origin of `h` as the `turn`-th counterclockwise from `h` (0: along `h`, or the first after it;
    /// −1: the last before it).
    pub fn leaving(&self, mesh: &Mesh, h: HalfedgeId, turn: i64) -> HalfedgeId {
        let [begin, end] = self.given.around(mesh.origin(h));
        let (k, degree) = (i64::from(self.now.first[h.index()]) + turn, end - begin);
        // A full turn is rare, and a remainder takes longer than everything else here.
        let k = if (0..degree).contains(&k) { k } else { k.rem_euclid(degree) };
        self.given.halfedges[(begin + k) as usize]
    }

    /// The given half-edge that `h` runs along, if any.
    pub fn along(&self, mesh: &Mesh, h: HalfedgeId) -> Option<HalfedgeId> {
        (self.crossings(h.edge()) < 0).then(|| self.leaving(mesh, h, 0))
    }

    /// The number of crossings of all curves with all edges.
    ///
    /// # Errors
    /// [`Error::Size`] if these are not the coordinates of this mesh; [`Error::TooLarge`] if coordinates have left the range, or if there
    /// are more crossings than can be numbered.
    pub fn check(&self, mesh: &Mesh) -> Result<usize> {
        self.check_size(mesh)?;
        let what = "crossings of the input's edges with those of the final triangulation";
        let total = self.now.crossings.iter().try_fold(0i64, |sum, &n| sum.checked_add(n.max(0)));
        match total {
            Some(total) if self.overflow.is_none() && total < i64::from(i32::MAX) => Ok(total as usize),
            _ => Err(Error::TooLarge { what, count: total.map_or(usize::MAX, |n| n as usize) }),
        }
    }
}
