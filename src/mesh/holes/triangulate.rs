//! Triangulations of closed polygons in space.

use crate::geometry::vector;
use crate::mesh::Point;

/// Most edges of a loop whose least area is sought among all triangulations, in time n³ and memory 12 n²: half a second and 3 MB.
pub const MOST_EXACT: usize = 500;

/// Weight of the squared edges beside the area: it decides between triangulations of one area, as all are of a planar polygon, for short
/// edges, and moves the area by less than a hundredth of a percent.
const SHORT_EDGES: f64 = 1e-5;

/// Smallest height of a triangle as a share of its longest edge: a lower one counts as no area.
const THIN: f64 = 1e-7;

/// The weight of a triangle; infinite without area.
pub(super) fn weight(corners: [Point; 3]) -> f64 {
    let sides = [[0, 1], [1, 2], [2, 0]].map(|[i, j]| vector::sub(corners[j], corners[i]));
    let squares = sides.map(|side| vector::dot(side, side));
    let twice = vector::norm(vector::cross(sides[0], sides[1]));
    let longest = squares.into_iter().fold(0.0, f64::max);
    if twice <= THIN * longest {
        return f64::INFINITY;
    }
    0.5 * twice + SHORT_EDGES * squares.iter().sum::<f64>()
}

/// The triangles of a polygon of least area, counterclockwise as the polygon runs, by dynamic programming over the parts that one edge cuts
/// off \[BS95\]. No edge inside is one for which `is_taken` holds, and no triangle is without area. `None` if there is no such triangulation.
pub(super) fn least_area(points: &[Point], is_taken: &dyn Fn(usize, usize) -> bool) -> Option<Vec<[u32; 3]>> {
    let n = points.len();
    let at = |i: usize, j: usize| i * n + j;
    // For each pair i < j the least weight of the part between, and the third corner of its triangle at the edge ij.
    let mut least = vec![f64::INFINITY; n * n];
    let mut third = vec![0u32; n * n];
    (1..n).for_each(|j| least[at(j - 1, j)] = 0.0);
    for span in 2..n {
        for i in 0..n - span {
            let j = i + span;
            if span < n - 1 && is_taken(i, j) {
                continue;
            }
            for k in i + 1..j {
                let parts = least[at(i, k)] + least[at(k, j)];
                // Most parts are too large without the triangle.
                if parts < least[at(i, j)] {
                    let whole = parts + weight([points[i], points[k], points[j]]);
                    if whole < least[at(i, j)] {
                        (least[at(i, j)], third[at(i, j)]) = (whole, k as u32);
                    }
                }
            }
        }
    }
    if n < 3 || least[at(0, n - 1)].is_infinite() {
        return None;
    }
    let (mut triangles, mut open) = (Vec::with_capacity(n - 2), vec![[0, n - 1]]);
    while let Some([i, j]) = open.pop() {
        if j > i + 1 {
            let k = third[at(i, j)] as usize;
            triangles.push([i as u32, k as u32, j as u32]);
            open.extend([[i, k], [k, j]]);
        }
    }
    Some(triangles)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::holes::ears;

    #[test]
    fn a_polygon_that_is_not_convex_has_its_own_area() {
        // An L: 7 of 9 unit squares less 4.
        let corners = [[0.0, 0.0], [3.0, 0.0], [3.0, 1.0], [1.0, 1.0], [1.0, 3.0], [0.0, 3.0]];
        let mut points = Vec::new();
        for k in 0..6 {
            let (p, q): ([f64; 2], [f64; 2]) = (corners[k], corners[(k + 1) % 6]);
            points.extend((0..8).map(|i| {
                let t = f64::from(i) / 8.0;
                [p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1]), 0.0]
            }));
        }
        for triangles in [least_area(&points, &|_, _| false), ears::cut_ears(&points, &|_, _| false)] {
            let triangles = triangles.unwrap();
            let normal = |t: &[u32; 3]| vector::triangle_normal(t.map(|k| points[k as usize]))[2];
            assert_eq!(triangles.len(), points.len() - 2);
            assert!(triangles.iter().all(|t| normal(t) > 0.0));
            let area: f64 = triangles.iter().map(|t| 0.5 * normal(t)).sum();
            assert!((area - 5.0).abs() < 1e-12, "{area}");
        }
        // On a line there is none, and a square whose two diagonals are taken has none.
        let line: Vec<Point> = (0..5).map(|k| [f64::from(k), 0.0, 0.0]).collect();
        assert_eq!(least_area(&line, &|_, _| false), None);
        let square = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
        assert_eq!(least_area(&square, &|_, _| true), None);
        assert_eq!(ears::cut_ears(&square, &|_, _| true), None);
    }
}
