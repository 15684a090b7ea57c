//! The map of an integer rectangle onto a rectangle of a T-mesh: grid lines are straight between points on opposite sides. Lines of one
//! direction do not meet, and each meets each of the other direction once, so that all squares become convex quadrilaterals.

use super::grid_complex::GridComplex;
use super::grid_surface::GridSurface;
use super::grid_vector::{GridMotion, GridPoint, cross, minus};
use super::t_mesh::{HalfArc, TMesh, TRectangle};
use crate::error::{Error, Result};
use crate::mesh::FaceId;
use std::collections::BTreeSet;

/// A point of the metric's triangulation: a triangle and barycentric coordinates in it.
pub(super) type MetricPlace = (FaceId, [f64; 3]);

/// Places for the points of a grid complex; none at points of rectangles without squares.
pub(super) fn grid_places(
    surface: &GridSurface,
    t_mesh: &TMesh,
    complex: &GridComplex<'_>,
    numbers: &[i64],
) -> Result<Vec<Option<MetricPlace>>> {
    let mut places = vec![None; complex.n_points];
    for (k, node) in t_mesh.nodes.iter().enumerate() {
        places[k] = node.place(surface);
    }
    for (r, rectangle) in t_mesh.rectangles.iter().enumerate() {
        let size = complex.size(rectangle);
        let lines = GridLines::new(t_mesh, rectangle, numbers);
        let sides = complex.sides(rectangle);
        let mut wanted: Vec<(u32, [f64; 2])> = Vec::new();
        let [m, n] = size;
        // Sides with arcs of length 0 have their points by arcs.
        lines.on_sides(complex, rectangle, numbers, &mut wanted);
        for j in 1..n {
            for i in 1..m {
                wanted.push((complex.point(r, size, &sides, [i, j]), lines.crossing([i, j])));
            }
        }
        wanted.retain(|(point, _)| places[*point as usize].is_none());
        if wanted.is_empty() {
            continue;
        }
        let developed = developed_triangles(surface, t_mesh, rectangle)?;
        locate(surface, &developed, &wanted, rectangle, &mut places);
    }
    Ok(places)
}

/// The grid lines of a rectangle: places along its sides, in units of the grid from its first corner.
struct GridLines {
    bottom: Vec<f64>,
    right: Vec<f64>,
    top: Vec<f64>,
    left: Vec<f64>,
    size: [f64; 2],
}

impl GridLines {
    fn new(t_mesh: &TMesh, rectangle: &TRectangle, numbers: &[i64]) -> GridLines {
        let along = |side: &[HalfArc]| {
            let (mut places, mut begin) = (vec![0.0], 0);
            for &h in side {
                let (n, length) = (numbers[h / 2], t_mesh.arcs[h / 2].length);
                places.extend((1..=n).map(|k| begin as f64 + length as f64 * (k as f64 / n as f64)));
                begin += length;
            }
            places
        };
        let size = rectangle.size.map(|x| x as f64);
        let backwards = |side: &[HalfArc], length: f64| {
            let mut places: Vec<f64> = along(side).into_iter().map(|x| length - x).collect();
            places.reverse();
            places
        };
        let [bottom, right] = [0, 1].map(|k| along(&rectangle.sides[k]));
        let (top, left) = (backwards(&rectangle.sides[2], size[0]), backwards(&rectangle.sides[3], size[1]));
        GridLines { bottom, right, top, left, size }
    }

    /// The crossing of column i and row j.
    fn crossing(&self, [i, j]: [usize; 2]) -> [f64; 2] {
        let [w, h] = self.size;
        let (a, lean) = (self.bottom[i], (self.top[i] - self.bottom[i]) / h);
        let (b, rise) = (self.left[j], (self.right[j] - self.left[j]) / w);
        // x = a + lean y, y = b + rise x; lean · rise < 1 inside.
        let x = (a + lean * b) / (1.0 - lean * rise);
        [x.clamp(0.0, w), (b + rise * x).clamp(0.0, h)]
    }

    /// The inner points of the arcs on the sides.
    fn on_sides(
        &self,
        complex: &GridComplex<'_>,
        rectangle: &TRectangle,
        numbers: &[i64],
        wanted: &mut Vec<(u32, [f64; 2])>,
    ) {
        let [w, h] = self.size;
        let along = [&self.bottom, &self.right, &self.top, &self.left];
        for (k, side) in rectangle.sides.iter().enumerate() {
            let mut at = 0;
            let last = along[k].len() - 1;
            for &arc in side {
                for step in 1..numbers[arc / 2] {
                    let index = at + step as usize;
                    let place = match k {
                        0 => [along[0][index], 0.0],
                        1 => [w, along[1][index]],
                        2 => [along[2][last - index], h],
                        _ => [0.0, along[3][last - index]],
                    };
                    wanted.push((complex.arc_point(arc, step), place));
                }
                at += numbers[arc / 2] as usize;
            }
        }
    }
}

