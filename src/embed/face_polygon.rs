//! The triangulation of a face of the input whose sides may be split: no triangle turns over, and the fewest points are added.
//!
//! ```text
//!            2              The points of the border, counterclockwise: the corners and the places where a side may be split. Triangles
//!           / \             have their corners at some of them, at those that are taken already in any case. Triangles of three points
//!          s   t            of one side have no area in the face, and are not allowed. The cheapest triangulation between the points i
//!         /     \           and j is found from those of smaller parts: a triangle i, k, j and what lies beyond its other two sides.
//!        0———r———1
//! ```

use crate::geometry::complex::{cross, norm2, sub};
use crate::geometry::predicates::orientation;
use crate::mesh::EdgeId;
use std::cmp::Ordering;

/// The spot of a point on the border of a face.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum BorderSpot {
    /// This corner of the face.
    Corner(usize),
    /// This crossing of an edge of the input, counted along its half-edge 2e.
    Crossing(EdgeId, u32),
}

/// A point on the border of a face at which triangles may have a corner.
#[derive(Debug, Clone, Copy)]
pub(super) struct BorderPoint {
    pub spot: BorderSpot,
    /// Its number in [`super::Layout::points`].
    pub corner: u32,
    /// Its place in the layout.
    pub place: [f64; 2],
    /// The weights of the corners of the face.
    pub weights: [f64; 3],
    /// The price of a corner of a triangle here; 0 if triangles have corners here in any case.
    pub price: u32,
}

/// The cost of a triangulation; the first number that differs decides which is the least.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
pub(super) struct TriangulationCost {
    /// The number of triangles that are not counterclockwise in the layout.
    pub folded: u32,
    /// The sum of the prices of the points.
    pub price: u32,
    /// The sum over the triangles of the square of the longest side over the area, in the layout and in the face.
    pub flatness: f64,
}

impl TriangulationCost {
    const NOTHING: TriangulationCost = TriangulationCost { folded: 0, price: 0, flatness: 0.0 };
    /// That of a triangulation that is not allowed. Sums of three such do not overflow.
    const NEVER: TriangulationCost = TriangulationCost { folded: u32::MAX / 4, price: 0, flatness: 0.0 };

    fn plus(self, other: TriangulationCost) -> TriangulationCost {
        TriangulationCost {
            folded: (self.folded + other.folded).min(TriangulationCost::NEVER.folded),
            price: self.price + other.price,
            flatness: self.flatness + other.flatness,
        }
    }
}

/// Most that one triangle adds to [`TriangulationCost::flatness`], so that sums stay finite.
const FLATTEST: f64 = 1e30;

/// A triangulation of a face.
pub(super) struct FaceTriangulation {
    pub cost: TriangulationCost,
    /// The corners of the triangles, as numbers of points of the polygon.
    pub triangles: Vec<[usize; 3]>,
}

/// The border of a face.
pub(super) struct FacePolygon {
    /// Counterclockwise from corner 0.
    pub points: Vec<BorderPoint>,
    /// The numbers of the corners among the points, then the number of points.
    pub start: [usize; 4],
}

impl FacePolygon {
    fn point(&self, i: usize) -> &BorderPoint {
        &self.points[i % self.points.len()]
    }

    /// True if both points lie on one side of the face.
    fn on_one_side(&self, i: usize, j: usize) -> bool {
        (0..3).any(|k| self.start[k] <= i && j <= self.start[k + 1])
    }

    /// True if a point between i and j has to be a corner of triangles.
    fn is_needed_between(&self, i: usize, j: usize) -> bool {
        self.points[i + 1..j].iter().any(|p| p.price == 0)
    }

    /// The cost of a triangle with the corners i < k < j, without that of its corners.
    fn triangle(&self, i: usize, k: usize, j: usize) -> TriangulationCost {
        // Point number n is corner 0 once more, which also lies on the first side.
        let ends_on_first = j == self.points.len() && k <= self.start[1];
        if self.on_one_side(i, j) || ends_on_first {
            return TriangulationCost::NEVER;
        }
        let corners = [i, k, j].map(|i| self.point(i));
        let [a, b, c] = corners.map(|p| p.place);
        if orientation(a, b, c) != Ordering::Greater {
            return TriangulationCost { folded: 1, price: 0, flatness: 0.0 };
        }
        // The face as an equilateral triangle.
        let in_face = corners.map(|p| [p.weights[1] + 0.5 * p.weights[2], 0.75f64.sqrt() * p.weights[2]]);
        let flatness = flatness([a, b, c]) + flatness(in_face);
        TriangulationCost { folded: 0, price: 0, flatness }
    }

