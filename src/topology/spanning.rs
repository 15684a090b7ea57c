//! Shortest-path forests, and the edges that are in neither a tree nor a dual tree.
//!
//! ```
//! use ricci::mesh::{VertexId, shapes};
//! use ricci::{Control, topology::shortest_paths};
//! let (mesh, lengths) = shapes::flat_torus([0.0, 1.0], 4, 4)?.build()?;
//! let forest = shortest_paths(&mesh, &lengths, [VertexId(0)], &Control::new())?;
//! assert_eq!(forest.distance[VertexId(2)], 0.5); // two edges of length 1/4
//! # Ok::<(), ricci::Error>(())
//! ```

use super::nearest::NearestQueue;
use super::{check_lengths, check_vertex};
use crate::archive::stored;
use crate::control::Control;
use crate::error::Result;
use crate::mesh::union_find::UnionFind;
use crate::mesh::{EdgeId, HalfedgeId, Mesh, PerEdge, PerVertex, VertexId};
use std::cmp::Ordering;

/// Vertices settled between two checks of the control: they take a fraction of a millisecond.
const VERTICES_PER_CHECK: usize = 4096;

/// A number as a key of a priority queue, in the total order of `f64`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Key(pub f64);

impl Eq for Key {}
impl Ord for Key {
    fn cmp(&self, other: &Self) -> Ordering {
        self.0.total_cmp(&other.0)
    }
}
impl PartialOrd for Key {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// Shortest paths along edges from a set of sources.
#[derive(Debug, Clone)]
pub struct Forest {
    /// The distance to the nearest source.
    pub distance: PerVertex<f64>,
    /// The half-edge that enters the vertex on its path from the source; `None` at a source.
    pub parent: PerVertex<Option<HalfedgeId>>,
}
stored!(sections Forest { distance, parent });

impl Forest {
    /// The path from `v` up to its source, as half-edges that lead downwards: the last one leaves the source.
    pub fn path<'a>(&'a self, mesh: &'a Mesh, v: VertexId) -> impl Iterator<Item = HalfedgeId> + 'a {
        std::iter::successors(self.parent[v], |&h| self.parent[mesh.origin(h)])
    }

    /// The length of an edge's arc: from a source to one end, along the edge, and from the other end to a source.
    pub(super) fn arc(&self, mesh: &Mesh, lengths: &PerEdge<f64>, e: EdgeId) -> f64 {
        let [u, v] = mesh.ends(e);
        self.distance[u] + self.distance[v] + lengths[e]
    }

    /// The path from the source of `v` down to it.
    pub(super) fn path_down(&self, mesh: &Mesh, v: VertexId) -> Vec<HalfedgeId> {
        let mut path: Vec<_> = self.path(mesh, v).collect();
        path.reverse();
        path
    }
}

/// Shortest-path forest along edges (Dijkstra), O(E log V).
///
/// `lengths` are positive, one per edge. Equal distances are settled in the order of vertex ids and the first path found stays, so the
/// forest depends on the input alone. In a component without a source, the vertex of lowest id becomes one.
///
/// # Errors
///
/// [`crate::Error::Size`] and [`crate::Error::EdgeLength`] for lengths that are not E positive numbers;
/// [`crate::Error::Argument`] for a source that is no vertex; [`crate::Error::Cancelled`].
pub fn shortest_paths(
    mesh: &Mesh,
    lengths: &PerEdge<f64>,
    sources: impl IntoIterator<Item = VertexId>,
    control: &Control,
) -> Result<Forest> {
    shortest_paths_through(mesh, lengths, sources, control, |_| Vec::new())
}

/// A vertex, the length of a path to it from another vertex, and the half-edge that enters it.
pub(super) type ReachedVertex = (VertexId, f64, HalfedgeId);

/// Like [`shortest_paths`], but when a vertex is settled, the vertices that `at_once` returns for it keep the paths from there that it
/// returns, even if there are shorter ones.
pub(super) fn shortest_paths_through(
    mesh: &Mesh,
    lengths: &PerEdge<f64>,
    sources: impl IntoIterator<Item = VertexId>,
    control: &Control,
    at_once: impl Fn(VertexId) -> Vec<ReachedVertex>,
) -> Result<Forest> {
    check_lengths(mesh, lengths)?;
    let edges = |v: VertexId| mesh.outgoing(v).map(|h| OutgoingEdge::along(mesh, lengths, h));
    PathSearch { mesh, unit: mean(lengths), edges, at_once }.run(sources, control)
}

/// A half-edge that leaves a vertex.
#[derive(Clone, Copy)]
struct OutgoingEdge {
    length: f64,
    tip: VertexId,
    along: HalfedgeId,
}

impl OutgoingEdge {
    #[inline]
    fn along(mesh: &Mesh, lengths: &PerEdge<f64>, h: HalfedgeId) -> OutgoingEdge {
        OutgoingEdge { length: lengths[h.edge()], tip: mesh.tip(h), along: h }
    }
}

/// The edges that leave each vertex, next to each other in memory. This pays when there are several searches on the same mesh.
pub(crate) struct OutgoingEdges<'a> {
    mesh: &'a Mesh,
    pub lengths: &'a PerEdge<f64>,
    /// The edges that leave vertex v are `edges[starts[v]..starts[v + 1]]`.
    starts: Vec<u32>,
    edges: Vec<OutgoingEdge>,
}

