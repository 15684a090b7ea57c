//! Surfaces of which some boundary loops are closed by caps of triangles, while others stay open.
//!
//! ```
//! use ricci::mesh::caps::{Cap, CappedMesh};
//! use ricci::mesh::{Mesh, shapes};
//! let annulus = Mesh::from_faces(6, &[[0, 1, 3], [1, 4, 3], [1, 2, 4], [2, 5, 4], [2, 0, 5], [0, 3, 5]])?;
//! let capped = CappedMesh::new(&annulus, vec![Cap::Open, Cap::Triangles(vec![[0, 1, 2]])])?;
//! assert_eq!((capped.mesh.euler(), capped.mesh.n_faces()), (1, 7));
//! # Ok::<(), ricci::Error>(())
//! ```

use super::halfedge::Mesh;
use super::ids::{EdgeId, HalfedgeId, VertexId};
use crate::error::{Error, Result};
use std::collections::BTreeMap;

/// Most half-edges of a cap per edge of its loop: those of a ring with its hub.
const MOST_HALFEDGES: usize = 8;

/// What closes a boundary loop.
#[derive(Debug, Clone, PartialEq)]
pub enum Cap {
    /// Nothing: the loop stays open.
    Open,
    /// A hub, which is a new vertex joined to all vertices of the loop.
    Hub,
    /// A ring of new vertices, one above each edge of the loop, and a hub inside the ring.
    Ring,
    /// Triangles between vertices of the loop, by the numbers of their places on it, counterclockwise as the loop runs: those of a polygon
    /// with n corners are n − 2.
    Triangles(Vec<[u32; 3]>),
}

/// A surface made from an open one by closing some of its loops.
///
/// Vertices, edges and faces of the open surface keep their numbers; hubs, and the edges and faces of caps, follow.
#[derive(Debug, Clone, PartialEq)]
pub struct CappedMesh {
    /// The surface with its caps.
    pub mesh: Mesh,
    /// The edges of the loops that were closed.
    pub rims: Vec<EdgeId>,
    /// Per loop of [`Mesh::boundary_loops`] its hub, if it has one.
    pub hubs: Vec<Option<VertexId>>,
    /// Per loop the vertices of its ring, one above each of its half-edges; empty where it has none.
    pub rings: Vec<Vec<VertexId>>,
}

/// A surface while caps are added.
struct CapBuilder {
    origin: Vec<u32>,
    sides: Vec<[u32; 3]>,
    n_vertices: usize,
}

impl CappedMesh {
    /// Closes the boundary loops, in the order of [`Mesh::boundary_loops`], by these caps.
    ///
    /// # Errors
    /// [`Error::Size`] unless there is a cap per loop; [`Error::Argument`] for triangles that do not fill their loop; [`Error::TooLarge`].
    pub fn new(open: &Mesh, caps: Vec<Cap>) -> Result<CappedMesh> {
        let loops = open.boundary_loops();
        crate::error::check_size("caps", caps.len(), loops.len())?;
        let n_halfedges = open.n_halfedges() + MOST_HALFEDGES * loops.iter().map(Vec::len).sum::<usize>();
        if u32::try_from(n_halfedges).is_err() {
            return Err(Error::TooLarge {
                what: "half-edges of the surface with its caps",
                count: n_halfedges,
            });
        }
        let mut builder = CapBuilder {
            origin: open.halfedges().map(|h| open.origin(h).0).collect(),
            sides: open.faces().map(|f| open.face_halfedges(f).map(|h| h.0)).collect(),
            n_vertices: open.n_vertices(),
        };
        let (mut rims, mut hubs) = (Vec::new(), vec![None; loops.len()]);
        let mut rings = vec![Vec::new(); loops.len()];
        for (k, (rim, cap)) in loops.iter().zip(caps).enumerate() {
            match cap {
                Cap::Open => continue,
                Cap::Hub => hubs[k] = Some(builder.add_hub(rim)),
                Cap::Ring => {
                    let inside;
                    (rings[k], inside) = builder.add_ring(rim);
                    hubs[k] = Some(builder.add_hub(&inside));
                }
                Cap::Triangles(triangles) => builder.add_triangles(rim, &triangles)?,
            }
            rims.extend(rim.iter().map(|h| h.edge()));
        }
        let mesh = Mesh::assemble(builder.n_vertices, builder.origin, &builder.sides)?;
        Ok(CappedMesh { mesh, rims, hubs, rings })
    }
}

impl CapBuilder {
    fn add_hub(&mut self, rim: &[HalfedgeId]) -> VertexId {
        let (hub, first) = (self.n_vertices as u32, self.origin.len() as u32);
        self.n_vertices += 1;
        // Half-edge 2s of the spoke of the rim's half-edge h runs from the origin of h to the hub.
        for (i, h) in rim.iter().enumerate() {
            let [own, next] = [i, (i + 1) % rim.len()].map(|i| first + 2 * i as u32);
            self.origin.extend([self.origin[h.index()], hub]);
            self.sides.push([h.0, next, own ^ 1]);
        }
        VertexId(hub)
    }

