//! Closed paths from face to face that generate the homology of a closed surface, their turning, and how flips change them.

use crate::error::{Error, Result};
use crate::mesh::{EdgeId, HalfedgeId, Mesh, PerEdge, PerFace, PerHalfedge, PerVertex, VertexId};
use std::collections::VecDeque;

/// Closed paths from face to face. A path is the cycle of the half-edges that it crosses, each from its own face to that of its twin.
#[derive(Debug, Clone, PartialEq)]
pub struct DualLoops {
    loops: Vec<Vec<HalfedgeId>>,
    /// Per edge, the number of times that paths cross it.
    crossings: PerEdge<u32>,
}

/// A passage through a face: the half-edge of the face over which the path came in, and the one over which it leaves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Passage {
    pub entry: HalfedgeId,
    pub exit: HalfedgeId,
}

impl Passage {
    /// The half-edge at whose origin lies the corner that the path turns around, and the sign of that turn: + where the corner lies to the
    /// left of the path.
    pub fn pivot(self, mesh: &Mesh) -> (HalfedgeId, f64) {
        if self.exit == mesh.prev(self.entry) { (self.entry, 1.0) } else { (self.exit, -1.0) }
    }
}

impl DualLoops {
    /// 2g closed paths that generate the homology of a closed surface of genus g, by a tree of edges from `root` and a tree of faces that
    /// crosses none of them. O(E + total length).
    ///
    /// # Errors
    /// [`Error::Connectivity`] for a surface with boundary or of several components.
    pub fn new(mesh: &Mesh, root: VertexId) -> Result<DualLoops> {
        if !mesh.is_closed() {
            return Err(Error::connectivity(
                "boundary loop",
                0,
                "paths around handles need a closed surface",
            ));
        }
        let in_tree = vertex_tree(mesh, root);
        let (entry, crossed) = face_tree(mesh, &in_tree);
        let left = mesh.edges().filter(|&e| !in_tree[e] && !crossed[e]);
        let loops: Vec<_> = left.map(|e| closed_path(mesh, &entry, e.halfedge())).collect();
        if loops.len() as i64 != 2 - mesh.euler() {
            return Err(Error::connectivity("path", loops.len(), "the surface has several components"));
        }
        let mut crossings = PerEdge::filled(mesh.n_edges(), 0);
        loops.iter().flatten().for_each(|h| crossings[h.edge()] += 1);
        Ok(DualLoops { loops, crossings })
    }

    /// The number of paths.
    pub fn len(&self) -> usize {
        self.loops.len()
    }

    /// True if there is no path, as on a sphere.
    pub fn is_empty(&self) -> bool {
        self.loops.is_empty()
    }

    /// The half-edges that path k crosses, in order.
    pub fn path(&self, k: usize) -> &[HalfedgeId] {
        &self.loops[k]
    }

