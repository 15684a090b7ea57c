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

mod chords;
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
use crate::geometry::conformal::Vertex;
use crate::mesh::normal_trace::CurveCrossing;
use crate::mesh::{Curves, EdgeId, FaceId, HalfedgeId, Mesh, NormalCoordinates};
use crate::mesh::{PerEdge, PerFace, PerVertex, VertexId};
use intrinsic::Placement;
use pieces::{Corner, Pieces};
use strip::{Raw, Strips};

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

/// Where a corner of a triangle lies in a face: at the face's corner, or on the side that starts there, whose edge may run backward.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
struct Place {
    corner: u8,
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
    /// Per triangle and corner: place in the face of the input, in the final face.
    places: Vec<[[Place; 2]; 3]>,
}

/// Half-edges of the refinement per crossing and edge, at most: `2 · (2 sides + 3 inside a piece)`, with room.
const HALFEDGES: usize = 12;

impl Refinement {
    /// The common refinement; only the pieces in those faces of the input that `keep` names (of a double: [`crate::mesh::Double::
    /// is_original`]; the vertices kept must come first, as they do there). O(input + output), parallel inside a pool.
    ///
    /// `intrinsic` is the triangulation that isometric flips of the input have led to and the flow has started from, if they are not
    /// the same: edges are then drawn straight on the surface.
    ///
    /// Errors: [`Error::Size`]; [`Error::TooLarge`] for more crossings than can be numbered; [`Error::Connectivity`] if `normal` did
    /// not see every flip; [`Error::EdgeWeight`] where imaginary circles leave no straight line; [`Error::Domain`] at a vertex whose
    /// weights leave the range of doubles; [`Error::Cancelled`].
    pub fn new(
        input: Input,
        intrinsic: Option<Intrinsic>,
        result: Final,
        keep: &dyn Fn(FaceId) -> bool,
        control: &Control,
    ) -> Result<Refinement> {
        let n = input.mesh.n_vertices();
        check_size("final vertices", result.mesh.n_vertices(), n)?;
        check_size("final edges", result.mesh.n_edges(), input.mesh.n_edges())?;
        check_size("input u", input.u.len(), n)?;
        result.metric.check(result.mesh)?;
        let count = result.normal.check(result.mesh)?.saturating_add(input.mesh.n_edges());
        if count > u32::MAX as usize / HALFEDGES {
            return Err(Error::TooLarge { what: "crossings of input and final edges", count });
        }
        control.step(Stage::Layout, 0.0)?;
        let curves = Curves::trace(result.mesh, result.normal, control)?;
        let ends: Vec<_> = input.mesh.edges().map(|e| input.mesh.ends(e)).collect();
        let strips = Strips::new(&result);
        let raw = strips.crossings(&ends, &curves)?;
        control.check()?;
        let scales = Scales::new(input, result)?;
        let mut crossings = Vec::with_capacity(raw.len());
        let mut weight = scales.vertices();
        let placement = intrinsic
            .map(|intrinsic| Placement::new(intrinsic, input.geometry, &result, &strips, &scales, control))
            .transpose()?;
        let mut moved = Vec::new();
        for e in input.mesh.edges() {
            let strip = curves.crossings(e);
            let along = |(c, at): (usize, &CurveCrossing)| {
                scales.crossing(&raw[c], e, ends[e.index()], at.halfedge, result.mesh)
            };
            let mut placed: Vec<_> = curves.numbers(e).zip(strip).map(along).collect();
            if let Some(placement) = &placement {
                let is_moved = placement.place(e, strip, &mut placed)?;
                moved.resize(moved.len() + strip.len(), is_moved);
            }
            for (crossing, q) in placed {
                if !(q > 0.0 && q < f64::INFINITY) {
                    let vertex = ends[e.index()][0];
                    let need = "nearer to the start: a homogeneous weight on an edge there is beyond doubles";
                    return Err(Error::Domain { vertex: vertex.index(), u: result.metric.u[vertex], need });
                }
                crossings.push(crossing);
                weight.push(q);
            }
        }
        if placement.is_some() {
            Placement::settle(result.mesh, &curves, &mut crossings, &mut moved);
        }
        let pieces = Pieces::cut(input.mesh, &result, &curves, &moved, keep, control)?;
        assemble(input.mesh, result.mesh, crossings, weight, pieces)
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
            let Place { corner, backward } = self.places[f.index()][k][which];
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

/// What positions are in vectors: `log s` per vertex, in the input and in the final metric.
struct Scales {
    input: Vec<f64>,
    result: Vec<f64>,
}

impl Scales {
    fn new(input: Input, result: Final) -> Result<Scales> {
        let metric = result.metric;
        let log = |space: Space, u: &PerVertex<f64>| -> Result<Vec<f64>> {
            let scale = |v: usize| {
                let v = VertexId::from(v);
                let d = Vertex::new(space, metric.epsilon[v], u[v]).d;
                let s = if space == Space::E2 { u[v] } else { std::f64::consts::LN_2 + u[v] - d.ln() };
                let need = "inside the metric's domain";
                if s.is_finite() { Ok(s) } else { Err(Error::Domain { vertex: v.index(), u: u[v], need }) }
            };
            (0..u.len()).map(scale).collect()
        };
        Ok(Scales { input: log(input.geometry, input.u)?, result: log(metric.space, &metric.u)? })
    }

    /// Homogeneous weights of the input's vertices.
    fn vertices(&self) -> Vec<f64> {
        self.input.iter().zip(&self.result).map(|(a, b)| (a - b).exp()).collect()
    }

    /// A crossing of the input's edge `e` with the final half-edge `at`, and its homogeneous weight.
    fn crossing(
        &self,
        raw: &Raw,
        e: EdgeId,
        ends: [VertexId; 2],
        at: HalfedgeId,
        mesh: &Mesh,
    ) -> (Crossing, f64) {
        // Weights of positions, as w · exp(top).
        let positions = |w: [f64; 2], exponent: [i32; 2], ends: [VertexId; 2], scale: &[f64]| {
            let log = [0, 1].map(|k| {
                w[k].ln() + f64::from(exponent[k]) * std::f64::consts::LN_2 - scale[ends[k].index()]
            });
            let top = log[0].max(log[1]);
            let x = log.map(|x| (x - top).exp());
            (x.map(|w| w / (x[0] + x[1])), (x[0] + x[1]).ln() + top)
        };
        let along = [mesh.origin(at), mesh.tip(at)];
        let (input_weights, below) = positions(raw.meeting.diagonal, raw.exponent, ends, &self.input);
        let (final_weights, above) = positions(raw.meeting.edge, [0; 2], along, &self.result);
        let swap = at.0 & 1 == 1;
        let turned = |x: [f64; 2]| if swap { [x[1], x[0]] } else { x };
        let crossing = Crossing {
            input_edge: e,
            input_ends: ends,
            input_weights,
            final_edge: at.edge(),
            final_ends: mesh.ends(at.edge()),
            final_weights: turned(final_weights),
        };
        (crossing, (above - below).exp())
    }
}

/// Number what was kept without gaps.
fn assemble(
    input: &Mesh,
    result: &Mesh,
    crossings: Vec<Crossing>,
    weight: Vec<f64>,
    pieces: Pieces,
) -> Result<Refinement> {
    const UNUSED: u32 = u32::MAX;
    let mut vertex = vec![UNUSED; weight.len()];
    let mut edge = vec![UNUSED; pieces.origins.len()];
    for (sides, corners) in pieces.sides.iter().zip(&pieces.corners) {
        sides.iter().for_each(|h| edge[(h >> 1) as usize] = 0);
        corners.iter().for_each(|c| vertex[c.vertex as usize] = 0);
    }
    let number = |all: &mut [u32]| {
        let mut n = 0;
        for x in all.iter_mut().filter(|x| **x != UNUSED) {
            *x = n;
            n += 1;
        }
        n as usize
    };
    let (n_vertices, n_edges) = (number(&mut vertex), number(&mut edge));
    let mut origin = vec![0; 2 * n_edges];
    let mut sides = pieces.sides;
    for (sides, corners) in sides.iter_mut().zip(&pieces.corners) {
        for k in 0..3 {
            sides[k] = 2 * edge[(sides[k] >> 1) as usize] + (sides[k] & 1);
            origin[sides[k] as usize] = vertex[corners[k].vertex as usize];
            origin[sides[k] as usize ^ 1] = vertex[corners[(k + 1) % 3].vertex as usize];
        }
    }
    let place = |mesh: &Mesh, h: HalfedgeId| {
        let face = mesh.face(h).unwrap_or(FaceId(0));
        let corner = mesh.face_halfedges(face).iter().position(|&x| x == h).unwrap_or(0);
        (face, Place { corner: corner as u8, backward: h.0 & 1 == 1 })
    };
    let face_of =
        |corners: &[Corner; 3]| (place(input, corners[0].input).0, place(result, corners[0].result).0);
    let places = pieces
        .corners
        .iter()
        .map(|corners| corners.map(|c| [place(input, c.input).1, place(result, c.result).1]));
    let n = input.n_vertices();
    let kept = |i: &usize| vertex[*i] != UNUSED;
    Ok(Refinement {
        n_input_vertices: (0..n).filter(kept).count(),
        crossings: (0..crossings.len()).filter(|c| kept(&(n + c))).map(|c| crossings[c]).collect(),
        weight: (0..weight.len()).filter(kept).map(|v| weight[v]).collect::<Vec<_>>().into(),
        input_face: pieces.corners.iter().map(|c| face_of(c).0).collect::<Vec<_>>().into(),
        final_face: pieces.corners.iter().map(|c| face_of(c).1).collect::<Vec<_>>().into(),
        places: places.collect(),
        piece: pieces.piece.into(),
        origin: (0..edge.len())
            .filter(|&e| edge[e] != UNUSED)
            .map(|e| pieces.origins[e])
            .collect::<Vec<_>>()
            .into(),
        mesh: Mesh::assemble(n_vertices, origin, &sides)?,
    })
}
