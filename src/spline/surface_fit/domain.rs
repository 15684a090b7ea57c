//! The domain of splines over a whole surface: a coarse flat triangulation with a chart for each triangle.

use super::coarse::CoarseTriangulation;
use super::infinity::{BareHole, InfinityHole};
use super::similarity::PlaneSimilarity;
use crate::control::Control;
use crate::error::{Error, Result};
use crate::geometry::Space;
use crate::geometry::complex::{
    Complex, add, conj, cross, distance, dot, doubled_area, mul, norm2, scale, sub, unit,
};
use crate::geometry::plane_triangle::PlaneTriangle;
use crate::mesh::{FaceId, HalfedgeId, Mesh, PerFace, PerHalfedge, PerVertex, Place, VertexId};
use crate::spline::triangular::knots::{KnotDirections, share_of_omega};
use crate::spline::triangular::overlap::overlaps;
use crate::spline::{Parameter, Patch, SplineSpace, Support, multi_indices};
use std::collections::HashMap;
use std::f64::consts::TAU;

/// Largest curvature, in radians, of a vertex that counts as flat.
const FLAT: f64 = 1e-6;
/// Least depth, as a share of a triangle, to which the knots of another triangle must reach into it for its basis functions to be evaluated
/// there: above rounding.
const REACH: f64 = 1e-12;
/// Angle around a singular vertex, in radians, between two triangles there from which on the basis functions of one do not reach the other
/// outside the core of the hole.
const APART: f64 = std::f64::consts::FRAC_PI_2;
/// Largest total angle, in radians, of two triangles at a singular vertex and the triangles between them for which their charts are
/// compared: with more, they overlap in the plane without overlapping on the surface.
const MOST_TOGETHER: f64 = TAU - std::f64::consts::FRAC_PI_6;
/// Factors by which the knots of a vertex are moved away from it; the first one that every triangle there allows is taken.
const WIDER: [f64; 4] = [2.5, 2.0, 1.5, 1.2];
/// Least area of Ω over that of its triangle after knots are moved away.
const LEAST_OMEGA: f64 = 0.02;
/// Most developed triangles whose basis functions may reach into one triangle: 13 are usual, up to 100 occur near singular vertices.
const MOST_DEVELOPED: usize = 1000;
/// Most triangles that a walk crosses; its steps are shorter than a triangle.
const MOST_TRIANGLES: usize = 16;
/// Distance between the corners of two developments of a triangle, in units of its longest side, below which they are the same.
pub(super) const SAME: f64 = 1e-6;

/// A triangulated flat surface with a chart for each triangle: corner 0 at 0, corner 1 on the positive axis, the longest side of length 1.
#[derive(Debug, Clone)]
pub struct SurfaceDomain {
    pub(super) coarse: CoarseTriangulation,
    pub(super) corners: PerFace<[Complex; 3]>,
    /// For each face the length that is 1 in its chart.
    pub(super) unit: PerFace<f64>,
    /// For each half-edge its angle from the first half-edge of its origin, counterclockwise.
    pub(super) angle: PerHalfedge<f64>,
    /// For each vertex, true if the surface is flat there (for a boundary vertex: if the boundary is straight there).
    pub(super) is_flat: PerVertex<bool>,
    /// The hole around the vertex at infinity, if the surface is a sphere in the plane.
    pub(super) infinity: Option<InfinityHole>,
    /// The holes around singular vertices whose total angle is no multiple of 2π, as they are planned.
    pub(super) bare: HashMap<VertexId, BareHole>,
}

