//! One geodesic triangle from its three lengths: angles and area.
//!
//! ```text
//!              k                 side i is opposite corner i: l_i = |jk|, l_j = |ki|, l_k = |ij|
//!            /   \               s = (l_i + l_j + l_k)/2,  r_i = s − l_i
//!       l_j /     \ l_i          f(x) = x, sinh x, sin x        in E², H², S²
//!          /       \
//!         i ─────── j
//!             l_k
//! ```
//!
//! All formulas are written in `f(s)` and `f(r)`, so that they are the same in the three geometries and no difference of nearly equal
//! numbers is formed.
//!
//! ```
//! use ricci::geometry::{Space, triangle::{angles, area}};
//! let right = angles(Space::E2, [5.0, 4.0, 3.0]).at;
//! assert!((right[0] - std::f64::consts::FRAC_PI_2).abs() < 1e-15);
//! assert!((area(Space::E2, [5.0, 4.0, 3.0]) - 6.0).abs() < 1e-14);
//! ```

use super::arctangent::angle;
use super::lanes::Lanes;
use super::scaled::exponent;
use super::{DoubleDouble, Space};
use std::f64::consts::PI;

/// The angles of a triangle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Angles {
    /// The angle at each corner, radians, opposite the length of the same index.
    pub at: [f64; 3],
}

impl Angles {
    /// True if the lengths break the triangle inequality (or, in S², have a perimeter of 2π or more). The angles are then the continuous
    /// extension (π, 0, 0) \[Luo11\], or (π, π, π) for the perimeter. No triangle with f64 lengths has two angles 0.
    #[inline]
    pub fn broken(&self) -> bool {
        let zeros = self.at.into_iter().filter(|&x| x == 0.0).count();
        zeros == 2 || self.at == [PI; 3]
    }
}

/// [`Angles::broken`], from the half-perimeter differences and without computing the angles.
#[inline]
pub fn is_broken(space: Space, r: [f64; 3]) -> bool {
    r.into_iter().any(|r| r <= 0.0) || (space == Space::S2 && r[0] + r[1] + r[2] >= PI)
}

/// The differences r_i = s − l_i of the half perimeter s = r_0 + r_1 + r_2.
///
/// The differences are formed from the sorted lengths, largest first (Kahan, "Miscalculating area and angles of
/// a needle-like triangle"): each is accurate to a few ulp however thin the triangle.
#[inline(always)]
pub fn half_differences<L: Lanes>(l: [L; 3]) -> [L; 3] {
    // No branches: the order of the lengths is random, so a branch would be predicted wrongly half of the time.
    let (larger, smaller) = (l[0].larger(l[1]), l[0].smaller(l[1]));
    let (a, c) = (larger.larger(l[2]), smaller.smaller(l[2]));
    let b = smaller.larger(larger.smaller(l[2]));
    let half = a.constant(0.5);
    let [first, second, third] = [half * (c - (a - b)), half * (c + (a - b)), half * (a + (b - c))];
    let mut r = l;
    for l in &mut r {
        *l = l.where_at_least(a, first, l.where_at_least(b, second, third));
    }
    r
}

/// f(x) = x, sinh x, sin x in E², H², S².
#[inline]
pub fn sine(space: Space, x: f64) -> f64 {
    match space {
        Space::E2 => x,
        Space::H2 => x.sinh(),
        Space::S2 => x.sin(),
    }
}

/// Half perimeter in H² above which quotients of sinh are formed from exponentials of differences: sinh overflows at 710.
const FAR: f64 = 300.0;

/// The half-perimeter differences of a triangle with their sines, from which both angles and weights are formed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TriangleSines {
    /// The space of the triangle.
    pub space: Space,
    /// The half-perimeter differences r.
    pub differences: [f64; 3],
    /// f(s) of the half perimeter.
    pub whole: f64,
    /// f(r_i) of the differences.
    pub parts: [f64; 3],
}

impl TriangleSines {
    /// The sines of a triangle with these half-perimeter differences.
    #[inline]
    pub fn new(space: Space, r: [f64; 3]) -> TriangleSines {
        let whole = sine(space, r[0] + r[1] + r[2]);
        TriangleSines { space, differences: r, whole, parts: r.map(|x| sine(space, x)) }
    }

    /// `f(r_i)/f(s)`. Products of such ratios neither overflow nor underflow, whatever the size of the lengths.
    #[inline]
    fn ratios(&self) -> [f64; 3] {
        let r = self.differences;
        let s = r[0] + r[1] + r[2];
        match self.space {
            // sinh x = e^x (1 − e^{−2x})/2
            Space::H2 if s > FAR => r.map(|x| (x - s).exp() * (-2.0 * x).exp_m1() / (-2.0 * s).exp_m1()),
            _ => self.parts.map(|x| x / self.whole),
        }
    }

