//! Shortest-path trees that contain all but one edge of every boundary loop, and the choice of their roots.

use super::farthest::farthest;
use super::spanning::{Forest, Key, ReachedVertex, leftover, shortest_paths_through};
use crate::control::Control;
use crate::error::Result;
use crate::mesh::{EdgeId, HalfedgeId, Mesh, PerEdge, VertexId};

/// Roots that are sampled. With [`MAX_MOVES`] moves from the best of them, the loops on the closed meshes and disks of the corpus are
/// within a few percent of those of the best of forty roots.
const SAMPLED_ROOTS: usize = 8;
/// Moves of the root towards shorter loops.
const MAX_MOVES: usize = 4;

/// A spanning tree T, and the edges that are neither in T nor in a dual tree.
#[derive(Debug, Clone)]
pub(super) struct RootedTree {
    pub root: VertexId,
    pub tree: Forest,
    /// 2g interior edges and one edge of each boundary loop. The surface opened along T and these is a disk.
    pub left: Vec<EdgeId>,
}

impl RootedTree {
    /// The shortest-path tree of `root` on a connected surface, except that the vertices of a boundary loop, once it is reached, are
    /// added along the loop from there to both sides until one edge of it is left.
    ///
    /// The interior edges left over are those of \[EW05\], whose loops through the root are short: their dual tree is a maximum spanning
    /// tree. The dual graph of the faces is connected without the edges of T: it would be if a disk were glued into each boundary loop,
    /// and each disk then is a leaf, since T has all edges of its loop but one.
    pub fn new(mesh: &Mesh, lengths: &PerEdge<f64>, root: VertexId, control: &Control) -> Result<RootedTree> {
        let around =
            |v| if mesh.is_boundary_vertex(v) { around_boundary(mesh, lengths, v) } else { Vec::new() };
        let tree = shortest_paths_through(mesh, lengths, [root], control, around)?;
        control.check()?;
        let mut left = leftover(mesh, lengths, &tree, |e| mesh.is_boundary_edge(e));
        let enters = |h: HalfedgeId| tree.parent[mesh.tip(h)] == Some(h);
        let in_tree = |e: EdgeId| enters(e.halfedge()) || enters(e.halfedge().twin());
        left.extend(mesh.edges().filter(|&e| mesh.is_boundary_edge(e) && !in_tree(e)));
        Ok(RootedTree { root, tree, left })
    }

    /// A tree with a root from which the loops of the edges left over are short in total.
    ///
    /// Roots are sampled far from each other; from the best one, the search moves to the far end of the shortest loop as long as that
    /// helps.
    pub fn central(mesh: &Mesh, lengths: &PerEdge<f64>, control: &Control) -> Result<RootedTree> {
        let mut best = RootedTree::new(mesh, lengths, VertexId(0), control)?;
        let mut nearest = best.tree.distance.clone();
        for _ in 1..SAMPLED_ROOTS.min(mesh.n_vertices()) {
            let next = RootedTree::new(mesh, lengths, farthest(mesh, &nearest, best.root), control)?;
            nearest.iter_mut().zip(&next.tree.distance).for_each(|(near, d)| *near = near.min(*d));
            if next.total(mesh, lengths) < best.total(mesh, lengths) {
                best = next;
            }
        }
        for _ in 0..MAX_MOVES {
            let arc = |e: &EdgeId| Key(best.tree.arc(mesh, lengths, *e));
            let Some(shortest) = best.left.iter().copied().min_by_key(arc) else { break };
            let next = RootedTree::new(mesh, lengths, mesh.tip(shortest.halfedge()), control)?;
            if next.total(mesh, lengths) >= best.total(mesh, lengths) {
                break;
            }
            best = next;
        }
        Ok(best)
    }

    /// The total length of the loops of the edges left over.
    fn total(&self, mesh: &Mesh, lengths: &PerEdge<f64>) -> f64 {
        self.left.iter().fold(0.0, |sum, &e| sum + self.tree.arc(mesh, lengths, e))
    }
}

/// The other vertices of the boundary loop through `v`, reached along the loop from both sides until one edge of it is left.
fn around_boundary(mesh: &Mesh, lengths: &PerEdge<f64>, v: VertexId) -> Vec<ReachedVertex> {
    let start = mesh.out(v);
    let onwards = |&h: &HalfedgeId| Some(mesh.next(h)).filter(|&next| next != start);
    let boundary: Vec<_> = std::iter::successors(Some(start), onwards).collect();
    let (mut ahead, mut behind) = (boundary.iter().copied(), boundary.iter().rev().map(|h| h.twin()));
    let (mut next, mut previous) = (ahead.next(), behind.next());
    let (mut ahead_length, mut behind_length) = (0.0, 0.0);
    let mut reached = Vec::new();
    for _ in 1..boundary.len() {
        let (Some(h), Some(k)) = (next, previous) else { break };
        let (to_h, to_k) = (ahead_length + lengths[h.edge()], behind_length + lengths[k.edge()]);
        if to_h <= to_k {
            reached.push((mesh.tip(h), to_h, h));
            (ahead_length, next) = (to_h, ahead.next());
        } else {
            reached.push((mesh.tip(k), to_k, k));
            (behind_length, previous) = (to_k, behind.next());
        }
    }
    reached
}
