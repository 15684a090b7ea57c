//! Directions of the edges of a finer triangulation on the given surface, and the places of its vertices there.
//!
//! Every half-edge knows the direction in which it leaves its origin \[SSC19\] §3: at a given vertex the angle from the first given edge
//! there, at an added one the angle in the plane of the given face that contains it. An added vertex is found by a straight walk over the
//! given faces from a vertex beside it.

use super::isometric::{Triangulated, delaunay_flip};
use super::plane_walk::{PlanePoint, UnfoldedFace};
use super::surface::Surface;
use crate::error::{Error, Result};
use crate::geometry::Space;
use crate::geometry::plane_triangle::PlaneTriangle;
use crate::mesh::{EdgeId, HalfedgeId, Mesh, PerEdge, Place, VertexId};
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

/// The directions and places; the finer triangulation is kept beside them and handed to each call.
pub(super) struct Signposts {
    given: Arc<Mesh>,
    lengths: Arc<PerEdge<f64>>,
    /// Per half-edge of the given surface, its direction.
    given_direction: Vec<f64>,
    /// Per given vertex, the sum of the angles around it.
    around: Vec<f64>,
    /// Per half-edge of the finer triangulation, its direction, radians.
    direction: Vec<f64>,
    /// Per vertex of the finer triangulation, its place on the given surface.
    places: Vec<Place>,
}

/// The angle of a half-edge's face at its origin, radians. The half-edge has a face.
fn corner_angle(mesh: &Mesh, lengths: &PerEdge<f64>, h: HalfedgeId) -> f64 {
    let [ab, bc, ca] = [h, mesh.next(h), mesh.prev(h)].map(|h| lengths[h.edge()]);
    let [cos, sin] = PlaneTriangle::direction_at([bc, ca, ab], 0).0;
    sin.atan2(cos)
}

impl Signposts {
    /// The directions of the given edges themselves.
    ///
    /// # Errors
    /// [`Error::Connectivity`] for a vertex without faces.
    pub fn new(surface: &Surface) -> Result<Signposts> {
        let (given, lengths) = (surface.mesh().clone(), surface.lengths().clone());
        let mut direction = vec![0.0; given.n_halfedges()];
        let mut around = vec![0.0; given.n_vertices()];
        for v in given.vertices() {
            let sum = &mut around[v.index()];
            for h in given.fan(v) {
                direction[h.index()] = *sum;
                *sum += corner_angle(&given, &lengths, h);
            }
            if given.is_boundary_vertex(v) {
                direction[given.out(v).index()] = *sum;
            }
        }
        let places = given.vertices().map(|v| Place::at_vertex(&given, v)).collect::<Result<_>>()?;
        Ok(Signposts { given, lengths, given_direction: direction.clone(), around, direction, places })
    }

    /// Makes the flips of these edges, one after the other, from the given triangulation on.
    ///
    /// # Errors
    /// [`Error::Connectivity`] for flips that are not those of a Delaunay triangulation of this surface.
    pub fn replay(&mut self, flips: &[EdgeId]) -> Result<()> {
        let (mesh, lengths) = (Mesh::clone(&self.given), PerEdge::clone(&self.lengths));
        let mut work = Triangulated { mesh, lengths, geometry: Space::E2 };
        for &e in flips {
            let length = delaunay_flip(Space::E2, &work.mesh, &work.lengths, e.halfedge());
            let message = "cannot be flipped a second time as it was the first time";
            let length = length.ok_or_else(|| Error::connectivity("edge", e.index(), message))?;
            work.mesh.flip(e);
            work.lengths[e] = length;
            self.flipped(&work, e);
        }
        Ok(())
    }

    /// Per vertex, its place on the given surface.
    pub fn into_places(self) -> Vec<Place> {
        self.places
    }

    /// An edge was flipped.
    pub fn flipped(&mut self, work: &Triangulated, e: EdgeId) {
        self.turn(work, e.halfedge());
        self.turn(work, e.halfedge().twin());
    }

    /// A vertex was added in a face, with spokes whose half-edges 2e start at it.
    pub fn added_in_face(&mut self, work: &Triangulated, spokes: [EdgeId; 3]) {
        self.direction.resize(work.mesh.n_halfedges(), 0.0);
        spokes.iter().for_each(|e| self.turn(work, e.halfedge().twin()));
        let [first, more @ ..] = spokes.map(EdgeId::halfedge);
        self.settle(work, first, &more);
    }

