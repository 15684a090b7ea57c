//! Schemes: how lengths depend on the conformal variables.

use crate::choice::choice;
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

choice!(ricci_scheme, "scheme", Scheme, [
    RICCI_SCHEME_YAMABE => Yamabe,
    RICCI_SCHEME_INVERSIVE => Inversive,
    RICCI_SCHEME_THURSTON => Thurston,
    RICCI_SCHEME_TANGENTIAL => Tangential,
    RICCI_SCHEME_VIRTUAL => Virtual,
]);
