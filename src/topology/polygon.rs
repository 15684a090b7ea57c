//! The polygon into which a surface opens along a spanning tree and the edges left over.

use super::rooted::RootedTree;
use super::word::Letter;
use crate::mesh::{HalfedgeId, Mesh, PerEdge, PerHalfedge};

/// The boundary of the opened surface, read counterclockwise. Sides on edges left over have letters.
///
/// Sides on tree edges have no letter. Every vertex of the mesh lies on the boundary of the polygon, so every corner of a face is at a
/// place there: the polygon's corners between letter k − 1 and letter k have place k.
pub(super) struct OpenedPolygon {
    /// The tree along which the surface was opened.
    pub rooted: RootedTree,
    /// Each generator of an interior edge occurs twice, once as its inverse; each of a boundary edge once, not inverted.
    pub letters: Vec<Letter>,
    /// For each generator the half-edge in whose direction the letter runs.
    pub halfedges: Vec<HalfedgeId>,
    /// For each half-edge of a face the place of the corner at its origin (0 outside the surface).
    pub place: PerHalfedge<u32>,
}

impl OpenedPolygon {
    /// The polygon, read from a corner of the root. O(E).
    pub fn new(mesh: &Mesh, rooted: RootedTree) -> OpenedPolygon {
        let mut letter_of = vec![None; mesh.n_halfedges()];
        let mut open = PerEdge::from_fn(mesh.n_edges(), |e| mesh.is_boundary_edge(e));
        rooted.tree.parent.iter().flatten().for_each(|h| open[h.edge()] = true);
        let mut halfedges = Vec::with_capacity(rooted.left.len());
        let mut n_letters = 0;
        for (k, &e) in rooted.left.iter().enumerate() {
            let h = if mesh.is_outside(e.halfedge()) { e.halfedge().twin() } else { e.halfedge() };
            letter_of[h.index()] = Some(Letter::generator(k));
            letter_of[h.twin().index()] = Some(Letter::generator(k).inverse());
            n_letters += if mesh.is_outside(h.twin()) { 1 } else { 2 };
            open[e] = true;
            halfedges.push(h);
        }
        let mut letters = Vec::with_capacity(n_letters);
        let mut place = PerHalfedge::filled(mesh.n_halfedges(), 0);
        let start = mesh.outgoing(rooted.root).find(|h| open[h.edge()] && !mesh.is_outside(*h));
        let mut at = start;
        while let Some(side) = at {
            letters.extend(letter_of[side.index()]);
            // After the last letter the polygon closes.
            let here = if letters.len() == n_letters { 0 } else { letters.len() as u32 };
            let mut h = mesh.next(side);
            place[h] = here;
            while !open[h.edge()] {
                h = mesh.next(h.twin());
                place[h] = here;
            }
            at = Some(h).filter(|&h| Some(h) != start);
        }
        OpenedPolygon { rooted, letters, halfedges, place }
    }

    /// The loop of a letter: from the root to its edge, along the edge, and back to the root.
    pub fn letter_loop(&self, mesh: &Mesh, letter: Letter) -> Vec<HalfedgeId> {
        let h = self.halfedges[letter.index()];
        let h = if letter.is_inverse() { h.twin() } else { h };
        let tree = &self.rooted.tree;
        let mut path = tree.path_down(mesh, mesh.origin(h));
        path.push(h);
        path.extend(tree.path(mesh, mesh.tip(h)).map(HalfedgeId::twin));
        path
    }
}
