//! Makes the common subdivision from the graph of two triangulations: triangulates the faces of the graph, and finds their places in both.

use super::super::cover::PlacedMesh;
use super::arcs::{NONE, OverlayGraph};
use super::stand::{SettledVertices, VertexPlace, WeightedPlace};
use crate::archive::stored;
use crate::error::{Error, Result};
use crate::mesh::{EdgeId, FaceId, HalfedgeId, Mesh, PerEdge, PerFace, Place};
use crate::metric::CommonSubdivision;
use crate::metric::common_subdivision::{Crossing, EdgePoint, Unpacked};
use std::sync::Arc;

/// A surface as it was given.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct GivenSurface {
    pub mesh: Arc<Mesh>,
    /// Per face in the domain: the given face that it is a part of, and the weights of its corners there.
    pub parts: Vec<(FaceId, [[f64; 3]; 3])>,
}
stored!(sections GivenSurface { mesh, parts });

/// The role of a vertex of the graph in one of the two triangulations.
enum VertexRole {
    Vertex,
    Inside(WeightedPlace),
    /// At the crossing of this number.
    Edge(usize),
}

/// The faces of the graph.
struct GraphPieces<'a> {
    arcs: &'a OverlayGraph,
    settled: &'a SettledVertices,
    meshes: [&'a Mesh; 2],
    /// Per half-edge, its number among those that leave its origin.
    turn: Vec<u32>,
}

/// The triangles of the common subdivision, on the surfaces as they were given.
#[derive(Default)]
struct SubdivisionTriangles {
    sides: Vec<[u32; 3]>,
    /// Per half-edge.
    origin: Vec<u32>,
    piece: Vec<u32>,
    faces: [Vec<FaceId>; 2],
    barycentric: [Vec<[[f64; 3]; 3]>; 2],
}

/// The pieces, triangulated.
///
/// # Errors
/// [`Error::Matching`] where a piece lies in several faces of one surface.
pub(super) fn subdivision(
    arcs: &OverlayGraph,
    settled: &SettledVertices,
    target: &PlacedMesh,
    given: [&GivenSurface; 2],
) -> Result<CommonSubdivision> {
    let mut turn = vec![NONE; arcs.origin.len()];
    for around in &arcs.around {
        around.iter().enumerate().for_each(|(k, &h)| turn[h as usize] = k as u32);
    }
    if turn.contains(&NONE) {
        return Err(torn());
    }
    let meshes = [settled.source.cover.mesh.as_ref(), target.cover.mesh.as_ref()];
    let pieces = GraphPieces { arcs, settled, meshes, turn };
    let mut triangles =
        SubdivisionTriangles { origin: arcs.origin.clone(), ..SubdivisionTriangles::default() };
    let mut seen = vec![false; arcs.origin.len()];
    let mut n_pieces = 0;
    for h in 0..arcs.origin.len() as u32 {
        if !seen[h as usize] && !pieces.is_outside(h) {
            let polygon = pieces.around(h, &mut seen);
            let corners = pieces.corners(&polygon)?;
            triangles.add(&polygon, &corners, n_pieces, given);
            n_pieces += 1;
        }
    }
    triangles.finish(&pieces, given)
}

