//! Orientation-preserving isometries of the Euclidean plane, as a rotation angle and a translation.
//!
//! ```
//! use ricci::geometry::PlaneIsometry;
//! let quarter_turn = PlaneIsometry::new(0.5 * std::f64::consts::PI, [1.0, 0.0]);
//! let [x, y] = quarter_turn.apply([2.0, 0.0]);
//! assert!((x - 1.0).abs() < 1e-15 && (y - 2.0).abs() < 1e-15);
//! ```

use super::complex::{add, cross, dot, mul, sub};
use super::{DoubleDouble, Motion};
use crate::archive::stored;
use std::f64::consts::{PI, TAU};

/// `z ↦ e^{iθ} z + t`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlaneIsometry {
    /// Rotation angle θ ∈ (−π, π], radians, counterclockwise.
    pub rotation: f64,
    /// Translation t.
    pub translation: [f64; 2],
}
stored!(sections PlaneIsometry { rotation, translation });

impl PlaneIsometry {
    /// The identity.
    pub const IDENTITY: PlaneIsometry = PlaneIsometry { rotation: 0.0, translation: [0.0; 2] };

    /// Rotation by `angle` (any real number) about the origin, then translation.
    pub fn new(angle: f64, translation: [f64; 2]) -> Self {
        PlaneIsometry { rotation: principal_angle(angle), translation }
    }

    /// The image of a point.
    pub fn apply(&self, p: [f64; 2]) -> [f64; 2] {
        add(self.apply_vector(p), self.translation)
    }

    /// The image of a direction, which is only rotated.
    pub fn apply_vector(&self, direction: [f64; 2]) -> [f64; 2] {
        let (sin, cos) = self.rotation.sin_cos();
        mul([cos, sin], direction)
    }

    /// The isometry that maps each `p` to its `q` as well as possible.
    ///
    /// `vectors`: pairs of corresponding directions; the rotation maximises Σ ⟨R p, q⟩, so each pair counts
    /// with the product of its norms. `points`: pairs of corresponding points; the translation is the
    /// least-squares one for that rotation. Without vectors the rotation is 0, without points the
    /// translation.
    pub fn fit(
        vectors: impl IntoIterator<Item = ([f64; 2], [f64; 2])>,
        points: impl IntoIterator<Item = ([f64; 2], [f64; 2])>,
    ) -> PlaneIsometry {
        let (mut cos, mut sin) = (0.0, 0.0);
        for (p, q) in vectors {
            cos += dot(p, q);
            sin += cross(p, q);
        }
        let turn = PlaneIsometry::new(sin.atan2(cos), [0.0; 2]);
        let (mut sum, mut n) = ([0.0; 2], 0.0);
        for (p, q) in points {
            sum = add(sum, sub(q, turn.apply_vector(p)));
            n += 1.0;
        }
        let n = f64::max(n, 1.0);
        PlaneIsometry { translation: sum.map(|x| x / n), ..turn }
    }
}

impl From<Motion<DoubleDouble>> for PlaneIsometry {
    /// The isometry of a motion of E².
    fn from(g: Motion<DoubleDouble>) -> PlaneIsometry {
        let [x, y, _] = g.origin().map(f64::from);
        let [cos, sin] = g.a.map(f64::from);
        PlaneIsometry::new(2.0 * sin.atan2(cos), [x, y])
    }
}

/// The angle in (−π, π] that differs from `angle` by a multiple of 2π.
pub fn principal_angle(angle: f64) -> f64 {
    let r = angle % TAU;
    if r > PI {
        r - TAU
    } else if r <= -PI {
        r + TAU
    } else {
        r
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(p: [f64; 2], q: [f64; 2]) -> bool {
        (p[0] - q[0]).hypot(p[1] - q[1]) < 1e-14
    }

    #[test]
    fn isometries_are_those_of_the_motions_that_they_come_from() {
        let place = [0.3, -1.0];
        let g = PlaneIsometry::new(2.5, place);
        let direction = [g.rotation.cos(), g.rotation.sin()].map(DoubleDouble::from);
        let from = PlaneIsometry::from(Motion::in_plane(direction, place.map(DoubleDouble::from)));
        assert!((from.rotation - g.rotation).abs() < 1e-15 && close(from.translation, g.translation));
        assert!(close(from.apply([0.7, -0.2]), g.apply([0.7, -0.2])));
    }

    #[test]
    fn principal_angles_lie_in_the_half_open_interval() {
        assert_eq!(principal_angle(PI), PI);
        assert_eq!(principal_angle(-PI), PI);
        assert_eq!(principal_angle(3.0 * PI), PI);
        assert!((principal_angle(7.0) - (7.0 - TAU)).abs() < 1e-15);
    }

    #[test]
    fn fit_recovers_an_isometry_from_its_action() {
        let g = PlaneIsometry::new(-2.0, [5.0, 7.0]);
        let points = [[0.0, 0.0], [1.0, 0.5], [-2.0, 3.0]];
        let pairs = points.map(|p| (p, g.apply(p)));
        let vectors = points.map(|p| (p, g.apply_vector(p)));
        let fit = PlaneIsometry::fit(vectors, pairs);
        assert!((fit.rotation - g.rotation).abs() < 1e-15 && close(fit.translation, g.translation));
    }
}