impl SurfaceDomain {
    /// The domain with a chart for each triangle of a triangulation.
    ///
    /// # Errors
    /// Those of [`crate::metric::curvature()`].
    pub fn new(coarse: CoarseTriangulation) -> Result<SurfaceDomain> {
        let CoarseTriangulation { mesh, lengths, .. } = &coarse;
        let curvature = crate::metric::curvature(mesh, Space::E2, lengths)?.at;
        let is_flat = PerVertex::from_fn(mesh.n_vertices(), |v: VertexId| curvature[v].abs() <= FLAT);
        let unit = PerFace::from_fn(mesh.n_faces(), |f: FaceId| {
            mesh.opposite_edges(f).into_iter().map(|e| lengths[e]).fold(0.0, f64::max)
        });
        let triangle = |f: FaceId| {
            let sides = mesh.opposite_edges(f).map(|e| lengths[e] / unit[f]);
            (sides, PlaneTriangle::from_sides(sides))
        };
        let corners = PerFace::from_fn(mesh.n_faces(), |f: FaceId| {
            let ([_, ca, ab], triangle) = triangle(f);
            [[0.0; 2], [ab, 0.0], scale(ca, triangle.direction[0])]
        });
        let mut angle = PerHalfedge::filled(mesh.n_halfedges(), 0.0);
        for v in mesh.vertices() {
            let mut sum = 0.0;
            for h in mesh.fan(v) {
                angle[h] = sum;
                if let Some((f, k)) = mesh.corner(h) {
                    let [c, s] = triangle(f).1.direction[k];
                    sum += s.atan2(c);
                }
            }
        }
        Ok(SurfaceDomain { corners, unit, angle, is_flat, coarse, infinity: None, bare: HashMap::new() })
    }

    /// The triangulation.
    pub fn coarse(&self) -> &CoarseTriangulation {
        &self.coarse
    }

    /// The corners of a triangle in its chart.
    pub fn corners(&self, f: FaceId) -> [Complex; 3] {
        self.corners[f]
    }

    /// The inner vertices at which the surface is not flat.
    pub fn singular(&self) -> Vec<VertexId> {
        let mesh = &self.coarse.mesh;
        mesh.vertices().filter(|&v| self.is_cone(v)).collect()
    }

    /// The sum of the angles at a vertex.
    pub fn total_angle(&self, v: VertexId) -> f64 {
        let spokes = self.coarse.mesh.fan(v);
        spokes.last().map_or(0.0, |&h| self.angle[h] + self.angle_at(h))
    }

    /// The angle of the triangle on the left of a half-edge, at its origin.
    fn angle_at(&self, h: HalfedgeId) -> f64 {
        let Some((f, k)) = self.coarse.mesh.corner(h) else { return 0.0 };
        let [a, b, c] = [0, 1, 2].map(|j| self.corners[f][(k + j) % 3]);
        cross(sub(b, a), sub(c, a)).atan2(dot(sub(b, a), sub(c, a)))
    }

    /// The distance of a vertex from the sides opposite it, in the unit of the metric: its triangles cover a disk of this radius.
    pub fn clearance(&self, v: VertexId) -> f64 {
        let distance_to_side = |h: HalfedgeId| {
            let (f, k) = self.coarse.mesh.corner(h)?;
            let [a, b, c] = [0, 1, 2].map(|j| self.corners[f][(k + j) % 3]);
            Some(self.unit[f] * distance(a, nearest_on_side(a, b, c)))
        };
        self.coarse.mesh.fan(v).into_iter().filter_map(distance_to_side).fold(f64::INFINITY, f64::min)
    }

    pub(super) fn is_cone(&self, v: VertexId) -> bool {
        !self.is_flat[v] && !self.coarse.mesh.is_boundary_vertex(v)
    }

    /// The coordinates of a place in the chart of its triangle.
    pub fn parameter(&self, place: Place) -> Parameter {
        let corners = self.corners[place.face];
        let [x, y] = (0..3).fold([0.0; 2], |sum, k| add(sum, scale(place.weights[k], corners[k])));
        Parameter { patch: place.face.0, x, y }
    }

    /// The places of the first `count` vertices of the fine triangulation; those beyond the triangles are in the chart of the hole at
    /// infinity.
    ///
    /// # Errors
    /// [`Error::Layout`] for a vertex that has none.
    pub fn places(&self, count: usize) -> Result<Vec<Parameter>> {
        let place = |v: VertexId| {
            let beyond = || self.infinity.as_ref()?.place(v);
            let place = self.coarse.places[v].map(|place| self.parameter(place)).or_else(beyond);
            place.ok_or_else(|| {
                Error::Layout(format!("vertex {v} has no place in the triangles of the domain"))
            })
        };
        (0..count as u32).map(|v| place(VertexId(v))).collect()
    }

