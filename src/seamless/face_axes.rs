//! Axes in the plane of a triangle in space.

use crate::geometry::vector::{self, Vector};
use crate::mesh::Point;

/// Two axes at right angles in a triangle, the first along its first side.
pub(super) struct FaceAxes {
    axes: [Vector; 2],
    pub area: f64,
}

impl FaceAxes {
    /// None for a triangle without area.
    pub fn new(places: [Point; 3]) -> Option<FaceAxes> {
        let normal = vector::triangle_normal(places);
        let area = 0.5 * vector::norm(normal);
        let first = vector::normalised(vector::sub(places[1], places[0]));
        let second = vector::cross(vector::normalised(normal), first);
        (area > 0.0 && vector::norm(second) > 0.5).then_some(FaceAxes { axes: [first, second], area })
    }

    /// The part of a vector in the plane of the triangle.
    pub fn flat(&self, v: Vector) -> [f64; 2] {
        self.axes.map(|axis| vector::dot(axis, v))
    }

    /// The unit vector at an angle, radians, from the first axis towards the second.
    pub fn direction(&self, angle: f64) -> Vector {
        let (sin, cos) = angle.sin_cos();
        vector::add(vector::scale(cos, self.axes[0]), vector::scale(sin, self.axes[1]))
    }
}
