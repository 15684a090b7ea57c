//! Paths from face to face whose turning decides that of all others: closed ones that generate the homology of a surface, and arcs from
//! feature to feature; their turning, and how flips change them.

use super::sectors::Sectors;
use crate::archive::stored;
use crate::error::{Error, Result};
use crate::mesh::{EdgeId, HalfedgeId, Mesh, PerEdge, PerFace, PerHalfedge, VertexId};
use std::collections::VecDeque;

/// Paths from face to face. A path is the list of the half-edges that it crosses, each from its own face to that of its twin. A closed path
/// goes on from the last to the first; an arc comes in over its first half-edge, a feature, and leaves over its last.
#[derive(Debug, Clone, PartialEq)]
pub struct DualLoops {
    /// The closed paths, then the arcs.
    loops: Vec<Vec<HalfedgeId>>,
    n_closed: usize,
    /// Per edge, the number of times that paths cross it.
    crossings: PerEdge<u32>,
}
stored!(sections DualLoops { loops, n_closed, crossings });

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
        let loops = DualLoops::between(mesh, &Sectors::new(mesh, &[])?, root);
        if loops.len() as i64 != 2 - mesh.euler() {
            return Err(Error::connectivity("path", loops.len(), "the surface has several components"));
        }
        Ok(loops)
    }

    /// Paths that cross no feature and no boundary: for each piece of the surface two closed ones to a handle, and an arc from one of the
    /// walks around it to each of the others. `root`: the vertex at which the tree of edges begins.
    ///
    /// # Errors
    /// [`Error::Argument`] for an edge that the mesh does not have.
    pub fn along_features(mesh: &Mesh, features: &[EdgeId], root: VertexId) -> Result<DualLoops> {
        Ok(DualLoops::between(mesh, &Sectors::new(mesh, features)?, root))
    }

    /// [`DualLoops::along_features`] between the features of these sectors.
    pub(super) fn between(mesh: &Mesh, sectors: &Sectors, root: VertexId) -> DualLoops {
        let walks = sectors.walks(mesh);
        let in_tree = edge_tree(mesh, sectors, &walks, root);
        let (entry, crossed) = face_tree(mesh, sectors, &in_tree);
        let left = mesh.edges().filter(|&e| !in_tree[e] && !crossed[e] && !sectors.is_feature(e));
        let mut loops: Vec<_> = left.map(|e| closed_path(mesh, &entry, e.halfedge())).collect();
        let n_closed = loops.len();
        let corners = sectors.of_corners(mesh);
        let mut first: Vec<Option<HalfedgeId>> = vec![None; sectors.n_pieces];
        for walk in &walks {
            let piece = sectors.piece[corners[walk[0]] as usize] as usize;
            match first[piece] {
                None => first[piece] = Some(walk[0]),
                Some(from) => loops.push(arc(mesh, &entry, from, walk[0])),
            }
        }
        let mut crossings = PerEdge::filled(mesh.n_edges(), 0);
        loops.iter().flatten().for_each(|h| crossings[h.edge()] += 1);
        DualLoops { loops, n_closed, crossings }
    }

    /// The number of paths.
    pub fn len(&self) -> usize {
        self.loops.len()
    }

    /// True if there is no path, as on a sphere.
    pub fn is_empty(&self) -> bool {
        self.loops.is_empty()
    }

    /// The number of closed paths, which come first.
    pub fn n_closed(&self) -> usize {
        self.n_closed
    }

    /// The half-edges that path k crosses, in order.
    pub fn path(&self, k: usize) -> &[HalfedgeId] {
        &self.loops[k]
    }

    /// The passages of path k through faces.
    pub(super) fn passages(&self, k: usize) -> impl Iterator<Item = Passage> + '_ {
        let path = &self.loops[k];
        let before = path.iter().cycle().skip(path.len().saturating_sub(1));
        let all = path.iter().zip(before).map(|(&exit, before)| Passage { entry: before.twin(), exit });
        // An arc comes into its first face from outside.
        all.skip(usize::from(k >= self.n_closed))
    }

    /// The turning of each path, radians: angles to its left less angles to its right; of an arc, from the normal of its first edge to that
    /// of its last. `angles`: that at the origin of each half-edge, in its face.
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
        for (number, path) in self.loops.iter_mut().enumerate() {
            if !path.iter().any(|x| near.contains(&x.edge())) {
                continue;
            }
            self.crossings[edge] -= path.iter().filter(|x| x.edge() == edge).count() as u32;
            path.retain(|x| x.edge() != edge);
            let mut carried = Vec::with_capacity(path.len() + 2);
            for (k, &exit) in path.iter().enumerate() {
                let entry = path[(k + path.len() - 1) % path.len()].twin();
                // The first half-edge of an arc has no entry before it.
                let goes_on = k > 0 || number < self.n_closed;
                if goes_on && first(entry) && second(exit) {
                    carried.push(h);
                } else if goes_on && second(entry) && first(exit) {
                    carried.push(h.twin());
                }
                carried.push(exit);
            }
            self.crossings[edge] += carried.iter().filter(|x| x.edge() == edge).count() as u32;
            *path = carried;
        }
    }
}

