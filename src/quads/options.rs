//! The options of quad meshes.

/// The size of the squares.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum QuadSize {
    /// This edge length, in the units of the surface's lengths.
    Edge(f64),
    /// About this number of quads.
    Quads(usize),
    /// As few quads as the lines between cones allow.
    Coarse,
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
