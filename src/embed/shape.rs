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
use crate::geometry::vector;
use crate::mesh::Point;

/// Least area of a triangle over the square of its longest edge. Below this, and what rounding of coordinates adds to it, a triangle counts
/// as degenerate; with as much area clockwise, as flipped. Crossings that should coincide give such slivers, since each is rounded.
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

    /// The share beyond which the triangle has an orientation: [`LEAST_SHARE`], and the change by rounding coordinates of the size
    /// `extent`.
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

/// How a triangle lies, as far as rounding lets that be known.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Standing {
    /// Counterclockwise.
    Upright,
    /// Clockwise.
    Flipped,
    /// Without area.
    Degenerate,
}

impl Standing {
    pub fn of(shape: &Shape, extent: f64) -> Standing {
        match () {
            () if shape.is_flipped(extent) => Standing::Flipped,
            () if shape.is_degenerate(extent) => Standing::Degenerate,
            () => Standing::Upright,
        }
    }
}

/// cosh of the distance from the origin up to which doubles show how triangles in H² lie where they lie.
const NEAR: f64 = 16.0;
/// Squares of lengths of the longest edge, as a vector of space, for which that is so.
const MIDDLE: std::ops::RangeInclusive<f64> = 1e-10..=1.0;
/// The determinant of such a triangle's corners over that square from which on it surely has area: [`Shape::share`] of the triangle moved to
/// the origin, about half of it, is then above 1e-7, and [`Shape::least`] below.
const SURE: f64 = 1e-6;

/// Whether a triangle with these corners on the hyperboloid surely is [`Standing::Upright`]; where it is not so sure, it has to be measured
/// at the origin.
pub(crate) fn is_surely_upright([p, q, r]: [Point; 3]) -> bool {
    let edges = [vector::sub(q, p), vector::sub(r, p), vector::sub(r, q)];
    let longest = edges.iter().map(|&e| vector::dot(e, e)).fold(0.0, f64::max);
    let det = vector::dot(p, vector::cross(edges[0], edges[1]));
    [p, q, r].iter().all(|p| p[2] < NEAR) && MIDDLE.contains(&longest) && det > SURE * longest
}

/// The largest absolute value of the points' coordinates.
pub(crate) fn extent(points: &[[f64; 2]]) -> f64 {
    points.as_flattened().iter().fold(0.0, |m, x| m.max(x.abs()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::embed::layout::shape_of;
    use crate::geometry::motion::precise_point;
    use crate::geometry::{Motion, Space};

    #[test]
    fn what_surely_stands_upright_does_so_at_the_origin() {
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
                let (shape, extent) = shape_of(corners, at_home);
                let is_sure = is_surely_upright(corners);
                assert!(!is_sure || Standing::of(&shape, extent) == Standing::Upright, "{far} {size} {thin}");
                assert!(!is_sure || shape.share > 1e-7);
                sure += usize::from(is_sure);
            }
        }
        assert!(sure > 8, "{sure}");
    }
}