impl<'a> OutgoingEdges<'a> {
    /// # Errors
    /// As [`shortest_paths`].
    pub fn new(mesh: &'a Mesh, lengths: &'a PerEdge<f64>) -> Result<Self> {
        check_lengths(mesh, lengths)?;
        let (mut starts, mut edges) =
            (Vec::with_capacity(mesh.n_vertices() + 1), Vec::with_capacity(mesh.n_halfedges()));
        for v in mesh.vertices() {
            starts.push(edges.len() as u32);
            edges.extend(mesh.outgoing(v).map(|h| OutgoingEdge::along(mesh, lengths, h)));
        }
        starts.push(edges.len() as u32);
        Ok(OutgoingEdges { mesh, lengths, starts, edges })
    }

    /// [`shortest_paths`] from these sources.
    ///
    /// # Errors
    /// Those of [`shortest_paths`].
    pub fn shortest_paths(&self, sources: &[VertexId], control: &Control) -> Result<Forest> {
        let edges = |v: VertexId| {
            let [begin, end] = [v.index(), v.index() + 1].map(|k| self.starts[k] as usize);
            self.edges[begin..end].iter().copied()
        };
        let search = PathSearch { mesh: self.mesh, unit: mean(self.lengths), edges, at_once: |_| Vec::new() };
        search.run(sources.iter().copied(), control)
    }
}

/// The mean of the lengths.
pub(super) fn mean(lengths: &PerEdge<f64>) -> f64 {
    lengths.iter().sum::<f64>() / lengths.len() as f64
}

/// A running search for shortest paths.
struct PathSearch<'a, R, A> {
    mesh: &'a Mesh,
    /// About the length of an edge, see [`NearestQueue::new`].
    unit: f64,
    /// Returns the edges that leave a vertex.
    edges: R,
    /// See [`shortest_paths_through`].
    at_once: A,
}

impl<R, I, A> PathSearch<'_, R, A>
where
    R: Fn(VertexId) -> I,
    I: Iterator<Item = OutgoingEdge>,
    A: Fn(VertexId) -> Vec<ReachedVertex>,
{
    fn run(&self, sources: impl IntoIterator<Item = VertexId>, control: &Control) -> Result<Forest> {
        let PathSearch { mesh, unit, .. } = *self;
        let unreached =
            VertexState { distance: f64::INFINITY, parent: NONE, is_settled: false, is_fixed: false };
        let mut reach = PerVertex::filled(mesh.n_vertices(), unreached);
        let mut queue = NearestQueue::new(unit);
        for v in sources {
            check_vertex(mesh, v)?;
            reach[v].distance = 0.0;
            queue.push(0.0, v);
        }
        let mut roots = mesh.vertices();
        let mut steps = 0;
        loop {
            while let Some((d, v)) = queue.pop() {
                control.check_every(VERTICES_PER_CHECK, &mut steps)?;
                let here = &mut reach[v];
                if d != here.distance || std::mem::replace(&mut here.is_settled, true) {
                    continue;
                }
                if !std::mem::replace(&mut here.is_fixed, true) {
                    for (w, through, h) in (self.at_once)(v) {
                        let there = &mut reach[w];
                        (there.distance, there.parent, there.is_fixed) = (d + through, h, true);
                        queue.push(d + through, w);
                    }
                }
                for OutgoingEdge { length, tip, along } in (self.edges)(v) {
                    let (there, through) = (&mut reach[tip], d + length);
                    if !there.is_fixed && through < there.distance {
                        (there.distance, there.parent) = (through, along);
                        queue.push(through, tip);
                    }
                }
            }
            let Some(v) = roots.find(|&v| !reach[v].is_settled) else { break };
            reach[v].distance = 0.0;
            queue.push(0.0, v);
        }
        Ok(Forest {
            distance: PerVertex::from_fn(reach.len(), |v| reach[v].distance),
            parent: PerVertex::from_fn(reach.len(), |v| Some(reach[v].parent).filter(|&h| h != NONE)),
        })
    }
}

/// Stands for no half-edge.
const NONE: HalfedgeId = HalfedgeId(u32::MAX);

/// The state of a vertex in a search, in one place of memory.
#[derive(Clone, Copy)]
struct VertexState {
    distance: f64,
    parent: HalfedgeId,
    is_settled: bool,
    /// True if the path to it is final: it is settled, or was returned by `at_once`.
    is_fixed: bool,
}

