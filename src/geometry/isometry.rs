//! Orientation-preserving isometries of the plane.

use super::{Motion, Twofold};
use std::f64::consts::{PI, TAU};

/// `z ↦ e^{iθ} z + t`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlaneIsometry {
    /// Rotation angle θ ∈ (−π, π], radians, counterclockwise.
    pub rotation: f64,
    /// Translation t.
    pub translation: [f64; 2],
}

impl PlaneIsometry {
    /// The identity.
    pub const IDENTITY: PlaneIsometry = PlaneIsometry { rotation: 0.0, translation: [0.0; 2] };

    /// Rotation by `angle` (any real number) about the origin, then translation.
    pub fn new(angle: f64, translation: [f64; 2]) -> Self {
        PlaneIsometry { rotation: principal_angle(angle), translation }
    }

    /// The image of a point.
    pub fn apply(&self, p: [f64; 2]) -> [f64; 2] {
        let [x, y] = self.apply_vector(p);
        [x + self.translation[0], y + self.translation[1]]
    }

    /// The image of a direction: the rotation alone.
    pub fn apply_vector(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let (s, c) = self.rotation.sin_cos();
        [c * x - s * y, s * x + c * y]
    }

    /// `self ∘ first`: `first` acts first.
    pub fn compose(&self, first: &PlaneIsometry) -> PlaneIsometry {
        PlaneIsometry::new(self.rotation + first.rotation, self.apply(first.translation))
    }

    /// The inverse.
    pub fn inverse(&self) -> PlaneIsometry {
        let back = PlaneIsometry::new(-self.rotation, [0.0; 2]);
        let [x, y] = back.apply_vector(self.translation);
        PlaneIsometry { translation: [-x, -y], ..back }
    }

    /// The isometry that best carries each `p` to its `q`.
    ///
    /// `vectors`: pairs of corresponding directions; the rotation maximises Σ ⟨R p, q⟩, so each pair counts
    /// with the product of its norms. `points`: pairs of corresponding points; the translation is the
    /// least-squares one for that rotation. Without vectors the rotation is 0, without points the
    /// translation.
    pub fn fit(
        vectors: impl IntoIterator<Item = ([f64; 2], [f64; 2])>,
        points: impl IntoIterator<Item = ([f64; 2], [f64; 2])>,
    ) -> PlaneIsometry {
        let (mut dot, mut cross) = (0.0, 0.0);
        for (p, q) in vectors {
            dot += p[0] * q[0] + p[1] * q[1];
            cross += p[0] * q[1] - p[1] * q[0];
        }
        let turn = PlaneIsometry::new(cross.atan2(dot), [0.0; 2]);
        let (mut sum, mut n) = ([0.0; 2], 0.0);
        for (p, q) in points {
            let p = turn.apply_vector(p);
            sum = [sum[0] + (q[0] - p[0]), sum[1] + (q[1] - p[1])];
            n += 1.0;
        }
        let n = f64::max(n, 1.0);
        PlaneIsometry { translation: sum.map(|x| x / n), ..turn }
    }
}

impl From<Motion<Twofold>> for PlaneIsometry {
    /// A motion of E².
    fn from(g: Motion<Twofold>) -> PlaneIsometry {
        let [x, y, _] = g.origin().map(f64::from);
        let [cos, sin] = g.a.map(f64::from);
        PlaneIsometry::new(2.0 * sin.atan2(cos), [x, y])
    }
}

/// The same angle in (−π, π].
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
    fn composition_and_inverse_act_as_on_points() {
        let (g, h) = (PlaneIsometry::new(2.5, [0.3, -1.0]), PlaneIsometry::new(1.7, [2.0, 0.25]));
        let p = [0.7, -0.2];
        assert!(close(g.compose(&h).apply(p), g.apply(h.apply(p))));
        assert!(close(g.inverse().apply(g.apply(p)), p));
        assert!(g.compose(&h).rotation > -PI && g.compose(&h).rotation <= PI);
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
