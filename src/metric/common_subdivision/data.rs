//! The common subdivision as data: its surface, and the place of each part of it in both triangulations.

use crate::archive::{in_range, invalid, stored};
use crate::error::{Error, Result, check_size};
use crate::mesh::{EdgeId, FaceId, HalfedgeId, Mesh, PerEdge, PerFace, PerVertex, VertexId};

/// A point on an edge. The weights belong to the ends (those of the half-edge 2e), are not negative and add up to 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EdgePoint {
    /// The edge.
    pub edge: EdgeId,
    /// Its ends.
    pub ends: [VertexId; 2],
    /// Weights of the positions of the ends.
    pub weights: [f64; 2],
}
stored!(row EdgePoint { edge: EdgeId, ends: [VertexId; 2], weights: [f64; 2] });

/// A vertex where an edge of the first triangulation and an edge of the second cross, as a point on either.
pub type Crossing = [EdgePoint; 2];

/// A vertex of the subdivision as a combination of three corners of a face.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct FacePoint {
    pub vertices: [VertexId; 3],
    pub weights: [f64; 3],
}
stored!(row FacePoint { vertices: [VertexId; 3], weights: [f64; 3] });

/// How the stored weights of a vertex of the subdivision are assigned to the corners of the face that has the triangle, in two bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct PackedPlace {
    /// The corner of the face that the first weight belongs to. The others follow counterclockwise.
    pub corner: u8,
    /// True if the first two weights are swapped: those of a crossing are stored in the direction of half-edge 2e, and the face has the
    /// other one.
    pub backward: bool,
}
stored!(row PackedPlace { corner: u8, backward: bool });

/// The place of a corner of a triangle in a face.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum PlaceInFace {
    /// At this corner of the face.
    Corner(usize),
    /// At the point with these weights of the corners; one of them may be rounded to 1.
    Weights([f64; 3]),
}

/// Weights of a triangle's corners in that triangle.
pub(crate) const CORNERS: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

impl PlaceInFace {
    /// The corner, if the place is one.
    pub fn corner(self) -> Option<usize> {
        if let PlaceInFace::Corner(corner) = self { Some(corner) } else { None }
    }

    /// The corner, if the place is one up to the rounding of its weights.
    pub fn rounded_corner(self) -> Option<usize> {
        match self {
            PlaceInFace::Corner(corner) => Some(corner),
            PlaceInFace::Weights(weights) => corner_at(weights),
        }
    }

    /// Weights of the corners.
    pub fn weights(self) -> [f64; 3] {
        match self {
            PlaceInFace::Corner(corner) => CORNERS[corner],
            PlaceInFace::Weights(weights) => weights,
        }
    }
}

/// The corner of a face at which a point with these weights lies, if it lies at one.
#[inline]
pub(crate) fn corner_at(weights: [f64; 3]) -> Option<usize> {
    weights.iter().position(|&w| w == 1.0)
}

/// The common subdivision of two triangulations of one surface: pieces that each lie in one face of either, and on every piece a
/// projective map.
///
/// After a flow the *first* triangulation is the input and the *second* is the final one, with the same vertices
/// ([`crate::flow::Solution::common_subdivision`]). Of a matching the first is the source and the second is the target
/// ([`crate::matching::CommonDomain::overlay`]). A `side` is 0 for the first and 1 for the second, and so is the index of every array of
/// two.
#[derive(Debug, Clone, PartialEq)]
pub struct CommonSubdivision {
    /// The pieces, triangulated: a surface of the same topology, and a Δ-complex if the triangulations are. Its vertices are those of
    /// the first triangulation with their numbers, then the crossings, then those of the second that are not at one of the first, then those
    /// on edges that were split ([`crate::embed::LayoutOptions::straight_sides`]).
    pub mesh: Mesh,
    /// Number of vertices of each triangulation; of a subdivision of some faces only, of those on these faces.
    pub n_vertices: [usize; 2],
    /// The crossings: vertex `n_vertices[0] + k` is `crossings[k]`.
    pub crossings: Vec<Crossing>,
    /// Homogeneous weight per vertex: the scale of its homogeneous coordinates in the second triangulation over that in the first. Positive and
    /// finite; only quotients within a piece have a meaning. These are no barycentric coordinates.
    pub weight: PerVertex<f64>,
    /// Per triangle, the piece (a polygon) that it is part of: triangles of one piece have consecutive numbers and the same projective map.
    pub polygon_of: PerFace<u32>,
    /// Per triangle, its face in each triangulation.
    pub faces: [PerFace<FaceId>; 2],
    /// Per edge e, the half-edge of each triangulation that its half-edge 2e runs along; none for the edges between triangles of one
    /// piece.
    pub halfedges_along: PerEdge<[Option<HalfedgeId>; 2]>,
    /// Per triangle and corner, its place in the face of each triangulation.
    pub(super) places: Vec<[[PackedPlace; 2]; 3]>,
    /// Per vertex, its place in each triangulation. Empty where every vertex is a crossing or a vertex of both.
    pub(super) points: Vec<[FacePoint; 2]>,
}
stored!(sections CommonSubdivision { mesh, n_vertices, crossings, weight, polygon_of, faces,
    halfedges_along, places, points } check CommonSubdivision::check_parts);

