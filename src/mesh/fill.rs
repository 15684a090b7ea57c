//! Surfaces whose boundary loops are filled, each by one new vertex.
//!
//! ```
//! use ricci::mesh::{FilledMesh, Mesh, shapes};
//! let disk = Mesh::from_soup(&shapes::disk(2)?)?;
//! let filled = FilledMesh::new(&disk)?;
//! assert_eq!((filled.mesh.is_closed(), filled.mesh.genus(), filled.hubs().len()), (true, 0, 1));
//! # Ok::<(), ricci::Error>(())
//! ```

use super::halfedge::Mesh;
use super::ids::{EdgeId, FaceId, HalfedgeId, VertexId};
use crate::archive::stored;
use crate::error::{Error, Result};

/// A closed surface made from an open one by adding a *hub* for each boundary loop, a vertex joined to all vertices of the loop.
///
/// Vertices 0 … V − 1, edges 0 … E − 1 and faces 0 … F − 1 are those of the open surface; they are followed by the hubs, and the edges
/// and faces at them, in the order of [`Mesh::boundary_loops`].
#[derive(Debug, Clone, PartialEq)]
pub struct FilledMesh {
    /// The closed surface.
    pub mesh: Mesh,
    /// The loops of the open surface from [`Mesh::boundary_loops`]; their half-edges now belong to faces at the hubs.
    pub loops: Vec<Vec<HalfedgeId>>,
    n_vertices: usize,
    n_faces: usize,
}
stored!(sections FilledMesh { mesh, loops, n_vertices, n_faces });

impl FilledMesh {
    /// Fills every boundary loop.
    ///
    /// # Errors
    /// [`Error::Argument`] for a closed surface; [`Error::TooLarge`].
    pub fn new(open: &Mesh) -> Result<FilledMesh> {
        let loops = open.boundary_loops();
        if loops.is_empty() {
            return Err(Error::argument("surface", "closed", "one with boundary: there is no loop to fill"));
        }
        let n_spokes: usize = loops.iter().map(Vec::len).sum();
        let n_halfedges = open.n_halfedges() + 2 * n_spokes;
        if u32::try_from(n_halfedges).is_err() {
            return Err(Error::TooLarge { what: "half-edges of the filled surface", count: n_halfedges });
        }
        let mut origin: Vec<u32> = open.halfedges().map(|h| open.origin(h).0).collect();
        let mut sides: Vec<[u32; 3]> = open.faces().map(|f| open.face_halfedges(f).map(|h| h.0)).collect();
        for (k, rim) in loops.iter().enumerate() {
            let (hub, first) = ((open.n_vertices() + k) as u32, origin.len() as u32);
            // Half-edge 2s of the spoke of the rim's half-edge h runs from the origin of h to the hub.
            for (i, &h) in rim.iter().enumerate() {
                let [own, next] = [i, (i + 1) % rim.len()].map(|i| first + 2 * i as u32);
                origin.extend([open.origin(h).0, hub]);
                sides.push([h.0, next, own ^ 1]);
            }
        }
        let mesh = Mesh::assemble(open.n_vertices() + loops.len(), origin, &sides)?;
        Ok(FilledMesh { mesh, loops, n_vertices: open.n_vertices(), n_faces: open.n_faces() })
    }

    /// The hubs, one per loop.
    pub fn hubs(&self) -> Vec<VertexId> {
        (0..self.loops.len()).map(|k| self.hub(k)).collect()
    }

    /// The hub of loop `k`.
    pub fn hub(&self, k: usize) -> VertexId {
        VertexId::from(self.n_vertices + k)
    }

    /// The loop of a hub; `None` for a vertex of the open surface.
    pub fn loop_of(&self, v: VertexId) -> Option<usize> {
        v.index().checked_sub(self.n_vertices)
    }

    /// True for faces of the open surface.
    pub fn is_original(&self, f: FaceId) -> bool {
        f.index() < self.n_faces
    }

    /// The edges of the loops and those at the hubs.
    pub fn rims(&self) -> Vec<EdgeId> {
        let loops = self.loops.iter().flatten().flat_map(|&h| [h.edge(), self.mesh.next(h).edge()]);
        loops.collect()
    }
}
