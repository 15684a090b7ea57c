//! The way back: the common refinement of the triangulation that a surface came with and of the one that flips have made of it.
//!
//! Each final triangle is cut by the input's edges into pieces, each of which lies in one triangle of either. On every piece the
//! map between the two is projective [SSP08, §3.4; GSC21, §5]: vertices are vectors v_i of Lorentz space
//! ([`crate::geometry::flip`]), a point of the piece is a vector
//!
//! ```text
//! P = Σ α_a v_a = Σ β_i v_i      over the corners a of its face of the input and i of its final face,
//! ```
//!
//! and in a metric with variables u the vector `s_i v_i` stands for the position of vertex i (plane: (x, y, 1), `s = e^u`; hyperboloid
//! or sphere: `s = 2 e^u/(1 + λ ε e^{2u})`). So P lies at the positions' combination with weights `α_a / s_a(0)` in the input, with
//! weights `β_i / s_i` in the final face. Weights that are divided by their sum are called *barycentric* here; the quotient of the
//! two sums is the homogeneous weight of the point, the `q` of a projective texture coordinate: q · (final position) is linear in the
//! input position, as vectors.
//!
//! Where isometric flips come before those inside the class ([`Intrinsic`]), edges of the input are drawn straight on the
//! surface; in the class they are straight otherwise.

mod assemble;
mod chords;
mod crossings;
mod geodesic;
mod intrinsic;
mod maps;
mod order;
mod pieces;
mod strip;

pub use intrinsic::Intrinsic;
pub use maps::{PointMap, Values};
pub use pieces::Origin;

use super::lengths::Metric;
use crate::control::{Control, Stage};
use crate::error::{Error, Result, check_size};
use crate::geometry::Space;
use crate::mesh::{Curves, EdgeId, FaceId, HalfedgeId, Mesh, NormalCoordinates};
use crate::mesh::{PerEdge, PerFace, PerVertex, VertexId};
use assemble::assemble;
use crossings::{Drawn, Lines};
use pieces::{Overlay, Pieces};

/// The surface as it came.
#[derive(Debug, Clone, Copy)]
pub struct Input<'a> {
    /// Its triangulation, before any flip.
    pub mesh: &'a Mesh,
    /// Geometry of its lengths.
    pub geometry: Space,
    /// Variables u of its metric in that geometry (V entries): [`super::Initial::input_u`].
    pub u: &'a PerVertex<f64>,
}

/// The surface after a flow.
#[derive(Debug, Clone, Copy)]
pub struct Final<'a> {
    /// Its triangulation, after all flips.
    pub mesh: &'a Mesh,
    /// Its metric.
    pub metric: &'a Metric,
    /// The input's edges on it: every flip recorded, isometric ones too.
    pub normal: &'a NormalCoordinates,
}

/// The triangulations of one surface between which a refinement leads.
#[derive(Debug, Clone, Copy)]
pub struct Triangulations<'a> {
    /// The one that the surface came with.
    pub input: Input<'a>,
    /// The one that isometric flips of the input have led to and the flow has started from, if that is another one: the edges of the
    /// input are then drawn straight on the surface.
    pub intrinsic: Option<Intrinsic<'a>>,
    /// The one after the flow.
    pub result: Final<'a>,
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

/// Where in a face a corner of a triangle of the refinement lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct OnFace {
    /// A corner of the refinement that is a vertex lies at this corner of the face, a crossing on the side that starts there.
    corner: u8,
    /// Whether that side runs against its edge.
    backward: bool,
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
    places: Vec<[[OnFace; 2]; 3]>,
}

/// Half-edges of the refinement per crossing and edge, at most: 2 · (2 sides + 3 edges inside a piece), and 2 to spare. It bounds the
/// number of crossings whose refinement u32 can number.
const HALFEDGES_PER_CROSSING: usize = 12;

