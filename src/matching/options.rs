//! What a matching can be asked.

use crate::flow::Options;
use crate::mesh::VertexId;

/// Options of [`super::match_surfaces`].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct MatchOptions {
    /// Pairs of vertices, of the source and of the target, that correspond: the map brings the one to the other. Both lie inside, or both on
    /// boundaries. Between those on boundaries these slide along each other; three of them or more mark the boundary of a disk.
    pub landmarks: Vec<[VertexId; 2]>,
    /// Which boundary loop of the target each of the source's goes to, by their places in [`crate::mesh::Mesh::boundary_loops`]. Default: the
    /// longest to the longest, and so on.
    pub loops: Option<Vec<usize>>,
    /// Tolerance, steps and threads of the flows to the canonical metrics.
    pub flow: Options,
}