    /// The place at the end of a straight line from another one, given by a vector of its chart. On the boundary, and after 16 triangles,
    /// the walk ends at the nearest place in the last triangle.
    pub fn walk(&self, from: Parameter, by: Complex) -> Parameter {
        let mesh = &self.coarse.mesh;
        let (mut f, mut at) = (FaceId(from.patch), add([from.x, from.y], by));
        for step in 0.. {
            let corners = self.corners[f];
            let side = |k: usize| [corners[k], corners[(k + 1) % 3]];
            let height =
                |k: usize| doubled_area([at, side(k)[0], side(k)[1]]) / distance(side(k)[0], side(k)[1]);
            let lowest = (0..3).min_by(|&j, &k| height(j).total_cmp(&height(k))).unwrap_or(0);
            if height(lowest) >= 0.0 {
                break;
            }
            match self.across(mesh.face_halfedges(f)[lowest]) {
                Some((g, across)) if step < MOST_TRIANGLES => (f, at) = (g, across.inverse().of(at)),
                _ => {
                    at = nearest(at, corners);
                    break;
                }
            }
        }
        Parameter { patch: f.0, x: at[0], y: at[1] }
    }

    /// The space of triangular B-splines of a degree on this domain. `spread` is that of [`crate::spline::KnotOptions`].
    ///
    /// Knots are in general position around flat vertices and along straight boundaries; they coincide at corners of the boundary. Knots of
    /// flat vertices are farther away where every triangle there keeps a region Ω. Around infinity, knots of the boundary lie as others do,
    /// because the spline ends in the middle of the hole. A singular vertex whose total angle is a multiple of 2π has its knots in general
    /// position in the core of its hole, so that outside the core every flat region is as in the plane, and splines are as smooth there. At
    /// other singular vertices all knots coincide.
    ///
    /// # Errors
    /// Those of [`SplineSpace::new`]; [`Error::Cancelled`].
    pub fn space(&self, degree: usize, spread: f64, control: &Control) -> Result<SplineSpace> {
        let mesh = &self.coarse.mesh;
        let mut around = PerVertex::from_fn(mesh.n_vertices(), |v: VertexId| {
            let around = self.surroundings(v);
            let spread = match (self.is_flat[v], self.hole(v)) {
                (true, _) => spread,
                // The spline ends there, and the filling of the hole is the surface.
                _ if self.infinity.is_some() => spread,
                (false, Ok(hole)) => spread.min(hole.core() / around.radius),
                _ => 0.0,
            };
            around.knots([0.0; 2], degree, spread)
        });
        self.widen(&mut around);
        let mut numbers = HashMap::new();
        let patches: Vec<Patch> = mesh
            .faces()
            .map(|f| {
                let knots = std::array::from_fn(|k| self.in_chart(f, k, &around[mesh.face_vertices(f)[k]]));
                let control = multi_indices(degree).map(|beta| {
                    let next = numbers.len() as u32;
                    *numbers.entry(owner(mesh, f, beta)).or_insert(next)
                });
                Patch { chart: f.0, control: control.collect(), knots }
            })
            .collect();
        let supports = |f| control.check().and_then(|()| self.supports(f, &patches));
        let supports = mesh.faces().map(supports).collect::<Result<_>>()?;
        control.check()?;
        SplineSpace::new(degree, patches, supports)
    }

    /// Moves the knots of flat vertices farther away while every triangle keeps a region Ω: the smallest triangle at a vertex limits only
    /// its own corners.
    fn widen(&self, around: &mut PerVertex<Vec<Complex>>) {
        let mesh = &self.coarse.mesh;
        for v in mesh.vertices().filter(|&v| self.is_flat[v]) {
            let faces: Vec<FaceId> = mesh.fan(v).into_iter().filter_map(|h| mesh.face(h)).collect();
            for factor in WIDER {
                let before = around[v].clone();
                around[v].iter_mut().for_each(|p| *p = scale(factor, *p));
                let knots = |f: FaceId| {
                    std::array::from_fn(|k| self.in_chart(f, k, &around[mesh.face_vertices(f)[k]]))
                };
                if faces.iter().all(|&f| share_of_omega(&knots(f)) >= LEAST_OMEGA) {
                    break;
                }
                around[v] = before;
            }
        }
    }

