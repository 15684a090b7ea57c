//! The flatness of a triangle: whether it has an orientation, or so little area that rounding of its coordinates could have made it.

use super::complex::{cross, norm, norm2, sub};
use super::model::klein;
use super::triangle_overlap::TriangleCorners;
use super::vector;

/// Least area of a triangle over the square of its longest edge. With less area than this, and than what rounding of coordinates adds to
/// it, a triangle counts as degenerate; with as much area clockwise, as flipped. Crossings of edges that should coincide give such slivers,
/// since each crossing is rounded.
pub const LEAST_RELATIVE_AREA: f64 = 1e-12;

/// The area and the size of a triangle in the plane, from which its orientation follows.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct TriangleFlatness {
    /// The signed area over the square of the longest edge; 0 for a point.
    pub relative_area: f64,
    /// The length of the longest edge.
    pub longest: f64,
}

/// The orientation of a triangle, as far as rounding lets it be known.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum TriangleOrientation {
    /// Counterclockwise.
    Upright,
    /// Clockwise.
    Flipped,
    /// Without area.
    Degenerate,
}

impl TriangleFlatness {
    pub fn of([a, b, c]: TriangleCorners) -> TriangleFlatness {
        let edges = [sub(b, a), sub(c, b), sub(a, c)];
        let square = edges.into_iter().map(norm2).fold(0.0, f64::max);
        // The squares of very small and very large lengths are not normal numbers.
        let longest =
            if square.is_normal() { square.sqrt() } else { edges.into_iter().map(norm).fold(0.0, f64::max) };
        if longest == 0.0 {
            return TriangleFlatness { relative_area: 0.0, longest };
        }
        let [p, q, _] = edges.map(|e| e.map(|x| x / longest));
        TriangleFlatness { relative_area: 0.5 * cross(p, q), longest }
    }

    /// The flatness of a triangle in H² or S² that has been moved to the origin, where f64s are densest, and the size of the coordinates at
    /// which its corners were rounded. `corners`: in ambient coordinates where the triangle lies; `at_origin`: after the move.
    pub fn in_curved_space(corners: [[f64; 3]; 3], at_origin: [[f64; 3]; 3]) -> (TriangleFlatness, f64) {
        let extent = corners.map(|[x, y, _]| x.hypot(y)).into_iter().fold(1.0, f64::max);
        (TriangleFlatness::of(at_origin.map(klein)), extent)
    }

    /// The relative area beyond which the triangle has an orientation: [`LEAST_RELATIVE_AREA`], and the change by rounding coordinates of
    /// the size `extent`.
    ///
    /// The height over the longest edge is twice the relative area times that edge: it must exceed two spacings of f64s at `extent`.
    fn least(&self, extent: f64) -> f64 {
        LEAST_RELATIVE_AREA + f64::EPSILON * extent / self.longest
    }

    pub fn is_flipped(&self, extent: f64) -> bool {
        self.relative_area < -self.least(extent)
    }

    pub fn is_degenerate(&self, extent: f64) -> bool {
        self.relative_area.abs() <= self.least(extent)
    }

    /// The orientation of a triangle whose coordinates were rounded at the size `extent`.
    pub fn orientation(&self, extent: f64) -> TriangleOrientation {
        if self.is_flipped(extent) {
            TriangleOrientation::Flipped
        } else if self.is_degenerate(extent) {
            TriangleOrientation::Degenerate
        } else {
            TriangleOrientation::Upright
        }
    }
}

/// Largest cosh of the distance from the origin at which f64s show the orientation of a triangle in H² without a move to the origin.
const NEAR: f64 = 16.0;
/// Range of the square of the longest edge, as a vector of space, in which that is so.
const MIDDLE: std::ops::RangeInclusive<f64> = 1e-10..=1.0;
/// Least determinant of such a triangle's corners, over that square, for which the triangle surely has area: the relative area of the
/// triangle moved to the origin is about half of it, then above 1e-7, and [`TriangleFlatness::least`] is below that.
const SURE: f64 = 1e-6;

/// True if a triangle with these corners on the hyperboloid surely is [`TriangleOrientation::Upright`]; any other triangle has to be moved
/// to the origin and measured there.
pub(crate) fn is_surely_upright([p, q, r]: [[f64; 3]; 3]) -> bool {
    let edges = [vector::sub(q, p), vector::sub(r, p), vector::sub(r, q)];
    let longest = edges.iter().map(|&e| vector::dot(e, e)).fold(0.0, f64::max);
    let det = vector::dot(p, vector::cross(edges[0], edges[1]));
    [p, q, r].iter().all(|p| p[2] < NEAR) && MIDDLE.contains(&longest) && det > SURE * longest
}

/// The largest absolute value of the points' coordinates.
pub(crate) fn largest_coordinate(points: &[[f64; 2]]) -> f64 {
    points.as_flattened().iter().fold(0.0, |m, x| m.max(x.abs()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::motion::precise_point;
    use crate::geometry::{Motion, Space};

    #[test]
    fn a_triangle_that_is_surely_upright_is_upright_at_the_origin() {
        let mut sure = 0;
        for (far, size) in [(0.1, 1e-3), (1.0, 0.3), (3.0, 0.01), (3.4, 1e-4), (6.0, 0.1), (2.0, 1e-7)] {
            for thin in [1.0, 1e-3, 1e-5, 1e-7, 1e-13, -1e-5, -1.0] {
                let corners = [
                    [far, 0.0],
                    [far + 0.6 * size, 0.8 * size],
                    [far + 0.6 * size - thin * size, 0.8 * size],
                ]
                .map(|[x, y]: [f64; 2]| [x, y, (1.0 + x * x + y * y).sqrt()]);
                let home = Motion::to_origin(Space::H2, precise_point(Space::H2, corners[0]));
                let at_home = corners.map(|p| home.apply(precise_point(Space::H2, p)).map(f64::from));
                let (flatness, extent) = TriangleFlatness::in_curved_space(corners, at_home);
                let is_sure = is_surely_upright(corners);
                assert!(
                    !is_sure || flatness.orientation(extent) == TriangleOrientation::Upright,
                    "{far} {size} {thin}"
                );
                assert!(!is_sure || flatness.relative_area > 1e-7);
                sure += usize::from(is_sure);
            }
        }
        assert!(sure > 8, "{sure}");
    }
}
