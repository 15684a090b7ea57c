//! Cut graphs: edges along which a surface opens into a disk.

use super::check_lengths;
use super::spanning::{DisjointSets, leftover, shortest_paths};
use crate::error::{Error, Result};
use crate::mesh::{EdgeId, HalfedgeId, Mesh, PerEdge, PerVertex, VertexId};
use std::collections::VecDeque;

/// Interior edges whose removal leaves a disk, as chains between nodes.
#[derive(Debug, Clone, PartialEq)]
pub struct CutGraph {
    /// Whether an edge is cut. Boundary edges are open anyway and never marked.
    pub is_cut: PerEdge<bool>,
    /// Where segments end, ascending: cones, boundary vertices that the cut reaches, and branch points.
    pub nodes: Vec<VertexId>,
    /// The cut as directed chains of half-edges from node to node that pass no other node; each cut edge is in
    /// exactly one.
    pub segments: Vec<Vec<HalfedgeId>>,
}

impl CutGraph {
    /// Total length of the cut.
    pub fn length(&self, lengths: &PerEdge<f64>) -> f64 {
        self.segments.iter().flatten().map(|h| lengths[h.edge()]).sum()
    }
}

/// A cut graph through all cones: a short set of interior edges that opens the surface into a disk.
///
/// The boundary and the cones together are the sources of a shortest-path forest; the edges that the forest and a
/// maximum spanning tree of the dual graph leave over, with their paths to the sources, are the cut (tree–cotree,
/// [EW05]). So cones are joined to each other, to the boundary and to the handles by short arcs. Then the
/// segments are shortened by pulling them across the triangles at one of their vertices while that makes them
/// shorter; they stay simple and meet only in nodes.
///
/// `lengths`: finite and positive, one per edge. `cones`: vertices that have to lie on the cut, in any order; those on
/// the boundary change nothing. A disk without interior cones has an empty cut.
///
/// Errors: [`Error::EdgeLength`]; [`Error::Argument`] for a cone that is no vertex; [`Error::Layout`] for a
/// closed surface of genus 0 with fewer than two cones (a sphere has no plane layout) and for a surface of several
/// components.
pub fn cut_graph(mesh: &Mesh, lengths: &PerEdge<f64>, cones: &[VertexId]) -> Result<CutGraph> {
    let mut cut = tree_cotree_cut(mesh, lengths, cones)?;
    shorten(mesh, lengths, &mut cut);
    debug_assert!(is_disk(mesh, &cut.is_cut));
    Ok(cut.into_graph(mesh))
}

/// Whether the surface opened along the marked edges is a disk: connected with Euler characteristic 1. O(E).
pub fn is_disk(mesh: &Mesh, is_cut: &PerEdge<bool>) -> bool {
    let n_cut = is_cut.iter().filter(|&&c| c).count();
    // A vertex opens into as many as it has cut edges, and one more on the boundary.
    let sectors: usize = mesh
        .vertices()
        .map(|v| {
            let degree = mesh.outgoing(v).filter(|h| is_cut[h.edge()]).count();
            if mesh.is_boundary_vertex(v) { degree + 1 } else { degree.max(1) }
        })
        .sum();
    let euler = sectors as i64 - (mesh.n_edges() + n_cut) as i64 + mesh.n_faces() as i64;
    euler == 1 && is_connected(mesh, |e| is_cut[e])
}

/// Whether all faces hang together through interior edges that are not walls.
fn is_connected(mesh: &Mesh, wall: impl Fn(EdgeId) -> bool) -> bool {
    let mut joined = DisjointSets::new(mesh.n_faces());
    let mut components = mesh.n_faces();
    for e in mesh.edges().filter(|&e| !wall(e)) {
        if let (Some(f), Some(g)) = (mesh.face(e.halfedge()), mesh.face(e.halfedge().twin())) {
            components -= usize::from(joined.union(f.index(), g.index()));
        }
    }
    components == 1
}

/// A cut in the making: marked edges, and per vertex how many half-edges of marked edges leave it.
struct Cut {
    is_cut: PerEdge<bool>,
    degree: PerVertex<u32>,
    /// Vertices a segment may not be pulled away from or across: cones and the boundary.
    fixed: PerVertex<bool>,
}

impl Cut {
    fn set(&mut self, mesh: &Mesh, e: EdgeId, cut: bool) {
        if std::mem::replace(&mut self.is_cut[e], cut) != cut {
            for v in mesh.ends(e) {
                self.degree[v] = if cut { self.degree[v] + 1 } else { self.degree[v] - 1 };
            }
        }
    }

    /// Whether a segment passes through `v`.
    fn is_inner(&self, v: VertexId) -> bool {
        self.degree[v] == 2 && !self.fixed[v]
    }

    fn into_graph(self, mesh: &Mesh) -> CutGraph {
        let nodes: Vec<_> = mesh.vertices().filter(|&v| self.degree[v] > 0 && !self.is_inner(v)).collect();
        let mut walked = PerEdge::filled(mesh.n_edges(), false);
        let mut segments = Vec::new();
        for &node in &nodes {
            for start in mesh.outgoing(node).filter(|h| self.is_cut[h.edge()]) {
                if std::mem::replace(&mut walked[start.edge()], true) {
                    continue;
                }
                let mut segment = vec![start];
                let mut h = start;
                while self.is_inner(mesh.tip(h)) {
                    let onwards =
                        mesh.outgoing(mesh.tip(h)).find(|&o| self.is_cut[o.edge()] && o != h.twin());
                    let Some(o) = onwards else { break };
                    h = o;
                    walked[h.edge()] = true;
                    segment.push(h);
                }
                segments.push(segment);
            }
        }
        CutGraph { is_cut: self.is_cut, nodes, segments }
    }
}