    /// The angles, see [`angles_from`].
    #[inline]
    pub fn angles(&self) -> Angles {
        let r = self.differences;
        let s = r[0] + r[1] + r[2];
        if let Some(corner) = (0..3).find(|&i| r[i] <= 0.0) {
            return Angles { at: [0, 1, 2].map(|k| if k == corner { PI } else { 0.0 }) };
        }
        if self.space == Space::S2 && s >= PI {
            return Angles { at: [PI; 3] };
        }
        // Roots are taken before products: f_i f_j may underflow.
        let [a, b, c] = self.ratios().map(f64::sqrt);
        Angles { at: [(b * c, a), (c * a, b), (a * b, c)].map(|(y, x)| 2.0 * angle(y, x)) }
    }
}

/// The angles by the half-angle law `tan²(θ_k/2) = f(r_i) f(r_j) / (f(s) f(r_k))` [JKLLG08, Eqn 12].
///
/// Lengths must be positive and finite.
#[inline]
pub fn angles(space: Space, l: [f64; 3]) -> Angles {
    angles_from(space, half_differences(l))
}

/// The angles from the half-perimeter differences, which may be known more precisely than the lengths.
#[inline]
pub fn angles_from(space: Space, r: [f64; 3]) -> Angles {
    TriangleSines::new(space, r).angles()
}

/// [`angles_from`] in E² together with half the cotangents of the angles; both come from the same roots. The cotangents are 0 where the
/// triangle is broken, or so thin that they are not finite.
#[inline]
pub fn plane_angles_with_weights(r: [f64; 3]) -> (Angles, [f64; 3]) {
    match sound_plane_angles_with_weights(r) {
        (at, weights, 1.0) => (Angles { at }, weights),
        _ => (angles_from(Space::E2, r), [0.0; 3]),
    }
}

/// [`plane_angles_with_weights`] for one triangle or several at a time. The last number is 1 for a triangle with finite weights, and 0
/// for a broken or too thin one, whose angles and weights are meaningless.
#[inline(always)]
pub(crate) fn sound_plane_angles_with_weights<L: Lanes>(r: [L; 3]) -> ([L; 3], [L; 3], L) {
    let of = |x: f64| r[0].constant(x);
    let [zero, one, half] = [0.0, 1.0, 0.5].map(of);
    // Divided by the half perimeter, which becomes 1, so that no product over- or underflows.
    let s = r[0] + r[1] + r[2];
    let q = [r[0] / s, r[1] / s, r[2] / s];
    let [a, b, c] = [q[0].root(), q[1].root(), q[2].root()];
    let two = of(2.0);
    let angles = [two * angle(b * c, a), two * angle(c * a, b), two * angle(a * b, c)];
    let area = a * b * c;
    let mut weights = [zero; 3];
    for k in 0..3 {
        weights[k] = half * ((q[k] - q[(k + 1) % 3] * q[(k + 2) % 3]) / (two * area));
    }
    let least = r[0].smaller(r[1]).smaller(r[2]);
    let is_whole = least.where_at_least(of(f64::MIN_POSITIVE), one, zero);
    (angles, weights, is_finite(weights, is_whole))
}

/// `yes` where all three numbers are finite, else 0.
#[inline(always)]
pub(crate) fn is_finite<L: Lanes>(x: [L; 3], yes: L) -> L {
    let ([a, b, c], zero) = (x, yes.constant(0.0));
    // 0 times a number that is not finite is NaN.
    (a * zero + (b * zero + c * zero)).where_at_least(zero, yes, zero)
}

/// `[cos, sin]` of half the angle at each corner in double-double precision, from the half chords q of the sides (l/2, sinh(l/2),
/// sin(l/2)). A broken triangle has those of (π, 0, 0).
///
/// With `c = C(l/2)`, `d = q_i c_j − q_j c_i`, `p = q_i c_j + q_j c_i` the half-angle law reads `tan²(θ_k/2) = (q_k − d)(q_k + d) / ((p −
/// q_k)(p + q_k))`, which needs no function except the square root.
pub fn half_angles_of_chords(space: Space, q: [DoubleDouble; 3]) -> [[DoubleDouble; 2]; 3] {
    let (one, curvature) = (DoubleDouble::from(1.0), DoubleDouble::from(space.curvature()));
    let c = q.map(|q| (one - curvature * q * q).sqrt());
    let shortest = [1, 2].into_iter().fold(0, |k, i| if q[i].high < q[k].high { i } else { k });
    let longest = q.iter().fold(0.0, |m: f64, q| m.max(q.high));
    if q[shortest].high < NEEDLE * longest {
        return half_angles_of_needle(q, c, shortest);
    }
    [0, 1, 2].map(|k| {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        let (there, back) = (q[i] * c[j], q[j] * c[i]);
        let (d, p) = (there - back, there + back);
        let sin = ((q[k] - d) * (q[k] + d)).sqrt();
        let cos = ((p - q[k]) * (p + q[k])).sqrt();
        let norm = (cos * cos + sin * sin).sqrt();
        [cos / norm, sin / norm]
    })
}

