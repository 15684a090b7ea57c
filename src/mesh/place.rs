//! Points of surfaces, as places in their faces.

use super::ids::FaceId;

/// A point of a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// Its face.
    pub face: FaceId,
    /// Its barycentric coordinates in the face: not negative, with the sum 1.
    pub weights: [f64; 3],
}
