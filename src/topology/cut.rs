//! Cut graphs: edges along which a surface opens into a disk.
//!
//! ```
//! use ricci::mesh::{VertexId, shapes};
//! use ricci::{Control, topology::cut_graph};
//! let (sphere, lengths) = shapes::two_triangle_sphere().build()?;
//! let cones = [VertexId(0), VertexId(1), VertexId(2)];
//! let cut = cut_graph(&sphere, &lengths, &cones, &Control::new())?;
//! assert_eq!(cut.length(&lengths), 2.0); // two of the three edges join the cones
//! # Ok::<(), ricci::Error>(())
//! ```

use super::check_lengths;
use super::shorten::{LEAST_SAVING, MOVES_PER_FACE, fan};
use super::spanning::{OutgoingEdges, leftover};
use crate::archive::stored;
use crate::control::Control;
use crate::error::{Error, Result};
use crate::mesh::union_find::UnionFind;
use crate::mesh::{EdgeId, HalfedgeId, Mesh, PerEdge, PerVertex, VertexId};
use std::collections::VecDeque;

/// Interior edges along which the surface opens into a disk, as chains between nodes.
#[derive(Debug, Clone, PartialEq)]
pub struct CutGraph {
    /// True for cut edges. Boundary edges are open anyway and never marked.
    pub is_cut: PerEdge<bool>,
    /// The ends of segments, ascending: cones, boundary vertices that the cut reaches, and branch points.
    pub nodes: Vec<VertexId>,
    /// The cut as directed chains of half-edges from node to node that pass no other node; each cut edge is
    /// in exactly one.
    pub segments: Vec<Vec<HalfedgeId>>,
}
stored!(sections CutGraph { is_cut, nodes, segments });

impl CutGraph {
    /// No cut at all.
    pub(crate) fn empty(mesh: &Mesh) -> CutGraph {
        let is_cut = PerEdge::filled(mesh.n_edges(), false);
        CutGraph { is_cut, nodes: Vec::new(), segments: Vec::new() }
    }

    /// The cut of the marked interior edges, without branches that end neither at a branch point nor on the boundary.
    pub(crate) fn around(mesh: &Mesh, marked: PerEdge<bool>) -> CutGraph {
        let fixed = PerVertex::from_fn(mesh.n_vertices(), |v| mesh.is_boundary_vertex(v));
        let mut cut = EditableCut::new(mesh, fixed);
        for e in mesh.edges().filter(|&e| marked[e] && !mesh.is_boundary_edge(e)) {
            cut.set(e, true);
        }
        cut.prune();
        cut.into_graph()
    }

    /// The cut without edges on the boundary of the surface, which split its segments.
    pub(crate) fn inside(self, mesh: &Mesh) -> CutGraph {
        let is_inside = |h: &HalfedgeId| !mesh.is_boundary_edge(h.edge());
        let runs = |segment: &Vec<HalfedgeId>| -> Vec<Vec<HalfedgeId>> {
            let parts = segment.split(|h| !is_inside(h));
            parts.filter(|run| !run.is_empty()).map(<[HalfedgeId]>::to_vec).collect()
        };
        CutGraph {
            is_cut: PerEdge::from_fn(self.is_cut.len(), |e| self.is_cut[e] && !mesh.is_boundary_edge(e)),
            segments: self.segments.iter().flat_map(runs).collect(),
            nodes: self.nodes,
        }
    }

    /// Total length of the cut.
    pub fn length(&self, lengths: &PerEdge<f64>) -> f64 {
        self.segments.iter().flatten().fold(0.0, |sum, h| sum + lengths[h.edge()])
    }
}