    /// The directions around a vertex in its own plane: the unit is that of the metric, the first half-edge points along the x axis.
    fn surroundings(&self, v: VertexId) -> KnotDirections {
        let CoarseTriangulation { mesh, lengths, .. } = &self.coarse;
        let inscribed = |h: &HalfedgeId| {
            let f = mesh.face(*h)?;
            let sides = mesh.opposite_edges(f).map(|e| lengths[e]);
            Some(2.0 * PlaneTriangle::from_sides(sides).area / (sides[0] + sides[1] + sides[2]))
        };
        let spokes: Vec<HalfedgeId> = mesh.fan(v);
        let radius = spokes.iter().filter_map(inscribed).fold(f64::INFINITY, f64::min);
        let direction = |angle: f64| [angle.cos(), angle.sin()];
        let edges = spokes.iter().map(|&h| direction(self.angle[h])).collect();
        let lines =
            if mesh.is_boundary_vertex(v) && self.infinity.is_none() { vec![[1.0, 0.0]] } else { Vec::new() };
        KnotDirections { radius, edges, lines }
    }

    /// Vectors from the plane of a vertex, as points of the chart of a triangle that has the vertex as corner k.
    fn in_chart(&self, f: FaceId, k: usize, vectors: &[Complex]) -> Vec<Complex> {
        let h = self.coarse.mesh.face_halfedges(f)[k];
        let corners = self.corners[f];
        let turn =
            mul(unit(sub(corners[(k + 1) % 3], corners[k])), [self.angle[h].cos(), -self.angle[h].sin()]);
        vectors.iter().map(|&p| add(corners[k], mul(turn, scale(1.0 / self.unit[f], p)))).collect()
    }

    /// The patches whose basis functions reach into triangle f, with the maps of their charts to its own.
    fn supports(&self, f: FaceId, patches: &[Patch]) -> Result<Vec<Support>> {
        let mesh = &self.coarse.mesh;
        let mut found = vec![DevelopedTriangle { face: f, to: PlaneSimilarity::IDENTITY, around: None }];
        let mut next = 0;
        while let Some(&way) = found.get(next) {
            next += 1;
            if next > MOST_DEVELOPED {
                let message = format!(
                    "its basis functions are reached in more than {MOST_DEVELOPED} ways: triangles are too large for a thin part of the surface; take more of them"
                );
                return Err(Error::Spline { what: "patch", index: f.index(), message });
            }
            for h in mesh.face_halfedges(way.face) {
                let Some((g, across)) = self.across(h) else { continue };
                // The cones at the ends of this edge, each with the half-edge of g there.
                let ends = [(mesh.origin(h), mesh.next(h.twin())), (mesh.tip(h), h.twin())];
                let cones: Vec<(VertexId, HalfedgeId)> =
                    ends.into_iter().filter(|&(v, _)| self.is_cone(v)).collect();
                let fan = |&(v, beyond): &(VertexId, HalfedgeId)| {
                    let before = way.around.filter(|fan| fan.vertex == v);
                    let first = || if v == mesh.origin(h) { h } else { mesh.next(h) };
                    let before = before.unwrap_or_else(|| ConeFan {
                        vertex: v,
                        first: self.angle_at(first()),
                        turned: 0.0,
                    });
                    (before, self.angle_at(beyond))
                };
                let fans: Vec<(ConeFan, f64)> = cones.iter().map(fan).collect();
                let is_far = |(fan, angle): &(ConeFan, f64)| {
                    fan.turned >= APART
                        || (fan.turned > 0.0 && fan.first + fan.turned + angle >= MOST_TOGETHER)
                };
                if fans.iter().any(is_far) {
                    continue;
                }
                let longest = fans.into_iter().max_by(|(a, _), (b, _)| a.turned.total_cmp(&b.turned));
                let around = longest.map(|(fan, angle)| ConeFan { turned: fan.turned + angle, ..fan });
                let to = way.to.after(&across);
                let knots: Vec<Complex> =
                    patches[g.index()].knots.iter().flatten().map(|&p| to.of(p)).collect();
                let at = |to: &PlaneSimilarity| self.corners[g].map(|p| to.of(p));
                let here = at(&to);
                let is_same = |other: &DevelopedTriangle| {
                    other.face == g && at(&other.to).into_iter().zip(here).all(|(p, q)| distance(p, q) < SAME)
                };
                if overlaps(&knots, self.corners[f], -REACH) && !found.iter().any(is_same) {
                    found.push(DevelopedTriangle { face: g, to, around: around.or(way.around) });
                }
            }
        }
        found.retain(|way| {
            let knots: Vec<Complex> =
                patches[way.face.index()].knots.iter().flatten().map(|&p| way.to.of(p)).collect();
            overlaps(&knots, self.corners[f], REACH)
        });
        found.sort_by_key(|way| way.face);
        Ok(found.into_iter().map(|way| Support { patch: way.face.0, to: way.to.rows() }).collect())
    }

