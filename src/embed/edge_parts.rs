//! The parts into which a common subdivision divides the edges of the surface as it came.

use crate::error::{Error, Result};
use crate::mesh::{EdgeId, HalfedgeId, Mesh};
use crate::metric::CommonSubdivision;

/// Per edge of the input, the half-edges of the subdivision along its half-edge 2e, in order.
pub(super) struct InputEdgeParts {
    start: Vec<usize>,
    parts: Vec<HalfedgeId>,
}

impl InputEdgeParts {
    /// The parts of edges that are not divided.
    pub fn whole(input: &Mesh) -> InputEdgeParts {
        InputEdgeParts {
            start: (0..=input.n_edges()).collect(),
            parts: input.edges().map(EdgeId::halfedge).collect(),
        }
    }

    /// The parts of the edges of a subdivision's first triangulation.
    ///
    /// # Errors
    /// [`Error::Layout`] where the parts of an edge do not follow one another.
    pub fn of_subdivision(input: &Mesh, r: &CommonSubdivision) -> Result<InputEdgeParts> {
        let along = |e: EdgeId| -> Option<(EdgeId, HalfedgeId)> {
            let h = r.halfedges_along[e][0]?;
            let part = e.halfedge();
            Some((h.edge(), if h.0 & 1 == 0 { part } else { part.twin() }))
        };
        let mut start = vec![0; input.n_edges() + 1];
        r.mesh.edges().filter_map(along).for_each(|(e, _)| start[e.index() + 1] += 1);
        (0..input.n_edges()).for_each(|e| start[e + 1] += start[e]);
        let (mut next, mut parts) = (start.clone(), vec![HalfedgeId(0); start[input.n_edges()]]);
        for (e, part) in r.mesh.edges().filter_map(along) {
            parts[next[e.index()]] = part;
            next[e.index()] += 1;
        }
        for e in input.edges() {
            let of_edge = &mut parts[start[e.index()]..start[e.index() + 1]];
            if of_edge.len() > 1 && !chain(of_edge, r, input.origin(e.halfedge()).0) {
                return Err(Error::Layout(format!("the parts of edge {e} do not follow one another")));
            }
        }
        Ok(InputEdgeParts { start, parts })
    }

    fn of(&self, e: EdgeId) -> &[HalfedgeId] {
        &self.parts[self.start[e.index()]..self.start[e.index() + 1]]
    }

    /// The number of points at which an edge is divided.
    pub fn n_crossings(&self, e: EdgeId) -> usize {
        self.of(e).len().saturating_sub(1)
    }

    /// The part of a half-edge that starts at a crossing, which is counted from 1 along the half-edge 2e.
    pub fn from(&self, h: HalfedgeId, crossing: u32) -> HalfedgeId {
        let parts = self.of(h.edge());
        if h.0 & 1 == 0 { parts[crossing as usize] } else { parts[crossing as usize - 1].twin() }
    }
}

/// Brings the parts of an edge into order, from this vertex on; true if they follow one another.
fn chain(parts: &mut [HalfedgeId], r: &CommonSubdivision, from: u32) -> bool {
    let mut known: Vec<(u32, HalfedgeId)> = parts.iter().map(|&h| (r.mesh.origin(h).0, h)).collect();
    known.sort_unstable();
    let mut at = from;
    for part in parts {
        let Ok(k) = known.binary_search_by_key(&at, |k| k.0) else { return false };
        *part = known[k].1;
        at = r.mesh.tip(*part).0;
    }
    true
}