/// A cut graph through all cones: a short set of interior edges that opens the surface into a disk.
///
/// The boundary and the cones together are the sources of a shortest-path forest. The cut consists of the edges that are neither in the
/// forest nor in a maximum spanning tree of the dual graph, with their paths to the sources (tree–cotree, \[EW05\]). So cones are joined
/// to each other, to the boundary and to the handles by short arcs. Then segments are pulled straight and their ends slid across
/// triangles as long as that makes the cut shorter.
///
/// `lengths`: finite and positive, one per edge. `cones`: vertices that have to lie on the cut, in any order;
/// those on the boundary change nothing. A disk without interior cones has an empty cut.
///
/// # Errors
///
/// [`Error::EdgeLength`]; [`Error::Argument`] for a cone that is no vertex; [`Error::Layout`] for a closed surface of genus 0 with fewer
/// than two cones (a sphere has no plane layout) and for a surface of several components; [`Error::Cancelled`].
pub fn cut_graph(
    mesh: &Mesh,
    lengths: &PerEdge<f64>,
    cones: &[VertexId],
    control: &Control,
) -> Result<CutGraph> {
    control.check()?;
    let fixed = fixed_vertices(mesh, lengths, cones)?;
    let sources: Vec<_> = mesh.vertices().filter(|&v| fixed[v]).collect();
    let outgoing = OutgoingEdges::new(mesh, lengths)?;
    let open = |sources: &[VertexId]| -> Result<_> {
        let mut cut = EditableCut::new(mesh, fixed.clone());
        let shortest_arc = cut.tree_cotree(&outgoing, sources, control)?;
        cut.shorten(lengths, control)?;
        Ok((cut, shortest_arc))
    };
    let cut = if sources.is_empty() {
        // Any vertex may be the source: the search continues from the shortest loop through the last one as long as that helps.
        let (mut cut, mut arc) = open(&[VertexId(0)])?;
        for _ in 0..MAX_ROOTS {
            let Some((e, length)) = arc else { break };
            let (next, next_arc) = open(&[mesh.tip(e.halfedge())])?;
            if next.length(lengths) >= cut.length(lengths) {
                break;
            }
            (cut, arc) = (next, next_arc.filter(|(_, next)| *next < LEAST_GAIN * length));
        }
        cut
    } else {
        open(&sources)?.0
    };
    debug_assert!(is_disk(mesh, &cut.is_cut));
    Ok(cut.into_graph())
}

/// Vertices of the cut between two checks of the control. A few fans of triangles are measured at each, so that these take a fraction of
/// a millisecond.
const VERTICES_PER_CHECK: usize = 1024;

/// Most sources that are tried on a closed surface without cones, besides the first. Usually the second or third is not better than
/// the one before it and ends the search.
const MAX_ROOTS: usize = 8;

/// Another source is tried only while the shortest loop through a source is shorter than this share of that through the one before it. On
/// flat tori all sources are alike, and only the zigzag of paths along edges differs.
const LEAST_GAIN: f64 = 0.99;

/// True if the surface opened along the marked edges is a disk: connected with Euler characteristic 1. O(E).
pub fn is_disk(mesh: &Mesh, is_cut: &PerEdge<bool>) -> bool {
    let n_cut = is_cut.iter().filter(|&&c| c).count();
    // A vertex opens into as many vertices as it has cut edges, and one more on the boundary.
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

/// Checks that the surface is connected and not empty; `advice` tells the user what to do with the components of another surface.
pub(crate) fn check_connected(mesh: &Mesh, advice: &str) -> Result<()> {
    if is_connected(mesh, |_| false) {
        return Ok(());
    }
    Err(Error::Layout(format!("the surface is empty or has several components: {advice} each alone")))
}

/// True if all faces are connected through interior edges that are not walls.
pub(super) fn is_connected(mesh: &Mesh, wall: impl Fn(EdgeId) -> bool) -> bool {
    let mut joined = UnionFind::new(mesh.n_faces());
    let mut components = mesh.n_faces();
    for e in mesh.edges().filter(|&e| !wall(e)) {
        if let (Some(f), Some(g)) = (mesh.face(e.halfedge()), mesh.face(e.halfedge().twin())) {
            components -= usize::from(joined.join(f.0, g.0));
        }
    }
    components == 1
}

/// A cut while it is changed: the marked edges, and for each vertex the number of half-edges of marked edges that leave it.
struct EditableCut<'a> {
    mesh: &'a Mesh,
    is_cut: PerEdge<bool>,
    degree: PerVertex<u32>,
    /// Vertices that segments may not be pulled away from or across: cones and the boundary.
    fixed: PerVertex<bool>,
    /// Memory of [`EditableCut::link`], all false between its calls.
    seen: PerVertex<bool>,
}

