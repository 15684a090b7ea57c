//! The triangles that are laid out: the metric's triangulation, or a refinement of it.

use crate::error::{Error, Result};
use crate::mesh::{EdgeId, FaceId, HalfedgeId, Mesh, PerEdge, VertexId};
use crate::metric::Refinement;
pub(super) use crate::metric::refinement::{CORNERS, Place};
use crate::topology::CutGraph;
use std::sync::Arc;

/// The triangles that are laid out, the *pieces*, each in a *final face*: one of the triangulation that the metric lives on.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum LayoutPieces {
    /// The final faces themselves.
    Mesh(Arc<Mesh>),
    /// The triangles of a common refinement.
    Refinement(Arc<Refinement>),
}

impl LayoutPieces {
    pub fn mesh(&self) -> &Mesh {
        match self {
            LayoutPieces::Mesh(mesh) => mesh,
            LayoutPieces::Refinement(r) => &r.mesh,
        }
    }

    pub fn refinement(&self) -> Option<&Arc<Refinement>> {
        match self {
            LayoutPieces::Mesh(_) => None,
            LayoutPieces::Refinement(r) => Some(r),
        }
    }

    /// The face of the input that a piece lies in.
    pub fn input_face(&self, f: FaceId) -> FaceId {
        self.refinement().map_or(f, |r| r.input_face[f])
    }

    pub fn final_face(&self, f: FaceId) -> FaceId {
        self.refinement().map_or(f, |r| r.final_face[f])
    }

    /// The half-edge of a final face along which a half-edge of a piece runs; `None` if it runs through the inside of the face.
    pub fn final_halfedge(&self, h: HalfedgeId) -> Option<HalfedgeId> {
        self.refinement().map_or(Some(h), |r| r.final_halfedge(h))
    }

    /// The edge of the input that contains an edge of the pieces; `None` if that runs through the inside of a face.
    pub fn input_edge(&self, e: EdgeId) -> Option<EdgeId> {
        self.refinement().map_or(Some(e), |r| r.origin[e].input)
    }

    /// The half-edge of a face of the input along which a half-edge of a piece runs; `None` if it runs through the inside of the face.
    pub fn input_halfedge(&self, input: &Mesh, h: HalfedgeId) -> Option<HalfedgeId> {
        let Some(r) = self.refinement() else { return Some(h) };
        let (e, f) = (r.origin[h.edge()].input?, r.mesh.face(h)?);
        let k = r.mesh.face_halfedges(f).iter().position(|&side| side == h)?;
        // The half-edge starts at a corner of the face or on the side that starts there.
        let place = r.input_barycentric(f)[k];
        let corner = (0..3).find(|&c| place[c] > 0.0 && place[(c + 2) % 3] == 0.0)?;
        Some(input.face_halfedges(r.input_face[f])[corner]).filter(|g| g.edge() == e)
    }

    /// The barycentric weights of a piece's corners in its face of the input.
    pub fn input_barycentric(&self, f: FaceId) -> [[f64; 3]; 3] {
        self.refinement().map_or(CORNERS, |r| r.input_barycentric(f))
    }

    /// The barycentric weights of a piece's corners in its final face.
    pub fn final_barycentric(&self, f: FaceId) -> [[f64; 3]; 3] {
        self.refinement().map_or(CORNERS, |r| r.final_barycentric(f))
    }

    /// The place, in its face of the input, of the corner of a piece at the origin of this half-edge.
    pub fn input_place(&self, corner: (FaceId, usize), h: HalfedgeId) -> Place {
        self.refinement().map_or(Place::Corner(corner.1), |r| r.input_place(corner, h))
    }

    /// The place, in its final face, of the corner of a piece at the origin of this half-edge.
    pub fn final_place(&self, corner: (FaceId, usize), h: HalfedgeId) -> Place {
        self.refinement().map_or(Place::Corner(corner.1), |r| r.final_place(corner, h))
    }

    /// A cut of the input as a cut of the pieces, with the same segments.
    pub fn cut_of_input(&self, input: &Mesh, cut: &CutGraph) -> Result<CutGraph> {
        let marked = |r: &Refinement, e: EdgeId| r.origin[e].input.is_some_and(|e| cut.is_cut[e]);
        self.cut_on_pieces(input, cut, marked, |h| self.input_halfedge(input, h))
    }

    /// A cut of the final triangulation as a cut of the pieces, with the same segments.
    pub fn cut_of_final(&self, mesh: &Mesh, cut: &CutGraph) -> Result<CutGraph> {
        let marked = |r: &Refinement, e: EdgeId| r.origin[e].result.is_some_and(|e| cut.is_cut[e]);
        self.cut_on_pieces(mesh, cut, marked, |h| self.final_halfedge(h))
    }

    /// A cut of a triangulation as a cut of the refinement. `marked`: true if an edge of the refinement lies on the cut; `whole`: the
    /// half-edge of the triangulation along which one of the refinement runs.
    fn cut_on_pieces(
        &self,
        coarse: &Mesh,
        cut: &CutGraph,
        marked: impl Fn(&Refinement, EdgeId) -> bool,
        whole: impl Fn(HalfedgeId) -> Option<HalfedgeId>,
    ) -> Result<CutGraph> {
        let Some(r) = self.refinement() else { return Ok(cut.clone()) };
        let is_crossing = |v: VertexId| v.index() >= r.n_input_vertices;
        let torn = || Error::Layout("a cut does not run along the edges of the refinement".into());
        let fine = |chain: &Vec<HalfedgeId>| -> Result<Vec<HalfedgeId>> {
            let mut parts = Vec::with_capacity(chain.len());
            for &h in chain {
                let along = |v| r.mesh.outgoing(v).find(|&part| whole(part) == Some(h));
                let mut part = along(coarse.origin(h)).ok_or_else(torn)?;
                parts.push(part);
                while is_crossing(r.mesh.tip(part)) {
                    part = along(r.mesh.tip(part)).ok_or_else(torn)?;
                    parts.push(part);
                }
            }
            Ok(parts)
        };
        Ok(CutGraph {
            is_cut: PerEdge::from_fn(r.mesh.n_edges(), |e| marked(r, e)),
            nodes: cut.nodes.clone(),
            segments: cut.segments.iter().map(fine).collect::<Result<_>>()?,
        })
    }
}
