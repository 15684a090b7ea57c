//! The curves of normal coordinates, traced one by one through the triangulation.
//!
//! ```
//! use ricci::mesh::{Curves, EdgeId, Mesh, NormalCoordinates};
//! let mut mesh = Mesh::from_faces(4, &[[0, 1, 2], [0, 2, 3]])?;
//! let mut given = NormalCoordinates::new(&mesh);
//! given.record(&mesh, EdgeId(2));
//! mesh.flip(EdgeId(2));
//! let curves = Curves::trace(&mesh, &given, &ricci::Control::new())?;
//! assert_eq!(curves.crossings(EdgeId(2))[0].halfedge.edge(), EdgeId(2)); // the old diagonal crosses the new one
//! # Ok::<(), ricci::Error>(())
//! ```

use super::halfedge::Mesh;
use super::ids::{EdgeId, HalfedgeId};
use super::normal::{NormalCoordinates, Strands};
use crate::control::Control;
use crate::error::{Error, Result};

/// Edges or curves between two checks of the control: they take less than a millisecond.
const PER_STEP: usize = 4096;

/// A crossing of a curve with an edge.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CurveCrossing {
    /// The half-edge that the curve crosses from its left to its right.
    pub halfedge: HalfedgeId,
    /// The number of curves that cross the half-edge nearer to its origin.
    pub position: u32,
}

/// The edges of the given triangulation on the current one, each from the origin of its half-edge `2e` to its tip.
#[derive(Debug, Clone, PartialEq)]
pub struct Curves {
    /// For each given edge the start of its crossings, and the end of the last.
    start: Vec<u32>,
    crossings: Vec<CurveCrossing>,
    /// For each given edge the half-edge along which it runs, if it crosses nothing.
    along: Vec<Option<HalfedgeId>>,
}

impl Curves {
    /// Traces every curve, O(edges + crossings).
    ///
    /// # Errors
    /// Those of [`NormalCoordinates::check`]; [`Error::Connectivity`] if the coordinates are not those of this triangulation;
    /// [`Error::Cancelled`].
    pub fn trace(mesh: &Mesh, normal: &NormalCoordinates, control: &Control) -> Result<Curves> {
        control.check()?;
        let total = normal.check(mesh)?;
        let mut along = vec![None; mesh.n_edges()];
        // For each given edge the corner that it leaves, and the number of curves that leave that corner before it.
        let mut source: Vec<Option<(HalfedgeId, i64)>> = vec![None; mesh.n_edges()];
        for e in mesh.edges() {
            if e.index().is_multiple_of(PER_STEP) {
                control.check()?;
            }
            let h = e.halfedge();
            if let Some(given) = normal.along(mesh, h) {
                let is_even = given == given.edge().halfedge();
                along[given.edge().index()] = Some(if is_even { h } else { h.twin() });
                continue;
            }
            // A corner that curves leave is opposite an edge that they cross.
            for corner in [h, h.twin()].into_iter().filter(|&h| !mesh.is_outside(h)).map(|h| mesh.prev(h)) {
                let sides = normal.sides(mesh, corner);
                for k in 0..Strands::new(sides).fan[0] {
                    let given = normal.leaving(mesh, corner, i64::from(sides[0] < 0) + k);
                    if given == given.edge().halfedge() {
                        source[given.edge().index()] = Some((corner, k));
                    }
                }
            }
        }
        let mut start = vec![0];
        let mut trace = CurveTrace { mesh, normal, total, crossings: Vec::with_capacity(total) };
        for e in 0..mesh.n_edges() {
            if e.is_multiple_of(PER_STEP) {
                control.check()?;
            }
            match (along[e], source[e]) {
                (Some(_), None) => {}
                (None, Some((corner, k))) => trace.follow(corner, k)?,
                _ => return Err(lost(e)),
            }
            start.push(trace.crossings.len() as u32);
        }
        if trace.crossings.len() < total {
            return Err(lost(0));
        }
        Ok(Curves { start, crossings: trace.crossings, along })
    }

    /// The crossings of a given edge, in order.
    pub fn crossings(&self, e: EdgeId) -> &[CurveCrossing] {
        &self.crossings[self.numbers(e)]
    }

    /// The given edges that cross other edges, ascending.
    pub fn that_cross(&self) -> Vec<EdgeId> {
        let crosses = |w: &(usize, &[u32])| w.1[0] < w.1[1];
        self.start.windows(2).enumerate().filter(crosses).map(|(e, _)| EdgeId::from(e)).collect()
    }

    /// The numbers of a given edge's crossings among all crossings.
    pub fn numbers(&self, e: EdgeId) -> std::ops::Range<usize> {
        self.start[e.index()] as usize..self.start[e.index() + 1] as usize
    }

    /// The half-edge along which a given edge runs, in its direction, if it crosses nothing.
    pub fn along(&self, e: EdgeId) -> Option<HalfedgeId> {
        self.along[e.index()]
    }

    /// Number of all crossings.
    pub fn n_crossings(&self) -> usize {
        self.crossings.len()
    }
}

/// The crossings of the curves traced so far, of `total`.
struct CurveTrace<'a> {
    mesh: &'a Mesh,
    normal: &'a NormalCoordinates,
    total: usize,
    crossings: Vec<CurveCrossing>,
}

impl CurveTrace<'_> {
    /// Appends the crossings of the k-th curve out of a corner.
    fn follow(&mut self, corner: HalfedgeId, k: i64) -> Result<()> {
        let (mesh, normal) = (self.mesh, self.normal);
        let n = |h: HalfedgeId| normal.crossings(h.edge());
        let (mut at, mut position) = (mesh.next(corner), n(corner).max(0) + k);
        loop {
            if self.crossings.len() == self.total || mesh.is_outside(at.twin()) {
                return Err(lost(at.edge().index()));
            }
            self.crossings.push(CurveCrossing { halfedge: at, position: position as u32 });
            // The curve enters the next face through t; `entry` curves cross nearer to the first end of t.
            let t = at.twin();
            let entry = n(t) - 1 - position;
            let strands = Strands::new(normal.sides(mesh, t));
            if entry < strands.arc[0] {
                at = mesh.prev(t);
                position = n(at) - 1 - entry;
            } else if entry < strands.arc[0] + strands.fan[2] {
                return Ok(());
            } else {
                at = mesh.next(t);
                position = n(t) - 1 - entry;
            }
        }
    }
}

fn lost(edge: usize) -> Error {
    let message = "the curve of this edge is lost: the coordinates are not those of this triangulation";
    Error::connectivity("edge", edge, message)
}
