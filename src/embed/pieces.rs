//! The triangles that are laid out: the metric's triangulation, or a subdivision of it.

use crate::archive::{ArchiveReader, ArchiveWriter, Stored};
use crate::error::{Error, Result};
use crate::mesh::{EdgeId, FaceId, HalfedgeId, Mesh, PerEdge, VertexId};
use crate::metric::CommonSubdivision;
pub(super) use crate::metric::common_subdivision::{CORNERS, PlaceInFace};
use crate::topology::CutGraph;
use std::sync::Arc;

/// The triangles that are laid out (*pieces*). Each lies in one triangle of the metric's own triangulation (its *final face*) and in one
/// of the input.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum LayoutPieces {
    /// No edge was flipped: a piece is a face of the input and a final face at once.
    Mesh(Arc<Mesh>),
    /// The triangles of a common subdivision.
    Subdivision(Arc<CommonSubdivision>),
}

impl Stored for LayoutPieces {
    const LEAST: usize = 5;

    fn write(&self, to: &mut ArchiveWriter) {
        self.common_subdivision().cloned().write(to);
        if let LayoutPieces::Mesh(mesh) = self {
            mesh.write(to);
        }
    }

    fn read(from: &mut ArchiveReader<'_>) -> Result<Self> {
        match Option::read(from)? {
            Some(subdivision) => Ok(LayoutPieces::Subdivision(subdivision)),
            None => Stored::read(from).map(LayoutPieces::Mesh),
        }
    }
}

impl LayoutPieces {
    pub fn mesh(&self) -> &Mesh {
        match self {
            LayoutPieces::Mesh(mesh) => mesh,
            LayoutPieces::Subdivision(subdivision) => &subdivision.mesh,
        }
    }

    pub fn common_subdivision(&self) -> Option<&Arc<CommonSubdivision>> {
        match self {
            LayoutPieces::Mesh(_) => None,
            LayoutPieces::Subdivision(subdivision) => Some(subdivision),
        }
    }

    /// The face of the input that a piece lies in.
    pub fn input_face(&self, f: FaceId) -> FaceId {
        self.common_subdivision().map_or(f, |subdivision| subdivision.faces[0][f])
    }

    pub fn final_face(&self, f: FaceId) -> FaceId {
        self.common_subdivision().map_or(f, |subdivision| subdivision.faces[1][f])
    }

    /// The half-edge of a final face along which a half-edge of a piece runs; `None` if it runs through the inside of the face.
    pub fn final_halfedge(&self, h: HalfedgeId) -> Option<HalfedgeId> {
        self.common_subdivision().map_or(Some(h), |subdivision| subdivision.halfedge(1, h))
    }

    /// The edge of the input that contains an edge of the pieces; `None` if that runs through the inside of a face.
    pub fn input_edge(&self, e: EdgeId) -> Option<EdgeId> {
        self.common_subdivision().map_or(Some(e), |subdivision| subdivision.edge(0, e))
    }

    /// The half-edge of a face of the input along which a half-edge of a piece runs; `None` if it runs through the inside of the face.
    pub fn input_halfedge(&self, h: HalfedgeId) -> Option<HalfedgeId> {
        self.common_subdivision().map_or(Some(h), |subdivision| subdivision.halfedge(0, h))
    }

    /// The barycentric weights of a piece's corners in its face of the input.
    pub fn input_barycentric(&self, f: FaceId) -> [[f64; 3]; 3] {
        self.common_subdivision().map_or(CORNERS, |subdivision| subdivision.barycentric(0, f))
    }

    /// The barycentric weights of a piece's corners in its final face.
    pub fn final_barycentric(&self, f: FaceId) -> [[f64; 3]; 3] {
        self.common_subdivision().map_or(CORNERS, |subdivision| subdivision.barycentric(1, f))
    }

    /// Where corner `(piece, k)` lies in its input face; `h` is half-edge k of the piece.
    pub fn input_place(&self, corner: (FaceId, usize), h: HalfedgeId) -> PlaceInFace {
        self.common_subdivision()
            .map_or(PlaceInFace::Corner(corner.1), |subdivision| subdivision.place(0, corner, h))
    }

    /// Where corner `(piece, k)` lies in its final face; `h` is half-edge k of the piece.
    pub fn final_place(&self, corner: (FaceId, usize), h: HalfedgeId) -> PlaceInFace {
        self.common_subdivision()
            .map_or(PlaceInFace::Corner(corner.1), |subdivision| subdivision.place(1, corner, h))
    }

    /// A cut of the input as a cut of the pieces: segment by segment, each half-edge replaced by its parts.
    pub fn cut_of_input(&self, input: &Mesh, cut: &CutGraph) -> Result<CutGraph> {
        let marked = |subdivision: &CommonSubdivision, e: EdgeId| {
            subdivision.edge(0, e).is_some_and(|e| cut.is_cut[e])
        };
        self.cut_on_pieces(input, cut, marked, |h| self.input_halfedge(h))
    }

    /// A cut of the final triangulation as a cut of the pieces: segment by segment, each half-edge replaced by its parts.
    pub fn cut_of_final(&self, final_mesh: &Mesh, cut: &CutGraph) -> Result<CutGraph> {
        let marked = |subdivision: &CommonSubdivision, e: EdgeId| {
            subdivision.edge(1, e).is_some_and(|e| cut.is_cut[e])
        };
        self.cut_on_pieces(final_mesh, cut, marked, |h| self.final_halfedge(h))
    }

    /// A cut of a triangulation as a cut of the subdivision. `marked`: true if an edge of the subdivision lies on the cut;
    /// `coarse_halfedge`: the half-edge of the triangulation along which one of the subdivision runs.
    fn cut_on_pieces(
        &self,
        coarse: &Mesh,
        cut: &CutGraph,
        marked: impl Fn(&CommonSubdivision, EdgeId) -> bool,
        coarse_halfedge: impl Fn(HalfedgeId) -> Option<HalfedgeId>,
    ) -> Result<CutGraph> {
        let Some(subdivision) = self.common_subdivision() else { return Ok(cut.clone()) };
        // Both triangulations have the same vertices, and they come first in the subdivision.
        let is_crossing = |v: VertexId| v.index() >= subdivision.n_vertices[0];
        let torn = || Error::Layout("a cut does not run along the edges of the subdivision".into());
        let subdivided = |chain: &Vec<HalfedgeId>| -> Result<Vec<HalfedgeId>> {
            let mut parts = Vec::with_capacity(chain.len());
            for &h in chain {
                let part_from =
                    |v| subdivision.mesh.outgoing(v).find(|&part| coarse_halfedge(part) == Some(h));
                let mut part = part_from(coarse.origin(h)).ok_or_else(torn)?;
                parts.push(part);
                while is_crossing(subdivision.mesh.tip(part)) {
                    part = part_from(subdivision.mesh.tip(part)).ok_or_else(torn)?;
                    parts.push(part);
                }
            }
            Ok(parts)
        };
        Ok(CutGraph {
            is_cut: PerEdge::from_fn(subdivision.mesh.n_edges(), |e| marked(subdivision, e)),
            nodes: cut.nodes.clone(),
            segments: cut.segments.iter().map(subdivided).collect::<Result<_>>()?,
        })
    }
}
