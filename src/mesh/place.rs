//! Points of surfaces, given by a face and barycentric coordinates.

use super::Point;
use super::halfedge::Mesh;
use super::ids::{FaceId, VertexId};
use crate::archive::stored;
use crate::error::{Error, Result};

/// A point of a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// The face that contains it.
    pub face: FaceId,
    /// Its barycentric coordinates in the face: not negative, with sum 1.
    pub weights: [f64; 3],
}
stored!(row Place { face: FaceId, weights: [f64; 3] });

impl Place {
    /// The point in space, on a mesh with these positions (V entries).
    pub fn point(&self, mesh: &Mesh, positions: &[Point]) -> Point {
        let corners = mesh.face_vertices(self.face).map(|v| positions[v.index()]);
        [0, 1, 2].map(|i| (0..3).map(|k| self.weights[k] * corners[k][i]).sum())
    }

    /// A vertex of a mesh, as a corner of one of its faces.
    ///
    /// # Errors
    /// [`Error::Argument`] for a vertex that does not exist, [`Error::Connectivity`] for one without faces.
    pub fn at_vertex(mesh: &Mesh, v: VertexId) -> Result<Place> {
        if v.index() >= mesh.n_vertices() {
            return Err(Error::argument("vertex", v, "an existing vertex"));
        }
        let first = mesh.outgoing(v).find_map(|h| mesh.corner(h));
        let Some((face, corner)) = first else {
            return Err(Error::connectivity("vertex", v.index(), "has no face"));
        };
        Ok(Place { face, weights: std::array::from_fn(|k| f64::from(k == corner)) })
    }
}
