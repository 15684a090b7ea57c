//! The common refinement of two triangulations of one surface that have different vertices.
//!
//! It says the same as [`super::Refinement`], whose two triangulations have the same vertices and are told apart by flips: pieces, each in
//! one face of either, and on every piece a projective map.

use crate::error::{Result, check_size};
use crate::mesh::{EdgeId, FaceId, Mesh, PerFace, PerVertex, VertexId};

/// A vertex where an edge of the source and an edge of the target cross: of each the edge, and the weight of its second end, from 0 to 1.
pub type Meeting = [(EdgeId, f64); 2];

/// Triangles that are parts of one face of a *source* and of one face of a *target*. Everything that is there twice is the source's first.
#[derive(Debug, Clone, PartialEq)]
pub struct Overlay {
    /// The pieces, triangulated: a surface of the same topology. Its vertices are those of the source with their numbers, then the
    /// crossings, then the others of the target.
    pub mesh: Mesh,
    /// Vertices of the source, and of the target.
    pub n_vertices: [usize; 2],
    /// The crossings: vertex `n_vertices[0] + k` is entry k.
    pub crossings: Vec<Meeting>,
    /// Per triangle: the piece that it is a part of. Triangles of one piece have consecutive numbers and one projective map.
    pub piece: PerFace<u32>,
    /// Per triangle: its face.
    pub faces: [PerFace<FaceId>; 2],
    /// Per triangle: the barycentric coordinates of its corners in its face, `[corner of the triangle][corner of the face]`.
    pub barycentric: [PerFace<[[f64; 3]; 3]>; 2],
    /// Per vertex, positive: in a piece, the barycentric coordinates in the target are those in the source times these weights, up to their
    /// sum. All are 1 in the plane.
    pub weight: PerVertex<f64>,
}

impl Overlay {
    /// Values at the vertices of one of the two (0 the source, 1 the target), linear in its faces, at the vertices of the overlay.
    ///
    /// # Errors
    /// [`crate::Error::Size`].
    pub fn from_vertices<const N: usize>(
        &self,
        side: usize,
        mesh: &Mesh,
        values: &[[f64; N]],
    ) -> Result<Vec<[f64; N]>> {
        check_size("values", values.len(), self.n_vertices[side])?;
        check_size("vertices", mesh.n_vertices(), self.n_vertices[side])?;
        let mut all = vec![[0.0; N]; self.mesh.n_vertices()];
        for f in self.mesh.faces() {
            let corners = mesh.face_vertices(self.faces[side][f]).map(|v| values[v.index()]);
            for (v, weights) in self.mesh.face_vertices(f).into_iter().zip(self.barycentric[side][f]) {
                all[v.index()] = combine(weights, corners);
            }
        }
        Ok(all)
    }

    /// Values at the corners of the faces of one of the two, linear in them, at the corners of the overlay's triangles.
    ///
    /// # Errors
    /// [`crate::Error::Size`].
    pub fn from_corners<const N: usize>(
        &self,
        side: usize,
        values: &[[[f64; N]; 3]],
    ) -> Result<Vec<[[f64; N]; 3]>> {
        let need = self.faces[side].iter().map(|f| f.index() + 1).fold(0, usize::max);
        check_size("corner values", values.len().min(need), need)?;
        let of = |f: FaceId| {
            let corners = values[self.faces[side][f].index()];
            self.barycentric[side][f].map(|weights| combine(weights, corners))
        };
        Ok(self.mesh.faces().map(of).collect())
    }

    /// The share of its face that the smallest triangle takes, with its sign: not negative where no piece folds.
    pub fn least_share(&self, side: usize) -> f64 {
        let share = |[a, b, c]: &[[f64; 3]; 3]| {
            let minor = |i: usize, j: usize| b[i] * c[j] - b[j] * c[i];
            a[0] * minor(1, 2) + a[1] * minor(2, 0) + a[2] * minor(0, 1)
        };
        self.barycentric[side].iter().map(share).fold(1.0, f64::min)
    }

    /// Weights of a triangle's corners.
    pub(super) fn weights(&self, f: FaceId) -> [f64; 3] {
        self.mesh.face_vertices(f).map(|v: VertexId| self.weight[v])
    }
}

fn combine<const N: usize>(weights: [f64; 3], corners: [[f64; N]; 3]) -> [f64; N] {
    std::array::from_fn(|i| (0..3).map(|k| weights[k] * corners[k][i]).sum())
}
