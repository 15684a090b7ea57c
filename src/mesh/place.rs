//! Points of surfaces, given by a face and barycentric coordinates.

use super::halfedge::Mesh;
use super::ids::{FaceId, VertexId};
use crate::error::{Error, Result};

/// A point of a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// The face that contains it.
    pub face: FaceId,
    /// Its barycentric coordinates in the face: not negative, with sum 1.
    pub weights: [f64; 3],
}

impl Place {
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
