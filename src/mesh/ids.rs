//! Typed indices of elements, so that a vertex id cannot index an array of edges.
//!
//! ```
//! use ricci::mesh::EdgeId;
//! let h = EdgeId(3).halfedge();
//! assert_eq!((h.0, h.twin().0, h.twin().edge()), (6, 7, EdgeId(3)));
//! ```

use crate::archive::stored;

macro_rules! id {
    ($(#[$doc:meta])* $name:ident) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[repr(transparent)]
        pub struct $name(pub u32);

        stored!(id $name);

        impl $name {
            /// The index as `usize`.
            #[inline]
            pub fn index(self) -> usize {
                self.0 as usize
            }
        }

        impl From<usize> for $name {
            /// From an index below 2³² − 1 (building checks the counts once).
            #[inline]
            fn from(index: usize) -> Self {
                debug_assert!(index < u32::MAX as usize);
                Self(index as u32)
            }
        }

        impl std::fmt::Display for $name {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                self.0.fmt(f)
            }
        }
    };
}

id!(
    /// A vertex.
    VertexId
);
id!(
    /// A half-edge; its twin is `h ^ 1`, its edge `h >> 1`.
    HalfedgeId
);
id!(
    /// An edge; its half-edges are `2e` and `2e + 1`.
    EdgeId
);
id!(
    /// A triangle.
    FaceId
);

impl HalfedgeId {
    /// The other half of the same edge.
    #[inline]
    pub fn twin(self) -> HalfedgeId {
        HalfedgeId(self.0 ^ 1)
    }

    /// The edge it is half of.
    #[inline]
    pub fn edge(self) -> EdgeId {
        EdgeId(self.0 >> 1)
    }
}

impl EdgeId {
    /// The half-edge `2e`, which has the edge's own direction.
    #[inline]
    pub fn halfedge(self) -> HalfedgeId {
        HalfedgeId(self.0 << 1)
    }
}