    /// The face on the other side of a half-edge, and the map of its chart to the chart of this side; none on the boundary.
    pub(super) fn across(&self, h: HalfedgeId) -> Option<(FaceId, PlaneSimilarity)> {
        let corner = |h: HalfedgeId| self.coarse.mesh.corner(h);
        let ends = |(f, k): (FaceId, usize)| (self.corners[f][k], self.corners[f][(k + 1) % 3]);
        let ((a, b), there) = (ends(corner(h)?), corner(h.twin())?);
        let (c, d) = ends(there);
        // The map takes c to b and d to a.
        let turn = scale(1.0 / norm2(sub(d, c)), mul(sub(a, b), conj(sub(d, c))));
        Some((there.0, PlaneSimilarity { turn, shift: sub(b, mul(turn, c)) }))
    }
}

/// The point of a triangle nearest to a point outside it.
fn nearest(p: Complex, corners: [Complex; 3]) -> Complex {
    let on_side = |k: usize| nearest_on_side(p, corners[k], corners[(k + 1) % 3]);
    let sides = [on_side(0), on_side(1), on_side(2)];
    sides.into_iter().min_by(|a, b| distance(*a, p).total_cmp(&distance(*b, p))).unwrap_or(p)
}

/// The point between a and b nearest to p.
pub(super) fn nearest_on_side(p: Complex, a: Complex, b: Complex) -> Complex {
    let along = sub(b, a);
    add(a, scale((dot(sub(p, a), along) / norm2(along)).clamp(0.0, 1.0), along))
}

/// A run of neighbouring triangles around a cone.
#[derive(Debug, Clone, Copy)]
struct ConeFan {
    vertex: VertexId,
    /// The angle of the first triangle at the cone, and the sum of the angles of the others.
    first: f64,
    turned: f64,
}

/// A triangle developed into the chart of another one.
#[derive(Debug, Clone, Copy)]
struct DevelopedTriangle {
    face: FaceId,
    to: PlaneSimilarity,
    /// The triangles around the last cone at an edge that the development crossed.
    around: Option<ConeFan>,
}

/// The key of a basis function: the vertex (0), edge (1) or triangle (2) whose knots its polar arguments are, its number, and the counts of
/// knots. Functions with the same key are one function.
fn owner(mesh: &Mesh, f: FaceId, beta: [usize; 3]) -> (u8, u32, [usize; 3]) {
    let zero: Vec<usize> = (0..3).filter(|&k| beta[k] == 0).collect();
    match zero[..] {
        [] => (2, f.0, beta),
        [k] => {
            let h = mesh.face_halfedges(f)[(k + 1) % 3];
            let (from, to) = (beta[(k + 1) % 3], beta[(k + 2) % 3]);
            (1, h.edge().0, if h == h.edge().halfedge() { [from, to, 0] } else { [to, from, 0] })
        }
        _ => {
            let k = (0..3).find(|&k| beta[k] > 0).unwrap_or(0);
            (0, mesh.face_vertices(f)[k].0, [beta[k], 0, 0])
        }
    }
}
