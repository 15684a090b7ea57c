//! A conformal class: the scheme, and the space that it deforms metrics in.

use super::scheme::Scheme;
use crate::geometry::Space;

/// A scheme and the space of the metrics that it gives.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Class {
    /// Which vertex types and edge weights represent the metric.
    pub scheme: Scheme,
    /// The space that the triangles of the metric are made of.
    pub space: Space,
}

impl Class {
    /// The class of a scheme in a space.
    pub fn new(scheme: Scheme, space: Space) -> Class {
        Class { scheme, space }
    }

    /// Vertex scaling in a space.
    pub fn yamabe(space: Space) -> Class {
        Class::new(Scheme::Yamabe, space)
    }
}
