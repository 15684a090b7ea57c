//! The rotation about an axis that brings one measure on a disk or a sphere as near as possible to another one.

use std::f64::consts::TAU;

/// A point with its share of the measure.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PolarSample {
    /// The distance from the axis, in [0, 1].
    pub distance: f64,
    /// The angle about the axis, radians.
    pub angle: f64,
    pub share: f64,
}

/// Number of rings about the axis into which a measure is divided.
const RINGS: usize = 8;
/// Number of Fourier coefficients around the axis that count in each ring.
const WAVES: usize = 8;
/// Number of angles at which the correlation is evaluated first: more than two for every wave.
const ANGLES: usize = 256;
/// Most Newton steps from the best of these angles.
const STEPS: usize = 20;

/// The angle of the rotation after which the correlation of the first measure with the second one, ring by ring in the first Fourier
/// coefficients, is the largest. If the second measure is a rotated copy of the first, it is the angle of that rotation up to rounding.
pub(crate) fn best_turn(from: &[PolarSample], to: &[PolarSample]) -> f64 {
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

/// Per ring the first Fourier coefficients of the measure, the constant one left out.
fn waves(of: &[PolarSample]) -> [[[f64; 2]; WAVES]; RINGS] {
    let mut sums = [[[0.0; 2]; WAVES]; RINGS];
    for &PolarSample { distance, angle, share } in of {
        // A share is divided between the two nearest rings, so that rounding moves nothing from ring to ring.
        let far = distance.clamp(0.0, 1.0) * (RINGS - 1) as f64;
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

/// The shift of numbers, given with their shares, after which the mean of their hyperbolic tangents is 0.
pub(crate) fn centre(numbers: &[(f64, f64)]) -> f64 {
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
        let points: Vec<PolarSample> = (0..400)
            .map(|k| {
                let x = f64::from(k);
                let share = 1.0 + (0.9 * x).sin() + (3.4 * x + 0.2).cos();
                PolarSample { distance: (0.37 * x) % 1.0, angle: (1.7 * x) % TAU, share }
            })
            .collect();
        let turned: Vec<PolarSample> =
            points.iter().map(|p| PolarSample { angle: p.angle + 2.3, ..*p }).collect();
        assert!((best_turn(&points, &turned) - 2.3).abs() < 1e-12, "{}", best_turn(&points, &turned));
        let numbers = [(1.0, 0.5), (3.0, 0.25), (-2.0, 0.25)];
        let shift = centre(&numbers);
        assert!(numbers.iter().map(|(x, w)| w * (x - shift).tanh()).sum::<f64>().abs() < 1e-15);
    }
}
