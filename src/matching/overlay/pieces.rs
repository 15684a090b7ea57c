//! The faces of the graph that two triangulations make, as triangles with their places in both.

use super::super::cover::PlacedMesh;
use super::arcs::{Arcs, NONE};
use super::stand::{At, Settled, Spot};
use crate::error::{Error, Result};
use crate::mesh::{EdgeId, FaceId, HalfedgeId, Mesh, PerFace};
use crate::metric::Overlay;
use crate::metric::overlay::Meeting;
use std::sync::Arc;

/// A surface as it was given.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Given {
    pub mesh: Arc<Mesh>,
    /// Per face in the domain: the face that it is a part of, and the weights of its corners there.
    pub parts: Vec<(FaceId, [[f64; 3]; 3])>,
}

/// A place in a face: its face and its barycentric coordinates there.
type Lies = (FaceId, [f64; 3]);

/// What a vertex of the graph is on one of the two.
enum On {
    Vertex,
    At(Spot),
    /// On an edge that crosses one of the other.
    Edge(usize),
}

struct Pieces<'a> {
    arcs: &'a Arcs,
    settled: &'a Settled,
    meshes: [&'a Mesh; 2],
    /// Per half-edge, its number among those that leave its origin.
    turn: Vec<u32>,
}

/// The triangles of an overlay, of the surfaces as they were given.
#[derive(Default)]
struct Triangles {
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
pub(super) fn overlay(
    arcs: &Arcs,
    settled: &Settled,
    target: &PlacedMesh,
    given: [&Given; 2],
) -> Result<Overlay> {
    let mut turn = vec![NONE; arcs.origin.len()];
    for around in &arcs.around {
        around.iter().enumerate().for_each(|(k, &h)| turn[h as usize] = k as u32);
    }
    if turn.contains(&NONE) {
        return Err(torn());
    }
    let meshes = [settled.source.cover.mesh.as_ref(), target.cover.mesh.as_ref()];
    let pieces = Pieces { arcs, settled, meshes, turn };
    let mut triangles = Triangles { origin: arcs.origin.clone(), ..Triangles::default() };
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

impl Pieces<'_> {
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
    fn corners(&self, polygon: &[u32]) -> Result<Vec<[Lies; 2]>> {
        let before = |k: usize| polygon[(k + polygon.len() - 1) % polygon.len()];
        let of = |k: usize, s: usize| self.place(s, [before(k), polygon[k]]).ok_or_else(torn);
        let corners: Vec<[Lies; 2]> =
            (0..polygon.len()).map(|k| Ok([of(k, 0)?, of(k, 1)?])).collect::<Result<_>>()?;
        let is_one = |s: usize| corners.iter().all(|c| c[s].0 == corners[0][s].0);
        if polygon.len() < 3 || !is_one(0) || !is_one(1) {
            return Err(torn());
        }
        Ok(corners)
    }

    /// What a vertex is on the source or the target.
    fn on(&self, s: usize, vertex: usize) -> Option<On> {
        let [n, m] = self.arcs.n;
        let of = |at: &At| match at {
            At::Vertex(_) => On::Vertex,
            At::Inside(spot) | At::Side(spot, _) => On::At(*spot),
        };
        if vertex >= n + m {
            Some(On::Edge(vertex - n - m))
        } else if (s == 0) == (vertex < n) {
            Some(On::Vertex)
        } else if s == 1 {
            Some(of(&self.settled.forward[vertex].at))
        } else {
            self.settled.backward[vertex - n].as_ref().map(|standing| of(&standing.at))
        }
    }

    /// The place, in the source or the target, of the corner of a piece between two of its half-edges.
    fn place(&self, s: usize, [into, out]: [u32; 2]) -> Option<Lies> {
        let (mesh, along) = (self.meshes[s], &self.arcs.along[s]);
        let vertex = self.arcs.origin[out as usize] as usize;
        match self.on(s, vertex)? {
            On::At(spot) => Some((spot.place.face, spot.place.weights)),
            On::Vertex => {
                // The corner is that of the next half-edge clockwise.
                let around = &self.arcs.around[vertex];
                let k = self.turn[out as usize] as usize;
                let clockwise = (0..around.len()).map(|i| around[(k + around.len() - i) % around.len()]);
                let (face, corner) = clockwise
                    .filter_map(|h| along[h as usize])
                    .find_map(|h| mesh.corner(h).filter(|_| !mesh.is_outside(h)))?;
                let mut weights = [0.0; 3];
                weights[corner] = 1.0;
                Some((face, weights))
            }
            On::Edge(k) => {
                let h = along[out as usize].or(along[into as usize])?;
                let (face, corner) = mesh.corner(h)?;
                let crossing = &self.arcs.crossings[k];
                let tip = if s == 0 { crossing.along } else { f64::from(crossing.across) };
                let mut weights = [0.0; 3];
                let [from, to] = if h.0 & 1 == 0 { [1.0 - tip, tip] } else { [tip, 1.0 - tip] };
                (weights[corner], weights[(corner + 1) % 3]) = (from, to);
                Some((face, weights))
            }
        }
    }

    /// Sum of the weights in the target over that in the source.
    fn weight(&self, vertex: usize) -> f64 {
        match (self.on(0, vertex), self.on(1, vertex)) {
            (_, Some(On::Edge(k))) => self.arcs.crossings[k].weight,
            (_, Some(On::At(spot))) => spot.total,
            (Some(On::At(spot)), _) => 1.0 / spot.total,
            _ => 1.0,
        }
    }
}

impl Triangles {
    /// A piece as triangles around its first corner.
    fn add(&mut self, polygon: &[u32], corners: &[[Lies; 2]], piece: u32, given: [&Given; 2]) {
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
                let (face, parts) = given.parts[corners[0][s].0.index()];
                let within = |k: usize| {
                    let weights = corners[k][s].1;
                    [0, 1, 2].map(|c| (0..3).map(|j| weights[j] * parts[j][c]).sum())
                };
                self.faces[s].push(face);
                self.barycentric[s].push([within(0), within(i), within(i + 1)]);
            }
            left = closing ^ 1;
        }
    }

    /// With the vertices in the order of an overlay.
    fn finish(self, pieces: &Pieces, given: [&Given; 2]) -> Result<Overlay> {
        let n_vertices = given.map(|given| given.mesh.n_vertices());
        let (order, crossings) = self.order(pieces, given, n_vertices);
        let mut number = vec![NONE; pieces.arcs.around.len()];
        order.iter().enumerate().for_each(|(k, &v)| number[v as usize] = k as u32);
        let origin = self.origin.iter().map(|&v| number[v as usize]).collect();
        let [of_source, of_target] = self.barycentric;
        Ok(Overlay {
            mesh: Mesh::assemble(order.len(), origin, &self.sides)?,
            n_vertices,
            crossings,
            piece: self.piece.into(),
            faces: self.faces.map(PerFace::from),
            barycentric: [of_source.into(), of_target.into()],
            weight: order.iter().map(|&v| pieces.weight(v as usize)).collect::<Vec<_>>().into(),
        })
    }

    /// The vertices in order: those of the given source, crossings of edges that were given, others.
    fn order(&self, pieces: &Pieces, given: [&Given; 2], n: [usize; 2]) -> (Vec<u32>, Vec<Meeting>) {
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

/// The edge that a place in a face lies on, and the weight of its second end; `None` at vertices and inside.
fn on_edge(mesh: &Mesh, face: FaceId, weights: [f64; 3]) -> Option<(EdgeId, f64)> {
    let k =
        (0..3).find(|&k| weights[k] == 0.0 && weights[(k + 1) % 3] > 0.0 && weights[(k + 2) % 3] > 0.0)?;
    let h: HalfedgeId = mesh.face_halfedges(face)[(k + 1) % 3];
    Some((h.edge(), weights[if h.0 & 1 == 0 { (k + 2) % 3 } else { (k + 1) % 3 }]))
}

fn torn() -> Error {
    Error::Matching("a piece of the overlay lies in several faces: lines are too near to each other".into())
}
