//! How flat a triangle in the plane is, and what rounding of its coordinates does to that.

use super::overlap::Triangle;
use crate::geometry::complex::{cross, norm, norm2, sub};

/// A triangle counts as flipped where its area is below −this · longest edge² and what rounding its coordinates does to it, as
/// degenerate within that of zero: thinner pieces are what rounding makes of crossings that coincide.
pub const LEAST_SHARE: f64 = 1e-12;

/// A triangle in the plane.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Shape {
    /// Signed area over the square of the longest edge; 0 for a point.
    pub share: f64,
    pub longest: f64,
}

impl Shape {
    pub fn of([a, b, c]: Triangle) -> Shape {
        let edges = [sub(b, a), sub(c, b), sub(a, c)];
        let square = edges.into_iter().map(norm2).fold(0.0, f64::max);
        // Squares of the smallest and the largest doubles are none.
        let longest = match square.is_normal() {
            true => square.sqrt(),
            false => edges.into_iter().map(norm).fold(0.0, f64::max),
        };
        if longest == 0.0 {
            return Shape { share: 0.0, longest };
        }
        let [p, q, _] = edges.map(|e| e.map(|x| x / longest));
        Shape { share: 0.5 * cross(p, q), longest }
    }

    /// What its share must exceed to count: [`LEAST_SHARE`], and what rounding coordinates of size `extent` does to it.
    ///
    /// The height over the longest edge is twice the share times that edge: it must exceed two spacings of doubles at `extent`.
    fn least(&self, extent: f64) -> f64 {
        LEAST_SHARE + f64::EPSILON * extent / self.longest
    }

    pub fn is_flipped(&self, extent: f64) -> bool {
        self.share < -self.least(extent)
    }

    pub fn is_degenerate(&self, extent: f64) -> bool {
        self.share.abs() <= self.least(extent)
    }
}

/// The largest coordinate of some points, in size.
pub(super) fn extent(points: &[[f64; 2]]) -> f64 {
    points.as_flattened().iter().fold(0.0, |m, x| m.max(x.abs()))
}
