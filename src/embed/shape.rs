//! How flat a triangle in the plane is, and how much rounding of its coordinates changes that.
//!
//! ```
//! use ricci::embed::{layout, shape::LEAST_SHARE};
//! use ricci::{Control, Surface, mesh::shapes, topology::cut_graph};
//! # fn main() -> ricci::Result<()> {
//! let disk = Surface::from_soup(&shapes::disk(4)?)?;
//! let cut = cut_graph(disk.mesh(), disk.lengths(), &[], &Control::new())?;
//! let layout = layout(disk.mesh(), disk.lengths(), &cut, &Control::new())?;
//! // The smallest angles of this disk are far from those of a degenerate triangle.
//! assert!(disk.lengths().iter().all(|l| *l > LEAST_SHARE * layout.diameter));
//! # Ok(())
//! # }
//! ```

use super::overlap::Triangle;
use crate::geometry::complex::{cross, norm, norm2, sub};

/// Least area of a triangle over the square of its longest edge. Below this, and what rounding of coordinates adds to it, a triangle counts as
/// degenerate; with as much area clockwise, as flipped. Crossings that should coincide give such slivers, since each is rounded.
pub const LEAST_SHARE: f64 = 1e-12;

/// A triangle in the plane.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Shape {
    /// Signed area over the square of the longest edge; 0 for a point.
    pub share: f64,
    pub longest: f64,
}

impl Shape {
    pub fn of([a, b, c]: Triangle) -> Shape {
        let edges = [sub(b, a), sub(c, b), sub(a, c)];
        let square = edges.into_iter().map(norm2).fold(0.0, f64::max);
        // The squares of very small and very large lengths are not normal numbers.
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

    /// The share beyond which the triangle has an orientation: [`LEAST_SHARE`], and the change by rounding coordinates of the size `extent`.
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

/// The largest absolute value of the points' coordinates.
pub(crate) fn extent(points: &[[f64; 2]]) -> f64 {
    points.as_flattened().iter().fold(0.0, |m, x| m.max(x.abs()))
}
