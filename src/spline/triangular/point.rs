//! Points of surfaces with derivatives, and the normal and curvatures that follow from them.

use crate::geometry::vector::{self, Vector};

/// A point of a surface with its derivatives by the coordinates (x, y) of the chart.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfacePoint {
    /// The point.
    pub point: Vector,
    /// First derivatives: by x, by y.
    pub first: [Vector; 2],
    /// Second derivatives: xx, xy, yy.
    pub second: [Vector; 3],
}

impl Default for SurfacePoint {
    fn default() -> Self {
        SurfacePoint { point: [0.0; 3], first: [[0.0; 3]; 2], second: [[0.0; 3]; 3] }
    }
}

impl SurfacePoint {
    /// The point with its derivatives beyond an order set to 0.
    pub(super) fn truncated(self, order: usize) -> SurfacePoint {
        let zero = SurfacePoint::default();
        let first = if order < 1 { zero.first } else { self.first };
        SurfacePoint { first, second: if order < 2 { zero.second } else { self.second }, ..self }
    }

    /// The unit normal, on the side from which the chart is seen counterclockwise; none if the first derivatives are parallel.
    pub fn normal(&self) -> Option<Vector> {
        let across = vector::cross(self.first[0], self.first[1]);
        let length = vector::norm(across);
        (length > 0.0).then(|| across.map(|x| x / length))
    }

    /// The Gauss–Newton step: the change of the coordinates to the nearest point of the tangent plane to a point. None if the first
    /// derivatives are parallel.
    pub fn step_towards(&self, point: Vector) -> Option<[f64; 2]> {
        let [x, y] = self.first;
        let miss = vector::sub(point, self.point);
        let (a, b, c) = (vector::dot(x, x), vector::dot(x, y), vector::dot(y, y));
        let (p, q) = (vector::dot(x, miss), vector::dot(y, miss));
        let det = a * c - b * b;
        let step = [(c * p - b * q) / det, (a * q - b * p) / det];
        step.iter().all(|x| x.is_finite()).then_some(step)
    }

    /// The principal curvatures, the larger one first, positive where the surface bends towards its normal; none without a normal.
    pub fn principal_curvatures(&self) -> Option<[f64; 2]> {
        let normal = self.normal()?;
        let [x, y] = self.first;
        let [e, f, g] = [vector::dot(x, x), vector::dot(x, y), vector::dot(y, y)];
        let [l, m, n] = self.second.map(|d| vector::dot(d, normal));
        let det = e * g - f * f;
        let mean = 0.5 * (e * n - 2.0 * f * m + g * l) / det;
        let gauss = (l * n - m * m) / det;
        let half = (mean * mean - gauss).max(0.0).sqrt();
        let curvatures = [mean + half, mean - half];
        curvatures.iter().all(|k| k.is_finite()).then_some(curvatures)
    }
}