    /// The passages of path k through faces.
    pub(super) fn passages(&self, k: usize) -> impl Iterator<Item = Passage> + '_ {
        let path = &self.loops[k];
        let before = path.iter().cycle().skip(path.len().saturating_sub(1));
        path.iter().zip(before).map(|(&exit, before)| Passage { entry: before.twin(), exit })
    }

    /// The turning of each path, radians: angles to its left less angles to its right. `angles`: that at the origin of each half-edge, in
    /// its face.
    pub fn turning(&self, mesh: &Mesh, angles: &PerHalfedge<f64>) -> Vec<f64> {
        let turn = |passage: Passage| {
            let (corner, sign) = passage.pivot(mesh);
            sign * angles[corner]
        };
        (0..self.len()).map(|k| self.passages(k).map(turn).sum()).collect()
    }

    /// Carries the paths over the flip of an edge, just before it is made: inside the quadrilateral of the edge only the sides over which a
    /// path comes in and leaves are kept, and it crosses the new diagonal if they lie in different new faces.
    pub fn before_flip(&mut self, mesh: &Mesh, edge: EdgeId) {
        let h = edge.halfedge();
        let [bc, ca, ad, db] = mesh.quadrilateral(h);
        let near = [edge, bc.edge(), ca.edge(), ad.edge(), db.edge()];
        if near.iter().all(|&e| self.crossings[e] == 0) {
            return;
        }
        // The new faces, and the half-edge of the new diagonal that lies in each.
        let first = |x: HalfedgeId| x == ca || x == ad;
        let second = |x: HalfedgeId| x == bc || x == db;
        for path in &mut self.loops {
            if !path.iter().any(|x| near.contains(&x.edge())) {
                continue;
            }
            self.crossings[edge] -= path.iter().filter(|x| x.edge() == edge).count() as u32;
            path.retain(|x| x.edge() != edge);
            let mut carried = Vec::with_capacity(path.len() + 2);
            for (k, &exit) in path.iter().enumerate() {
                let entry = path[(k + path.len() - 1) % path.len()].twin();
                if first(entry) && second(exit) {
                    carried.push(h);
                } else if second(entry) && first(exit) {
                    carried.push(h.twin());
                }
                carried.push(exit);
            }
            self.crossings[edge] += carried.iter().filter(|x| x.edge() == edge).count() as u32;
            *path = carried;
        }
    }
}

/// Per edge, true if it is in a tree of shortest edge paths from a vertex.
fn vertex_tree(mesh: &Mesh, root: VertexId) -> PerEdge<bool> {
    let mut in_tree = PerEdge::filled(mesh.n_edges(), false);
    let mut is_reached = PerVertex::filled(mesh.n_vertices(), false);
    is_reached[root] = true;
    let mut waiting = VecDeque::from([root]);
    while let Some(v) = waiting.pop_front() {
        for h in mesh.outgoing(v) {
            let tip = mesh.tip(h);
            if !is_reached[tip] {
                is_reached[tip] = true;
                in_tree[h.edge()] = true;
                waiting.push_back(tip);
            }
        }
    }
    in_tree
}

/// A tree of faces that are joined across edges outside `in_tree`: per face the half-edge of its parent that leads to it (none for the
/// root), and per edge true if the tree crosses it.
fn face_tree(mesh: &Mesh, in_tree: &PerEdge<bool>) -> (PerFace<Option<HalfedgeId>>, PerEdge<bool>) {
    let mut entry = PerFace::filled(mesh.n_faces(), None);
    let mut crossed = PerEdge::filled(mesh.n_edges(), false);
    let mut is_reached = PerFace::filled(mesh.n_faces(), false);
    let mut waiting: VecDeque<_> = mesh.faces().take(1).collect();
    waiting.iter().for_each(|&f| is_reached[f] = true);
    while let Some(f) = waiting.pop_front() {
        for h in mesh.face_halfedges(f) {
            let Some(g) = mesh.face(h.twin()) else { continue };
            if !in_tree[h.edge()] && !is_reached[g] {
                is_reached[g] = true;
                entry[g] = Some(h);
                crossed[h.edge()] = true;
                waiting.push_back(g);
            }
        }
    }
    (entry, crossed)
}

/// The closed path that crosses h and is closed in the tree of faces, without the part that it would go there and back.
fn closed_path(mesh: &Mesh, entry: &PerFace<Option<HalfedgeId>>, h: HalfedgeId) -> Vec<HalfedgeId> {
    let from_root = |h: HalfedgeId| {
        let mut path = Vec::new();
        let mut next = mesh.face(h).and_then(|f| entry[f]);
        while let Some(x) = next {
            path.push(x);
            next = mesh.face(x).and_then(|f| entry[f]);
        }
        path.reverse();
        path
    };
    let (to, back) = (from_root(h), from_root(h.twin()));
    let common = to.iter().zip(&back).take_while(|(a, b)| a == b).count();
    let home = back[common..].iter().rev().map(|x| x.twin());
    to[common..].iter().copied().chain([h]).chain(home).collect()
}