/// A triangle whose shortest side is less than this part of the longest one is a needle. Sums in double-double precision have 32 digits, of
/// which 12 at least show a side above the limit.
const NEEDLE: f64 = 1e-20;

/// [`half_angles_of_chords`] where side `k` is so short that it is lost in sums with the others: these are subtracted from each other first.
/// `c`: C(l/2) of the sides.
fn half_angles_of_needle(q: [DoubleDouble; 3], c: [DoubleDouble; 3], k: usize) -> [[DoubleDouble; 2]; 3] {
    let mut halves = [[DoubleDouble::from(0.5).sqrt(); 2]; 3];
    let mut set = |at: usize, cos: DoubleDouble, sin: DoubleDouble| {
        // Both are 0 where the long sides are equal and the short one is below the range of numbers: a right angle.
        let larger = cos.high.max(sin.high);
        if larger > 0.0 {
            // In units of the larger one, since squares would underflow.
            let [cos, sin] = [cos, sin].map(|x| x.scaled(-exponent(larger)));
            let norm = (cos * cos + sin * sin).sqrt();
            halves[at] = [cos / norm, sin / norm];
        }
    };
    let (i, j) = ((k + 1) % 3, (k + 2) % 3);
    let p = q[i] * c[j] + q[j] * c[i];
    let d = (q[i] - q[j]) * ((q[i] + q[j]) / p);
    set(k, ((p - q[k]) * (p + q[k])).sqrt(), (q[k] - d).sqrt() * (q[k] + d).sqrt());
    for (long, other) in [(i, j), (j, i)] {
        let (far, near) = (q[other] * c[k], q[k] * c[other]);
        let sum = [(far - q[long]) + near, far + q[long] + near];
        let difference = [(q[long] - far) + near, far + q[long] - near];
        let [cos, sin] = [sum, difference].map(|[small, large]| small.sqrt() * large.sqrt());
        set(long, cos, sin);
    }
    halves
}

/// Area by Heron's formula in E², by l'Huilier's in H² and S²: `tan(area/4) = sqrt(t(s/2) t(r_i/2) t(r_j/2) t(r_k/2))`, t = tanh, tan.
/// Neither sums angles, so nothing cancels.
///
/// A broken triangle has area 0; one whose perimeter reaches 2π in S² has 2π.
pub fn area(space: Space, l: [f64; 3]) -> f64 {
    area_from(space, half_differences(l))
}

