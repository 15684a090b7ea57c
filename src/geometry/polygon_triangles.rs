//! Triangles of a polygon in the plane, without further vertices (constrained Delaunay triangulation by the crate `spade`).
//!
//! ```
//! use ricci::geometry::polygon_triangles::polygon_triangles;
//! let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
//! assert_eq!(polygon_triangles(&square).map(|t| t.len()), Some(2));
//! let crossed = [square[0], square[2], square[1], square[3]];
//! assert_eq!(polygon_triangles(&crossed), None);
//! ```

use super::complex::{Complex, norm, scale, sub};
use spade::{ConstrainedDelaunayTriangulation, Point2, Triangulation};
use std::collections::BTreeSet;

/// Coordinates, in units of the polygon's size, below which `spade` may refuse a point: they are taken as 0.
const LEAST_COORDINATE: f64 = 1e-40;

/// The triangles inside a polygon, each by the numbers of three corners, counterclockwise; `None` unless the polygon is simple and runs
/// counterclockwise.
pub fn polygon_triangles(polygon: &[Complex]) -> Option<Vec<[u32; 3]>> {
    let first = polygon.first()?;
    let size = polygon.iter().map(|&p| norm(sub(p, *first))).fold(0.0, f64::max);
    let mut triangulation = ConstrainedDelaunayTriangulation::<Point2<f64>>::new();
    let mut corners = Vec::with_capacity(polygon.len());
    for &p in polygon {
        let [x, y] =
            scale(1.0 / size, sub(p, *first)).map(|x| if x.abs() < LEAST_COORDINATE { 0.0 } else { x });
        corners.push(triangulation.insert(Point2::new(x, y)).ok()?);
    }
    // Points that coincide share a vertex, whose number is then not that of the corner.
    if corners.iter().enumerate().any(|(i, corner)| corner.index() != i) {
        return None;
    }
    let sides = || (0..corners.len()).map(|i| (corners[i], corners[(i + 1) % corners.len()]));
    for (from, to) in sides() {
        if !triangulation.can_add_constraint(from, to) {
            return None;
        }
        triangulation.add_constraint(from, to);
    }
    let mut open = Vec::new();
    for (from, to) in sides() {
        open.push(triangulation.get_edge_from_neighbors(from, to)?.face().as_inner()?);
    }
    let (mut seen, mut triangles) = (BTreeSet::new(), Vec::new());
    while let Some(face) = open.pop() {
        if !seen.insert(face.fix().index()) {
            continue;
        }
        triangles.push(face.vertices().map(|v| v.fix().index() as u32));
        for edge in face.adjacent_edges().into_iter().filter(|edge| !edge.is_constraint_edge()) {
            open.push(edge.rev().face().as_inner()?);
        }
    }
    triangles.sort_unstable();
    (triangles.len() + 2 == polygon.len()).then_some(triangles)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::complex::cross;

    #[test]
    fn triangles_cover_a_polygon_that_is_not_convex() {
        let star: Vec<Complex> = (0..10)
            .map(|k| {
                let (radius, angle) =
                    (if k % 2 == 0 { 1.0 } else { 0.3 }, 0.2 * std::f64::consts::PI * f64::from(k));
                [radius * angle.cos(), radius * angle.sin()]
            })
            .collect();
        let triangles = polygon_triangles(&star).unwrap();
        let doubled = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|i| star[i as usize]);
            cross(sub(b, a), sub(c, a))
        };
        let around: f64 = (0..10).map(|k| cross(star[k], star[(k + 1) % 10])).sum();
        assert!(triangles.iter().all(|t| doubled(t) > 0.0));
        assert!((triangles.iter().map(doubled).sum::<f64>() - around).abs() < 1e-14);
        let clockwise: Vec<Complex> = star.into_iter().rev().collect();
        assert_eq!(polygon_triangles(&clockwise), None);
    }

    #[test]
    fn points_on_a_side_and_repeated_points() {
        let side = |k: usize| k as f64 / 8.0;
        let mut square: Vec<Complex> = (0..8).map(|k| [side(k), 0.0]).collect();
        square.extend((0..8).map(|k| [1.0, side(k)]));
        square.extend((0..8).map(|k| [1.0 - side(k), 1.0]));
        square.extend((0..8).map(|k| [0.0, 1.0 - side(k)]));
        assert_eq!(polygon_triangles(&square).unwrap().len(), 30);
        square[5] = square[4];
        assert_eq!(polygon_triangles(&square), None);
        assert_eq!(polygon_triangles(&[]), None);
        assert_eq!(polygon_triangles(&[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]]), None);
    }
}