    /// The triangulation of least cost. O(n³) for n points.
    pub fn triangulate(&self) -> FaceTriangulation {
        let n = self.points.len();
        let width = n + 1;
        // Per pair i < j, the cost of what lies between the points i and j, and the third corner of the triangle on that side.
        let mut best = vec![(TriangulationCost::NEVER, usize::MAX); width * width];
        for length in 1..n {
            for i in 1..=n - length {
                let j = i + length;
                best[i * width + j] = if self.on_one_side(i, j) {
                    let whole = !self.is_needed_between(i, j);
                    (if whole { TriangulationCost::NOTHING } else { TriangulationCost::NEVER }, usize::MAX)
                } else {
                    self.cheapest(&best, i, j)
                };
            }
        }
        let first = (1..=self.start[1]).filter(|&j| !self.is_needed_between(0, j)).map(|j| {
            let price = TriangulationCost { price: self.points[j].price, ..TriangulationCost::NOTHING };
            (best[j * width + n].0.plus(price), j)
        });
        let never = (TriangulationCost::NEVER, self.start[1]);
        let (cost, first) = first.fold(never, |least, next| if next.0 < least.0 { next } else { least });
        let (mut triangles, mut open) = (Vec::with_capacity(n), vec![(first, n)]);
        while let Some((i, j)) = open.pop() {
            let k = best[i * width + j].1;
            if k != usize::MAX {
                triangles.push([i, k, j % n]);
                open.extend([(i, k), (k, j)]);
            }
        }
        FaceTriangulation { cost, triangles }
    }

    /// The least cost of what lies between the points i and j of different sides, and the third corner of the triangle there.
    fn cheapest(
        &self,
        best: &[(TriangulationCost, usize)],
        i: usize,
        j: usize,
    ) -> (TriangulationCost, usize) {
        let width = self.points.len() + 1;
        let mut least = (TriangulationCost::NEVER, usize::MAX);
        for k in i + 1..j {
            let beyond = best[i * width + k].0.plus(best[k * width + j].0);
            if beyond.folded > least.0.folded {
                continue;
            }
            let price = TriangulationCost { price: self.points[k].price, ..TriangulationCost::NOTHING };
            let cost = beyond.plus(price).plus(self.triangle(i, k, j));
            if cost < least.0 {
                least = (cost, k);
            }
        }
        least
    }
}

/// The square of the longest side of a triangle over twice its area.
fn flatness([a, b, c]: [[f64; 2]; 3]) -> f64 {
    let longest = norm2(sub(b, a)).max(norm2(sub(c, b))).max(norm2(sub(a, c)));
    let found = longest / cross(sub(b, a), sub(c, a)).abs();
    if found < FLATTEST { found } else { FLATTEST }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A face with the corners (0, 0), (4, 0), (2, 1), whose side from corner 0 to corner 1 may be split in the middle, which lies at
    /// `middle` in the layout.
    fn face(top: [f64; 2], middle: [f64; 2]) -> FacePolygon {
        let corner = |k: usize, place: [f64; 2]| BorderPoint {
            spot: BorderSpot::Corner(k),
            corner: k as u32,
            place,
            weights: [0, 1, 2].map(|i| f64::from(u8::from(i == k))),
            price: 0,
        };
        let split = BorderPoint {
            spot: BorderSpot::Crossing(EdgeId(0), 1),
            corner: 3,
            place: middle,
            weights: [0.5, 0.5, 0.0],
            price: 2,
        };
        let points = vec![corner(0, [0.0, 0.0]), split, corner(1, [4.0, 0.0]), corner(2, top)];
        FacePolygon { points, start: [0, 2, 3, 4] }
    }

    #[test]
    fn a_face_that_does_not_fold_is_one_triangle() {
        let found = face([2.0, 1.0], [2.0, -0.5]).triangulate();
        assert_eq!((found.cost.folded, found.cost.price), (0, 0));
        assert_eq!(found.triangles, [[2, 3, 0]]);
    }

    #[test]
    fn a_face_that_folds_is_split_where_that_helps() {
        let found = face([2.0, -1.0], [2.0, -3.0]).triangulate();
        assert_eq!((found.cost.folded, found.cost.price), (0, 2));
        let mut triangles = found.triangles;
        triangles.sort_unstable();
        assert_eq!(triangles, [[1, 2, 3], [1, 3, 0]]);
    }

    #[test]
    fn a_face_that_folds_anyway_is_not_split() {
        let found = face([2.0, -1.0], [2.0, 0.0]).triangulate();
        assert_eq!((found.cost.folded, found.cost.price), (1, 0));
        assert_eq!(found.triangles.len(), 1);
    }

    #[test]
    fn a_point_that_is_taken_is_a_corner_of_triangles() {
        let mut polygon = face([2.0, 1.0], [2.0, -0.5]);
        polygon.points[1].price = 0;
        let found = polygon.triangulate();
        assert_eq!((found.cost.folded, found.triangles.len()), (0, 2));
    }
}
