//! Numbers in double-double precision, the rounding errors of sums and products, and e^x together with its error.
//!
//! ```
//! use ricci::geometry::DoubleDouble;
//! let third = DoubleDouble::from(1.0) / 3.0.into();
//! assert!(f64::from(third * 3.0.into() - 1.0.into()).abs() < 1e-31);
//! ```

use super::exponentials::{EXPONENTIALS, MOST, STEPS};
use super::lanes::Lanes;
use super::scaled::scaled;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A number with about 32 digits: the unevaluated sum of two f64, the second at most half an ulp of the first \[Dek71\].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct DoubleDouble<T = f64> {
    /// The nearest f64.
    pub high: T,
    /// The difference between the number and `high`.
    pub low: T,
}

impl<L: Lanes> DoubleDouble<L> {
    /// An f64 as a double-double number.
    #[inline(always)]
    pub(crate) fn plain(high: L) -> DoubleDouble<L> {
        DoubleDouble { high, low: high.constant(0.0) }
    }

    /// The sum of a number and a much smaller one.
    #[inline(always)]
    pub(super) fn renormalised(high: L, low: L) -> DoubleDouble<L> {
        let sum = high + low;
        DoubleDouble { high: sum, low: low - (sum - high) }
    }

    /// The sum with an f64.
    #[inline(always)]
    pub fn plus(self, x: L) -> DoubleDouble<L> {
        let (high, lost) = two_sum(self.high, x);
        DoubleDouble::renormalised(high, lost + self.low)
    }

    /// The square root of a number that is not negative (0 for one that is).
    #[inline(always)]
    pub fn sqrt(self) -> DoubleDouble<L> {
        let zero = self.high.constant(0.0);
        // One step of Newton's method from the f64 root.
        let root = self.high.root();
        let (square, lost) = two_product(root, root);
        let rest = ((self.high - square) - lost) + self.low;
        let DoubleDouble { high, low } = DoubleDouble::renormalised(root, rest / (root + root));
        DoubleDouble {
            high: zero.where_at_least(self.high, zero, high),
            low: zero.where_at_least(self.high, zero, low),
        }
    }

    /// Twice this number.
    #[inline(always)]
    pub(crate) fn twice(self) -> DoubleDouble<L> {
        DoubleDouble { high: self.high + self.high, low: self.low + self.low }
    }

    /// `a b + c d`: each product is exact except for its last digits, and their sum is rounded once.
    #[inline(always)]
    pub(crate) fn two_products(
        a: DoubleDouble<L>,
        b: DoubleDouble<L>,
        c: DoubleDouble<L>,
        d: DoubleDouble<L>,
    ) -> DoubleDouble<L> {
        let ((p, p_low), (q, q_low)) = (two_product(a.high, b.high), two_product(c.high, d.high));
        let p_low = p_low + (a.high * b.low + a.low * b.high);
        let q_low = q_low + (c.high * d.low + c.low * d.high);
        let (sum, lost) = two_sum(p, q);
        DoubleDouble::renormalised(sum, lost + (p_low + q_low))
    }
}

impl DoubleDouble {
    /// This number times 2^k: exact while both parts stay normal numbers.
    pub(crate) fn scaled(self, k: i32) -> DoubleDouble {
        DoubleDouble { high: scaled(self.high, k), low: scaled(self.low, k) }
    }
}

impl From<f64> for DoubleDouble {
    #[inline]
    fn from(x: f64) -> DoubleDouble {
        DoubleDouble { high: x, low: 0.0 }
    }
}

impl From<DoubleDouble> for f64 {
    #[inline]
    fn from(x: DoubleDouble) -> f64 {
        x.high
    }
}

impl<L: Lanes> Neg for DoubleDouble<L> {
    type Output = DoubleDouble<L>;
    #[inline(always)]
    fn neg(self) -> DoubleDouble<L> {
        DoubleDouble { high: -self.high, low: -self.low }
    }
}

impl<L: Lanes> Add for DoubleDouble<L> {
    type Output = DoubleDouble<L>;
    #[inline(always)]
    fn add(self, other: DoubleDouble<L>) -> DoubleDouble<L> {
        // Both parts are added exactly: where the high parts cancel, the low ones determine the result.
        let (high, lost) = two_sum(self.high, other.high);
        let (low, more) = two_sum(self.low, other.low);
        let first = DoubleDouble::renormalised(high, lost + low);
        DoubleDouble::renormalised(first.high, first.low + more)
    }
}

