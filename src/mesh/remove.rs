//! Removal of vertices from a triangulation, one at a time, by replacing the triangles around each by fewer.
//!
//! ```
//! use ricci::mesh::{Mesh, Thinning, VertexId};
//! // A triangle with a vertex inside it.
//! let mut thinning = Thinning::new(Mesh::from_faces(4, &[[0, 1, 3], [1, 2, 3], [2, 0, 3]])?);
//! assert!(thinning.remove(VertexId(3)).is_some());
//! let left = thinning.finish()?;
//! assert_eq!((left.mesh.n_vertices(), left.mesh.n_faces()), (3, 1));
//! # Ok::<(), ricci::Error>(())
//! ```

use super::halfedge::Mesh;
use super::ids::{EdgeId, FaceId, HalfedgeId, VertexId};
use crate::error::Result;

/// A mesh from which vertices are removed. The other elements keep their numbers until [`Thinning::finish`].
#[derive(Debug, Clone)]
pub struct Thinning {
    mesh: Mesh,
    has_vertex: Vec<bool>,
    has_edge: Vec<bool>,
    has_face: Vec<bool>,
}

/// The mesh that is left, with the former numbers of its elements.
#[derive(Debug, Clone)]
pub struct Thinned {
    /// The connectivity, renumbered in the same order.
    pub mesh: Mesh,
    /// For each vertex its former number.
    pub vertices: Vec<VertexId>,
    /// For each edge its former number. Directions are the same.
    pub edges: Vec<EdgeId>,
    /// For each face its former number. First corners are the same.
    pub faces: Vec<FaceId>,
}

impl Thinning {
    /// A mesh with all of its vertices.
    pub fn new(mesh: Mesh) -> Thinning {
        Thinning {
            has_vertex: vec![true; mesh.n_vertices()],
            has_edge: vec![true; mesh.n_edges()],
            has_face: vec![true; mesh.n_faces()],
            mesh,
        }
    }

    /// The connectivity. Removed elements still have numbers, which must not be used.
    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// Flips an edge, see [`Mesh::flip`].
    pub fn flip(&mut self, e: EdgeId) -> bool {
        self.has_edge[e.index()] && self.mesh.flip(e)
    }

    /// True if a vertex has not been removed.
    pub fn has_vertex(&self, v: VertexId) -> bool {
        self.has_vertex[v.index()]
    }

    /// True if an edge has not been removed.
    pub fn has_edge(&self, e: EdgeId) -> bool {
        self.has_edge[e.index()]
    }

    /// Removes a vertex with three different faces around it, or with two on the boundary. Returns `None` and does nothing for other
    /// vertices.
    ///
    /// Face i of [`Mesh::fan`] is (v, p_i, p_(i+1)). The face that is left has the number of face 0 and the corners (p_0, p_1, p_2), on
    /// the boundary (p_2, p_0, p_1); the edge from v to p_0 becomes its side from p_2 to p_0:
    ///
    /// ```text
    ///           p2                    p2                  p1                  p1
    ///         / | \                 /    \              / | \              /    \
    ///       /   v   \      ⇒      /        \          /   |   \     ⇒    /        \
    ///     / ⟋     ⟍  \          /            \      /    |    \        /            \
    ///   p0 ─────────── p1      p0 ─────────── p1   p2 ─── v ─── p0    p2 ────────── p0
    /// ```
    pub fn remove(&mut self, v: VertexId) -> Option<FaceId> {
        let fan = self.mesh.fan(v);
        let is_loop = fan.iter().any(|&h| self.mesh.tip(h) == v);
        if !self.has_vertex(v) || is_loop {
            return None;
        }
        let faces: Vec<FaceId> = fan.iter().filter_map(|&h| self.mesh.face(h)).collect();
        match (self.mesh.is_boundary_vertex(v), &fan[..], &faces[..]) {
            (false, &[h0, h1, h2], &[f0, f1, f2]) if f0 != f1 && f1 != f2 && f2 != f0 => {
                let rim = [h0, h1, h2].map(|h| self.mesh.next(h));
                self.replace(v, &fan, &faces, rim);
            }
            (true, &[h0, h1], &[f0, f1]) if f0 != f1 => {
                let last = self.mesh.prev(h1);
                let beyond = self.mesh.next(last.twin());
                let rim = [h0, self.mesh.next(h0), self.mesh.next(h1)];
                self.replace(v, &[h1, last.twin()], &faces, rim);
                self.mesh.set_origin(h0, self.mesh.origin(last));
                self.mesh.set_next(h0.twin(), beyond);
            }
            _ => return None,
        }
        faces.first().copied()
    }

    /// Replaces faces around a vertex by the one with the sides `rim`, and removes the vertex and its edges `spokes`.
    fn replace(&mut self, v: VertexId, spokes: &[HalfedgeId], faces: &[FaceId], rim: [HalfedgeId; 3]) {
        for &spoke in spokes {
            let tip = self.mesh.tip(spoke);
            if self.mesh.out(tip) == spoke.twin()
                && let Some(&side) = rim.iter().find(|&&side| self.mesh.origin(side) == tip)
            {
                self.mesh.set_out(tip, side);
            }
            self.has_edge[spoke.edge().index()] = false;
        }
        self.mesh.set_triangle(faces[0], rim);
        faces[1..].iter().for_each(|f| self.has_face[f.index()] = false);
        self.has_vertex[v.index()] = false;
    }

    /// The rest as a mesh of its own.
    ///
    /// # Errors
    /// [`crate::Error::Connectivity`] where a rule of the structure is broken, which removals never do.
    pub fn finish(self) -> Result<Thinned> {
        let Thinning { mesh, has_vertex, has_edge, has_face } = self;
        let kept =
            |has: &[bool]| -> Vec<u32> { (0..has.len() as u32).filter(|&i| has[i as usize]).collect() };
        let [vertices, edges, faces] = [&has_vertex, &has_edge, &has_face].map(|has| kept(has));
        let numbers = |kept: &[u32], n: usize| -> Vec<u32> {
            let mut number = vec![u32::MAX; n];
            kept.iter().enumerate().for_each(|(new, &old)| number[old as usize] = new as u32);
            number
        };
        let (vertex, edge) = (numbers(&vertices, has_vertex.len()), numbers(&edges, has_edge.len()));
        let halfedges = edges.iter().flat_map(|&e| [EdgeId(e).halfedge(), EdgeId(e).halfedge().twin()]);
        let origin = halfedges.map(|h| vertex[mesh.origin(h).index()]).collect();
        let side = |h: HalfedgeId| 2 * edge[h.edge().index()] + (h.0 & 1);
        let sides: Vec<[u32; 3]> = faces.iter().map(|&f| mesh.face_halfedges(FaceId(f)).map(side)).collect();
        Ok(Thinned {
            mesh: Mesh::assemble(vertices.len(), origin, &sides)?,
            vertices: vertices.into_iter().map(VertexId).collect(),
            edges: edges.into_iter().map(EdgeId).collect(),
            faces: faces.into_iter().map(FaceId).collect(),
        })
    }
}