impl GraphPieces<'_> {
    fn is_outside(&self, h: u32) -> bool {
        self.arcs.along[1][h as usize].is_some_and(|h| self.meshes[1].is_outside(h))
    }

    /// The half-edges around the piece to the left of one.
    fn around(&self, h: u32, seen: &mut [bool]) -> Vec<u32> {
        let mut polygon = Vec::with_capacity(6);
        let mut at = h;
        while !std::mem::replace(&mut seen[at as usize], true) {
            polygon.push(at);
            let around = &self.arcs.around[self.arcs.tip(at)];
            let k = self.turn[at as usize ^ 1] as usize;
            at = around[(k + around.len() - 1) % around.len()];
        }
        polygon
    }

    /// Per corner of a piece its places in both surfaces.
    fn corners(&self, polygon: &[u32]) -> Result<Vec<[Place; 2]>> {
        let before = |k: usize| polygon[(k + polygon.len() - 1) % polygon.len()];
        let of = |k: usize, s: usize| self.place(s, [before(k), polygon[k]]).ok_or_else(torn);
        let corners: Vec<[Place; 2]> =
            (0..polygon.len()).map(|k| Ok([of(k, 0)?, of(k, 1)?])).collect::<Result<_>>()?;
        let is_one = |s: usize| corners.iter().all(|c| c[s].face == corners[0][s].face);
        if polygon.len() < 3 || !is_one(0) || !is_one(1) {
            return Err(torn());
        }
        Ok(corners)
    }

    /// The role of a vertex in the source or the target.
    fn on(&self, s: usize, vertex: usize) -> Option<VertexRole> {
        let [n, m] = self.arcs.n;
        let of = |at: &VertexPlace| match at {
            VertexPlace::Vertex(_) => VertexRole::Vertex,
            VertexPlace::Inside(spot) | VertexPlace::Side(spot, _) => VertexRole::Inside(*spot),
        };
        if vertex >= n + m {
            Some(VertexRole::Edge(vertex - n - m))
        } else if (s == 0) == (vertex < n) {
            Some(VertexRole::Vertex)
        } else if s == 1 {
            Some(of(&self.settled.forward[vertex].at))
        } else {
            self.settled.backward[vertex - n].as_ref().map(|standing| of(&standing.at))
        }
    }

    /// The place, in the source or the target, of the corner of a piece between two of its half-edges.
    fn place(&self, s: usize, [into, out]: [u32; 2]) -> Option<Place> {
        let (mesh, along) = (self.meshes[s], &self.arcs.along[s]);
        let vertex = self.arcs.origin[out as usize] as usize;
        match self.on(s, vertex)? {
            VertexRole::Inside(spot) => Some(spot.place),
            VertexRole::Vertex => {
                // The corner is that of the next half-edge clockwise.
                let around = &self.arcs.around[vertex];
                let k = self.turn[out as usize] as usize;
                let clockwise = (0..around.len()).map(|i| around[(k + around.len() - i) % around.len()]);
                let (face, corner) = clockwise
                    .filter_map(|h| along[h as usize])
                    .find_map(|h| mesh.corner(h).filter(|_| !mesh.is_outside(h)))?;
                let mut weights = [0.0; 3];
                weights[corner] = 1.0;
                Some(Place { face, weights })
            }
            VertexRole::Edge(k) => {
                let h = along[out as usize].or(along[into as usize])?;
                let (face, corner) = mesh.corner(h)?;
                let crossing = &self.arcs.crossings[k];
                let tip = if s == 0 { crossing.along } else { f64::from(crossing.across) };
                let mut weights = [0.0; 3];
                let [from, to] = if h.0 & 1 == 0 { [1.0 - tip, tip] } else { [tip, 1.0 - tip] };
                (weights[corner], weights[(corner + 1) % 3]) = (from, to);
                Some(Place { face, weights })
            }
        }
    }

    /// The half-edge of a given surface that a half-edge of the graph runs along, if it runs along one.
    fn given_halfedge(&self, s: usize, given: &GivenSurface, h: HalfedgeId) -> Option<HalfedgeId> {
        let along = (*self.arcs.along[s].get(h.index())?)?;
        let inner = if self.meshes[s].is_outside(along) { along.twin() } else { along };
        let (part, k) = self.meshes[s].corner(inner)?;
        let (face, corners) = given.parts[part.index()];
        // On a side, both ends have no weight of the corner that is opposite to it.
        let opposite = (0..3).find(|&c| corners[k][c] == 0.0 && corners[(k + 1) % 3][c] == 0.0)?;
        let side = given.mesh.face_halfedges(face)[(opposite + 1) % 3];
        Some(if inner == along { side } else { side.twin() })
    }

    /// Homogeneous weight of a vertex: the sum of its weights in the target over that in the source.
    fn weight(&self, vertex: usize) -> f64 {
        match (self.on(0, vertex), self.on(1, vertex)) {
            (_, Some(VertexRole::Edge(k))) => self.arcs.crossings[k].weight,
            (_, Some(VertexRole::Inside(spot))) => spot.total,
            (Some(VertexRole::Inside(spot)), _) => 1.0 / spot.total,
            _ => 1.0,
        }
    }
}