impl<L: Lanes> Sub for DoubleDouble<L> {
    type Output = DoubleDouble<L>;
    #[inline(always)]
    fn sub(self, other: DoubleDouble<L>) -> DoubleDouble<L> {
        self + -other
    }
}

impl<L: Lanes> Mul for DoubleDouble<L> {
    type Output = DoubleDouble<L>;
    #[inline(always)]
    fn mul(self, other: DoubleDouble<L>) -> DoubleDouble<L> {
        let (product, lost) = two_product(self.high, other.high);
        DoubleDouble::renormalised(product, lost + (self.high * other.low + self.low * other.high))
    }
}

impl<L: Lanes> Div for DoubleDouble<L> {
    type Output = DoubleDouble<L>;
    #[inline(always)]
    fn div(self, other: DoubleDouble<L>) -> DoubleDouble<L> {
        let first = self.high / other.high;
        let (product, lost) = two_product(first, other.high);
        // The product is within an ulp of the dividend, so that their difference is exact.
        let rest = ((self.high - product) - lost) + (self.low - first * other.low);
        DoubleDouble::renormalised(first, rest / other.high)
    }
}

/// The sum of two f64 and its rounding error, which is exact (Knuth).
#[inline(always)]
pub(crate) fn two_sum<L: Lanes>(a: L, b: L) -> (L, L) {
    let sum = a + b;
    let part = sum - a;
    (sum, (a - (sum - part)) + (b - part))
}

/// The product of two f64 and its rounding error, which is exact unless something over- or underflows.
#[inline(always)]
pub(crate) fn two_product<L: Lanes>(a: L, b: L) -> (L, L) {
    let product = a * b;
    (product, a.lost_of_product(b, product))
}

/// Largest |x| for [`exp_parts`]: e^x is then 2^(±7e5), and the multiples of log 2 that are subtracted from x are still exact.
pub(crate) const MAX_EXPONENT: f64 = 5e5;
/// log 2 in three parts; the first has 33 binary digits, so that its products with integers below 2^20 are exact.
const LN_2: [f64; 3] = [0.693_147_180_369_123_8, 1.908_214_929_270_587_7e-10, 1.161_222_722_936_253_2e-26];
/// 1/k! from k = 4 on: at the end of the series its terms are below 1e-29.
const FACTORIALS: [f64; 7] =
    [1.0 / 24.0, 1.0 / 120.0, 1.0 / 720.0, 1.0 / 5040.0, 1.0 / 40_320.0, 1.0 / 362_880.0, 1.0 / 3_628_800.0];

/// Largest |x| for which e^x is certainly a normal number.
pub(super) const SURELY_NORMAL: f64 = 700.0;

/// `e^x` as an f64, and its relative error (known to 3e-24). u is known to more digits than an f64 holds, and the rounding of e^u would
/// lose them.
///
/// A result that is not a normal number is that of [`f64::exp`], with error 0; [`exp_parts`] has no such limit.
pub(crate) fn exp(x: f64) -> (f64, f64) {
    if !(-SURELY_NORMAL..=SURELY_NORMAL).contains(&x) {
        let rounded = x.exp();
        if !rounded.is_normal() {
            return (rounded, 0.0);
        }
    }
    let [mantissa, low, k] = exp_parts(x);
    (scaled(mantissa, k as i32), low)
}

