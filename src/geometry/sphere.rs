//! Stereographic projection between the unit sphere and the plane, and similarities of the plane.
//!
//! ```text
//! lift:     z ↦ (2 Re z, 2 Im z, 1 − |z|²)/(1 + |z|²)        0 ↦ (0, 0, 1),  ∞ ↦ (0, 0, −1)
//! project:  (x, y, w) ↦ (x + i y)/(1 + w)
//! chord:    |lift(a) − lift(b)| = 2 |a − b| / √((1 + |a|²)(1 + |b|²))
//! ```
//!
//! The projection is from the south pole, so that counterclockwise in the plane is counterclockwise on the sphere seen from outside. Each
//! Möbius transformation of the sphere is a similarity of the plane, `z ↦ (z − p)/t` with t > 0, followed by a rotation of the sphere. A
//! similarity is also a point (p, t) of hyperbolic space in the upper half-space model.
//!
//! ```
//! use ricci::geometry::sphere::{lift, project};
//! assert_eq!(lift([1.0, 0.0]), [1.0, 0.0, 0.0]);
//! assert_eq!(project([0.0, 1.0, 0.0]), Some([0.0, 1.0]));
//! ```

use super::complex::{self, Complex};
use super::double_double::{self, two_product, two_sum};
use super::vector::Vector;

/// The point of the sphere over a point of the plane, for coordinates of any size. x, y and the distance from either pole are computed to
/// full relative accuracy.
pub fn lift([x, y]: [f64; 2]) -> Vector {
    let r = x.hypot(y);
    if r <= 1.0 {
        let d = 1.0 + r * r;
        return [2.0 * x / d, 2.0 * y / d, (1.0 - r) * (1.0 + r) / d];
    }
    if r == f64::INFINITY {
        return SOUTH;
    }
    let q = 1.0 / r;
    let d = 1.0 + q * q;
    [2.0 * (x / r) * q / d, 2.0 * (y / r) * q / d, -(1.0 - q) * (1.0 + q) / d]
}

/// The lift of ∞.
pub const SOUTH: Vector = [0.0, 0.0, -1.0];

/// The point of the plane under a point of the sphere; `None` for the south pole.
pub fn project([x, y, w]: Vector) -> Option<[f64; 2]> {
    // 1 + w = (x² + y²)/(1 − w) on the sphere.
    let d = if w >= 0.0 { 1.0 + w } else { (x * x + y * y) / (1.0 - w) };
    (d > 0.0).then(|| [x / d, y / d]).filter(|z| z.iter().all(|x| x.is_finite()))
}

/// `log(1 + |z|²)` as an f64, and the part that it misses. The lift multiplies small lengths at z by `2/(1 + |z|²)`.
pub fn log_density([x, y]: [f64; 2]) -> (f64, f64) {
    let r = x.hypot(y);
    let log = if r <= 1.0 { (r * r).ln_1p() } else { 2.0 * r.ln() + (1.0 / r / r).ln_1p() };
    let ((xx, xx_low), (yy, yy_low)) = (two_product(x, x), two_product(y, y));
    let (square, lost) = two_sum(xx, yy);
    let (sum, rest) = two_sum(1.0, square);
    let (e, e_low) = double_double::exp(log);
    let low = ((sum - e) + (rest + lost + xx_low + yy_low - e * e_low)) / e;
    (log, if low.is_finite() { low } else { 0.0 })
}

/// `z ↦ (z − centre)/scale`; also the point (centre, scale) of the upper half-space model of hyperbolic space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Similarity {
    /// The point p that is mapped to 0.
    pub centre: [f64; 2],
    /// The length t > 0 that is mapped to 1.
    pub scale: f64,
}

impl Similarity {
    /// The identity.
    pub const IDENTITY: Similarity = Similarity { centre: [0.0; 2], scale: 1.0 };

    /// The image of a point.
    pub fn apply(&self, z: Complex) -> Complex {
        complex::sub(z, self.centre).map(|x| x / self.scale)
    }

    /// The point whose image is `z`.
    pub fn before(&self, z: Complex) -> Complex {
        complex::add(complex::scale(self.scale, z), self.centre)
    }

