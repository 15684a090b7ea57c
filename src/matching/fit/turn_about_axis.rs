//! Turns about an axis that bring one measure on a disk or a sphere near another one.

use std::f64::consts::TAU;

/// A point with its share of the measure: how far it is from the axis, in [0, 1], its angle about the axis in radians, and the share.
pub(super) type Around = (f64, f64, f64);

/// Rings about the axis, between which measures are told apart.
const RINGS: usize = 8;
/// Waves around the axis: of each ring its first coefficients count.
const WAVES: usize = 8;
/// Angles at which the correlation is looked at first: more than two for every wave.
const ANGLES: usize = 256;
/// Newton steps from the best of them.
const STEPS: usize = 20;

/// The angle by which the first measure is turned so that its correlation with the second one, ring by ring and in the first waves around
/// the axis, is the largest. For a copy that is turned it is the angle between the two up to rounding.
pub(super) fn best_turn(from: &[Around], to: &[Around]) -> f64 {
    let [first, second] = [from, to].map(waves);
    // The correlation is Σ Re(c_m e^{imα}) with these coefficients.
    let mut all = [[0.0; 2]; WAVES];
    for (a, b) in first.iter().zip(&second) {
        for (m, sum) in all.iter_mut().enumerate() {
            let ([x, y], [u, v]) = (a[m], b[m]);
            *sum = [sum[0] + x * u + y * v, sum[1] + y * u - x * v];
        }
    }
    let at = |angle: f64, derivative: usize| -> f64 {
        let wave = |(m, c): (usize, &[f64; 2])| {
            let m = (m + 1) as f64;
            let (sin, cos) = (m * angle).sin_cos();
            match derivative {
                0 => c[0] * cos - c[1] * sin,
                1 => -m * (c[0] * sin + c[1] * cos),
                _ => -m * m * (c[0] * cos - c[1] * sin),
            }
        };
        all.iter().enumerate().map(wave).sum()
    };
    let angles = (0..ANGLES).map(|k| TAU * k as f64 / ANGLES as f64);
    let mut best = angles.fold(0.0, |best, angle| if at(angle, 0) > at(best, 0) { angle } else { best });
    for _ in 0..STEPS {
        let (slope, curvature) = (at(best, 1), at(best, 2));
        if curvature >= 0.0 {
            break;
        }
        let next = best - slope / curvature;
        if at(next, 0) < at(best, 0) {
            break;
        }
        best = next;
    }
    best
}

/// Per ring the first coefficients of the measure.
fn waves(of: &[Around]) -> [[[f64; 2]; WAVES]; RINGS] {
    let mut sums = [[[0.0; 2]; WAVES]; RINGS];
    for &(far, angle, share) in of {
        // Shared between the two nearest rings, so that rounding moves nothing from ring to ring.
        let far = far.clamp(0.0, 1.0) * (RINGS - 1) as f64;
        let ring = (far as usize).min(RINGS - 2);
        let part = far - ring as f64;
        for (ring, share) in [(ring, (1.0 - part) * share), (ring + 1, part * share)] {
            for (m, sum) in sums[ring].iter_mut().enumerate() {
                let (sin, cos) = ((m + 1) as f64 * angle).sin_cos();
                *sum = [sum[0] + share * cos, sum[1] + share * sin];
            }
        }
    }
    sums
}

/// The shift of numbers with these shares after which the mean of their hyperbolic tangents is 0.
pub(super) fn centre(numbers: &[(f64, f64)]) -> f64 {
    let ends = numbers.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], n| [a.min(n.0), b.max(n.0)]);
    let [mut low, mut high] = ends;
    let mean = |shift: f64| numbers.iter().map(|(x, share)| share * (x - shift).tanh()).sum::<f64>();
    loop {
        let middle = 0.5 * (low + high);
        // Until the two ends are neighbours.
        if !(low < middle && middle < high) {
            return if middle.is_finite() { middle } else { 0.0 };
        }
        if mean(middle) > 0.0 { low = middle } else { high = middle }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turned_copy_is_turned_back_and_a_shift_is_found() {
        let points: Vec<Around> = (0..400)
            .map(|k| {
                let x = f64::from(k);
                ((0.37 * x) % 1.0, (1.7 * x) % TAU, 1.0 + (0.9 * x).sin() + (3.4 * x + 0.2).cos())
            })
            .collect();
        let turned: Vec<Around> = points.iter().map(|&(r, angle, w)| (r, angle + 2.3, w)).collect();
        assert!((best_turn(&points, &turned) - 2.3).abs() < 1e-12, "{}", best_turn(&points, &turned));
        let numbers = [(1.0, 0.5), (3.0, 0.25), (-2.0, 0.25)];
        let shift = centre(&numbers);
        assert!(numbers.iter().map(|(x, w)| w * (x - shift).tanh()).sum::<f64>().abs() < 1e-15);
    }
}
