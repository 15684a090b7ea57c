//! The refinement as data: its surface, and where each part of it lies in the input and in the final triangulation.

use crate::error::Error;
use crate::mesh::{EdgeId, FaceId, HalfedgeId, Mesh, PerEdge, PerFace, PerVertex, VertexId};

/// The two triangulations that a refinement leads between.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Side {
    Input,
    Final,
}

/// A vertex of the refinement that is not one of the input: where an edge of the input and an edge of the final triangulation meet.
/// Weights belong to the ends of the edges (of their half-edges 2e), are positive and add up to 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crossing {
    /// The edge of the input.
    pub input_edge: EdgeId,
    /// Its ends.
    pub input_ends: [VertexId; 2],
    /// Weights of the ends' positions in the input.
    pub input_weights: [f64; 2],
    /// The edge of the final triangulation.
    pub final_edge: EdgeId,
    /// Its ends.
    pub final_ends: [VertexId; 2],
    /// Weights of the ends' positions in the final metric.
    pub final_weights: [f64; 2],
}

impl Crossing {
    /// The ends of the edge that it lies on, and their weights.
    pub(super) fn on(&self, side: Side) -> ([VertexId; 2], [f64; 2]) {
        match side {
            Side::Input => (self.input_ends, self.input_weights),
            Side::Final => (self.final_ends, self.final_weights),
        }
    }
}

/// Which edges an edge of the refinement is part of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Origin {
    /// The edge of the input.
    pub input: Option<EdgeId>,
    /// The edge of the final triangulation.
    pub result: Option<EdgeId>,
}

/// Where in a face a corner of a triangle of the refinement lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct OnFace {
    /// A corner of the refinement that is a vertex lies at this corner of the face, a crossing on the side that starts there.
    pub corner: u8,
    /// Whether that side runs against its edge.
    pub backward: bool,
}

/// Where in a face a corner of a triangle of the refinement lies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Place {
    /// At this corner.
    Corner(usize),
    /// On a side, with these weights of the corners; one of them may be rounded to 1.
    Side([f64; 3]),
}

/// Weights of a triangle's corners in that triangle.
pub(crate) const CORNERS: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

impl Place {
    /// The corner, if it lies at one.
    pub fn corner(self) -> Option<usize> {
        if let Place::Corner(corner) = self { Some(corner) } else { None }
    }

    /// The corner at which it lies as far as doubles tell.
    pub fn rounded(self) -> Option<usize> {
        match self {
            Place::Corner(corner) => Some(corner),
            Place::Side(weights) => corner_at(weights),
        }
    }

    /// Weights of the corners.
    pub fn weights(self) -> [f64; 3] {
        match self {
            Place::Corner(corner) => CORNERS[corner],
            Place::Side(weights) => weights,
        }
    }
}

/// The corner of a face at which a point with these weights lies, if it is one.
#[inline]
pub(crate) fn corner_at(weights: [f64; 3]) -> Option<usize> {
    weights.iter().position(|&w| w == 1.0)
}

/// The common refinement. Its vertices are those of the input, in order, then the crossings.
#[derive(Debug, Clone, PartialEq)]
pub struct Refinement {
    /// The pieces, triangulated: a surface of the same topology. A Δ-complex if the input is one.
    pub mesh: Mesh,
    /// Number of vertices of the input: vertex `n_input_vertices + k` is `crossings[k]`.
    pub n_input_vertices: usize,
    /// The vertices that are not the input's.
    pub crossings: Vec<Crossing>,
    /// Homogeneous weight per vertex: that of its position in the final metric over that in the input. Positive and finite; only
    /// quotients within a piece have a meaning.
    pub weight: PerVertex<f64>,
    /// Per triangle, the piece it is part of: triangles of one piece have consecutive numbers and the same projective map.
    pub piece: PerFace<u32>,
    /// Per triangle, the face of the input.
    pub input_face: PerFace<FaceId>,
    /// Per triangle, the face of the final triangulation.
    pub final_face: PerFace<FaceId>,
    /// Per edge, the edges that it is a part of; none for the edges between triangles of one piece.
    pub origin: PerEdge<Origin>,
    /// Per triangle and corner: where it lies in the face of the input, in the final face.
    pub(super) places: Vec<[[OnFace; 2]; 3]>,
}

impl Refinement {
    /// Weights of a triangle's corners in its face of the input, `[corner of the triangle][corner of the face]`: barycentric
    /// coordinates if that is plane.
    pub fn input_barycentric(&self, f: FaceId) -> [[f64; 3]; 3] {
        self.barycentric(f, Side::Input)
    }

    /// Weights of a triangle's corners in its final face.
    pub fn final_barycentric(&self, f: FaceId) -> [[f64; 3]; 3] {
        self.barycentric(f, Side::Final)
    }

    /// Per triangle, its face in one of the triangulations.
    pub(super) fn faces(&self, side: Side) -> &PerFace<FaceId> {
        match side {
            Side::Input => &self.input_face,
            Side::Final => &self.final_face,
        }
    }

    pub(super) fn barycentric(&self, f: FaceId, side: Side) -> [[f64; 3]; 3] {
        let halfedges = self.mesh.face_halfedges(f);
        [0, 1, 2].map(|k| self.place((f, k), halfedges[k], side).weights())
    }

    /// Where in its face of the input a corner of a triangle lies, at the origin of this half-edge.
    pub(crate) fn input_place(&self, corner: (FaceId, usize), h: HalfedgeId) -> Place {
        self.place(corner, h, Side::Input)
    }

    /// Where in its final face a corner of a triangle lies, at the origin of this half-edge.
    pub(crate) fn final_place(&self, corner: (FaceId, usize), h: HalfedgeId) -> Place {
        self.place(corner, h, Side::Final)
    }

    #[inline]
    fn place(&self, (f, k): (FaceId, usize), h: HalfedgeId, side: Side) -> Place {
        let OnFace { corner, backward } = self.places[f.index()][k][side as usize];
        let corner = usize::from(corner);
        let Some(crossing) = self.crossing(self.mesh.origin(h)) else { return Place::Corner(corner) };
        let [from, to] = crossing.on(side).1;
        let (mut all, tip) = ([0.0; 3], (corner + 1) % 3);
        (all[corner], all[tip]) = if backward { (to, from) } else { (from, to) };
        Place::Side(all)
    }

    /// The crossing that a vertex is, if it is none of the input's.
    fn crossing(&self, v: VertexId) -> Option<&Crossing> {
        self.crossings.get(v.index().wrapping_sub(self.n_input_vertices))
    }

    /// The half-edge of the final triangulation that a half-edge of the refinement runs along, in its direction, if it does.
    pub fn final_halfedge(&self, h: HalfedgeId) -> Option<HalfedgeId> {
        self.origin[h.edge()].result.map(|e| HalfedgeId(e.halfedge().0 + (h.0 & 1)))
    }

    /// Homogeneous weights of a triangle's corners.
    pub fn weights(&self, f: FaceId) -> [f64; 3] {
        self.mesh.face_vertices(f).map(|v| self.weight[v])
    }
}

/// The error of triangulations that are not of one surface.
pub(super) fn torn() -> Error {
    let message = "its faces and those of the final triangulation do not overlap as the flips say";
    Error::Connectivity { element: "mesh", index: 0, message }
}