fn tree_cotree_cut(mesh: &Mesh, lengths: &PerEdge<f64>, cones: &[VertexId]) -> Result<Cut> {
    check_lengths(mesh, lengths)?;
    if let Some(v) = cones.iter().find(|v| v.index() >= mesh.n_vertices()) {
        return Err(Error::Argument {
            what: "cone vertex",
            value: v.to_string(),
            need: "it must be below the number of vertices",
        });
    }
    if !is_connected(mesh, |_| false) {
        return Err(Error::Layout(
            "the surface is empty or has several components: lay out each alone".into(),
        ));
    }
    let mut fixed = PerVertex::from_fn(mesh.n_vertices(), |v| mesh.is_boundary_vertex(v));
    for &v in cones {
        fixed[v] = true;
    }
    let mut sources: Vec<_> = mesh.vertices().filter(|&v| fixed[v]).collect();
    if mesh.euler() == 2 && sources.len() < 2 {
        let message = "a closed surface of genus 0 needs at least two cones: a sphere has no plane layout";
        return Err(Error::Layout(message.into()));
    }
    if sources.is_empty() {
        sources.push(VertexId(0));
    }
    let forest = shortest_paths(mesh, lengths, sources);
    let mut cut = Cut {
        is_cut: PerEdge::filled(mesh.n_edges(), false),
        degree: PerVertex::filled(mesh.n_vertices(), 0),
        fixed,
    };
    for e in leftover(mesh, lengths, &forest, |e| mesh.is_boundary_edge(e)) {
        cut.set(mesh, e, true);
        for v in mesh.ends(e) {
            for h in forest.path(mesh, v) {
                if cut.is_cut[h.edge()] {
                    break;
                }
                cut.set(mesh, h.edge(), true);
            }
        }
    }
    prune(mesh, &mut cut);
    Ok(cut)
}

/// Close the branches that end nowhere: not at a cone and not on the boundary.
fn prune(mesh: &Mesh, cut: &mut Cut) {
    for v in mesh.vertices() {
        let mut v = v;
        while cut.degree[v] == 1 && !cut.fixed[v] {
            let Some(h) = mesh.outgoing(v).find(|h| cut.is_cut[h.edge()]) else { break };
            cut.set(mesh, h.edge(), false);
            v = mesh.tip(h);
        }
    }
}

/// A move must save this fraction of the length it replaces. Far above the rounding of a sum of lengths, so no
/// sequence of moves comes back to where it was.
const LEAST_SAVING: f64 = 1e-12;

/// Moves allowed per face of the mesh. Paths from a shortest-path forest need far fewer; the bound keeps the
/// worst case linear.
const MOVES_PER_FACE: usize = 8;

/// Shorten segments by pulling them across the triangles on one side of one of their vertices.
///
/// ```text
///      x1 --- x2             the fan of triangles at v between u and w
///     / \    / \             the new way u x1 x2 w bounds a disk with the old one u v w
///    /   \  /   \            if x1, x2 are distinct, free of cuts, cones and boundary:
///   u ---- v --- w           sweeping over it moves the cut by an isotopy
/// ```
fn shorten(mesh: &Mesh, lengths: &PerEdge<f64>, cut: &mut Cut) {
    let mut waiting: VecDeque<_> = mesh.vertices().filter(|&v| cut.is_inner(v)).collect();
    let mut seen = PerVertex::filled(mesh.n_vertices(), false);
    let mut budget = MOVES_PER_FACE * mesh.n_faces();
    while let (Some(v), 1..) = (waiting.pop_front(), budget) {
        if !cut.is_inner(v) {
            continue;
        }
        let mut ways = mesh.outgoing(v).filter(|h| cut.is_cut[h.edge()]);
        let (Some(a), Some(b)) = (ways.next(), ways.next()) else { continue };
        if a.edge() == b.edge() {
            continue;
        }
        let old = lengths[a.edge()] + lengths[b.edge()];
        let limit = old * (1.0 - LEAST_SAVING);
        let one = link(mesh, lengths, cut, &mut seen, a, b, limit);
        let best = one.as_ref().map_or(limit, |(_, length)| *length);
        let other = link(mesh, lengths, cut, &mut seen, b, a, best);
        let Some((way, _)) = other.or(one) else { continue };
        budget -= 1;
        cut.set(mesh, a.edge(), false);
        cut.set(mesh, b.edge(), false);
        for h in way {
            cut.set(mesh, h.edge(), true);
            waiting.push_back(mesh.origin(h));
            waiting.push_back(mesh.tip(h));
        }
    }
}

/// The edges opposite v in the fan counterclockwise from outgoing half-edge `a` to `b`, with their length; `None` if
/// that reaches `limit` or the fan cannot be swept.
fn link(
    mesh: &Mesh,
    lengths: &PerEdge<f64>,
    cut: &Cut,
    seen: &mut PerVertex<bool>,
    a: HalfedgeId,
    b: HalfedgeId,
    limit: f64,
) -> Option<(Vec<HalfedgeId>, f64)> {
    let mut way = Vec::new();
    let mut length = 0.0;
    let mut h = a;
    let mut free = true;
    while free && h != b {
        let (opposite, on) = (mesh.next(h), mesh.prev(h).twin());
        length += lengths[opposite.edge()];
        free = length < limit && !cut.is_cut[opposite.edge()] && !mesh.is_boundary_edge(opposite.edge());
        if free && on != b {
            let x = mesh.tip(on);
            free = cut.degree[x] == 0 && !cut.fixed[x] && !std::mem::replace(&mut seen[x], true);
        }
        way.push(opposite);
        h = on;
    }
    for h in &way {
        seen[mesh.tip(*h)] = false;
    }
    free.then_some((way, length))
}