/// `e^x = mantissa (1 + low) 2^k` as [mantissa, low, k], with a mantissa between 0.7 and 1.5 and a whole number k, for |x| up to
/// [`MAX_EXPONENT`].
#[inline(always)]
pub(crate) fn exp_parts<L: Lanes>(x: L) -> [L; 3] {
    let (first, k) = (x, nearest_integer(x * x.constant(std::f64::consts::LOG2_E)));
    let of = |x: f64| first.constant(x);
    let (rest, lost) = two_sum(x, -k * of(LN_2[0]));
    let (middle, middle_low) = two_product(k, of(LN_2[1]));
    let (rest, more) = two_sum(rest, -middle);
    let (x, low) = two_sum(rest, (lost + more) - (middle_low + k * of(LN_2[2])));
    // x is reduced by a multiple of 1/64, whose exponential is in the table; the difference is exact.
    let step = nearest_integer(of(STEPS) * x);
    let [known, known_low] = (step + of(MOST)).look_up(&EXPONENTIALS);
    let x = x - step / of(STEPS);
    // e^x − 1 = x + x²/2 + x³/6 + …, and e^(x + low) is e^x + low e^x.
    let (square, square_low) = two_product(of(0.5) * x, x);
    let (thrice, thrice_low) = two_product(square, x);
    let cube = thrice / of(3.0);
    let (back, back_low) = two_product(of(3.0), cube);
    let cube_low = ((thrice - back) + (thrice_low - back_low) + square_low * x) / of(3.0);
    let mut tail = of(0.0);
    for &factor in FACTORIALS.iter().rev() {
        tail = tail * x + of(factor);
    }
    let tail = tail * (x * x) * (x * x);
    let (sum, first) = two_sum(x, square);
    let (sum, second) = two_sum(sum, cube);
    let (p, third) = two_sum(sum, tail);
    let p_low = first + second + third + (low + low * p) + (square_low + cube_low);
    // known (1 + p)
    let (product, product_low) = two_product(known, p);
    let (sum, lost) = two_sum(known, product);
    let (sum, lost) = two_sum(sum, lost + (product_low + known * p_low + known_low * (of(1.0) + p)));
    [sum, lost / sum, k]
}

/// The integer nearest to a number whose size is below 2^51, the even one of two.
#[inline(always)]
fn nearest_integer<L: Lanes>(x: L) -> L {
    /// A number so large that f64 of its size are whole numbers.
    const WHOLE: f64 = 6_755_399_441_055_744.0;
    (x + x.constant(WHOLE)) - x.constant(WHOLE)
}

/// Largest |x| for [`sinh`].
pub(crate) const MAX_SERIES: f64 = 0.25;
/// 1/3! and 1/5! in double-double precision.
const SIXTH: DoubleDouble = DoubleDouble { high: 1.0 / 6.0, low: 9.251_858_538_542_97e-18 };
const HUNDRED_TWENTIETH: DoubleDouble = DoubleDouble { high: 1.0 / 120.0, low: 1.156_482_317_317_871_4e-19 };
/// 1/7!, 1/9!, … up to 1/15!: the next term is below 1e-24 of sinh x.
const ODD_FACTORIALS: [f64; 5] =
    [1.0 / 5040.0, 1.0 / 362_880.0, 1.0 / 39_916_800.0, 1.0 / 6_227_020_800.0, 1.0 / 1_307_674_368_000.0];

