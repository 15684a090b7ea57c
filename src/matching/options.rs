//! The options of a matching.

use crate::flow::Options;
use crate::mesh::{HalfedgeId, Place, VertexId};

/// The rule by which the boundaries of two surfaces go to each other between the landmarks on them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum BoundaryMatching {
    /// They slide along each other until the map is harmonic up to the boundary too.
    #[default]
    Slides,
    /// By the share of the length from landmark to landmark. On a loop without landmarks it is counted from an added corner (of a disk), or
    /// from the end of the first of the paths that determine the class. In H² it holds at the vertices of both boundaries up to the
    /// difference between lengths and barycentric coordinates within one edge.
    ArcLength,
}

/// The shape of the boundary loops of surfaces with handles in the domain.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum LoopShape {
    /// Closed geodesics of a hyperbolic metric, or straight sides between landmarks on them: no map onto them folds.
    #[default]
    Geodesics,
    /// Circles: the domain is a closed flat torus or hyperbolic surface with round holes. The class, and the correspondence of the
    /// boundaries, are those of the map onto geodesics. Faces may fold beside a hole, because the domain is not convex there; then the
    /// weights of the map are changed around them, and it is an error if that does not open them. Landmarks inside the surfaces are
    /// refused.
    Circles,
}

/// A landmark that draws the map near its partner.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SoftLandmark {
    /// A vertex of the source and one of the target, both inside the surfaces.
    pub pair: [VertexId; 2],
    /// Its weight w ≥ 0: the landmark goes to the share w/(1 + w) of the path to its partner from its image in the map without it.
    pub weight: f64,
}

/// Options of [`super::match_surfaces`].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct MatchOptions {
    /// Pairs of vertices, of the source and of the target, that correspond: the map brings the one to the other. Both lie inside, or both
    /// on boundaries. On every surface there may be any number of them; on those with handles each is pushed to its partner along a short
    /// path from its image in the map without landmarks, which chooses the class: of several sets of paths the one with the least energy.
    pub landmarks: Vec<[VertexId; 2]>,
    /// Pairs of points, of the source and of the target, that correspond as landmarks do: inside faces, on edges or at vertices.
    pub points: Vec<[Place; 2]>,
    /// Landmarks that need not be met, but draw the map near their partners.
    pub soft: Vec<SoftLandmark>,
    /// Pairs of curves, of the source and of the target, that correspond by shares of their lengths: vertices in order, each joined to the
    /// next by an edge, closed if the last is the first. Each vertex of the source's curve is a landmark whose partner lies on the target's
    /// curve.
    pub curves: Vec<[Vec<VertexId>; 2]>,
    /// Pairs of closed edge paths, of the source and of the target, that name the homotopy class on surfaces with handles: the map brings
    /// each to its partner. They generate the fundamental groups of both, a basis of 2g loops of a closed surface for example, and 2g + b −
    /// 1 with b boundary loops; on each surface they all start at one vertex, but on tori. Landmarks leave this class of the surface
    /// without them as it is, whatever the paths along which they are pushed to their partners. Without any loops, a class of low energy is
    /// searched.
    pub basis: Vec<[Vec<HalfedgeId>; 2]>,
    /// Per boundary loop of the source the one of the target to which it goes, by their places in [`crate::mesh::Mesh::boundary_loops`].
    /// Default: a loop with landmarks to that of their partners, of the others the longest to the longest, and so on. On surfaces with
    /// handles loops without landmarks whose lengths are nearly equal are also exchanged, if
    /// that gives no more than six orders, and the order with the least energy is taken.
    pub loops: Option<Vec<usize>>,
    /// The rule by which boundaries correspond.
    pub boundary: BoundaryMatching,
    /// The shape of boundary loops of surfaces with handles.
    pub loop_shape: LoopShape,
    /// Tolerance, steps and threads of the flows to the canonical metrics.
    pub flow: Options,
}
