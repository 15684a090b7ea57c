//! The three background geometries.

use crate::choice::choice;
use ricci::geometry::space::Space;

/// Background geometry.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ricci_space {
    /// The Euclidean plane.
    RICCI_SPACE_E2 = 0,
    /// The hyperbolic plane, curvature -1.
    RICCI_SPACE_H2 = 1,
    /// The unit sphere, curvature +1.
    RICCI_SPACE_S2 = 2,
}

choice!(ricci_space, "space", Space, [
    RICCI_SPACE_E2 => E2,
    RICCI_SPACE_H2 => H2,
    RICCI_SPACE_S2 => S2,
]);