/// sinh x for |x| up to [`MAX_SERIES`] (relative error below 1e-23), by its series: it does not cancel, and costs a third of two
/// exponentials.
pub(crate) fn sinh(x: f64) -> DoubleDouble {
    let (square, lost) = two_product(x, x);
    let y = DoubleDouble { high: square, low: lost };
    let tail = square * ODD_FACTORIALS.iter().rev().fold(0.0, |sum, factor| sum * square + factor);
    let inner = y * HUNDRED_TWENTIETH.plus(tail);
    let (sum, lost) = two_sum(SIXTH.high, inner.high);
    let rest = y * DoubleDouble::renormalised(sum, lost + (SIXTH.low + inner.low));
    let (product, lost) = two_product(rest.high, x);
    let (sum, more) = two_sum(x, product);
    DoubleDouble::renormalised(sum, more + (lost + rest.low * x))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_series_of_sinh_is_half_the_difference_of_exponentials() {
        for k in 1..=400 {
            let x = MAX_SERIES * f64::from(k) / 400.0 * if k % 2 == 0 { 1.0 } else { -1.0 };
            let (up, lost) = exp(x);
            let up = DoubleDouble::from(up) + (up * lost).into();
            let expected = (up - DoubleDouble::from(1.0) / up).scaled(-1);
            // The exponentials have errors of 3e-24, and sinh x is about x times their size.
            assert!((sinh(x) - expected).high.abs() < 1e-23 * x.abs() + 6e-24, "{x}");
        }
    }

    /// (√2)² = 2, (1/3)·3 = 1 and the like, and the remainder of 1 + 2⁻⁷⁰ when 1 is subtracted.
    #[test]
    fn double_double_arithmetic_keeps_thirty_digits() {
        for i in 1..200 {
            let (x, y) = (DoubleDouble::from(f64::from(i)), DoubleDouble::from(1.0 / f64::from(7 * i + 1)));
            let error = |a: DoubleDouble, b: DoubleDouble| ((a - b).high / b.high).abs();
            assert!(error(x.sqrt() * x.sqrt(), x) < 1e-31, "{i}");
            assert!(error(x / y * y, x) < 1e-30, "{i}");
            let (sum, difference) = (x.sqrt() + y, x.sqrt() - y);
            assert!(error(sum * difference, x - y * y) < 1e-30, "{i}");
        }
        let tiny = 0.5f64.powi(70);
        let almost = DoubleDouble::from(1.0) + tiny.into();
        assert_eq!((almost - 1.0.into()).high, tiny);
        assert_eq!((almost * almost - 1.0.into()).high, 2.0 * tiny);
    }

    /// e^(a + b) = e^a e^b where a + b is an f64.
    #[test]
    fn exponentials_multiply() {
        let mut worst = 0.0f64;
        for i in -4000..4000 {
            let (a, b) = (f64::from(i) * 0.085_937_5, f64::from(i % 97) * 0.007_812_5);
            let [(x, x_low), (y, y_low), (z, z_low)] = [a, b, a + b].map(exp);
            assert!((z - (a + b).exp()).abs() <= 2.0 * f64::EPSILON * z, "{a} + {b}");
            let (product, low) = two_product(x, y);
            let error = (product - z) / z + (low / z + x_low + y_low - z_low);
            worst = worst.max(error.abs());
        }
        assert!(worst < 3e-24, "{worst:e}");
    }

    /// d/dx e^x = e^x: differences far below an ulp of e^x are right.
    #[test]
    fn exponentials_are_smooth() {
        for i in 0..1000 {
            let x = f64::from(i) * 0.37 - 185.0;
            let step = x.abs().max(1.0) * f64::EPSILON;
            let [(e, low), (next, next_low)] = [x, x + step].map(exp);
            let step = (x + step) - x;
            let change = (next - e) / e + (next_low * (next / e) - low);
            let expected = step + 0.5 * step * step;
            assert!((change - expected).abs() < 3e-24, "{x}: {change:e} {expected:e}");
        }
    }

    /// e^x beyond the range of f64: e^a e^−a = 1, and e^(a + log 2) = 2 e^a to the digits of log 2.
    #[test]
    fn exponentials_beyond_doubles_keep_their_digits() {
        for i in 1..500 {
            let a = f64::from(i) * 1000.0;
            let [[x, x_low, k], [y, y_low, l]] = [a, -a].map(exp_parts);
            assert_eq!(k, -l);
            let (product, low) = two_product(x, y);
            let error = (product - 1.0) + (low + x_low + y_low);
            assert!(error.abs() < 1e-23, "{a}: {error:e}");
            let [z, z_low, m] = exp_parts(a + 0.5);
            let (root, root_low) = exp(0.5);
            let (product, low) = two_product(x, root);
            let error =
                (product - scaled(z, (m - k) as i32)) / product + (low / product + x_low + root_low - z_low);
            assert!(error.abs() < 1e-23, "{a}: {error:e}");
        }
    }

    /// e and 2 to 20 digits.
    #[test]
    fn known_values() {
        let (e, low) = exp(1.0);
        assert_eq!(e, std::f64::consts::E);
        assert!((low * e - 1.445_646_891_729_250_2e-16).abs() < 1e-20);
        let (two, low) = exp(std::f64::consts::LN_2);
        // log 2 is its f64 plus 2.319…e-17
        assert!(((two - 2.0) / 2.0 + low + 2.319_046_813_846_299_6e-17).abs() < 1e-21);
        assert_eq!(exp(0.0), (1.0, 0.0));
        assert_eq!(exp(-800.0), ((-800.0f64).exp(), 0.0));
        assert_eq!(exp(800.0), (f64::INFINITY, 0.0));
        assert!(exp(f64::NAN).0.is_nan());
    }
}
