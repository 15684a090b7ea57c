//! The angle of a point of the first quadrant, computed without branches and independently of the C library.

use super::lanes::Lanes;
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, SQRT_2};

/// The parts that the f64 nearest to π/2 and π/4 miss.
const LOST: [f64; 2] = [6.123_233_995_736_766e-17, 3.061_616_997_868_383e-17];
/// `(arctan q / q − 1)/q²` as a polynomial in q², for |q| up to tan(π/8): the resulting arctan q has a relative error of 7e-18 (computed
/// with 60 decimal digits, interpolating at the roots of a Chebyshev polynomial).
const SERIES: [f64; 11] = [
    -0.333_333_333_333_333_3,
    0.199_999_999_999_955_2,
    -0.142_857_142_846_665_42,
    0.111_111_110_152_563_61,
    -0.090_909_045_781_239_03,
    0.076_921_831_908_260_87,
    -0.066_645_114_473_819_48,
    0.058_581_489_128_022_1,
    -0.050_854_497_379_402_6,
    0.039_231_658_295_587_19,
    -0.019_176_887_119_062_26,
];

/// `atan2(y, x)` for x and y that are not negative, with an error of at most two roundings; π/2 where both are 0.
#[inline(always)]
pub(crate) fn angle<L: Lanes>(y: L, x: L) -> L {
    let (steep, flat) = (x * y.constant(SQRT_2 + 1.0), x * y.constant(SQRT_2 - 1.0));
    let third = |of: [L; 3]| choose(y, [steep, flat], of);
    // π/2 − arctan(x/y), π/4 + arctan((y − x)/(y + x)) or arctan(y/x)
    let below = third([y, y + x, x]);
    let below = below.where_at_least(y.constant(f64::MIN_POSITIVE), below, y.constant(1.0));
    let q = third([-x, y - x, y]) / below;
    let square = q * q;
    let mut series = y.constant(SERIES[10]);
    for &a in SERIES[..10].iter().rev() {
        series = series * square + y.constant(a);
    }
    let base = third([y.constant(FRAC_PI_2), y.constant(FRAC_PI_4), y.constant(0.0)]);
    let lost = third([y.constant(LOST[0]), y.constant(LOST[1]), y.constant(0.0)]);
    // The rounding error of the sum is kept: π/4 misses half an ulp of q, and would round all angles near 60° the same way.
    let sum = base + q;
    sum + ((q - (sum - base)) + (q * (square * series) + lost))
}

/// The first value where y is steep, the second where it is not flat, else the third.
#[inline(always)]
fn choose<L: Lanes>(y: L, [steep, flat]: [L; 2], of: [L; 3]) -> L {
    let other = y.where_at_least(flat, of[1], of[2]);
    y.where_at_least(steep, of[0], other)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_are_those_of_the_c_library_to_two_roundings() {
        let mut worst = 0.0f64;
        for k in 0..200_000u32 {
            let turn = f64::from(k).mul_add(0.618_033_988_749_894_9, 0.1).fract();
            let size = 2f64.powi((k % 300) as i32 - 150);
            let (y, x) = ((FRAC_PI_2 * turn).sin() * size, (FRAC_PI_2 * turn).cos() * size);
            let exact = y.atan2(x);
            worst = worst.max((angle(y, x) / exact - 1.0).abs() / f64::EPSILON);
        }
        assert!(worst < 2.0, "{worst}");
    }

    /// The angles of a million faces satisfy the theorem of Gauss and Bonnet to 1e-11, so roundings must not be biased to one side.
    #[test]
    fn roundings_cancel_over_many_angles() {
        for (from, to) in [(0.05, 0.39), (0.45, 0.6), (0.6, 1.0), (1.0, 1.17), (1.2, 1.5)] {
            let mut sum = 0.0;
            for k in 0..200_000u32 {
                let [turn, size] = [0.618_033_988_749_894_9, 0.414_213_562_373_095]
                    .map(|step| f64::from(k).mul_add(step, 0.1).fract());
                let at = from + (to - from) * turn;
                let (y, x) = (at.sin() * (1.0 + size), at.cos() * (1.0 + size));
                sum += angle(y, x) - y.atan2(x);
            }
            let mean = sum / 200_000.0;
            assert!(mean.abs() < 2e-18, "{from} to {to}: {mean:e}");
        }
    }

    #[test]
    fn the_ends_are_exact_and_small_angles_keep_their_digits() {
        assert!(angle(0.0, 1.0) == 0.0 && angle(1.0, 0.0) == FRAC_PI_2 && angle(0.0, 0.0) == FRAC_PI_2);
        assert!(angle(1.0, 1.0) == FRAC_PI_4);
        for x in [1e-300, 1e-160, 1e-20, 1e-8] {
            assert!((angle(x, 1.0) / x - 1.0).abs() < 1e-15 && angle(1.0, x) <= FRAC_PI_2);
        }
    }
}
