//! Domains of splines on surfaces: a coarse flat triangulation with a chart for each of its triangles.

use super::coarse::{Coarse, Place};
use crate::embed::triangle::Triangle;
use crate::error::{Error, Result};
use crate::geometry::Space;
use crate::geometry::complex::{
    Complex, add, conj, cross, distance, dot, doubled_area, mul, norm, norm2, scale, sub, unit,
};
use crate::mesh::{FaceId, HalfedgeId, Mesh, PerFace, PerHalfedge, PerVertex, VertexId};
use crate::spline::knots::Around;
use crate::spline::overlap::overlaps;
use crate::spline::{Hole, Parameter, Patch, Sector, SplineSpace, Support, multi_indices};
use std::collections::HashMap;
use std::f64::consts::TAU;

/// Largest curvature, in radians, of a vertex that counts as flat.
const FLAT: f64 = 1e-6;
/// Share of a triangle by which the knots of another must reach into it for its basis functions to count: rounding.
const REACH: f64 = 1e-12;
/// Radius of a hole over the distance of its vertex from the sides opposite it.
const HOLE: f64 = 0.9;
/// Around a singular vertex the angle, in radians, beyond which no basis function reaches: outside the disk of its knots, a convex hull of points on one side
/// of it lies there.
const HALF_TURN: f64 = std::f64::consts::PI;
/// How far the total angle of a hole's vertex may be from a multiple of 2π, in turns.
const WHOLE: f64 = 1e-6;
/// Triangles that a walk crosses at most: steps are shorter than a triangle.
const MOST_TRIANGLES: usize = 16;
/// Two developments of a triangle are the same where a corner of unit triangles is less far apart.
const SAME: f64 = 1e-6;

/// A triangulated flat surface with coordinates in each triangle: corner 0 is at 0, corner 1 on the positive axis, and the longest side has
/// the length 1.
#[derive(Debug, Clone)]
pub struct SurfaceDomain {
    coarse: Coarse,
    corners: PerFace<[Complex; 3]>,
    /// Per face the length that is 1 in its chart.
    unit: PerFace<f64>,
    /// Per half-edge of a face its angle with the first one of its vertex, counterclockwise.
    angle: PerHalfedge<f64>,
    /// Per vertex whether the surface is flat around it; on the boundary, whether that is straight there.
    is_flat: PerVertex<bool>,
}