    /// A vertex was added on an edge: `halves` are the two parts, the first with the number of the whole, which started where the first does.
    pub fn added_on_edge(&mut self, work: &Triangulated, halves: [EdgeId; 2], lines: [Option<EdgeId>; 2]) {
        self.direction.resize(work.mesh.n_halfedges(), 0.0);
        let [near, far] = halves.map(EdgeId::halfedge);
        // The half-edge at the end of the whole edge has a new number.
        self.direction[far.twin().index()] = self.direction[near.twin().index()];
        for line in lines.into_iter().flatten() {
            self.turn(work, line.halfedge().twin());
        }
        self.settle(work, near.twin(), &[far]);
    }

    /// Finds the place of the last vertex from the nearest of its neighbours at the tips of these half-edges, and the directions there.
    fn settle(&mut self, work: &Triangulated, first: HalfedgeId, more: &[HalfedgeId]) {
        let Triangulated { mesh, lengths, .. } = work;
        let nearer = |a: HalfedgeId, b: HalfedgeId| if lengths[b.edge()] < lengths[a.edge()] { b } else { a };
        let back = more.iter().copied().fold(first, nearer);
        let direction = self.direction[back.twin().index()];
        let (place, arriving) = self.walk(mesh.tip(back), direction, lengths[back.edge()]);
        self.places.push(place);
        self.direction[back.index()] = (arriving + PI).rem_euclid(TAU);
        // Counterclockwise from there on, and clockwise for what lies behind the boundary.
        let mut at = back;
        while !mesh.is_outside(at) {
            let next = mesh.prev(at).twin();
            if next == back {
                return;
            }
            self.turn(work, next);
            at = next;
        }
        at = back;
        while !mesh.is_outside(at.twin()) {
            at = mesh.next(at.twin());
            self.turn_back(work, at);
        }
    }

    /// Sets the direction of a half-edge from that of the one before it, counterclockwise; without a face between them, from the one after.
    fn turn(&mut self, work: &Triangulated, h: HalfedgeId) {
        let Triangulated { mesh, lengths, .. } = work;
        if mesh.is_outside(h.twin()) {
            return self.turn_back(work, h);
        }
        let before = mesh.next(h.twin());
        let direction = self.direction[before.index()] + corner_angle(mesh, lengths, before);
        self.direction[h.index()] = self.within(mesh.origin(h), direction);
    }

    /// Sets the direction of a half-edge from that of the one after it, counterclockwise.
    fn turn_back(&mut self, work: &Triangulated, h: HalfedgeId) {
        let Triangulated { mesh, lengths, .. } = work;
        let after = mesh.prev(h).twin();
        let direction = self.direction[after.index()] - corner_angle(mesh, lengths, h);
        self.direction[h.index()] = self.within(mesh.origin(h), direction);
    }

    /// A direction at a vertex inside the surface, from 0 to below the sum of the angles there.
    fn within(&self, v: VertexId, direction: f64) -> f64 {
        match self.around.get(v.index()) {
            None => direction.rem_euclid(TAU),
            Some(_) if self.given.is_boundary_vertex(v) => direction,
            Some(&around) => direction.rem_euclid(around),
        }
    }

    /// The place at a distance from a vertex in a direction, and the direction of arrival in the plane of the face there.
    fn walk(&self, from: VertexId, direction: f64, distance: f64) -> (Place, f64) {
        let (face, start, angle) = self.start(from, direction);
        let goal = [start[0] + distance * angle.cos(), start[1] + distance * angle.sin()];
        let end = face.walk_on(&self.given, &self.lengths, [start, goal]);
        let weights = end.weights(goal).map(|w| w.max(0.0));
        let sum: f64 = weights.iter().sum();
        let first = self.given.face_halfedge(end.face);
        let turn = end.sides.iter().position(|&h| h == first).unwrap_or(0);
        let [p, q] = [end.points[turn], end.points[(turn + 1) % 3]];
        let place = Place { face: end.face, weights: [0, 1, 2].map(|k| weights[(k + turn) % 3] / sum) };
        (place, angle - (q[1] - p[1]).atan2(q[0] - p[0]))
    }

    /// The given face into which a direction at a vertex of the finer triangulation leads, the vertex in its plane, and the angle of the
    /// direction there.
    fn start(&self, from: VertexId, direction: f64) -> (UnfoldedFace, PlanePoint, f64) {
        if from.index() < self.around.len() {
            // The last given half-edge whose direction is not beyond this one.
            let direction = direction.max(0.0);
            for h in self.given.fan(from).into_iter().rev() {
                let angle = direction - self.given_direction[h.index()];
                let face = UnfoldedFace::beside(&self.given, &self.lengths, h);
                if let Some(face) = face.filter(|_| angle >= 0.0) {
                    return (face, [0.0; 2], angle);
                }
            }
        }
        let Place { face, weights } = self.places[from.index()];
        let face = UnfoldedFace::new(&self.given, &self.lengths, face);
        let at = [0, 1].map(|i| (0..3).map(|k| weights[k] * face.points[k][i]).sum());
        (face, at, direction)
    }
}
