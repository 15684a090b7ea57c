//! The conformal class of a metric: the scheme that represents it, and the space that its triangles live in.
//!
//! ```
//! # use ricci::{Class, geometry::Space, metric::Scheme};
//! assert_eq!(Class::yamabe(Space::H2), Class::new(Scheme::Yamabe, Space::H2));
//! # Ok::<(), ricci::Error>(())
//! ```

use super::scheme::Scheme;
use crate::archive::stored;
use crate::geometry::Space;

/// A conformal class up to the surface: how lengths depend on the variables u, and the background geometry of the triangles.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Class {
    /// The row of (ε, η) of \[JKLLG08, §4.1\] that represents the input's metric.
    pub scheme: Scheme,
    /// The geometry of the result's triangles; the input's lengths may be read in another one.
    pub space: Space,
}
stored!(sections Class { scheme, space });

impl Class {
    /// Any scheme in any space.
    pub fn new(scheme: Scheme, space: Space) -> Class {
        Class { scheme, space }
    }

    /// Vertex scaling, the discrete Yamabe flow: the usual choice.
    pub fn yamabe(space: Space) -> Class {
        Class::new(Scheme::Yamabe, space)
    }

    /// Inversive distance circle packings.
    pub fn inversive(space: Space) -> Class {
        Class::new(Scheme::Inversive, space)
    }
}