impl SurfaceDomain {
    /// The charts of a triangulation.
    ///
    /// # Errors
    /// Those of [`crate::metric::curvature`].
    pub fn new(coarse: Coarse) -> Result<SurfaceDomain> {
        let Coarse { mesh, lengths, .. } = &coarse;
        let curvature = crate::metric::curvature(mesh, Space::E2, lengths)?.at;
        let is_flat = PerVertex::from_fn(mesh.n_vertices(), |v: VertexId| curvature[v].abs() <= FLAT);
        let unit = PerFace::from_fn(mesh.n_faces(), |f: FaceId| {
            mesh.opposite_edges(f).into_iter().map(|e| lengths[e]).fold(0.0, f64::max)
        });
        let triangle = |f: FaceId| {
            let sides = mesh.opposite_edges(f).map(|e| lengths[e] / unit[f]);
            (sides, Triangle::from_sides(sides))
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
        Ok(SurfaceDomain { corners, unit, angle, is_flat, coarse })
    }

    /// The triangulation.
    pub fn coarse(&self) -> &Coarse {
        &self.coarse
    }

    /// Corners of a triangle in its chart.
    pub fn corners(&self, f: FaceId) -> [Complex; 3] {
        self.corners[f]
    }

    /// The vertices inside the surface around which it is not flat.
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

    /// The distance of a vertex from the sides opposite it, in the unit of the metric: triangles around it cover a disk of this radius.
    pub fn clearance(&self, v: VertexId) -> f64 {
        let distance_to_side = |h: HalfedgeId| {
            let (f, k) = self.coarse.mesh.corner(h)?;
            let [a, b, c] = [0, 1, 2].map(|j| self.corners[f][(k + j) % 3]);
            Some(self.unit[f] * distance(a, nearest_on_side(a, b, c)))
        };
        self.coarse.mesh.fan(v).into_iter().filter_map(distance_to_side).fold(f64::INFINITY, f64::min)
    }

    /// The hole around a singular vertex whose total angle is a multiple of 2π, with nothing in it yet, inside the triangles at the vertex.
    ///
    /// # Errors
    /// [`Error::Argument`] for another vertex.
    pub fn hole(&self, v: VertexId) -> Result<Hole> {
        let radius = HOLE * self.clearance(v);
        Hole::new(self.around(v, radius).sectors, self.turns(v)?, radius)
    }

    /// A hole of this radius, or the widest that meets neither itself, another singular vertex nor the boundary; at least that of [`SurfaceDomain::hole`].
    ///
    /// # Errors
    /// Those of [`SurfaceDomain::hole`].
    pub fn wide_hole(&self, v: VertexId, radius: f64) -> Result<Hole> {
        let turns = self.turns(v)?;
        // The hole meets itself beyond half of the way from the vertex to itself.
        let free = self.around(v, 2.0 * radius).free;
        let radius = radius.min(HOLE * free).max(HOLE * self.clearance(v));
        Hole::new(self.around(v, radius).sectors, turns, radius)
    }

    /// The total angle of a singular vertex in turns.
    fn turns(&self, v: VertexId) -> Result<u32> {
        let turns = self.total_angle(v) / TAU;
        let is_whole = (turns - turns.round()).abs() < WHOLE && turns > 0.5;
        if self.coarse.mesh.is_boundary_vertex(v) || !is_whole {
            let need = "a multiple of one turn, at a vertex inside the surface";
            return Err(Error::argument("total angle in turns", turns, need));
        }
        Ok(turns.round() as u32)
    }

    /// The triangles that a disk around a vertex meets, developed from it.
    fn around(&self, v: VertexId, radius: f64) -> Surroundings {
        let mesh = &self.coarse.mesh;
        let whole = self.total_angle(v);
        let mut found: Vec<Sector> = Vec::new();
        let mut known: HashMap<u32, Vec<Sector>> = HashMap::new();
        let mut free = f64::INFINITY;
        // How far a singular vertex of a triangle is; half as far, where that is the vertex itself.
        let room = |sector: &Sector| {
            let f = FaceId(sector.patch);
            let far = |(k, &u): (usize, &VertexId)| {
                let far = norm(sector.local(self.corners[f][k]));
                let counts = !self.is_flat[u] && far > SAME * self.unit[f];
                counts.then_some(if u == v { 0.5 * far } else { far })
            };
            mesh.face_vertices(f).iter().enumerate().filter_map(far).fold(f64::INFINITY, f64::min)
        };
        for h in mesh.fan(v) {
            let Some((f, k)) = mesh.corner(h) else { continue };
            let [a, b] = [k, (k + 1) % 3].map(|k| self.corners[f][k]);
            let turn = scale(self.unit[f], conj(unit(sub(b, a))));
            let to = Similarity { turn, shift: sub([0.0; 2], mul(turn, a)) };
            let sector = self.sector(f, to, self.angle[h]);
            free = free.min(room(&sector));
            known.entry(f.0).or_default().push(sector);
            found.push(sector);
        }
        let mut next = 0;
        while let Some(&Sector { patch, angle, to }) = found.get(next) {
            next += 1;
            let (f, to) = (FaceId(patch), Similarity::of_rows(to));
            for h in mesh.face_halfedges(f) {
                let Some((_, k)) = mesh.corner(h) else { continue };
                let ends = [k, (k + 1) % 3].map(|k| to.of(self.corners[f][k]));
                // Sides at the vertex lead to triangles that are known.
                if ends.iter().any(|&p| norm(p) < SAME * self.unit[f]) {
                    continue;
                }
                let far = distance([0.0; 2], nearest_on_side([0.0; 2], ends[0], ends[1]));
                // Beyond, no disk that is free comes closer to itself.
                if far >= radius.min(2.0 * free) {
                    continue;
                }
                let Some((g, across)) = self.across(h) else {
                    free = free.min(far);
                    continue;
                };
                let there = self.sector(g, to.after(&across), angle);
                free = free.min(room(&there));
                let is_there = |other: &Sector| {
                    let apart = (other.angle - there.angle) / whole;
                    let places = self.corners[g].map(|p| distance(other.local(p), there.local(p)));
                    (apart - apart.round()).abs() * whole < SAME
                        && places.iter().all(|&d| d < SAME * self.unit[g])
                };
                let of_patch = known.entry(g.0).or_default();
                if !of_patch.iter().any(is_there) {
                    of_patch.push(there);
                    found.push(there);
                }
            }
        }
        Surroundings { sectors: found, free }
    }

    /// A triangle developed around a vertex, its middle turned to the x axis; the map is given up to a rotation by `angle`.
    fn sector(&self, f: FaceId, to: Similarity, angle: f64) -> Sector {
        let middle = self.corners[f].iter().fold([0.0; 2], |sum, &p| add(sum, scale(1.0 / 3.0, p)));
        let at = to.of(middle);
        let back = Similarity { turn: conj(unit(at)), shift: [0.0; 2] };
        Sector { patch: f.0, angle: angle + at[1].atan2(at[0]), to: back.after(&to).rows() }
    }

    fn is_cone(&self, v: VertexId) -> bool {
        !self.is_flat[v] && !self.coarse.mesh.is_boundary_vertex(v)
    }

    /// A place as coordinates in the chart of its triangle.
    pub fn parameter(&self, place: Place) -> Parameter {
        let corners = self.corners[place.face];
        let [x, y] = (0..3).fold([0.0; 2], |sum, k| add(sum, scale(place.weights[k], corners[k])));
        Parameter { patch: place.face.0, x, y }
    }

    /// The place at the end of a straight line from another one, in its chart; on the boundary and after [`MOST_TRIANGLES`] the nearest one in the last triangle.
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

    /// The triangular B-splines of a degree on this domain: their knots are in general position around flat vertices, along straight boundaries, and
    /// coincide at corners of the boundary. `spread` as in [`crate::spline::KnotOptions`].
    ///
    /// A singular vertex whose total angle is a multiple of 2π has directions as any other, and its knots lie in general position in the core of its
    /// hole: outside that core every flat region is as in the plane, and the splines are as smooth there. At another one knots coincide.
    ///
    /// # Errors
    /// Those of [`SplineSpace::new`].
    pub fn space(&self, degree: usize, spread: f64) -> Result<SplineSpace> {
        let mesh = &self.coarse.mesh;
        let around = PerVertex::from_fn(mesh.n_vertices(), |v: VertexId| {
            let around = self.surroundings(v);
            let spread = match (self.is_flat[v], self.hole(v)) {
                (true, _) => spread,
                (false, Ok(hole)) => spread.min(hole.core() / around.radius),
                _ => 0.0,
            };
            around.knots([0.0; 2], degree, spread)
        });
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
        let supports = mesh.faces().map(|f| self.supports(f, &patches)).collect();
        SplineSpace::new(degree, patches, supports)
    }

    /// The surroundings of a vertex, in its own plane: the unit is that of the metric, the first half-edge points along the axis.
    fn surroundings(&self, v: VertexId) -> Around {
        let Coarse { mesh, lengths, .. } = &self.coarse;
        let inscribed = |h: &HalfedgeId| {
            let f = mesh.face(*h)?;
            let sides = mesh.opposite_edges(f).map(|e| lengths[e]);
            Some(2.0 * Triangle::from_sides(sides).area / (sides[0] + sides[1] + sides[2]))
        };
        let spokes: Vec<HalfedgeId> = mesh.fan(v);
        let radius = spokes.iter().filter_map(inscribed).fold(f64::INFINITY, f64::min);
        let direction = |angle: f64| [angle.cos(), angle.sin()];
        let edges = spokes.iter().map(|&h| direction(self.angle[h])).collect();
        let lines = if mesh.is_boundary_vertex(v) { vec![[1.0, 0.0]] } else { Vec::new() };
        Around { radius, edges, lines }
    }

    /// Vectors at corner k of a triangle in its chart, from those in the plane of the vertex.
    fn in_chart(&self, f: FaceId, k: usize, vectors: &[Complex]) -> Vec<Complex> {
        let h = self.coarse.mesh.face_halfedges(f)[k];
        let corners = self.corners[f];
        let turn =
            mul(unit(sub(corners[(k + 1) % 3], corners[k])), [self.angle[h].cos(), -self.angle[h].sin()]);
        vectors.iter().map(|&p| add(corners[k], mul(turn, scale(1.0 / self.unit[f], p)))).collect()
    }

    /// The patches that reach into triangle f, with the maps of their charts to its own.
    fn supports(&self, f: FaceId, patches: &[Patch]) -> Vec<Support> {
        let mesh = &self.coarse.mesh;
        let mut found = vec![Way { face: f, to: Similarity::IDENTITY, around: None }];
        let mut next = 0;
        while let Some(&way) = found.get(next) {
            next += 1;
            for h in mesh.face_halfedges(way.face) {
                let Some((g, across)) = self.across(h) else { continue };
                // Of the cones at this edge, the triangle that it leads to.
                let ends = [(mesh.origin(h), mesh.next(h.twin())), (mesh.tip(h), h.twin())];
                let cones: Vec<(VertexId, HalfedgeId)> =
                    ends.into_iter().filter(|&(v, _)| self.is_cone(v)).collect();
                let known = |v: VertexId| way.around.filter(|&(cone, _)| cone == v).map(|(_, turned)| turned);
                if cones.iter().any(|&(v, _)| known(v).is_some_and(|turned| turned >= HALF_TURN)) {
                    continue;
                }
                let entered = |&(v, beyond): &(VertexId, HalfedgeId)| {
                    (v, known(v).unwrap_or(0.0) + self.angle_at(beyond))
                };
                let around = cones.iter().find(|(v, _)| known(*v).is_some()).or(cones.last()).map(entered);
                let to = way.to.after(&across);
                let knots: Vec<Complex> =
                    patches[g.index()].knots.iter().flatten().map(|&p| to.of(p)).collect();
                let at = |to: &Similarity| self.corners[g].map(|p| to.of(p));
                let is_same = |other: &Way| {
                    let pairs = at(&other.to).into_iter().zip(at(&to));
                    other.face == g && pairs.into_iter().all(|(p, q)| distance(p, q) < SAME)
                };
                if overlaps(&knots, self.corners[f], -REACH) && !found.iter().any(is_same) {
                    found.push(Way { face: g, to, around: around.or(way.around) });
                }
            }
        }
        found.retain(|way| {
            let knots: Vec<Complex> =
                patches[way.face.index()].knots.iter().flatten().map(|&p| way.to.of(p)).collect();
            overlaps(&knots, self.corners[f], REACH)
        });
        found.sort_by_key(|way| way.face);
        found.into_iter().map(|way| Support { patch: way.face.0, to: way.to.rows() }).collect()
    }

    /// The face on the other side of a half-edge, and the map of its chart to the chart on this side; none on the boundary.
    fn across(&self, h: HalfedgeId) -> Option<(FaceId, Similarity)> {
        let corner = |h: HalfedgeId| self.coarse.mesh.corner(h);
        let ends = |(f, k): (FaceId, usize)| (self.corners[f][k], self.corners[f][(k + 1) % 3]);
        let ((a, b), there) = (ends(corner(h)?), corner(h.twin())?);
        let (c, d) = ends(there);
        // c goes to b and d to a.
        let turn = scale(1.0 / norm2(sub(d, c)), mul(sub(a, b), conj(sub(d, c))));
        Some((there.0, Similarity { turn, shift: sub(b, mul(turn, c)) }))
    }
}

/// An orientation-preserving similarity of the plane: z ↦ turn z + shift.
#[derive(Debug, Clone, Copy)]
struct Similarity {
    turn: Complex,
    shift: Complex,
}

impl Similarity {
    const IDENTITY: Similarity = Similarity { turn: [1.0, 0.0], shift: [0.0, 0.0] };

