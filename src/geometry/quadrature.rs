//! Places and weights for integrals over an interval.

use std::f64::consts::PI;

/// Newton steps, far more than the few that are needed.
const STEPS: usize = 30;

/// The places and weights of Gauss and Legendre on [0, 1]: n places integrate polynomials up to degree 2n − 1 exactly.
pub(crate) fn gauss_legendre(n: usize) -> Vec<[f64; 2]> {
    let place = |i: usize| {
        // A root of the Legendre polynomial, from a place near it.
        let mut x = (PI * (i as f64 + 0.75) / (n as f64 + 0.5)).cos();
        for _ in 0..STEPS {
            let [value, slope] = legendre(n, x);
            x -= value / slope;
        }
        let slope = legendre(n, x)[1];
        [0.5 - 0.5 * x, 1.0 / ((1.0 - x * x) * slope * slope)]
    };
    (0..n).map(place).collect()
}

/// The Legendre polynomial of degree n and its derivative, inside (−1, 1).
fn legendre(n: usize, x: f64) -> [f64; 2] {
    let (mut value, mut before) = (1.0, 0.0);
    for k in 0..n {
        let k = k as f64;
        (value, before) = (((2.0 * k + 1.0) * x * value - k * before) / (k + 1.0), value);
    }
    [value, n as f64 * (x * value - before) / (x * x - 1.0)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_are_integrated_exactly() {
        for n in 1..=12 {
            for degree in 0..2 * n {
                let sum: f64 = gauss_legendre(n).iter().map(|[x, w]| w * x.powi(degree as i32)).sum();
                assert!(
                    (sum - 1.0 / (degree + 1) as f64).abs() < 1e-14,
                    "{n} places, degree {degree}: {sum}"
                );
            }
            let sum: f64 = gauss_legendre(n).iter().map(|[x, w]| w * x.powi(2 * n as i32)).sum();
            assert!((sum - 1.0 / (2 * n + 1) as f64).abs() > 1e-15);
        }
    }
}
