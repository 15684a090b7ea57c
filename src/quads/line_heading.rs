//! A line along an axis in the coordinates of one triangle: one whole coordinate, and its length as a function of the other.

use super::grid_vector::{Axis, GridMotion, GridPoint, minus};
use crate::mesh::HalfedgeId;

/// Farther away than any point of the grid, such that differences of two coordinates still are 64-bit numbers.
const FAR: i128 = 1 << 61;

/// The place at which a line comes into a triangle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum LinePlace {
    /// Across this half-edge of the triangle.
    Edge(HalfedgeId),
    /// At the origin of this half-edge of the triangle.
    Vertex(HalfedgeId),
}

impl LinePlace {
    pub fn halfedge(self) -> HalfedgeId {
        match self {
            LinePlace::Edge(h) | LinePlace::Vertex(h) => h,
        }
    }
}

/// A line in the coordinates of a triangle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct LineHeading {
    /// Its direction.
    pub axis: Axis,
    /// The coordinate that stays.
    pub fixed: i64,
    /// Its length where the other coordinate is 0.
    offset: i128,
    /// The place at which it comes.
    pub place: LinePlace,
}

impl LineHeading {
    /// A line through a point, at which it has this length.
    pub fn from_point(point: GridPoint, axis: Axis, length: i128, place: LinePlace) -> LineHeading {
        let moving = usize::from(axis % 2);
        let mut heading = LineHeading { axis, fixed: point[1 - moving], offset: 0, place };
        heading.offset = length - heading.length_at(point);
        heading
    }

    /// The number of the coordinate that changes along the line.
    pub fn moving(&self) -> usize {
        usize::from(self.axis % 2)
    }

    fn sign(&self) -> i128 {
        if self.axis < 2 { 1 } else { -1 }
    }

    /// The line's point whose other coordinate this is.
    pub fn point_at(&self, moving: i64) -> GridPoint {
        if self.moving() == 0 { [moving, self.fixed] } else { [self.fixed, moving] }
    }

    /// The line's length at one of its points.
    pub fn length_at(&self, point: GridPoint) -> i128 {
        self.sign() * i128::from(point[self.moving()]) + self.offset
    }

    /// The vector from a point of the line to another point.
    pub fn offset_of(&self, point: GridPoint) -> GridPoint {
        minus(point, self.point_at(0))
    }

    /// The point at which this line and one from the opposite direction have the same length.
    pub fn meeting_point(&self, other: &LineHeading) -> GridPoint {
        let doubled = self.sign() * (other.offset - self.offset);
        self.point_at((doubled / 2).clamp(-FAR, FAR) as i64)
    }

    /// The line in other coordinates.
    pub fn moved(&self, motion: &GridMotion, place: LinePlace) -> LineHeading {
        LineHeading::from_point(motion.apply(self.point_at(0)), motion.turn(self.axis), self.offset, place)
    }

    /// The length, rounded down, at which the line crosses a segment that is not parallel to it.
    pub fn floor_of_crossing(&self, a: GridPoint, b: GridPoint) -> i128 {
        let (m, f) = (self.moving(), 1 - self.moving());
        let product = i128::from(self.fixed - a[f]) * i128::from(b[m] - a[m]) * self.sign();
        let width = i128::from(b[f] - a[f]);
        let along = if width < 0 { (-product).div_euclid(-width) } else { product.div_euclid(width) };
        self.length_at(a) + along
    }
}