    /// The point of hyperbolic space at `distance` from this one, in the direction of the unit vector `to`: towards the point of the
    /// plane whose image under this similarity and [`lift`] is `to`.
    ///
    /// From (0, 1): `t = 1/(cosh s + w sinh s)`, `p = (x, y) t sinh s`.
    pub fn towards(&self, to: Vector, distance: f64) -> Similarity {
        let (sinh, cosh) = (distance.sinh(), distance.cosh());
        let t = 1.0 / (cosh + to[2] * sinh);
        let step = [to[0], to[1]].map(|x| x * sinh * t);
        Similarity { centre: self.before(step), scale: self.scale * t }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::vector::{norm, sub};

    fn spiral() -> impl Iterator<Item = [f64; 2]> {
        (-600..=600).map(|k| {
            let (r, angle) = (10f64.powf(f64::from(k) * 0.25), f64::from(k) * 0.7);
            [r * angle.cos(), r * angle.sin()]
        })
    }

    #[test]
    fn lifts_lie_on_the_sphere_and_project_back_near_both_poles() {
        for z in spiral() {
            let x = lift(z);
            assert!((norm(x) - 1.0).abs() < 4e-16);
            let back = project(x).unwrap();
            assert!((0..2).all(|k| (back[k] - z[k]).abs() <= 1e-15 * z[0].hypot(z[1])), "{z:?} {back:?}");
        }
        assert_eq!(lift([0.0, 0.0]), [0.0, 0.0, 1.0]);
        assert_eq!(lift([f64::INFINITY, 0.0]), SOUTH);
        assert_eq!(project(SOUTH), None);
    }

    #[test]
    fn chords_obey_their_formula() {
        let points: Vec<[f64; 2]> = spiral().skip(580).take(40).collect();
        for a in &points {
            for b in &points {
                let flat = (a[0] - b[0]).hypot(a[1] - b[1]);
                let exact = 2.0 * flat * (-0.5 * (log_density(*a).0 + log_density(*b).0)).exp();
                assert!((norm(sub(lift(*a), lift(*b))) - exact).abs() < 1e-14);
            }
        }
    }

    /// `1 + |(5 a/4, 3/4)|² = 25/16 (1 + a²)`, for a and 5a/4 that are both f64.
    #[test]
    fn densities_have_more_digits_than_f64() {
        let (factor, factor_low) = log_density([0.75, 0.0]);
        for k in 0..4000 {
            let a = f64::from(k) * 2f64.powi(k % 40 - 20);
            let [(one, one_low), (other, other_low)] = [[a, 0.0], [1.25 * a, 0.75]].map(log_density);
            let (sum, lost) = two_sum(one, factor);
            let error = (sum - other) + (lost + one_low + factor_low - other_low);
            assert!(error.abs() < 1e-20, "{a}: {error:e}");
        }
    }

    #[test]
    fn counterclockwise_triangles_face_outward() {
        let [a, b, c] = [[0.3, -0.2], [0.9, 0.1], [0.2, 0.8]].map(lift);
        use crate::geometry::vector::{cross, dot};
        assert!(dot(cross(sub(b, a), sub(c, a)), a) > 0.0);
    }

    /// cosh d = 1 + (|p − q|² + (t − s)²)/(2 t s), and the far end of the ray is the given direction.
    #[test]
    fn geodesics_have_their_length_and_their_end() {
        let from = Similarity { centre: [0.4, -1.3], scale: 0.2 };
        for to in [[0.0, 0.0, 1.0], [0.6, 0.0, -0.8], [0.0, 1.0, 0.0], [0.48, 0.6, 0.64]] {
            for d in [1e-3, 0.5, 2.0, 9.0] {
                let end = from.towards(to, d);
                let [x, y] = [0, 1].map(|k| end.centre[k] - from.centre[k]);
                let rise = end.scale - from.scale;
                let cosh = 1.0 + (x * x + y * y + rise * rise) / (2.0 * end.scale * from.scale);
                assert!((cosh.acosh() / d - 1.0).abs() < 1e-9, "{to:?} {d}");
            }
            let far = from.towards(to, 20.0);
            let z = from.apply(far.centre);
            let goal = project(to).unwrap();
            assert!((z[0] - goal[0]).hypot(z[1] - goal[1]) < 1e-15 + 1e-8 * goal[0].hypot(goal[1]));
        }
    }
}
