//! Cubic B-splines over clamped knots on [0, 1]: values, derivatives, and the interpolant of values and end derivatives [dB01].

use crate::geometry::vector::{Vector, add, scale, sub};

/// Degree in each direction.
pub(super) const DEGREE: usize = 3;
/// Number of basis functions that do not vanish in a span.
pub(super) const LOCAL: usize = DEGREE + 1;

/// Clamped knots with equal spans: 0 four times, 1/k, 2/k, …, 1 four times.
pub(super) fn uniform(spans: usize) -> Vec<f64> {
    let inner = (1..spans).map(|i| i as f64 / spans as f64);
    [0.0; LOCAL].into_iter().chain(inner).chain([1.0; LOCAL]).collect()
}

/// The basis functions at a place: the number of the first that does not vanish there, and the derivatives of order 0, 1, 2 of it and the
/// next three.
pub(super) fn basis(knots: &[f64], x: f64) -> (usize, [[f64; LOCAL]; 3]) {
    let last = knots.len() - LOCAL;
    // The span [t_i, t_{i+1}) contains x; the last span contains its end too.
    let span = knots[..last].partition_point(|&t| t <= x).clamp(LOCAL, last) - 1;
    let mut rows = [[0.0; LOCAL]; LOCAL];
    rows[0][0] = 1.0;
    for degree in 1..=DEGREE {
        for j in 0..=degree {
            let i = span + j - degree;
            let rising = if j > 0 {
                ratio(x - knots[i], knots[i + degree] - knots[i]) * rows[degree - 1][j - 1]
            } else {
                0.0
            };
            let falling = if j < degree {
                ratio(knots[i + degree + 1] - x, knots[i + degree + 1] - knots[i + 1]) * rows[degree - 1][j]
            } else {
                0.0
            };
            rows[degree][j] = rising + falling;
        }
    }
    let first = derivative(knots, span, DEGREE, rows[2]);
    let second = derivative(knots, span, DEGREE, derivative(knots, span, DEGREE - 1, rows[1]));
    (span - DEGREE, [rows[DEGREE], first, second])
}

/// The derivatives of basis functions of degree p, from those of degree p − 1 or their derivatives.
fn derivative(knots: &[f64], span: usize, degree: usize, below: [f64; LOCAL]) -> [f64; LOCAL] {
    let p = degree as f64;
    let mut found = [0.0; LOCAL];
    for j in 0..=degree {
        let i = span + j - degree;
        let rising = if j > 0 { ratio(below[j - 1], knots[i + degree] - knots[i]) } else { 0.0 };
        let falling = if j < degree { ratio(below[j], knots[i + degree + 1] - knots[i + 1]) } else { 0.0 };
        found[j] = p * (rising - falling);
    }
    found
}

/// The quotient a / b; 0 if b is, as where knots coincide.
fn ratio(a: f64, b: f64) -> f64 {
    if b > 0.0 { a / b } else { 0.0 }
}

/// The value and the first and second derivative of a curve.
pub(super) fn curve_at(knots: &[f64], control: &[Vector], x: f64) -> [Vector; 3] {
    let (first, weights) = basis(knots, x);
    weights.map(|w| combined(&w, |j| control[first + j]))
}

/// The sum of four vectors with weights.
pub(super) fn combined(weights: &[f64; LOCAL], vector: impl Fn(usize) -> Vector) -> Vector {
    (0..LOCAL).fold([0.0; 3], |sum, j| add(sum, scale(weights[j], vector(j))))
}

/// The control points, over [`uniform`] knots, of the C² cubic with given values at the ends of the spans and given derivatives at 0 and 1:
/// k + 3 points from k + 1 values.
pub(super) fn interpolate(values: &[Vector], ends: [Vector; 2]) -> Vec<Vector> {
    let spans = values.len() - 1;
    let third = 1.0 / (DEGREE * spans) as f64;
    let knots = uniform(spans);
    let mut control = vec![[0.0; 3]; spans + DEGREE];
    (control[0], control[spans + 2]) = (values[0], values[spans]);
    control[1] = add(values[0], scale(third, ends[0]));
    control[spans + 1] = sub(values[spans], scale(third, ends[1]));
    // At the end of span i only the functions i, i + 1, i + 2 do not vanish: tridiagonal equations, eliminated from the front.
    let mut upper = vec![0.0; spans + 1];
    for i in 1..spans {
        let [below, middle, above, _] = basis(&knots, knots[DEGREE + i]).1[0];
        let pivot = middle - below * upper[i - 1];
        upper[i] = if i + 1 < spans { above / pivot } else { 0.0 };
        let known = if i + 1 < spans { [0.0; 3] } else { scale(above, control[spans + 1]) };
        let right = sub(sub(values[i], known), scale(below, control[i]));
        control[i + 1] = scale(1.0 / pivot, right);
    }
    for i in (1..spans).rev() {
        control[i + 1] = sub(control[i + 1], scale(upper[i], control[i + 2]));
    }
    control
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cubic(x: f64) -> [Vector; 3] {
        [
            [1.0 + x * (2.0 - x * (3.0 - 4.0 * x)), x, x * x],
            [2.0 - 6.0 * x + 12.0 * x * x, 1.0, 2.0 * x],
            [-6.0 + 24.0 * x, 0.0, 2.0],
        ]
    }

    #[test]
    fn cubics_are_reproduced_with_their_derivatives() {
        for spans in [1, 2, 3, 4, 8, 32] {
            let values: Vec<Vector> = (0..=spans).map(|i| cubic(i as f64 / spans as f64)[0]).collect();
            let control = interpolate(&values, [cubic(0.0)[1], cubic(1.0)[1]]);
            assert_eq!(control.len(), spans + 3);
            for i in 0..=40 {
                let x = f64::from(i) / 40.0;
                let (found, exact) = (curve_at(&uniform(spans), &control, x), cubic(x));
                for (found, exact) in found.as_flattened().iter().zip(exact.as_flattened()) {
                    assert!((found - exact).abs() < 1e-11, "{spans} spans at {x}: {found} {exact}");
                }
            }
        }
    }

    #[test]
    fn the_interpolant_of_a_sine_nears_it_with_the_fourth_power() {
        let error = |spans: usize| {
            let point = |x: f64| [x.sin(), x.cos(), 0.0];
            let values: Vec<Vector> = (0..=spans).map(|i| point(i as f64 / spans as f64)).collect();
            let control = interpolate(&values, [[1.0, 0.0, 0.0], [1f64.cos(), -1f64.sin(), 0.0]]);
            let miss = |x: f64| (curve_at(&uniform(spans), &control, x)[0][0] - x.sin()).abs();
            (0..=1000).map(|i| miss(f64::from(i) / 1000.0)).fold(0.0, f64::max)
        };
        for spans in [4, 8, 16] {
            let ratio = error(spans) / error(2 * spans);
            assert!((13.0..19.0).contains(&ratio), "{spans}: {ratio}");
        }
    }
}