    /// Adds a ring of vertices, and returns them with the half-edges inside the ring, which follow each other as those of the rim do.
    fn add_ring(&mut self, rim: &[HalfedgeId]) -> (Vec<VertexId>, Vec<HalfedgeId>) {
        let (n, first, base) = (rim.len(), self.n_vertices as u32, self.origin.len() as u32);
        self.n_vertices += n;
        let vertex = |i: usize| first + (i % n) as u32;
        // Of the half-edges of place i, base + 6 i + 0 runs from the tip of the rim's half-edge to the vertex above it, + 2 from there to
        // its origin, + 4 from that vertex to the next one.
        let half = |i: usize, k: u32| base + 6 * (i % n) as u32 + k;
        for (i, h) in rim.iter().enumerate() {
            let [from, to] = [h, &rim[(i + 1) % n]].map(|h| self.origin[h.index()]);
            self.origin.extend([to, vertex(i), vertex(i), from, vertex(i), vertex(i + 1)]);
        }
        for (i, h) in rim.iter().enumerate() {
            self.sides.push([h.0, half(i, 0), half(i, 2)]);
            // Tip of the rim's half-edge, the next vertex of the ring, this one.
            self.sides.push([half(i + 1, 3), half(i, 5), half(i, 1)]);
        }
        ((0..n).map(|i| VertexId(vertex(i))).collect(), (0..n).map(|i| HalfedgeId(half(i, 4))).collect())
    }

    fn add_triangles(&mut self, rim: &[HalfedgeId], triangles: &[[u32; 3]]) -> Result<()> {
        let n = rim.len() as u32;
        let wrong = |at: usize| {
            Error::argument("cap", format!("triangle {at}"), "triangles that fill the polygon of their loop")
        };
        if triangles.len() + 2 != rim.len() {
            return Err(wrong(triangles.len()));
        }
        let mut between: BTreeMap<[u32; 2], u32> =
            (0..n).map(|i| ([i, (i + 1) % n], rim[i as usize].0)).collect();
        for (at, t) in triangles.iter().enumerate() {
            let mut side = [0; 3];
            for k in 0..3 {
                let [a, b] = [t[k], t[(k + 1) % 3]];
                if a >= n || b >= n {
                    return Err(wrong(at));
                }
                // A half-edge that is used is taken out, so that no other triangle finds it.
                side[k] = match between.remove(&[a, b]) {
                    Some(h) => h,
                    None => {
                        let h = self.origin.len() as u32;
                        self.origin.extend([a, b].map(|i| self.origin[rim[i as usize].index()]));
                        between.insert([b, a], h + 1);
                        h
                    }
                };
            }
            self.sides.push(side);
        }
        if between.is_empty() { Ok(()) } else { Err(wrong(triangles.len())) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::shapes;

    #[test]
    fn a_loop_is_closed_by_a_hub_or_by_triangles() {
        let disk = Mesh::from_soup(&shapes::disk(2).unwrap()).unwrap();
        let n = disk.boundary_loops()[0].len();
        let hub = CappedMesh::new(&disk, vec![Cap::Hub]).unwrap();
        assert!(hub.mesh.is_closed() && hub.mesh.genus() == 0 && hub.rims.len() == n);
        assert_eq!(hub.hubs, [Some(VertexId::from(disk.n_vertices()))]);
        let ring = CappedMesh::new(&disk, vec![Cap::Ring]).unwrap();
        assert!(ring.mesh.is_closed() && ring.mesh.genus() == 0 && ring.rings[0].len() == n);
        assert_eq!(ring.mesh.n_vertices(), disk.n_vertices() + n + 1);
        assert_eq!(ring.mesh.n_edges(), disk.n_edges() + 4 * n);
        let fan: Vec<[u32; 3]> = (1..n as u32 - 1).map(|i| [0, i, i + 1]).collect();
        let fan = CappedMesh::new(&disk, vec![Cap::Triangles(fan)]).unwrap();
        assert!(fan.mesh.is_closed() && fan.mesh.genus() == 0 && fan.hubs == [None]);
        assert_eq!(fan.mesh.n_edges(), disk.n_edges() + n - 3);
    }

    #[test]
    fn triangles_that_do_not_fill_their_loop_are_refused() {
        let disk = Mesh::from_soup(&shapes::disk(2).unwrap()).unwrap();
        let n = disk.boundary_loops()[0].len() as u32;
        let mut fan: Vec<[u32; 3]> = (1..n - 1).map(|i| [0, i, i + 1]).collect();
        assert!(CappedMesh::new(&disk, vec![Cap::Triangles(fan[1..].to_vec())]).is_err());
        fan[0] = [0, 2, 1];
        assert!(CappedMesh::new(&disk, vec![Cap::Triangles(fan.clone())]).is_err());
        fan[0] = [0, n, 1];
        assert!(CappedMesh::new(&disk, vec![Cap::Triangles(fan)]).is_err());
        assert!(CappedMesh::new(&disk, Vec::new()).is_err());
    }
}