/// A triangle in the coordinates of a rectangle.
struct TriangleInRectangle {
    face: FaceId,
    corners: [GridPoint; 3],
}

/// The triangles that share more than border with a rectangle, in its coordinates.
fn developed_triangles(
    surface: &GridSurface,
    t_mesh: &TMesh,
    rectangle: &TRectangle,
) -> Result<Vec<TriangleInRectangle>> {
    let mesh = &surface.mesh;
    let first = rectangle.sides[0][0];
    let (node, slot) = t_mesh.arcs[first / 2].ends[first % 2];
    let frame = t_mesh.nodes[node].frame(surface, slot);
    let Some(start) = frame else {
        return Err(Error::Layout(format!(
            "no triangle lies beside the rectangle at {:?}",
            t_mesh.nodes[node]
        )));
    };
    let size = rectangle.size.map(|x| x as i64);
    let mut seen: BTreeSet<(FaceId, GridMotion)> = BTreeSet::from([start]);
    let mut waiting = vec![start];
    let mut found = Vec::new();
    while let Some((face, motion)) = waiting.pop() {
        let corners = surface.corners(face).map(|p| motion.apply(p));
        for (k, h) in mesh.face_halfedges(face).into_iter().enumerate() {
            let Some(next) = mesh.face(h.twin()) else { continue };
            if meets_inside(corners[k], corners[(k + 1) % 3], size) {
                let there = (next, motion.after(&surface.across(h.twin())));
                if seen.insert(there) {
                    waiting.push(there);
                }
            }
        }
        found.push(TriangleInRectangle { face, corners });
    }
    Ok(found)
}

/// True if a segment has a point inside of the rectangle [0, w] × [0, h].
fn meets_inside(a: GridPoint, b: GridPoint, size: [i64; 2]) -> bool {
    let is_beside = |k: usize| a[k].max(b[k]) <= 0 || a[k].min(b[k]) >= size[k];
    if is_beside(0) || is_beside(1) {
        return false;
    }
    let [w, h] = size;
    let sides = [[0, 0], [w, 0], [0, h], [w, h]].map(|corner| cross(minus(b, a), minus(corner, a)).signum());
    sides.contains(&1) && sides.contains(&-1)
}

/// Finds the triangles in which points lie: those in which the least barycentric coordinate is largest.
fn locate(
    surface: &GridSurface,
    developed: &[TriangleInRectangle],
    wanted: &[(u32, [f64; 2])],
    rectangle: &TRectangle,
    places: &mut [Option<MetricPlace>],
) {
    let size = rectangle.size.map(|x| x as f64);
    let bins = ((wanted.len() as f64).sqrt().ceil() as usize).clamp(1, 256);
    let bin = |x: f64, k: usize| ((x / size[k] * bins as f64).floor().max(0.0) as usize).min(bins - 1);
    let mut in_bin: Vec<Vec<usize>> = vec![Vec::new(); bins * bins];
    for (k, (_, p)) in wanted.iter().enumerate() {
        in_bin[bin(p[1], 1) * bins + bin(p[0], 0)].push(k);
    }
    let mut best: Vec<Option<(f64, MetricPlace)>> = vec![None; wanted.len()];
    for triangle in developed {
        let corners = triangle.corners.map(|p| p.map(|x| x as f64));
        let range = |k: usize| {
            let x = corners.map(|p| p[k]);
            let low = x.into_iter().fold(f64::INFINITY, f64::min);
            let high = x.into_iter().fold(f64::NEG_INFINITY, f64::max);
            bin(low, k)..=bin(high, k)
        };
        for row in range(1) {
            for column in range(0) {
                for &k in &in_bin[row * bins + column] {
                    let Some(weights) = weights(corners, wanted[k].1) else { continue };
                    let least = weights.into_iter().fold(f64::INFINITY, f64::min);
                    if best[k].is_none_or(|(most, _)| least > most) {
                        best[k] = Some((least, (triangle.face, weights)));
                    }
                }
            }
        }
    }
    debug_assert!(developed.iter().all(|t| t.face.index() < surface.mesh.n_faces()));
    for ((point, _), found) in wanted.iter().zip(best) {
        places[*point as usize] = found.map(|(_, (face, weights))| (face, inside(weights)));
    }
}

/// Barycentric coordinates of a point.
fn weights([a, b, c]: [[f64; 2]; 3], p: [f64; 2]) -> Option<[f64; 3]> {
    let area =
        |a: [f64; 2], b: [f64; 2], c: [f64; 2]| (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    let parts = [area(p, b, c), area(p, c, a), area(p, a, b)];
    let total = area(a, b, c);
    (total > 0.0).then(|| parts.map(|x| x / total))
}

/// Weights that are not negative and have the sum 1.
fn inside(weights: [f64; 3]) -> [f64; 3] {
    let positive = weights.map(|x| x.max(0.0));
    let total: f64 = positive.iter().sum();
    positive.map(|x| x / total)
}
