//! The choice of the vertex of a sphere that goes to infinity, and the stereographic projection from it.

use super::areas::{smooth, vertex_areas};
use crate::geometry::complex::Complex;
use crate::geometry::vector;
use crate::mesh::{Mesh, PerEdge, PerVertex, Point, VertexId};
use crate::metric::Surface;

/// Number of calls of [`smooth`] for the means of the factor and its square: their disks have about 11 edges, as large as a hole.
const WIDE: usize = 24;

/// The vertex with the least variance, in a disk around it, of the logarithm of the factor between sphere and surface.
pub(super) fn evenest_vertex(surface: &Surface, round: &Mesh, positions: &PerVertex<Point>) -> VertexId {
    let chords = PerEdge::from_fn(round.n_edges(), |e| {
        let [a, b] = round.ends(e).map(|v| positions[v]);
        vector::distance(a, b)
    });
    let areas = [vertex_areas(round, &chords), vertex_areas(surface.mesh(), surface.lengths())];
    let mut mean = PerVertex::from_fn(positions.len(), |v| (areas[0][v] / areas[1][v]).ln());
    let mut square = PerVertex::from_fn(positions.len(), |v| mean[v] * mean[v]);
    for _ in 0..WIDE {
        smooth(surface.mesh(), &mut mean);
        smooth(surface.mesh(), &mut square);
    }
    let variance = |v: VertexId| square[v] - mean[v] * mean[v];
    let best = surface.mesh().vertices().min_by(|&u, &v| variance(u).total_cmp(&variance(v)).then(u.cmp(&v)));
    best.unwrap_or(VertexId(0))
}

/// The stereographic projection from a vertex, which goes to infinity.
pub(super) fn from_pole(positions: &PerVertex<Point>, pole: VertexId) -> PerVertex<Complex> {
    let south = positions[pole];
    // A right-handed frame whose third axis points away from the pole.
    let least = (0..3).min_by(|&j, &k| south[j].abs().total_cmp(&south[k].abs())).unwrap_or(0);
    let axis = [0, 1, 2].map(|k| if k == least { 1.0 } else { 0.0 });
    let first = vector::cross(axis, south);
    let first = vector::scale(1.0 / vector::norm(first), first);
    let second = vector::cross(first, south);
    let place = |v: VertexId| {
        if v == pole {
            return [f64::INFINITY; 2];
        }
        let away = vector::sub(positions[v], south);
        // This is 1 − x·p, without its cancellation near the pole.
        let height = 0.5 * vector::dot(away, away);
        [first, second].map(|axis| vector::dot(positions[v], axis) / height)
    };
    PerVertex::from_fn(positions.len(), place)
}
