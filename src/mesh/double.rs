//! The double of a surface with boundary: two copies of it, glued along the boundary.
//!
//! ```
//! use ricci::mesh::{Double, Mesh, shapes};
//! let disk = Mesh::from_soup(&shapes::disk(2)?)?;
//! let sphere = Double::new(&disk)?.mesh;
//! assert_eq!((sphere.is_closed(), sphere.genus()), (true, 0));
//! # Ok::<(), ricci::Error>(())
//! ```

use super::flip::marked;
use super::halfedge::Mesh;
use super::ids::{EdgeId, FaceId, HalfedgeId, VertexId};
use crate::archive::{in_range, invalid, stored};
use crate::error::{Error, Result, check_size};

/// Two copies of a surface, the second mirrored, glued along the boundary: a closed surface with a mirror symmetry.
///
/// Vertices 0 … V − 1, edges 0 … E − 1 and faces 0 … F − 1 are those of the surface; they are followed by the mirror images of the
/// interior vertices, of the interior edges and of the faces, in the same order.
#[derive(Debug, Clone, PartialEq)]
pub struct Double {
    /// The closed surface.
    pub mesh: Mesh,
    /// The numbers of vertices, edges and faces of the surface that was doubled.
    counts: [usize; 3],
    /// For each vertex of the double its mirror image, which is the vertex itself on the boundary of the surface.
    mirror: Vec<u32>,
    /// For each edge of the double the edge of the surface that it is or mirrors.
    edge_origin: Vec<u32>,
}
stored!(sections Double { mesh, counts, mirror, edge_origin } check Double::check_parts);

impl Double {
    /// Checks that the arrays of an archive fit each other.
    fn check_parts(&self) -> Result<()> {
        check_size("mirror images", self.mirror.len(), self.mesh.n_vertices())?;
        check_size("edges of halves", self.edge_origin.len(), self.mesh.n_edges())?;
        let counts = [self.mesh.n_vertices(), self.mesh.n_edges(), self.mesh.n_faces()];
        if (0..3).any(|k| self.counts[k] > counts[k]) {
            return Err(invalid("half of a double", "a part of it"));
        }
        in_range("mirror image", self.mirror.iter().map(|&v| v as usize), self.mesh.n_vertices())?;
        in_range("edge of a half", self.edge_origin.iter().map(|&e| e as usize), self.counts[1])
    }

    /// The double of a surface.
    ///
    /// # Errors
    /// [`Error::Argument`] for a closed surface; [`Error::TooLarge`].
    pub fn new(half: &Mesh) -> Result<Double> {
        if half.is_closed() {
            return Err(Error::argument("surface", "closed", "one with boundary: there is nothing to glue"));
        }
        let (n, e, f) = (half.n_vertices(), half.n_edges(), half.n_faces());
        let interior: Vec<EdgeId> = half.edges().filter(|&e| !half.is_boundary_edge(e)).collect();
        let n_halfedges = 2 * (e + interior.len());
        if u32::try_from(n_halfedges).is_err() {
            return Err(Error::TooLarge { what: "half-edges of the double", count: n_halfedges });
        }
        let mut mirror: Vec<u32> = (0..n as u32).collect();
        for v in half.vertices().filter(|&v| !half.is_boundary_vertex(v)) {
            mirror[v.index()] = mirror.len() as u32;
            mirror.push(v.0);
        }
        let mut image: Vec<u32> = (0..e as u32).collect();
        let mut edge_origin = image.clone();
        for (k, edge) in interior.iter().enumerate() {
            image[edge.index()] = (e + k) as u32;
            edge_origin.push(edge.0);
        }
        // The mirror image of a half-edge runs the same way, with the mirrored face on its right: its twin is a side of that face. A
        // boundary edge is its own image.
        let turned = |h: HalfedgeId| 2 * image[h.edge().index()] + (h.0 & 1 ^ 1);
        let mut origin = vec![0; n_halfedges];
        for h in half.halfedges() {
            origin[h.index()] = half.origin(h).0;
            origin[turned(h) as usize] = mirror[half.tip(h).index()];
        }
        let mut sides: Vec<[u32; 3]> = half.faces().map(|f| half.face_halfedges(f).map(|h| h.0)).collect();
        for f in half.faces() {
            let [ab, bc, ca] = half.face_halfedges(f).map(turned);
            sides.push([ca, bc, ab]);
        }
        let mesh = Mesh::assemble(mirror.len(), origin, &sides)?;
        Ok(Double { mesh, counts: [n, e, f], mirror, edge_origin })
    }

    /// The mirror image of a vertex, which is the vertex itself on the boundary of the surface.
    pub fn mirror(&self, v: VertexId) -> VertexId {
        VertexId(self.mirror[v.index()])
    }

    /// Number of vertices of the surface.
    pub fn n_half_vertices(&self) -> usize {
        self.counts[0]
    }

    /// True for faces of the double, before any flip, that belong to the surface itself.
    pub fn is_original(&self, f: FaceId) -> bool {
        f.index() < self.counts[2]
    }

