//! Schemes: how lengths depend on the conformal variables.

use crate::choice::Choice;
use ricci::metric::scheme::Scheme;

/// How edge lengths depend on one variable u per vertex.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ricci_scheme {
    /// Vertex scaling (discrete Yamabe); represents any input metric exactly.
    RICCI_SCHEME_YAMABE = 0,
    /// Inversive distance circle packing; represents any input metric exactly.
    RICCI_SCHEME_INVERSIVE = 1,
    /// Thurston's circle packing: circles meet at angles in [0, pi/2]; changes lengths at the start.
    RICCI_SCHEME_THURSTON = 2,
    /// Tangential (combinatorial) circle packing: ignores lengths but for the initial radii.
    RICCI_SCHEME_TANGENTIAL = 3,
    /// Virtual radius circle packing: imaginary circles.
    RICCI_SCHEME_VIRTUAL = 4,
}

use ricci_scheme::*;

impl Choice for ricci_scheme {
    const NAME: &'static str = "scheme";
    type Value = Scheme;
    const ALL: &'static [(Self, Scheme)] = &[
        (RICCI_SCHEME_YAMABE, Scheme::Yamabe),
        (RICCI_SCHEME_INVERSIVE, Scheme::Inversive),
        (RICCI_SCHEME_THURSTON, Scheme::Thurston),
        (RICCI_SCHEME_TANGENTIAL, Scheme::Tangential),
        (RICCI_SCHEME_VIRTUAL, Scheme::Virtual),
    ];
    fn number(self) -> i32 {
        self as i32
    }
}