impl CommonSubdivision {
    /// Checks that the arrays of an archive fit each other.
    fn check_parts(&self) -> Result<()> {
        let (n, e, f) = (self.mesh.n_vertices(), self.mesh.n_edges(), self.mesh.n_faces());
        check_size("weights", self.weight.len(), n)?;
        check_size("pieces", self.polygon_of.len(), f)?;
        check_size("places", self.places.len(), f)?;
        check_size("edges along triangulations", self.halfedges_along.len(), e)?;
        self.faces.iter().try_for_each(|faces| check_size("faces of triangles", faces.len(), f))?;
        let ends = self.n_vertices[0].checked_add(self.crossings.len()).is_some_and(|end| end <= n);
        if !ends || self.n_vertices[1] > n || self.points.len() > n {
            return Err(invalid(
                "vertices of a common subdivision",
                "those of both triangulations and crossings",
            ));
        }
        in_range("corner", self.places.as_flattened().as_flattened().iter().map(|p| p.corner.into()), 3)
    }

    /// Checks that a subdivision of an archive is one of triangulations with these numbers of faces and half-edges.
    pub(crate) fn check_sides(&self, sides: [&Mesh; 2]) -> Result<()> {
        for (s, side) in sides.into_iter().enumerate() {
            in_range("face", self.faces[s].iter().map(|f| f.index()), side.n_faces())?;
            let along = self.halfedges_along.iter().filter_map(|both| both[s]);
            in_range("half-edge", along.map(|h| h.index()), side.n_halfedges())?;
            in_range("edge", self.crossings.iter().map(|point| point[s].edge.index()), side.n_edges())?;
        }
        Ok(())
    }

    /// Weights of a triangle's corners in its face on a side, `[corner of the triangle][corner of the face]`: barycentric coordinates if
    /// that is plane.
    pub fn barycentric(&self, side: usize, f: FaceId) -> [[f64; 3]; 3] {
        let halfedges = self.mesh.face_halfedges(f);
        [0, 1, 2].map(|k| self.place(side, (f, k), halfedges[k]).weights())
    }

    /// The place, in its face on a side, of a corner of a triangle, which is the origin of this half-edge.
    #[inline]
    pub(crate) fn place(&self, side: usize, (f, k): (FaceId, usize), h: HalfedgeId) -> PlaceInFace {
        let PackedPlace { corner, backward } = self.places[f.index()][k][side];
        let corner = usize::from(corner);
        let v = self.mesh.origin(h);
        let [from, to, third] = if let Some(crossing) = self.crossing(v) {
            let [from, to] = crossing[side].weights;
            [from, to, 0.0]
        } else if let Some(point) = self.points.get(v.index()) {
            let FacePoint { vertices, weights } = point[side];
            // A vertex of a triangulation is stored as itself with weight 1.
            if vertices[0] == v && weights[0] == 1.0 {
                return PlaceInFace::Corner(corner);
            }
            weights
        } else {
            return PlaceInFace::Corner(corner);
        };
        let mut all = [third; 3];
        (all[corner], all[(corner + 1) % 3]) = if backward { (to, from) } else { (from, to) };
        PlaceInFace::Weights(all)
    }

    /// The crossing at a vertex, if it is one.
    pub(super) fn crossing(&self, v: VertexId) -> Option<&Crossing> {
        self.crossings.get(v.index().wrapping_sub(self.n_vertices[0]))
    }

    /// The edge on a side that an edge is a part of, if it is part of one.
    pub fn edge(&self, side: usize, e: EdgeId) -> Option<EdgeId> {
        self.halfedges_along[e][side].map(HalfedgeId::edge)
    }

    /// The half-edge on a side that a half-edge runs along, in its direction, if it runs along one.
    pub fn halfedge(&self, side: usize, h: HalfedgeId) -> Option<HalfedgeId> {
        let along = self.halfedges_along[h.edge()][side]?;
        Some(if h.0 & 1 == 0 { along } else { along.twin() })
    }

    /// The homogeneous weights ([`CommonSubdivision::weight`]) of a triangle's corners.
    pub fn weights(&self, f: FaceId) -> [f64; 3] {
        self.mesh.face_vertices(f).map(|v| self.weight[v])
    }

    /// The least signed quotient of the area of a triangle and that of its face on a side: not negative where no piece folds.
    pub fn least_share(&self, side: usize) -> f64 {
        let share = |[a, b, c]: [[f64; 3]; 3]| {
            let minor = |i: usize, j: usize| b[i] * c[j] - b[j] * c[i];
            a[0] * minor(1, 2) + a[1] * minor(2, 0) + a[2] * minor(0, 1)
        };
        self.mesh.faces().map(|f| share(self.barycentric(side, f))).fold(1.0, f64::min)
    }
}

/// The error where faces of both triangulations do not overlap as the record of flips says, so that they are not of one surface.
pub(super) fn torn() -> Error {
    let message = "its faces and those of the final triangulation do not overlap as the flips say";
    Error::Connectivity { element: "mesh", index: 0, message }
}