/// The area from the half-perimeter differences.
pub fn area_from(space: Space, r: [f64; 3]) -> f64 {
    let s = r[0] + r[1] + r[2];
    if r.iter().any(|&x| x <= 0.0) {
        return 0.0;
    }
    // A product of t(s/2)² and a root of ratios: no factor underflows before the area does.
    let heron = |t: fn(f64) -> f64| {
        let whole = t(0.5 * s);
        let [a, b, c] = r.map(|x| t(0.5 * x) / whole);
        whole * whole * (a.sqrt() * b.sqrt() * c.sqrt())
    };
    match space {
        Space::E2 => 4.0 * heron(|x| x),
        Space::H2 => 4.0 * heron(f64::tanh).atan(),
        Space::S2 if s >= PI => 2.0 * PI,
        Space::S2 => 4.0 * heron(f64::tan).atan(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SPACES: [Space; 3] = [Space::E2, Space::H2, Space::S2];

    #[test]
    fn needles_have_their_angles_however_short_their_third_side_is() {
        // Two long sides differ by the part t of the third side: the angles between them and that side have the cosines t and −t.
        for space in SPACES {
            for (x, t) in
                [(1e-19, 0.5), (1e-21, 0.5), (1e-25, -0.25), (1e-40, 0.0), (1e-200, 0.0), (1e-320, 0.0)]
            {
                let long = DoubleDouble::from(0.5);
                let c = (DoubleDouble::from(1.0) - DoubleDouble::from(0.25 * space.curvature())).sqrt();
                // A length grows by a half chord over C(l/2).
                let q = [long, DoubleDouble::from(x), long + DoubleDouble::from(x * t) * c];
                let at = half_angles_of_chords(space, q).map(|[cos, sin]| 2.0 * sin.high.atan2(cos.high));
                let known = [f64::acos(t), 0.0, PI - f64::acos(t)];
                for k in 0..3 {
                    assert!((at[k] - known[k]).abs() < 1e-10, "{space} {x:e} {t}: {at:?} {known:?}");
                }
            }
        }
        // A broken needle.
        let q = [0.5, 1e-30, 0.5 + 1e-10].map(DoubleDouble::from);
        for space in SPACES {
            let at = half_angles_of_chords(space, q).map(|[cos, sin]| 2.0 * sin.high.atan2(cos.high));
            assert_eq!(at, [0.0, 0.0, PI], "{space}");
        }
    }

    #[test]
    fn angles_obey_the_cosine_law() {
        for (i, l) in [[1.0, 1.1, 0.7], [0.3, 0.4, 0.5], [1.2, 0.9, 1.0]].into_iter().enumerate() {
            for space in SPACES {
                let at = angles(space, l).at;
                for k in 0..3 {
                    let (a, b, c) = (l[(k + 1) % 3], l[(k + 2) % 3], l[k]);
                    let cos = match space {
                        Space::E2 => (a * a + b * b - c * c) / (2.0 * a * b),
                        Space::H2 => (a.cosh() * b.cosh() - c.cosh()) / (a.sinh() * b.sinh()),
                        Space::S2 => (c.cos() - a.cos() * b.cos()) / (a.sin() * b.sin()),
                    };
                    assert!((at[k].cos() - cos).abs() < 1e-14, "{space} triangle {i} corner {k}");
                }
            }
        }
    }

    #[test]
    fn area_is_the_angle_defect() {
        let l = [1.1, 0.8, 0.9];
        for space in [Space::H2, Space::S2] {
            let sum: f64 = angles(space, l).at.iter().sum();
            assert!((area(space, l) - space.curvature() * (sum - PI)).abs() < 1e-14);
        }
        let sum: f64 = angles(Space::E2, l).at.iter().sum();
        assert!((sum - PI).abs() < 1e-15);
        assert!((area(Space::E2, [3.0, 4.0, 5.0]) - 6.0).abs() < 1e-14);
    }

    #[test]
    fn needles_keep_their_relative_accuracy() {
        // Exact lengths 1, 1, h: the small angle is 2 asin(h/2), the area h/2 · sqrt(1 − h²/4).
        for h in [1e-3, 1e-9, 1e-160, 1e-300] {
            for scale in [1.0, 2f64.powi(-20), 2f64.powi(500)] {
                let l = [h * scale, scale, scale];
                let small = angles(Space::E2, l).at[0];
                assert!((small / (2.0 * (0.5 * h).asin()) - 1.0).abs() < 1e-15, "{h} {scale}");
            }
            let exact = 0.5 * h * (1.0 - 0.25 * h * h).sqrt();
            assert!((area(Space::E2, [1.0, h, 1.0]) / exact - 1.0).abs() < 1e-15, "{h}");
        }
    }

    #[test]
    fn lengths_of_any_size_have_finite_angles_and_areas() {
        for exponent in [-1000, -600, -300, 0, 8, 9, 300, 500] {
            let l = [1.0, 1.25, 0.75].map(|x| x * 2f64.powi(exponent));
            for space in [Space::E2, Space::H2] {
                let at = angles(space, l).at;
                assert!(at.iter().all(|x| (0.0..=PI).contains(x)), "{space} {exponent}: {at:?}");
                assert!(area(space, l) >= 0.0 && area(space, l).is_finite(), "{space} {exponent}");
                if space == Space::E2 {
                    assert!((at[1] - 0.5 * PI).abs() < 1e-15 && (at[0] - 0.8f64.asin()).abs() < 1e-15);
                }
            }
        }
        // 700: the triangle is a tripod with angles near 0; 2e^{−l/2} for an equilateral one.
        let angle = angles(Space::H2, [400.0; 3]).at[0];
        assert!((angle / (2.0 * (-200f64).exp()) - 1.0).abs() < 1e-13, "{angle}");
    }

    #[test]
    fn broken_triangles_have_the_extended_angles() {
        for space in SPACES {
            assert_eq!(angles(space, [1.0, 0.3, 0.4]).at, [PI, 0.0, 0.0]);
            assert!(angles(space, [1.0, 0.3, 0.4]).broken() && !angles(space, [1.0, 0.9, 0.4]).broken());
        }
        assert_eq!(angles(Space::S2, [2.2, 2.2, 2.2]).at, [PI; 3]);
        assert!(angles(Space::S2, [2.2, 2.2, 2.2]).broken());
    }
}
