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

/// Most half-edges of a cap per edge of its loop.
const MOST_HALFEDGES: usize = 4;

/// What closes a boundary loop.
#[derive(Debug, Clone, PartialEq)]
pub enum Cap {
    /// Nothing: the loop stays open.
    Open,
    /// A hub, which is a new vertex joined to all vertices of the loop.
    Hub,
    /// A triangle on each edge of the loop, with a new vertex each: the loop moves outwards and stays open.
    Flaps,
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
    /// The edges of the loops that have caps.
    pub rims: Vec<EdgeId>,
    /// Per loop of [`Mesh::boundary_loops`] its hub, if it has one.
    pub hubs: Vec<Option<VertexId>>,
    /// Per loop the new vertices of its flaps, one above each of its half-edges; empty where it has none.
    pub flaps: Vec<Vec<VertexId>>,
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
        let mut flaps = vec![Vec::new(); loops.len()];
        for (k, (rim, cap)) in loops.iter().zip(caps).enumerate() {
            match cap {
                Cap::Open => continue,
                Cap::Hub => hubs[k] = Some(builder.add_hub(rim)),
                Cap::Flaps => flaps[k] = builder.add_flaps(rim),
                Cap::Triangles(triangles) => builder.add_triangles(rim, &triangles)?,
            }
            rims.extend(rim.iter().map(|h| h.edge()));
        }
        let mesh = Mesh::assemble(builder.n_vertices, builder.origin, &builder.sides)?;
        Ok(CappedMesh { mesh, rims, hubs, flaps })
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

    fn add_flaps(&mut self, rim: &[HalfedgeId]) -> Vec<VertexId> {
        let first = self.n_vertices;
        for h in rim {
            let (tip, base) = (self.n_vertices as u32, self.origin.len() as u32);
            self.n_vertices += 1;
            let [to, from] = [h.twin(), *h].map(|h| self.origin[h.index()]);
            self.origin.extend([to, tip, tip, from]);
            self.sides.push([h.0, base, base + 2]);
        }
        (first..self.n_vertices).map(VertexId::from).collect()
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
        let flaps = CappedMesh::new(&disk, vec![Cap::Flaps]).unwrap().mesh;
        assert_eq!((flaps.euler(), flaps.boundary_loops()[0].len()), (1, 2 * n));
        assert_eq!(flaps.n_faces(), disk.n_faces() + n);
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
