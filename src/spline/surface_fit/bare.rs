//! Holes around singular vertices of any total angle: their radii, and the vertices on a ring around each.
//!
//! A singular vertex whose total angle is no multiple of 2π has all its knots at one place, and a spline is less smooth along the edges
//! there. So the triangles at the vertex end at a ring inside the hole, where its filling alone is the surface.

use super::coarse::CoarseTriangulation;
use super::domain::SurfaceDomain;
use super::flat::FlatMetric;
use super::holes::VertexDisk;
use super::infinity::BareHole;
use crate::error::Result;
use crate::geometry::complex::{Complex, distance, norm};
use crate::mesh::{Mesh, PerVertex, Place, VertexId};
use std::f64::consts::TAU;

/// |w| of the ring. Its edges, and the knots of its vertices, have |w| < 0.8.
const RIM: f64 = 0.6;
/// Least number of vertices of the ring, and the number for each turn: at most a quarter of a turn lies between two of them.
const RING: [f64; 2] = [6.0, 4.0];
/// |w| below which no vertex outside the ring is taken into the triangulation.
const BARE: f64 = 0.88;
/// Radius of a hole over its distance from the boundary, and from itself around a handle.
const FREE: f64 = 0.9;
/// Radius of a hole over the distance of another singular vertex: the holes of both are as wide.
const HALF: f64 = 0.47;
/// Largest share of all vertices in holes.
const MOST_INSIDE: f64 = 0.6;
/// Largest |w| of a vertex of the ring.
const MOST_RIM: f64 = 0.7;
/// Growth of the radius from trial to trial while a hole has too few vertices.
const GROWTH: f64 = 1.3;
/// Least number of vertices in a hole.
const LEAST_INSIDE: usize = 24;

/// A planned hole with the vertices that it prescribes.
pub(super) struct PlannedHole {
    pub vertex: VertexId,
    pub hole: BareHole,
    pub ring: Vec<VertexId>,
    /// The vertices in the hole that are not taken, unless they are on the ring.
    pub bare: Vec<VertexId>,
}

/// The surface with all its vertices as a domain, to measure around its singular vertices.
pub(super) fn fine_domain(flat: &FlatMetric) -> Result<SurfaceDomain> {
    let mesh = Mesh::clone(&flat.mesh);
    let place = |v: VertexId| {
        let (face, corner) = mesh.outgoing(v).find_map(|h| mesh.corner(h))?;
        Some(Place { face, weights: [0, 1, 2].map(|k| if k == corner { 1.0 } else { 0.0 }) })
    };
    let places: PerVertex<Option<Place>> = PerVertex::from_fn(mesh.n_vertices(), place);
    let (lengths, vertices) = (flat.lengths.clone(), mesh.vertices().collect());
    SurfaceDomain::new(CoarseTriangulation { lengths, vertices, places, mesh })
}

/// The mean distance from one vertex to its neighbours, from which the search for a hole's radius starts.
fn near(fine: &SurfaceDomain, v: VertexId) -> f64 {
    let coarse = fine.coarse();
    let around: Vec<f64> = coarse.mesh.outgoing(v).map(|h| coarse.lengths[h.edge()]).collect();
    around.iter().sum::<f64>() / around.len().max(1) as f64
}

/// Plans the hole around a singular vertex of a total angle in turns, with about `inside` of the first `n` vertices in it, or fewer where it
/// would meet itself, another one or the boundary. `holes`: the number of all holes.
pub(super) fn plan_hole(
    fine: &SurfaceDomain,
    v: VertexId,
    inside: usize,
    [n, holes]: [usize; 2],
) -> PlannedHole {
    let turns = fine.total_angle(v) / TAU;
    let most = (MOST_INSIDE * n as f64 / holes.max(1) as f64) as usize;
    let wanted = inside.min(most).max(LEAST_INSIDE);
    let mut radius = near(fine, v);
    let mut disk = fine.disk(v, radius);
    let count = |disk: &VertexDisk, radius: f64| {
        disk.places.iter().filter(|(u, [far, _])| *far < radius && u.index() < n).count()
    };
    while count(&disk, radius) < wanted && disk.free >= radius {
        radius *= GROWTH;
        disk = fine.disk(v, radius);
    }
    // Twice as far, so that no other hole is met.
    let wide = fine.disk(v, radius / HALF);
    let is_other = |u: VertexId| fine.is_cone(u);
    let other = wide.places.iter().find(|(u, _)| is_other(*u)).map_or(f64::INFINITY, |(_, [far, _])| *far);
    let nth = disk.places.iter().filter(|(u, _)| u.index() < n).nth(wanted).map_or(radius, |(_, p)| p[0]);
    let radius = nth.min(radius).min(HALF * other).min(FREE * wide.free.min(disk.free));
    let hole = BareHole { radius, inside: count(&disk, radius) };
    let ring = ring(&disk, radius, turns, n);
    let in_w = |far: f64| (far / radius).powf(1.0 / turns);
    let is_bare =
        |(u, [far, _]): &(VertexId, [f64; 2])| (in_w(*far) < BARE && !ring.contains(u)).then_some(*u);
    let bare = disk.places.iter().filter_map(is_bare).collect();
    PlannedHole { vertex: v, hole, ring, bare }
}

/// The vertices nearest in w to the corners of a regular polygon.
fn ring(disk: &VertexDisk, radius: f64, turns: f64, n: usize) -> Vec<VertexId> {
    let in_w = |[far, angle]: [f64; 2]| {
        let (size, angle) = ((far / radius).powf(1.0 / turns), angle / turns);
        [size * angle.cos(), size * angle.sin()]
    };
    let inside = |(u, p): &(VertexId, [f64; 2])| (u.index() < n && p[0] < radius).then(|| (*u, in_w(*p)));
    let places: Vec<(VertexId, Complex)> =
        disk.places.iter().filter_map(inside).filter(|(_, w)| norm(*w) < MOST_RIM).collect();
    let corners = RING[0].max((RING[1] * turns).ceil()) as usize;
    let mut ring = Vec::new();
    for k in 0..corners {
        let angle = TAU * k as f64 / corners as f64;
        let at = [RIM * angle.cos(), RIM * angle.sin()];
        let free = places.iter().filter(|(u, _)| !ring.contains(u));
        let nearest = free.min_by(|(_, a), (_, b)| distance(*a, at).total_cmp(&distance(*b, at)));
        ring.extend(nearest.map(|(u, _)| *u));
    }
    ring
}
