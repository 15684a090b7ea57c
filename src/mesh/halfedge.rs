//! Connectivity of an oriented triangulated surface as a half-edge Δ-complex.
//!
//! ```text
//!            c                 h = a→b of face (a, b, c); next(h) = b→c; prev(h) = c→a
//!           / \                twin(h) = h ^ 1 = b→a, in the neighbouring face or outside
//!     prev /   \ next          edge(h) = h >> 1
//!         /  f  \              corner of h: the corner of f at the origin of h
//!        a ----- b
//!            h
//! ```
//!
//! Two vertices may share several edges, an edge may be a loop, a face may touch itself: edges are never looked up by their end vertices.
//! Half-edges outside the surface have no face and are linked by `next` to boundary loops (which run with the surface on their right).
//!
//! ```
//! use ricci::mesh::{Mesh, VertexId};
//! let mesh = Mesh::from_faces(3, &[[0, 1, 2]])?;
//! let inside = mesh.halfedges().find(|&h| !mesh.is_outside(h) && mesh.origin(h) == VertexId(1)).unwrap();
//! assert_eq!(mesh.tip(inside), VertexId(2));
//! assert!(mesh.is_outside(inside.twin()) && mesh.boundary_loops().len() == 1);
//! # Ok::<(), ricci::Error>(())
//! ```

use super::ids::{EdgeId, FaceId, HalfedgeId, VertexId};
use crate::archive::stored;
use crate::error::{Error, Result};
use crate::parallel;

/// The face of half-edges outside the surface; also marks entries of arrays that are not filled yet.
const OUTSIDE: u32 = u32::MAX;

/// Connectivity of a triangulated surface, without positions and lengths.
#[derive(Debug, PartialEq, Eq)]
pub struct Mesh {
    /// For each half-edge the next one around its face or boundary loop.
    next: Vec<u32>,
    /// For each half-edge the vertex at which it starts.
    origin: Vec<u32>,
    /// For each half-edge its face, or `OUTSIDE`.
    face: Vec<u32>,
    /// For each vertex an outgoing half-edge; on the boundary the one outside the surface.
    out: Vec<u32>,
    /// For each face the half-edge of its first corner.
    first: Vec<u32>,
}
stored!(sections Mesh { next, origin, face, out, first } check Mesh::validate);

/// Runs in parallel inside a pool: most of the time is spent on memory that is touched for the first time.
impl Clone for Mesh {
    fn clone(&self) -> Mesh {
        let around_faces = || (self.next.clone(), self.out.clone(), self.first.clone());
        let ((next, out, first), (origin, face)) =
            parallel::join(around_faces, || (self.origin.clone(), self.face.clone()));
        Mesh { next, origin, face, out, first }
    }
}

impl Mesh {
    /// Assembles a mesh from three half-edges per face (in corner order) and the origin of every half-edge.
    ///
    /// `sides[f]` are the half-edges of face f in order, `n_edges` edges own the half-edges `2e`, `2e + 1`, and `origin[h]` is a vertex
    /// below `n_vertices` for all `2·n_edges` half-edges. Half-edges without a face become boundary. The callers (`build`) have diagnosed
    /// their input; a rule that is still broken is an [`Error::Connectivity`].
    pub(crate) fn assemble(n_vertices: usize, origin: Vec<u32>, sides: &[[u32; 3]]) -> Result<Mesh> {
        let n = origin.len();
        let (mut next, mut face) = (vec![OUTSIDE; n], vec![OUTSIDE; n]);
        for (f, s) in sides.iter().enumerate() {
            for k in 0..3 {
                if face[s[k] as usize] != OUTSIDE {
                    return Err(broken("half-edge", s[k] as usize, "is used by two faces"));
                }
                face[s[k] as usize] = f as u32;
                next[s[k] as usize] = s[(k + 1) % 3];
            }
        }
        // A boundary half-edge h is followed by the outside half-edge that leaves its tip, which is found by turning around the tip
        // through its faces.
        for h in (0..n).filter(|&h| face[h] == OUTSIDE) {
            let mut around = h ^ 1;
            while face[around] != OUTSIDE {
                let prev = next[next[around] as usize] as usize;
                around = prev ^ 1;
            }
            next[h] = around as u32;
        }
        let mut out = vec![OUTSIDE; n_vertices];
        for h in 0..n {
            let v = origin[h] as usize;
            if out[v] == OUTSIDE || face[h] == OUTSIDE {
                out[v] = h as u32;
            }
        }
        let first = sides.iter().map(|s| s[0]).collect();
        let mesh = Mesh { next, origin, face, out, first };
        mesh.validate()?;
        Ok(mesh)
    }

