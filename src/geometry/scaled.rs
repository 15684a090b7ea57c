//! Products of numbers with powers of two that f64 need not hold. Such products are exact.

/// Largest |k| that changes a result: an f64 lies between 2^−1074 and 2^1024, so that beyond 2098 all results are 0 or infinite.
const BEYOND: i32 = 2100;

/// `x 2^k`: exact where the result is a normal number, else 0, subnormal or infinite, as for any f64.
#[inline]
pub(crate) fn scaled(x: f64, k: i32) -> f64 {
    if k == 0 {
        return x;
    }
    // Three factors, each a normal number, so that no intermediate product over- or underflows unless the result does.
    let k = k.clamp(-BEYOND, BEYOND);
    let first = k / 3;
    let second = (k - first) / 2;
    x * power(first) * power(second) * power(k - first - second)
}

/// `2^k` for −1022 ≤ k ≤ 1023.
fn power(k: i32) -> f64 {
    f64::from_bits(((1023 + k) as u64) << 52)
}

/// The k with `2^k ≤ |x| < 2^(k+1)`; −1023 for 0 and subnormal numbers.
#[inline]
pub(crate) fn exponent(x: f64) -> i32 {
    ((x.to_bits() >> 52) & 0x7ff) as i32 - 1023
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_of_two_are_exact() {
        for k in [-2000, -1500, -1022, -700, -1, 0, 1, 3, 500, 1023, 1500, 2000] {
            let x = 1.0 + f64::EPSILON;
            assert_eq!(scaled(scaled(x, k / 2), -(k / 2)), x);
            let there = scaled(x, k);
            match k {
                k if k > 1023 => assert_eq!(there, f64::INFINITY),
                k if k < -1074 => assert_eq!(there, 0.0),
                _ => assert_eq!((exponent(there), scaled(there, -k)), (k, x)),
            }
        }
        assert_eq!(scaled(f64::MAX, -2097), scaled(1.0 - f64::EPSILON / 2.0, -1073));
    }
}
