//! Points of surfaces, as places in their faces.

use super::halfedge::Mesh;
use super::ids::{FaceId, VertexId};

/// A point of a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// Its face.
    pub face: FaceId,
    /// Its barycentric coordinates in the face: not negative, with the sum 1.
    pub weights: [f64; 3],
}

impl Place {
    /// A vertex of a mesh, as a corner of one of its faces.
    pub fn at_vertex(mesh: &Mesh, v: VertexId) -> Place {
        let first = mesh.outgoing(v).find_map(|h| mesh.corner(h));
        let (face, corner) = first.unwrap_or((FaceId(0), 0));
        Place { face, weights: std::array::from_fn(|k| f64::from(k == corner)) }
    }
}
