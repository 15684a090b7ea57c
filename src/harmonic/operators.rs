//! The operators of a [`Domain`] as sparse matrices stored by rows (CSR). Rows and columns are numbered by the elements' ids.
//!
//! ```
//! use ricci::{Control, Surface, harmonic::Domain, mesh::shapes};
//! let domain = Domain::new(&Surface::from_soup(&shapes::torus(2.0, 1.0, 24, 12)?)?, &Control::new())?;
//! let (d0, star1) = (domain.d0(), domain.star1());
//! let laplacian = &(&d0.transpose_view() * &star1) * &d0;
//! let difference = &laplacian - &domain.laplacian();
//! assert!(difference.data().iter().all(|x| x.abs() < 1e-14));
//! # Ok::<(), ricci::Error>(())
//! ```

use super::domain::Domain;
use crate::mesh::FaceId;
use sprs::{CsMat, TriMat};

impl Domain {
    /// The derivative of functions: E×V, with −1 at the origin and +1 at the tip of the half-edge 2e in row e (0 for a loop).
    pub fn d0(&self) -> CsMat<f64> {
        let mesh = self.mesh();
        let mut matrix = TriMat::with_capacity((mesh.n_edges(), mesh.n_vertices()), 2 * mesh.n_edges());
        for e in mesh.edges() {
            let [i, j] = mesh.ends(e).map(|v| v.index());
            matrix.add_triplet(e.index(), i, -1.0);
            matrix.add_triplet(e.index(), j, 1.0);
        }
        matrix.to_csr()
    }

    /// The derivative of 1-forms: F×E, +1 if the face has the half-edge 2e, −1 if it has the twin of that. `d1 d0 = 0`.
    pub fn d1(&self) -> CsMat<f64> {
        let mesh = self.mesh();
        let mut matrix = TriMat::with_capacity((mesh.n_faces(), mesh.n_edges()), 3 * mesh.n_faces());
        for f in mesh.faces() {
            for h in mesh.face_halfedges(f) {
                matrix.add_triplet(f.index(), h.edge().index(), if h.0 & 1 == 0 { 1.0 } else { -1.0 });
            }
        }
        matrix.to_csr()
    }

    /// The Hodge star of functions, which is the lumped mass matrix: V×V, diagonal, positive; a third of the area of the faces around the
    /// vertex.
    pub fn star0(&self) -> CsMat<f64> {
        diagonal(self.vertex_areas())
    }

    /// The Hodge star of 1-forms: E×E, diagonal; the cotangent weights, at least 0 on edges inside of a Delaunay triangulation.
    pub fn star1(&self) -> CsMat<f64> {
        diagonal(self.weights())
    }

    /// The cotangent Laplacian `L = d0ᵀ ⋆1 d0` \[PP93\]: V×V, symmetric, positive semidefinite, rows add up to 0; an entry off
    /// the diagonal is minus the sum of the weights of the edges between the two vertices. `uᵀ L u / 2` is the Dirichlet energy. L is not
    /// divided by areas; the pointwise Laplacian is `⋆0⁻¹ L`.
    pub fn laplacian(&self) -> CsMat<f64> {
        let mesh = self.mesh();
        let mut matrix = TriMat::with_capacity((mesh.n_vertices(), mesh.n_vertices()), 4 * mesh.n_edges());
        for e in mesh.edges() {
            let [i, j] = mesh.ends(e).map(|v| v.index());
            let weight = self.weights()[e];
            for (row, column, value) in [(i, i, weight), (j, j, weight), (i, j, -weight), (j, i, -weight)] {
                matrix.add_triplet(row, column, value);
            }
        }
        matrix.to_csr()
    }

    /// The gradient of functions that are linear on the faces: 2F×V, in one over length. Rows 2f and 2f + 1 are the components along the
    /// first half-edge of face f and 90° counterclockwise of it. `L = Gᵀ A G`, where A holds the area of every face twice.
    pub fn gradient(&self) -> CsMat<f64> {
        let mesh = self.mesh();
        let shape = (2 * mesh.n_faces(), mesh.n_vertices());
        let mut matrix = TriMat::with_capacity(shape, 6 * mesh.n_faces());
        for f in mesh.faces() {
            let corners = self.face_corners(f);
            for (k, v) in mesh.face_vertices(f).into_iter().enumerate() {
                // The gradient of corner k's hat function points 90° counterclockwise of the opposite side; its length is 1 over the
                // height.
                let [p, q] = [corners[(k + 1) % 3], corners[(k + 2) % 3]];
                let across = [p[1] - q[1], q[0] - p[0]].map(|x| x / (2.0 * self.face_areas()[f]));
                for (row, value) in across.into_iter().enumerate() {
                    matrix.add_triplet(2 * f.index() + row, v.index(), value);
                }
            }
        }
        matrix.to_csr()
    }

    /// The corners of a face in the plane, the first corner at the origin and the half-edge from it along the x axis.
    pub fn face_corners(&self, f: FaceId) -> [[f64; 2]; 3] {
        let base = self.lengths()[self.mesh().face_halfedge(f).edge()];
        let height = 2.0 * self.face_areas()[f] / base;
        [[0.0, 0.0], [base, 0.0], [self.cotangents()[f][0] * height, height]]
    }
}

fn diagonal(values: &[f64]) -> CsMat<f64> {
    let n = values.len();
    let mut matrix = TriMat::with_capacity((n, n), n);
    values.iter().enumerate().for_each(|(i, &x)| matrix.add_triplet(i, i, x));
    matrix.to_csr()
}