/// The edges that are neither in a shortest-path forest nor in a maximum spanning tree of the dual graph, shortest arcs first.
///
/// The arc of an edge `e = uv` runs from a source to u, along e, and from v to a source; its length `σ(e) = d(u) + d(v) + |e|` is the
/// weight in the dual tree, so the edges left over have the shortest arcs [EW05, §3.4]. Edges of the forest and those with `wall` are in
/// neither the dual tree nor the result; a boundary edge that is no wall joins its face to the outside, which is one node of the dual
/// graph.
pub(crate) fn leftover(
    mesh: &Mesh,
    lengths: &PerEdge<f64>,
    forest: &Forest,
    wall: impl Fn(EdgeId) -> bool,
) -> Vec<EdgeId> {
    let mut in_forest = PerEdge::filled(mesh.n_edges(), false);
    for h in forest.parent.iter().flatten() {
        in_forest[h.edge()] = true;
    }
    let free: Vec<EdgeId> = mesh.edges().filter(|&e| !in_forest[e] && !wall(e)).collect();
    // In the dual graph the outside is one more node.
    let outside = mesh.n_faces() as u32;
    let nodes =
        |e: EdgeId| [e.halfedge(), e.halfedge().twin()].map(|h| mesh.face(h).map_or(outside, |f| f.0));
    let cycles = on_cycles(free, mesh.n_faces() + 1, nodes);
    let mut arcs: Vec<(Key, EdgeId)> =
        cycles.into_iter().map(|e| (Key(forest.arc(mesh, lengths, e)), e)).collect();
    arcs.sort_unstable_by(|a, b| b.cmp(a));
    let mut joined = UnionFind::new(mesh.n_faces() + 1);
    let mut closes = |e: &EdgeId| {
        let [a, b] = nodes(*e);
        !joined.join(a, b)
    };
    let mut left: Vec<EdgeId> = arcs.into_iter().map(|(_, e)| e).filter(|e| closes(e)).collect();
    left.reverse();
    left
}

/// The edges of a graph that remain after repeatedly removing edges to a node with no other edge: those on cycles and between cycles.
/// Every spanning tree contains the removed ones. `edges` are ascending and stay so; `nodes` returns the ends of each, below `n`.
fn on_cycles(mut edges: Vec<EdgeId>, n: usize, nodes: impl Fn(EdgeId) -> [u32; 2]) -> Vec<EdgeId> {
    // For each node the number of its edges and the exclusive or of their ids, which is the id of the last one when one is left.
    let mut ends = vec![(0u32, 0u32); n];
    let remove = |ends: &mut [(u32, u32)], e: EdgeId, node: u32| {
        let (degree, sum) = &mut ends[node as usize];
        (*degree, *sum) = (*degree - 1, *sum ^ e.0);
        *degree == 1
    };
    for &e in &edges {
        for node in nodes(e) {
            let (degree, sum) = &mut ends[node as usize];
            (*degree, *sum) = (*degree + 1, *sum ^ e.0);
        }
    }
    let mut leaves: Vec<u32> = (0..n as u32).filter(|&node| ends[node as usize].0 == 1).collect();
    let mut is_cut_off = vec![false; edges.last().map_or(0, |e| e.index() + 1)];
    while let Some(leaf) = leaves.pop() {
        let (1, e) = ends[leaf as usize] else { continue };
        is_cut_off[e as usize] = true;
        let e = EdgeId(e);
        leaves.extend(nodes(e).into_iter().filter(|&node| remove(&mut ends, e, node) && node != leaf));
    }
    edges.retain(|e| !is_cut_off[e.index()]);
    edges
}

/// On closed and open surfaces and with walls, the result is the same as when all arcs are tried in order.
#[cfg(test)]
#[test]
#[allow(clippy::unwrap_used)]
fn what_is_left_over_is_found_without_the_edges_of_every_spanning_tree() {
    use crate::mesh::shapes;
    use std::cmp::Reverse;
    let samples =
        [shapes::flat_torus([0.3, 1.0], 12, 9), shapes::bolza(2), shapes::pants([1.0, 2.0, 3.0], 2)];
    for sample in samples {
        let (mesh, lengths) = &sample.unwrap().build().unwrap();
        let forest = shortest_paths(mesh, lengths, [VertexId(0)], &Control::new()).unwrap();
        for wall in [|_: EdgeId| false, |e: EdgeId| e.0.is_multiple_of(7)] {
            let in_forest = |e: EdgeId| forest.parent.iter().flatten().any(|h| h.edge() == e);
            let mut all: Vec<EdgeId> = mesh.edges().filter(|&e| !in_forest(e) && !wall(e)).collect();
            all.sort_by_key(|&e| Reverse((Key(forest.arc(mesh, lengths, e)), e)));
            let node = |h: HalfedgeId| mesh.face(h).map_or(mesh.n_faces() as u32, |f| f.0);
            let mut joined = UnionFind::new(mesh.n_faces() + 1);
            all.retain(|e| !joined.join(node(e.halfedge()), node(e.halfedge().twin())));
            all.reverse();
            assert_eq!(leftover(mesh, lengths, &forest, wall), all);
            assert!(wall(EdgeId(0)) || all.len() >= 2 * mesh.genus());
        }
    }
}