impl<'a> EditableCut<'a> {
    fn new(mesh: &'a Mesh, fixed: PerVertex<bool>) -> EditableCut<'a> {
        EditableCut {
            mesh,
            is_cut: PerEdge::filled(mesh.n_edges(), false),
            degree: PerVertex::filled(mesh.n_vertices(), 0),
            fixed,
            seen: PerVertex::filled(mesh.n_vertices(), false),
        }
    }

    fn set(&mut self, e: EdgeId, cut: bool) {
        if std::mem::replace(&mut self.is_cut[e], cut) != cut {
            for v in self.mesh.ends(e) {
                self.degree[v] = if cut { self.degree[v] + 1 } else { self.degree[v] - 1 };
            }
        }
    }

    fn length(&self, lengths: &PerEdge<f64>) -> f64 {
        let cut = self.is_cut.iter().zip(lengths).filter(|(cut, _)| **cut);
        cut.fold(0.0, |sum, (_, l)| sum + l)
    }

    /// True if a segment passes through `v`.
    fn is_inner(&self, v: VertexId) -> bool {
        self.degree[v] == 2 && !self.fixed[v]
    }

    /// The cut edges that leave `v`, clockwise.
    fn leaving(&self, v: VertexId) -> impl Iterator<Item = HalfedgeId> {
        self.mesh.outgoing(v).filter(|h| self.is_cut[h.edge()])
    }

    fn into_graph(self) -> CutGraph {
        let mesh = self.mesh;
        let nodes: Vec<_> = mesh.vertices().filter(|&v| self.degree[v] > 0 && !self.is_inner(v)).collect();
        let mut walked = PerEdge::filled(mesh.n_edges(), false);
        let mut segments = Vec::new();
        for start in nodes.iter().flat_map(|&node| self.leaving(node)) {
            if std::mem::replace(&mut walked[start.edge()], true) {
                continue;
            }
            let onwards = |&h: &HalfedgeId| {
                let tip = mesh.tip(h);
                self.leaving(tip).find(|&o| o != h.twin()).filter(|_| self.is_inner(tip))
            };
            let segment: Vec<_> = std::iter::successors(Some(start), onwards).collect();
            segment.iter().for_each(|h| walked[h.edge()] = true);
            segments.push(segment);
        }
        CutGraph { is_cut: self.is_cut, nodes, segments }
    }

    /// Marks the edges that are neither in the forest of the sources nor in its dual tree, with the paths from their ends to the sources.
    /// Returns the one of those edges with the shortest arc, and the length of that arc.
    fn tree_cotree(
        &mut self,
        outgoing: &OutgoingEdges,
        sources: &[VertexId],
        control: &Control,
    ) -> Result<Option<(EdgeId, f64)>> {
        let mesh = self.mesh;
        let forest = outgoing.shortest_paths(sources, control)?;
        let arcs = leftover(mesh, outgoing.lengths, &forest, |e| mesh.is_boundary_edge(e));
        control.check()?;
        for &e in &arcs {
            self.set(e, true);
            for v in mesh.ends(e) {
                for h in forest.path(mesh, v) {
                    if self.is_cut[h.edge()] {
                        break;
                    }
                    self.set(h.edge(), true);
                }
            }
        }
        self.prune();
        Ok(arcs.first().map(|&e| (e, forest.arc(mesh, outgoing.lengths, e))))
    }

    /// Unmarks branches that end at a vertex which is neither a cone nor on the boundary.
    fn prune(&mut self) {
        for mut v in self.mesh.vertices() {
            while self.degree[v] == 1 && !self.fixed[v] {
                let Some(h) = self.leaving(v).next() else { break };
                self.set(h.edge(), false);
                v = self.mesh.tip(h);
            }
        }
    }

    /// Shortens the cut by sliding edges across fans of triangles.
    ///
    /// ```text
    ///      x1 --- x2         triangles at v between two neighbouring cut edges vu and vw: the end of vu
    ///     / \    / \         slides along vw to w, so that u x1 x2 w takes the place of vu. The fan, a
    ///    /   \  /   \        disk that hung on the path u x1 x2 w, then hangs on vu instead: the opened
    ///   u ---- v --- w       surface stays a disk if x1, x2 are distinct and free of cuts, cones and
    ///                        boundary. If nothing else ends at v, vw dangles then and goes too: a
    ///                        segment is pulled straight.
    /// ```
    fn shorten(&mut self, lengths: &PerEdge<f64>, control: &Control) -> Result<()> {
        let mesh = self.mesh;
        let mut waiting: VecDeque<_> = mesh.vertices().filter(|&v| self.degree[v] > 1).collect();
        let mut budget = MOVES_PER_FACE * mesh.n_faces();
        let mut looked_at = 0;
        while let (Some(v), 1..) = (waiting.pop_front(), budget) {
            control.check_every(VERTICES_PER_CHECK, &mut looked_at)?;
            let Some((closed, opened)) = self.best_slide(lengths, v) else { continue };
            budget -= 1;
            for (edges, open) in [(closed, false), (opened, true)] {
                for h in edges {
                    self.set(h.edge(), open);
                    waiting.extend([mesh.origin(h), mesh.tip(h)]);
                }
            }
        }
        Ok(())
    }

    /// The slide at `v` that saves most: the cut edges to unmark and those to mark.
    fn best_slide(
        &mut self,
        lengths: &PerEdge<f64>,
        v: VertexId,
    ) -> Option<(Vec<HalfedgeId>, Vec<HalfedgeId>)> {
        let mesh = self.mesh;
        let clockwise: Vec<_> = self.leaving(v).collect();
        let n = clockwise.len();
        let pairs = if n < 2 || mesh.is_boundary_vertex(v) { n.saturating_sub(1) } else { n };
        let (mut best, mut saving) = (None, 0.0);
        for i in 0..pairs {
            let (b, a) = (clockwise[i], clockwise[(i + 1) % n]);
            if mesh.tip(a) == v || mesh.tip(b) == v {
                continue;
            }
            let closed = match lengths[a.edge()] >= lengths[b.edge()] {
                _ if self.is_inner(v) => vec![a, b],
                true => vec![a],
                false => vec![b],
            };
            let old: f64 = closed.iter().map(|h| lengths[h.edge()]).sum();
            let limit = old * (1.0 - LEAST_SAVING) - saving;
            if let Some((opened, new)) = self.link(lengths, [a, b], limit) {
                saving = old - new;
                best = Some((closed, opened));
            }
        }
        best
    }

    /// The edges opposite v in the fan counterclockwise between two outgoing half-edges, with their length; `None` if the length reaches
    /// `limit` or a segment may not be slid across the fan.
    fn link(
        &mut self,
        lengths: &PerEdge<f64>,
        [a, b]: [HalfedgeId; 2],
        limit: f64,
    ) -> Option<(Vec<HalfedgeId>, f64)> {
        let mesh = self.mesh;
        let (way, length) = fan(mesh, lengths, [a, b], limit)?;
        let is_open = |h: &HalfedgeId| self.is_cut[h.edge()] || mesh.is_boundary_edge(h.edge());
        if way.iter().any(is_open) {
            return None;
        }
        let inner = || way.iter().rev().skip(1).map(|&h| mesh.tip(h));
        let is_free = inner()
            .all(|x| self.degree[x] == 0 && !self.fixed[x] && !std::mem::replace(&mut self.seen[x], true));
        inner().for_each(|x| self.seen[x] = false);
        is_free.then_some((way, length))
    }
}

/// The vertices that stay on the cut, cones and the boundary. Checks the input of [`cut_graph`].
fn fixed_vertices(mesh: &Mesh, lengths: &PerEdge<f64>, cones: &[VertexId]) -> Result<PerVertex<bool>> {
    check_lengths(mesh, lengths)?;
    if let Some(v) = cones.iter().find(|v| v.index() >= mesh.n_vertices()) {
        return Err(Error::argument("cone vertex", v, "it must be below the number of vertices"));
    }
    check_connected(mesh, "lay out")?;
    let mut fixed = PerVertex::from_fn(mesh.n_vertices(), |v| mesh.is_boundary_vertex(v));
    for &v in cones {
        fixed[v] = true;
    }
    if mesh.euler() == 2 && fixed.iter().filter(|&&f| f).count() < 2 {
        let message = "a closed surface of genus 0 needs at least two cones: a sphere has no plane layout";
        return Err(Error::Layout(message.into()));
    }
    Ok(fixed)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::shapes;

    /// An n × n grid of squares with diagonals, opposite sides glued. Edge 3 (i + n j) + k leaves vertex (i, j) along the row (k = 0),
    /// the column or the diagonal.
    fn torus(n: usize) -> Mesh {
        shapes::flat_torus([0.0, 1.0], n, n).unwrap().build().unwrap().0
    }

    #[test]
    fn a_shortened_cut_is_never_longer_and_still_opens_a_disk() {
        let mut shorter = 0;
        for seed in 1..200_usize {
            let mesh = torus(1 + seed % 9);
            let lengths = PerEdge::from_fn(mesh.n_edges(), |e: EdgeId| {
                1.0 + ((e.index() * 7919 + seed * 104_729) % 1009) as f64 / 1009.0
            });
            let cones: Vec<_> = (0..seed % 4).map(|k| VertexId::from(k * 37 % mesh.n_vertices())).collect();
            let fixed = fixed_vertices(&mesh, &lengths, &cones).unwrap();
            let sources = if cones.is_empty() { &[VertexId(0)] } else { &cones[..] };
            let mut cut = EditableCut::new(&mesh, fixed);
            cut.tree_cotree(&OutgoingEdges::new(&mesh, &lengths).unwrap(), sources, &Control::new()).unwrap();
            assert!(is_disk(&mesh, &cut.is_cut));
            let before = cut.length(&lengths);
            cut.shorten(&lengths, &Control::new()).unwrap();
            assert!(is_disk(&mesh, &cut.is_cut));
            assert!(cut.length(&lengths) <= before);
            shorter += usize::from(cut.length(&lengths) < before);
        }
        assert!(shorter > 20, "only {shorter} cuts became shorter");
    }

    #[test]
    fn a_detour_is_pulled_straight() {
        // Row 0 is shorter than the others, but the cut leaves it for a stretch of row 1.
        let n = 8;
        let mesh = torus(n);
        let lengths =
            PerEdge::from_fn(mesh.n_edges(), |e: EdgeId| match (e.index() % 3, e.index() / 3 / n) {
                (0, 0) => 0.9,
                (2, _) => 1.3,
                _ => 1.0,
            });
        let edge = |kind: usize, i: usize, j: usize| EdgeId::from(3 * (i + n * j) + kind);
        let mut cut = EditableCut::new(&mesh, PerVertex::filled(mesh.n_vertices(), false));
        let column = (0..n).map(|j| edge(1, 0, j));
        let row = (0..n).filter(|i| ![3, 4].contains(i)).map(|i| edge(0, i, 0));
        let detour = [edge(1, 3, 0), edge(0, 3, 1), edge(0, 4, 1), edge(1, 5, 0)];
        column.chain(row).chain(detour).for_each(|e| cut.set(e, true));
        assert!(is_disk(&mesh, &cut.is_cut));
        cut.shorten(&lengths, &Control::new()).unwrap();
        assert!(is_disk(&mesh, &cut.is_cut));
        assert!((0..n).all(|i| cut.is_cut[edge(0, i, 0)] && cut.is_cut[edge(1, 0, i)]));
    }
}
