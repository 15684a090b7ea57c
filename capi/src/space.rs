//! The three background geometries.

use crate::choice::Choice;
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

impl Choice for ricci_space {
    const NAME: &'static str = "space";
    type Value = Space;
    const ALL: &'static [(Self, Space)] = &[
        (ricci_space::RICCI_SPACE_E2, Space::E2),
        (ricci_space::RICCI_SPACE_H2, Space::H2),
        (ricci_space::RICCI_SPACE_S2, Space::S2),
    ];
    fn number(self) -> i32 {
        self as i32
    }
}