impl SubdivisionTriangles {
    /// A piece as triangles around its first corner.
    fn add(&mut self, polygon: &[u32], corners: &[[Place; 2]], piece: u32, given: [&GivenSurface; 2]) {
        let size = polygon.len();
        let origin = |k: usize| self.origin[polygon[k] as usize];
        let vertices: Vec<u32> = (0..size).map(origin).collect();
        let mut left = polygon[0];
        for i in 1..size - 1 {
            let closing = if i + 2 == size {
                polygon[size - 1]
            } else {
                self.origin.extend([vertices[i + 1], vertices[0]]);
                self.origin.len() as u32 - 2
            };
            self.sides.push([left, polygon[i], closing]);
            self.piece.push(piece);
            for (s, given) in given.iter().enumerate() {
                let (face, parts) = given.parts[corners[0][s].face.index()];
                let within = |k: usize| {
                    let weights = corners[k][s].weights;
                    [0, 1, 2].map(|c| (0..3).map(|j| weights[j] * parts[j][c]).sum())
                };
                self.faces[s].push(face);
                self.barycentric[s].push([within(0), within(i), within(i + 1)]);
            }
            left = closing ^ 1;
        }
    }

    /// The common subdivision of these triangles, with its vertices in order.
    fn finish(self, pieces: &GraphPieces, given: [&GivenSurface; 2]) -> Result<CommonSubdivision> {
        let n_vertices = given.map(|given| given.mesh.n_vertices());
        let (order, crossings) = self.order(pieces, given, n_vertices);
        let mut number = vec![NONE; pieces.arcs.around.len()];
        order.iter().enumerate().for_each(|(k, &v)| number[v as usize] = k as u32);
        let origin = self.origin.iter().map(|&v| number[v as usize]).collect();
        let along = |e: EdgeId| [0, 1].map(|s| pieces.given_halfedge(s, given[s], e.halfedge()));
        let unpacked = Unpacked {
            mesh: Mesh::assemble(order.len(), origin, &self.sides)?,
            n_vertices,
            crossings,
            weight: order.iter().map(|&v| pieces.weight(v as usize)).collect::<Vec<_>>().into(),
            polygon_of: self.piece.into(),
            faces: self.faces.map(PerFace::from),
            halfedges_along: PerEdge::from_fn(self.origin.len() / 2, along),
            barycentric: self.barycentric,
        };
        Ok(CommonSubdivision::from_barycentric(unpacked, given.map(|given| &*given.mesh)))
    }

    /// The vertices in order: those of the given source, crossings of given edges, others; and these crossings.
    fn order(
        &self,
        pieces: &GraphPieces,
        given: [&GivenSurface; 2],
        n: [usize; 2],
    ) -> (Vec<u32>, Vec<Crossing>) {
        let arcs = pieces.arcs;
        let mut order: Vec<u32> = (0..n[0] as u32).collect();
        let mut seen = vec![false; arcs.around.len()];
        order.iter().for_each(|&v| seen[v as usize] = true);
        let (mut crossings, mut others) = (Vec::new(), Vec::new());
        for (t, sides) in self.sides.iter().enumerate() {
            for (k, &side) in sides.iter().enumerate() {
                let v = self.origin[side as usize];
                if std::mem::replace(&mut seen[v as usize], true) {
                    continue;
                }
                let on = |s: usize| on_edge(&given[s].mesh, self.faces[s][t], self.barycentric[s][t][k]);
                match on(0).zip(on(1)) {
                    Some((first, second)) => {
                        order.push(v);
                        crossings.push([first, second]);
                    }
                    None => others.push(v),
                }
            }
        }
        order.extend(others);
        (order, crossings)
    }
}

/// A place in a face as a point on an edge; `None` at vertices and inside.
fn on_edge(mesh: &Mesh, face: FaceId, weights: [f64; 3]) -> Option<EdgePoint> {
    let k =
        (0..3).find(|&k| weights[k] == 0.0 && weights[(k + 1) % 3] > 0.0 && weights[(k + 2) % 3] > 0.0)?;
    let h: HalfedgeId = mesh.face_halfedges(face)[(k + 1) % 3];
    let (from, to) = (weights[(k + 1) % 3], weights[(k + 2) % 3]);
    let weights = if h.0 & 1 == 0 { [from, to] } else { [to, from] };
    Some(EdgePoint { edge: h.edge(), ends: mesh.ends(h.edge()), weights })
}

fn torn() -> Error {
    Error::Matching("a piece of the overlay lies in several faces: lines are too near to each other".into())
}
