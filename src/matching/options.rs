//! What a matching can be asked.

use super::soft::SoftLandmark;
use crate::flow::Options;
use crate::mesh::{HalfedgeId, Place, VertexId};

/// How the boundaries of two surfaces go to each other, between vertices on them that are landmarks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Boundary {
    /// They slide along each other until the map is harmonic up to the boundary too.
    #[default]
    Slides,
    /// By the share of the length from landmark to landmark. Where a loop has none it is counted from a corner that is found (of a disk),
    /// or from where the first of the paths that mark the map ends. In H² it holds at the vertices of both boundaries up to the difference
    /// between lengths and barycentric coordinates within one edge.
    ArcLength,
}

/// What the boundary loops of surfaces with handles become in the domain.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum LoopShape {
    /// Closed geodesics of a hyperbolic metric, or straight sides between landmarks on them: no map onto them folds.
    #[default]
    Geodesics,
    /// Circles: the domain is a closed flat torus or hyperbolic surface with round holes. The class, and how boundaries correspond, are
    /// those of the map onto geodesics. Faces may fold beside a hole, which bends away from them; then the weights of the map are changed
    /// there, and where that does not open them it is an error. Landmarks inside the surfaces are refused.
    Circles,
}

/// Options of [`super::match_surfaces`].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct MatchOptions {
    /// Pairs of vertices, of the source and of the target, that correspond: the map brings the one to the other. Both lie inside, or both
    /// on boundaries. On every surface there may be any number of them; on those with handles each goes to its partner by a short way from
    /// where the map without landmarks has it, which chooses the class: of several sets of ways that with the least energy.
    pub landmarks: Vec<[VertexId; 2]>,
    /// Pairs of points, of the source and of the target, that correspond as landmarks do: inside faces, on edges or at vertices.
    pub points: Vec<[Place; 2]>,
    /// Landmarks that need not be met.
    pub soft: Vec<SoftLandmark>,
    /// Pairs of curves, of the source and of the target, that correspond by shares of their lengths: vertices in order, each joined to the
    /// next by an edge, closed if the last is the first. Each vertex of the source's curve is a landmark whose partner lies on the target's
    /// curve.
    pub curves: Vec<[Vec<VertexId>; 2]>,
    /// Pairs of closed edge paths, of the source and of the target, that name the homotopy class on surfaces with handles: the map brings
    /// each to its partner. They generate the fundamental groups of both, a basis of 2g loops of a closed surface for example, and 2g + b −
    /// 1 with b boundary loops; on each surface they all start at one vertex, but on tori. Landmarks leave this class of the surface
    /// without them as it is, whatever the ways on which they are pushed to their partners. Without any loops, a class of low energy is
    /// searched.
    pub basis: Vec<[Vec<HalfedgeId>; 2]>,
    /// Which boundary loop of the target each of the source's goes to, by their places in [`crate::mesh::Mesh::boundary_loops`]. Default:
    /// the longest to the longest, and so on; on surfaces with handles also other orders of loops of like lengths, if these leave no more
    /// than six orders open, and of all the one with the least energy.
    pub loops: Option<Vec<usize>>,
    /// How boundaries correspond.
    pub boundary: Boundary,
    /// What boundary loops of surfaces with handles become.
    pub loop_shape: LoopShape,
    /// Tolerance, steps and threads of the flows to the canonical metrics.
    pub flow: Options,
}