impl Triangulations<'_> {
    /// Whether arrays have the sizes of the meshes, and crossings can be numbered.
    fn check(&self) -> Result<()> {
        let Triangulations { input, intrinsic, result } = self;
        check_size("final vertices", result.mesh.n_vertices(), input.mesh.n_vertices())?;
        check_size("final edges", result.mesh.n_edges(), input.mesh.n_edges())?;
        check_size("input u", input.u.len(), input.mesh.n_vertices())?;
        result.metric.check(result.mesh)?;
        let count = result.normal.check(result.mesh)?.saturating_add(input.mesh.n_edges());
        check_count("crossings of input and final edges", count)?;
        let Some(Intrinsic { mesh, lengths, given, normal }) = intrinsic else { return Ok(()) };
        check_size("intrinsic edges", mesh.n_edges(), result.mesh.n_edges())?;
        check_size("intrinsic lengths", lengths.len(), mesh.n_edges())?;
        check_count("crossings of input and intrinsic edges", given.check(mesh)?)?;
        check_count("crossings of intrinsic and final edges", normal.check(result.mesh)?)
    }
}

fn check_count(what: &'static str, count: usize) -> Result<()> {
    if count > u32::MAX as usize / HALFEDGES_PER_CROSSING {
        return Err(Error::TooLarge { what, count });
    }
    Ok(())
}

impl Refinement {
    /// The common refinement, of the pieces in those faces of the input that `keep` names (of a double those of
    /// [`crate::mesh::Double::is_original`]; the vertices that are kept must come first, as they do there). O(input + output), parallel
    /// inside a pool.
    ///
    /// # Errors
    /// - [`Error::Size`].
    /// - [`Error::TooLarge`] for more crossings than can be numbered.
    /// - [`Error::Connectivity`] if the normal coordinates did not see every flip.
    /// - [`Error::EdgeWeight`] where imaginary circles leave no straight line.
    /// - [`Error::Domain`] at a vertex whose weights leave the range of doubles.
    /// - [`Error::Cancelled`].
    pub fn new(all: Triangulations, keep: &dyn Fn(FaceId) -> bool, control: &Control) -> Result<Refinement> {
        all.check()?;
        let Triangulations { input, result, .. } = all;
        control.step(Stage::Layout, 0.0)?;
        let curves = Curves::trace(result.mesh, result.normal, control)?;
        let drawn = Drawn::new(&all, &Lines::new(input, &result)?, &curves, control)?;
        let overlay = Overlay { input: input.mesh, result: &result, curves: &curves, moved: &drawn.moved };
        let pieces = Pieces::cut(overlay, keep, control)?;
        assemble(pieces, drawn.crossings, drawn.weight)
    }

    /// Weights of a triangle's corners in its face of the input, `[corner of the triangle][corner of the face]`: barycentric
    /// coordinates if that is plane.
    pub fn input_barycentric(&self, f: FaceId) -> [[f64; 3]; 3] {
        self.barycentric(f, 0)
    }

    /// Weights of a triangle's corners in its final face.
    pub fn final_barycentric(&self, f: FaceId) -> [[f64; 3]; 3] {
        self.barycentric(f, 1)
    }

    fn barycentric(&self, f: FaceId, which: usize) -> [[f64; 3]; 3] {
        let vertices = self.mesh.face_vertices(f);
        [0, 1, 2].map(|k| {
            let OnFace { corner, backward } = self.places[f.index()][k][which];
            let corner = usize::from(corner);
            let mut all = [0.0; 3];
            match self.crossing(vertices[k]) {
                None => all[corner] = 1.0,
                Some(crossing) => {
                    let w = if which == 0 { crossing.input_weights } else { crossing.final_weights };
                    let [from, to] = if backward { [w[1], w[0]] } else { w };
                    (all[corner], all[(corner + 1) % 3]) = (from, to);
                }
            }
            all
        })
    }

    /// The crossing that a vertex is, if it is none of the input's.
    pub fn crossing(&self, v: VertexId) -> Option<&Crossing> {
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