    fn of(&self, p: Complex) -> Complex {
        add(mul(self.turn, p), self.shift)
    }

    /// First `other`, then this.
    fn after(&self, other: &Similarity) -> Similarity {
        Similarity { turn: mul(self.turn, other.turn), shift: self.of(other.shift) }
    }

    fn inverse(&self) -> Similarity {
        let turn = scale(1.0 / norm2(self.turn), conj(self.turn));
        Similarity { turn, shift: mul(turn, sub([0.0; 2], self.shift)) }
    }

    fn of_rows([[a, _, x], [b, _, y]]: [[f64; 3]; 2]) -> Similarity {
        Similarity { turn: [a, b], shift: [x, y] }
    }

    fn rows(&self) -> [[f64; 3]; 2] {
        let ([a, b], [x, y]) = (self.turn, self.shift);
        [[a, -b, x], [b, a, y]]
    }
}

/// The point of a triangle that is nearest to one outside it.
fn nearest(p: Complex, corners: [Complex; 3]) -> Complex {
    let on_side = |k: usize| nearest_on_side(p, corners[k], corners[(k + 1) % 3]);
    let sides = [on_side(0), on_side(1), on_side(2)];
    sides.into_iter().min_by(|a, b| distance(*a, p).total_cmp(&distance(*b, p))).unwrap_or(p)
}

/// The point between a and b that is nearest to p.
fn nearest_on_side(p: Complex, a: Complex, b: Complex) -> Complex {
    let along = sub(b, a);
    add(a, scale((dot(sub(p, a), along) / norm2(along)).clamp(0.0, 1.0), along))
}

/// The triangles around a vertex.
struct Surroundings {
    sectors: Vec<Sector>,
    /// Radius of the widest disk around the vertex that the triangles show to be free of singular vertices, the boundary and itself.
    free: f64,
}

/// A triangle as it is seen from another one.
#[derive(Debug, Clone, Copy)]
struct Way {
    face: FaceId,
    to: Similarity,
    /// The last cone at an edge on the way, and the sum of the angles there of the triangles that the way entered by such edges.
    around: Option<(VertexId, f64)>,
}

/// What owns a basis function: the vertex, edge or triangle whose knots its polar arguments are. Functions with the same owner and counts are one.
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
