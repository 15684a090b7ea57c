//! The area that belongs to each vertex of a mesh, and the smoothing of numbers at vertices.

use crate::geometry::plane_triangle::PlaneTriangle;
use crate::mesh::{Mesh, PerEdge, PerVertex};

/// Smoothing steps of one call of [`smooth`]; in each, a number becomes the mean of itself and its neighbours' mean.
const SMOOTHINGS: usize = 5;

/// A third of the area of the triangles at each vertex.
pub(super) fn vertex_areas(mesh: &Mesh, lengths: &PerEdge<f64>) -> PerVertex<f64> {
    let mut areas = PerVertex::filled(mesh.n_vertices(), 0.0);
    for f in mesh.faces() {
        let third = PlaneTriangle::from_sides(mesh.opposite_edges(f).map(|e| lengths[e])).area / 3.0;
        mesh.face_vertices(f).into_iter().for_each(|v| areas[v] += third);
    }
    areas
}

/// The share of the whole area that belongs to the vertices, by their numbers, for which `is_there` is true; 0 where there is no area.
pub(super) fn area_share(areas: &PerVertex<f64>, is_there: impl Fn(usize) -> bool) -> f64 {
    let (mut there, mut all) = (0.0, 0.0);
    for (v, area) in areas.iter().enumerate() {
        all += area;
        there += if is_there(v) { *area } else { 0.0 };
    }
    if all > 0.0 { there / all } else { 0.0 }
}

/// Replaces every number five times by the mean of itself and the mean of its neighbours.
pub(super) fn smooth(mesh: &Mesh, sizes: &mut PerVertex<f64>) {
    for _ in 0..SMOOTHINGS {
        let before = sizes.clone();
        for v in mesh.vertices() {
            let around = mesh.outgoing(v).map(|h| before[mesh.tip(h)]);
            let (sum, n) = around.fold((0.0, 0.0), |(sum, n), size| (sum + size, n + 1.0));
            sizes[v] = 0.5 * (before[v] + sum / n);
        }
    }
}
