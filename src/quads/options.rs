//! The options of quad meshes.

use crate::error::{Error, Result};

/// The size of the squares.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum QuadSize {
    /// This edge length, in the units of the surface's lengths.
    Edge(f64),
    /// About this number of quads.
    Quads(usize),
    /// As few quads as the lines between cones allow.
    Coarse,
    /// At most this number of quads, each side as near as that allows to its length on the surface.
    AtMost(usize),
}

/// The options of [`super::quad_mesh`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct QuadOptions {
    /// The size of the squares. Default: 1,000 quads.
    pub size: QuadSize,
    /// The number of threads, in a pool of the call's own; 0: one for each core. The result does not depend on it.
    pub threads: usize,
}

impl Default for QuadOptions {
    fn default() -> QuadOptions {
        QuadOptions { size: QuadSize::Quads(1000), threads: 0 }
    }
}

impl QuadOptions {
    /// # Errors
    /// [`Error::Argument`] for a size that is not positive.
    pub(super) fn check(&self) -> Result<()> {
        match self.size {
            QuadSize::Edge(edge) if !(edge > 0.0 && edge.is_finite()) => {
                Err(Error::argument("edge", edge, "positive"))
            }
            QuadSize::Quads(0) | QuadSize::AtMost(0) => Err(Error::argument("quads", 0, "positive")),
            _ => Ok(()),
        }
    }
}