    /// Number of vertices V.
    pub fn n_vertices(&self) -> usize {
        self.out.len()
    }
    /// Number of edges E.
    pub fn n_edges(&self) -> usize {
        self.next.len() / 2
    }
    /// Number of half-edges, 2E.
    pub fn n_halfedges(&self) -> usize {
        self.next.len()
    }
    /// Number of faces F.
    pub fn n_faces(&self) -> usize {
        self.first.len()
    }

    /// All vertices.
    pub fn vertices(&self) -> impl ExactSizeIterator<Item = VertexId> + use<> {
        (0..self.n_vertices()).map(VertexId::from)
    }
    /// All edges.
    pub fn edges(&self) -> impl ExactSizeIterator<Item = EdgeId> + use<> {
        (0..self.n_edges()).map(EdgeId::from)
    }
    /// All half-edges.
    pub fn halfedges(&self) -> impl ExactSizeIterator<Item = HalfedgeId> + use<> {
        (0..self.n_halfedges()).map(HalfedgeId::from)
    }
    /// All faces.
    pub fn faces(&self) -> impl ExactSizeIterator<Item = FaceId> + use<> {
        (0..self.n_faces()).map(FaceId::from)
    }

    /// The next half-edge around the face or boundary loop.
    #[inline]
    pub fn next(&self, h: HalfedgeId) -> HalfedgeId {
        HalfedgeId(self.next[h.index()])
    }
    /// The previous half-edge around the face (`h` must be inside the surface).
    #[inline]
    pub fn prev(&self, h: HalfedgeId) -> HalfedgeId {
        self.next(self.next(h))
    }
    /// The vertex at which it starts.
    #[inline]
    pub fn origin(&self, h: HalfedgeId) -> VertexId {
        VertexId(self.origin[h.index()])
    }
    /// The vertex at which it ends.
    #[inline]
    pub fn tip(&self, h: HalfedgeId) -> VertexId {
        self.origin(h.twin())
    }
    /// The face on its left, `None` outside the surface.
    #[inline]
    pub fn face(&self, h: HalfedgeId) -> Option<FaceId> {
        let f = self.face[h.index()];
        (f != OUTSIDE).then_some(FaceId(f))
    }
    /// The half-edge of the face's first corner.
    #[inline]
    pub fn face_halfedge(&self, f: FaceId) -> HalfedgeId {
        HalfedgeId(self.first[f.index()])
    }
    /// The face's half-edges in corner order: `h[k]` starts at corner k, `h[(k + 1) % 3]` is opposite corner k.
    #[inline]
    pub fn face_halfedges(&self, f: FaceId) -> [HalfedgeId; 3] {
        let h = self.face_halfedge(f);
        [h, self.next(h), self.prev(h)]
    }
    /// The face of a half-edge, and the number of the face's corner at its origin; `None` outside the surface.
    #[inline]
    pub fn corner(&self, h: HalfedgeId) -> Option<(FaceId, usize)> {
        let f = self.face(h)?;
        let corner = self.face_halfedges(f).iter().position(|&side| side == h)?;
        Some((f, corner))
    }
    /// The face's vertices in corner order.
    #[inline]
    pub fn face_vertices(&self, f: FaceId) -> [VertexId; 3] {
        self.face_halfedges(f).map(|h| self.origin(h))
    }
    /// The vertices of every face in corner order, which is the mesh as a triangle list.
    pub fn triangles(&self) -> Vec<[u32; 3]> {
        self.faces().map(|f| self.face_vertices(f).map(|v| v.0)).collect()
    }
    /// The edges opposite the face's corners: `[bc, ca, ab]` for the face `(a, b, c)`.
    #[inline]
    pub fn opposite_edges(&self, f: FaceId) -> [EdgeId; 3] {
        let [ab, bc, ca] = self.face_halfedges(f).map(HalfedgeId::edge);
        [bc, ca, ab]
    }
    /// The two ends of an edge, in the direction of its half-edge `2e`.
    #[inline]
    pub fn ends(&self, e: EdgeId) -> [VertexId; 2] {
        [self.origin(e.halfedge()), self.tip(e.halfedge())]
    }
    /// An outgoing half-edge; the one outside the surface if `v` is on the boundary.
    #[inline]
    pub fn out(&self, v: VertexId) -> HalfedgeId {
        HalfedgeId(self.out[v.index()])
    }
    /// The outgoing half-edges, clockwise from [`Mesh::out`]; each once (a loop edge appears with both halves).
    pub fn outgoing(&self, v: VertexId) -> impl Iterator<Item = HalfedgeId> + '_ {
        let start = self.out(v);
        let turn = move |&h: &HalfedgeId| Some(self.next(h.twin())).filter(|&n| n != start);
        std::iter::successors(Some(start), turn)
    }

    /// The outgoing half-edges that have a face, counterclockwise; at a boundary vertex from one boundary edge on, without the other.
    pub fn fan(&self, v: VertexId) -> Vec<HalfedgeId> {
        let mut fan: Vec<HalfedgeId> = self.outgoing(v).filter(|&h| !self.is_outside(h)).collect();
        fan.reverse();
        fan
    }

    /// True if the half-edge lies outside the surface.
    #[inline]
    pub fn is_outside(&self, h: HalfedgeId) -> bool {
        self.face[h.index()] == OUTSIDE
    }
    /// True if the edge has a face on one side only.
    #[inline]
    pub fn is_boundary_edge(&self, e: EdgeId) -> bool {
        self.is_outside(e.halfedge()) || self.is_outside(e.halfedge().twin())
    }
    /// True if the vertex lies on the boundary.
    #[inline]
    pub fn is_boundary_vertex(&self, v: VertexId) -> bool {
        self.is_outside(self.out(v))
    }
    /// True if the surface has no boundary.
    pub fn is_closed(&self) -> bool {
        !self.face.contains(&OUTSIDE)
    }

    /// The boundary loops, each as its outside half-edges in order.
    pub fn boundary_loops(&self) -> Vec<Vec<HalfedgeId>> {
        let mut seen = vec![false; self.n_halfedges()];
        let mut loops = Vec::new();
        for start in self.halfedges().filter(|&h| self.is_outside(h)) {
            let mut walk = Vec::new();
            let mut h = start;
            while !seen[h.index()] {
                seen[h.index()] = true;
                walk.push(h);
                h = self.next(h);
            }
            if !walk.is_empty() {
                loops.push(walk);
            }
        }
        loops
    }

    /// The boundary loop from a half-edge of a face on the boundary on: half-edges of faces, with the surface on their left.
    pub fn boundary_from(&self, h: HalfedgeId) -> Vec<HalfedgeId> {
        if !self.is_outside(h.twin()) {
            return Vec::new();
        }
        // Half-edges outside the surface run backwards.
        let before = |at: &HalfedgeId| Some(self.next(*at)).filter(|&next| next != h.twin());
        let mut path: Vec<_> = std::iter::successors(Some(h.twin()), before).map(HalfedgeId::twin).collect();
        path[1..].reverse();
        path
    }

    /// Euler characteristic χ = V − E + F.
    pub fn euler(&self) -> i64 {
        self.n_vertices() as i64 - self.n_edges() as i64 + self.n_faces() as i64
    }
    /// Genus of a connected surface: (2 − χ − number of boundary loops) / 2.
    pub fn genus(&self) -> usize {
        ((2 - self.euler() - self.boundary_loops().len() as i64) / 2).max(0) as usize
    }

    /// Makes three half-edges, in this order, the sides of a face.
    pub(super) fn set_triangle(&mut self, f: FaceId, sides: [HalfedgeId; 3]) {
        for k in 0..3 {
            self.next[sides[k].index()] = sides[(k + 1) % 3].0;
            self.face[sides[k].index()] = f.0;
        }
        self.first[f.index()] = sides[0].0;
    }

    /// Sets the half-edge that follows a half-edge of a boundary loop.
    pub(super) fn set_next(&mut self, h: HalfedgeId, next: HalfedgeId) {
        self.next[h.index()] = next.0;
    }

    /// Sets the origin of a half-edge.
    pub(super) fn set_origin(&mut self, h: HalfedgeId, v: VertexId) {
        self.origin[h.index()] = v.0;
    }

    /// Sets the half-edge from which turning around a vertex starts.
    pub(super) fn set_out(&mut self, v: VertexId, h: HalfedgeId) {
        self.out[v.index()] = h.0;
    }

    /// Adds a vertex that nothing leads to yet.
    pub(super) fn add_vertex(&mut self) -> VertexId {
        self.out.push(OUTSIDE);
        VertexId::from(self.out.len() - 1)
    }

    /// Adds an edge that no face has yet; its half-edge 2e starts at `from`.
    pub(super) fn add_edge(&mut self, from: VertexId, to: VertexId) -> EdgeId {
        self.next.extend([OUTSIDE; 2]);
        self.face.extend([OUTSIDE; 2]);
        self.origin.extend([from.0, to.0]);
        EdgeId::from(self.n_edges() - 1)
    }

    /// Adds a face without sides.
    pub(super) fn add_face(&mut self) -> FaceId {
        self.first.push(OUTSIDE);
        FaceId::from(self.first.len() - 1)
    }

    /// Checks every rule of the structure. O(V + E + F).
    ///
    /// # Errors
    ///
    /// [`Error::Connectivity`] for the first rule that is broken.
    pub fn validate(&self) -> Result<()> {
        self.validate_halfedges()?;
        self.validate_faces()?;
        self.validate_vertices()
    }

    /// Checks array sizes, and the relations between a half-edge, its twin and the next one.
    fn validate_halfedges(&self) -> Result<()> {
        let n = self.n_halfedges();
        if !n.is_multiple_of(2) || self.origin.len() != n || self.face.len() != n {
            return Err(broken("mesh", 0, "half-edge arrays of different or odd size"));
        }
        let mut entered = vec![false; n];
        for h in 0..n {
            let (next, origin) = (self.next[h] as usize, self.origin[h] as usize);
            if next >= n || origin >= self.out.len() {
                return Err(broken("half-edge", h, "next or origin out of range"));
            }
            if std::mem::replace(&mut entered[next], true) {
                return Err(broken("half-edge", next, "follows two half-edges"));
            }
            if self.origin[next] != self.origin[h ^ 1] {
                return Err(broken("half-edge", h, "its tip is not where the next one starts"));
            }
            if self.face[next] != self.face[h] {
                return Err(broken("half-edge", h, "next lies in another face"));
            }
            if self.face[h] == OUTSIDE && self.face[h ^ 1] == OUTSIDE {
                return Err(broken("edge", h >> 1, "has no face on either side"));
            }
        }
        Ok(())
    }

    /// Checks that faces are triangles, and that all half-edges with a face are sides of it.
    fn validate_faces(&self) -> Result<()> {
        let n = self.n_halfedges();
        for (f, &h) in self.first.iter().enumerate() {
            let h = h as usize;
            if h >= n || self.face[h] as usize != f {
                return Err(broken("face", f, "its first half-edge belongs elsewhere"));
            }
            let third = self.next[self.next[h] as usize] as usize;
            if self.next[third] as usize != h || self.next[h] as usize == h {
                return Err(broken("face", f, "is not a triangle"));
            }
        }
        if self.face.iter().filter(|&&f| f != OUTSIDE).count() != 3 * self.n_faces() {
            return Err(broken("mesh", 0, "half-edges in faces are not three per face"));
        }
        Ok(())
    }

    /// Checks that turning around each vertex meets each half-edge once, and at most one boundary.
    fn validate_vertices(&self) -> Result<()> {
        let n = self.n_halfedges();
        let mut reached = 0;
        for v in self.vertices() {
            let out = self.out[v.index()] as usize;
            if out >= n || self.origin[out] as usize != v.index() {
                return Err(broken("vertex", v.index(), "its outgoing half-edge starts elsewhere"));
            }
            let mut outside = 0;
            for h in self.outgoing(v) {
                reached += 1;
                outside += usize::from(self.is_outside(h));
                if reached > n {
                    return Err(broken("vertex", v.index(), "turning around it does not end"));
                }
            }
            if outside > 1 || (outside == 1 && !self.is_outside(self.out(v))) {
                return Err(broken("vertex", v.index(), "boundary passes it twice or is not its first"));
            }
        }
        if reached != n {
            return Err(broken("mesh", 0, "turning around the vertices misses half-edges"));
        }
        Ok(())
    }
}

fn broken(element: &'static str, index: usize, message: &'static str) -> Error {
    Error::Connectivity { element, index, message }
}

#[cfg(test)]
#[path = "halfedge_tests.rs"]
mod tests;