    /// For each edge of the double, before any flip, the value of the edge that it is or mirrors.
    ///
    /// # Errors
    /// [`Error::Size`] unless there is one value per edge of the surface.
    pub fn spread_edges<T: Copy>(&self, values: &[T]) -> Result<Vec<T>> {
        check_size("values of the edges", values.len(), self.counts[1])?;
        Ok(self.edge_origin.iter().map(|&e| values[e as usize]).collect())
    }

    /// The given edges of the surface and their mirror images, ascending.
    ///
    /// # Errors
    /// [`Error::Argument`] for an edge that the surface does not have.
    pub fn with_images(&self, edges: &[EdgeId]) -> Result<Vec<EdgeId>> {
        let chosen = marked("edge of the surface that was doubled", self.counts[1], edges)?;
        let all = (0..self.edge_origin.len()).filter(|&e| chosen[self.edge_origin[e] as usize]);
        Ok(all.map(EdgeId::from).collect())
    }

    /// For each vertex of the double the value of the vertex that it is or mirrors.
    ///
    /// # Errors
    /// [`Error::Size`] unless there is one value per vertex of the surface.
    pub fn spread_vertices<T: Copy>(&self, values: &[T]) -> Result<Vec<T>> {
        let n = self.counts[0];
        check_size("values of the vertices", values.len(), n)?;
        Ok((0..self.mirror.len()).map(|v| values[if v < n { v } else { self.mirror[v] as usize }]).collect())
    }

    /// The target on the double for a target on the surface (curvature per vertex, radians): the same at mirror images, and twice as much
    /// on the boundary of the surface, where both halves meet.
    ///
    /// # Errors
    /// [`Error::Size`] unless there is one value per vertex of the surface.
    pub fn target(&self, target: &[f64]) -> Result<Vec<f64>> {
        let mut all = self.spread_vertices(target)?;
        for (v, curvature) in all.iter_mut().enumerate() {
            if self.mirror[v] as usize == v {
                *curvature *= 2.0;
            }
        }
        Ok(all)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::shapes;

    #[test]
    fn double_is_closed_and_symmetric() {
        let surfaces = [
            shapes::disk(3).unwrap(),
            shapes::annulus(0.5, 1.0, 3, 9).unwrap(),
            shapes::punch(&shapes::genus(2, 3).unwrap(), 2).unwrap(),
        ];
        for soup in surfaces {
            let half = Mesh::from_soup(&soup).unwrap();
            let double = Double::new(&half).unwrap();
            assert!(double.mesh.is_closed());
            assert_eq!(double.mesh.euler(), 2 * half.euler());
            assert_eq!(double.mesh.genus(), 2 * half.genus() + half.boundary_loops().len() - 1);
            assert_eq!(double.n_half_vertices(), half.n_vertices());
            for f in half.faces() {
                let [a, b, c] = half.face_vertices(f);
                assert_eq!(double.mesh.face_vertices(f), [a, b, c]);
                let image = FaceId(f.0 + half.n_faces() as u32);
                assert!(double.is_original(f) && !double.is_original(image));
                assert_eq!(double.mesh.face_vertices(image), [a, c, b].map(|v| double.mirror(v)));
            }
            for v in double.mesh.vertices() {
                assert_eq!(double.mirror(double.mirror(v)), v);
            }
            for v in half.vertices() {
                assert_eq!(double.mirror(v) == v, half.is_boundary_vertex(v));
            }
            // Edges are mirrored with their ends.
            let lengths: Vec<[VertexId; 2]> = half.edges().map(|e| half.ends(e)).collect();
            for (e, [a, b]) in double.spread_edges(&lengths).unwrap().into_iter().enumerate() {
                let ends = double.mesh.ends(EdgeId(e as u32));
                assert!(ends == [a, b] || ends == [a, b].map(|v| double.mirror(v)));
            }
            let ones = double.target(&vec![1.0; half.n_vertices()]).unwrap();
            assert_eq!(ones.iter().sum::<f64>(), 2.0 * half.n_vertices() as f64);
        }
        assert!(Double::new(&Mesh::from_soup(&shapes::icosphere(1).unwrap()).unwrap()).is_err());
    }

    #[test]
    fn values_of_another_surface_are_refused() {
        let half = Mesh::from_soup(&shapes::disk(2).unwrap()).unwrap();
        let double = Double::new(&half).unwrap();
        let [n, e] = [half.n_vertices(), half.n_edges()];
        for wrong in [0, n - 1, n + 1] {
            assert!(matches!(double.target(&vec![1.0; wrong]), Err(Error::Size { .. })));
            assert!(matches!(double.spread_vertices(&vec![1; wrong]), Err(Error::Size { .. })));
        }
        assert!(matches!(double.spread_edges(&vec![1.0; e + 1]), Err(Error::Size { .. })));
        assert!(matches!(double.with_images(&[EdgeId::from(e)]), Err(Error::Argument { .. })));
        assert!(double.with_images(&[EdgeId::from(e - 1)]).unwrap().contains(&EdgeId::from(e - 1)));
    }

    #[test]
    fn a_single_triangle_has_the_double_of_two() {
        let double = Double::new(&Mesh::from_faces(3, &[[0, 1, 2]]).unwrap()).unwrap();
        assert_eq!((double.mesh.n_faces(), double.mesh.n_edges(), double.mesh.n_vertices()), (2, 3, 3));
        assert_eq!(double.mesh.euler(), 2);
    }
}
