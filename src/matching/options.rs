//! What a matching can be asked.

use crate::flow::Options;
use crate::mesh::VertexId;

/// How the boundaries of two surfaces go to each other, between vertices on them that are landmarks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Boundary {
    /// They slide along each other until the map is harmonic up to the boundary too.
    #[default]
    Slides,
    /// By the share of the length from landmark to landmark. Where a loop has none it is counted from a corner that is found (of a disk), or from where the first
    /// of the paths that mark the map ends. In H² it holds at the vertices of both boundaries up to the difference between lengths and barycentric coordinates within
    /// one edge.
    ArcLength,
}

/// Options of [`super::match_surfaces`].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct MatchOptions {
    /// Pairs of vertices, of the source and of the target, that correspond: the map brings the one to the other. Both lie inside, or both on
    /// boundaries. Three of them or more mark the boundary of a disk.
    pub landmarks: Vec<[VertexId; 2]>,
    /// Which boundary loop of the target each of the source's goes to, by their places in [`crate::mesh::Mesh::boundary_loops`]. Default: the
    /// longest to the longest, and so on.
    pub loops: Option<Vec<usize>>,
    /// How boundaries correspond.
    pub boundary: Boundary,
    /// Tolerance, steps and threads of the flows to the canonical metrics.
    pub flow: Options,
}