/// Per edge, true if it is in a tree of shortest edge paths that spans the vertices of each piece, all those on one walk along features as
/// one. The first tree begins at a vertex.
fn edge_tree(mesh: &Mesh, sectors: &Sectors, walks: &[Vec<HalfedgeId>], root: VertexId) -> PerEdge<bool> {
    let corners = sectors.of_corners(mesh);
    // A sector between features stands for the walk that passes it.
    let mut node: Vec<usize> = (0..sectors.len()).collect();
    for (k, walk) in walks.iter().enumerate() {
        walk.iter().for_each(|&h| node[corners[h] as usize] = sectors.len() + k);
    }
    let at = |h: HalfedgeId| node[corners[h] as usize];
    let mut leaving: Vec<Vec<HalfedgeId>> = vec![Vec::new(); sectors.len() + walks.len()];
    for v in mesh.vertices() {
        mesh.outgoing(v).filter(|h| !sectors.is_feature(h.edge())).for_each(|h| leaving[at(h)].push(h));
    }
    let mut in_tree = PerEdge::filled(mesh.n_edges(), false);
    let mut is_reached = vec![false; leaving.len()];
    let roots = mesh.outgoing(root).filter(|&h| mesh.face(h).is_some()).map(at);
    for first in roots.chain(node.iter().copied()) {
        if std::mem::replace(&mut is_reached[first], true) {
            continue;
        }
        let mut waiting = VecDeque::from([first]);
        while let Some(v) = waiting.pop_front() {
            for h in &leaving[v] {
                let tip = at(mesh.next(*h));
                if !is_reached[tip] {
                    is_reached[tip] = true;
                    in_tree[h.edge()] = true;
                    waiting.push_back(tip);
                }
            }
        }
    }
    in_tree
}

/// A tree of the faces of each piece, which are joined across edges outside `in_tree` and no features: per face the half-edge of its parent
/// that leads to it (none for the root), and per edge true if the tree crosses it.
fn face_tree(
    mesh: &Mesh,
    sectors: &Sectors,
    in_tree: &PerEdge<bool>,
) -> (PerFace<Option<HalfedgeId>>, PerEdge<bool>) {
    let mut entry = PerFace::filled(mesh.n_faces(), None);
    let mut crossed = PerEdge::filled(mesh.n_edges(), false);
    let mut is_reached = PerFace::filled(mesh.n_faces(), false);
    for root in mesh.faces() {
        if std::mem::replace(&mut is_reached[root], true) {
            continue;
        }
        let mut waiting = VecDeque::from([root]);
        while let Some(f) = waiting.pop_front() {
            for h in mesh.face_halfedges(f) {
                let Some(g) = mesh.face(h.twin()) else { continue };
                if !in_tree[h.edge()] && !sectors.is_feature(h.edge()) && !is_reached[g] {
                    is_reached[g] = true;
                    entry[g] = Some(h);
                    crossed[h.edge()] = true;
                    waiting.push_back(g);
                }
            }
        }
    }
    (entry, crossed)
}

/// The half-edges by which the tree of faces leads from its root to the face of h.
fn from_root(mesh: &Mesh, entry: &PerFace<Option<HalfedgeId>>, h: HalfedgeId) -> Vec<HalfedgeId> {
    let mut path = Vec::new();
    let mut next = mesh.face(h).and_then(|f| entry[f]);
    while let Some(x) = next {
        path.push(x);
        next = mesh.face(x).and_then(|f| entry[f]);
    }
    path.reverse();
    path
}

/// The arc in the tree of faces that comes in over one feature and leaves over another, each given as the half-edge in the piece.
fn arc(
    mesh: &Mesh,
    entry: &PerFace<Option<HalfedgeId>>,
    from: HalfedgeId,
    to: HalfedgeId,
) -> Vec<HalfedgeId> {
    let (back, on) = (from_root(mesh, entry, from), from_root(mesh, entry, to));
    let common = back.iter().zip(&on).take_while(|(a, b)| a == b).count();
    let away = back[common..].iter().rev().map(|x| x.twin());
    [from.twin()].into_iter().chain(away).chain(on[common..].iter().copied()).chain([to]).collect()
}

/// The closed path that crosses h and is closed in the tree of faces, without the part that it would go there and back.
fn closed_path(mesh: &Mesh, entry: &PerFace<Option<HalfedgeId>>, h: HalfedgeId) -> Vec<HalfedgeId> {
    let from_root = |h| from_root(mesh, entry, h);
    let (to, back) = (from_root(h), from_root(h.twin()));
    let common = to.iter().zip(&back).take_while(|(a, b)| a == b).count();
    let home = back[common..].iter().rev().map(|x| x.twin());
    to[common..].iter().copied().chain([h]).chain(home).collect()
}
