//! B-splines of degree 5 over clamped knots on [0, 1] with equal spans and triple inner knots: twice continuously differentiable, with three
//! more functions for every further span [dB01].

/// Degree in each direction.
pub const QUINTIC: usize = 5;
/// Number of basis functions that do not vanish in a span.
pub(super) const LOCAL: usize = QUINTIC + 1;
/// Most spans of a patch in each direction.
pub(super) const MAX_SPANS: usize = 32;
/// Multiplicity of inner knots.
pub(super) const MULTIPLICITY: usize = 3;

/// The values and derivatives of order 1 to 3 of the basis functions that do not vanish at a place.
#[derive(Debug, Clone, Copy)]
pub(super) struct QuinticBasis {
    /// The number of the first of these functions.
    pub first: usize,
    /// `derivatives[k][j]`: the derivative of order k of the function `first` + j.
    pub derivatives: [[f64; LOCAL]; 4],
}

/// The number of basis functions for a number of spans.
pub(super) const fn basis_size(spans: usize) -> usize {
    LOCAL + MULTIPLICITY * (spans - 1)
}

/// The knot of a number.
fn knot(spans: usize, number: usize) -> f64 {
    match number.checked_sub(LOCAL) {
        None => 0.0,
        Some(inner) => ((inner / MULTIPLICITY + 1) as f64 / spans as f64).min(1.0),
    }
}

/// The knots: 0 six times, each inner knot three times, 1 six times.
pub(super) fn knots(spans: usize) -> Vec<f64> {
    (0..basis_size(spans) + LOCAL).map(|number| knot(spans, number)).collect()
}

impl QuinticBasis {
    /// The basis at x from 0 to 1; a knot between two spans counts for the second.
    pub fn at(spans: usize, x: f64) -> QuinticBasis {
        let span = ((x * spans as f64) as usize).min(spans - 1);
        let knot = |number: usize| knot(spans, number);
        let at = QUINTIC + MULTIPLICITY * span;
        let mut rows = [[0.0; LOCAL]; LOCAL];
        rows[0][0] = 1.0;
        for degree in 1..=QUINTIC {
            for j in 0..=degree {
                let i = at + j - degree;
                let rise = if j > 0 { share(x - knot(i), knot(i + degree) - knot(i)) } else { 0.0 };
                let fall = share(knot(i + degree + 1) - x, knot(i + degree + 1) - knot(i + 1));
                let before = if j > 0 { rows[degree - 1][j - 1] } else { 0.0 };
                let after = if j < degree { rows[degree - 1][j] } else { 0.0 };
                rows[degree][j] = rise * before + fall * after;
            }
        }
        let mut derivatives = [rows[QUINTIC]; 4];
        for (order, found) in derivatives.iter_mut().enumerate().skip(1) {
            let start = QUINTIC - order;
            *found = (start + 1..=QUINTIC).fold(rows[start], |below, degree| slope(spans, at, degree, below));
        }
        QuinticBasis { first: at - QUINTIC, derivatives }
    }
}

/// The derivatives of the basis functions of a degree, from those of one degree less or their derivatives. `at`: the last knot at or before
/// the place.
fn slope(spans: usize, at: usize, degree: usize, below: [f64; LOCAL]) -> [f64; LOCAL] {
    let knot = |number: usize| knot(spans, number);
    let mut found = [0.0; LOCAL];
    for (j, found) in found.iter_mut().enumerate().take(degree + 1) {
        let i = at + j - degree;
        let rise = if j > 0 { share(below[j - 1], knot(i + degree) - knot(i)) } else { 0.0 };
        let fall = if j < degree { share(below[j], knot(i + degree + 1) - knot(i + 1)) } else { 0.0 };
        *found = degree as f64 * (rise - fall);
    }
    found
}

/// The quotient a / b; 0 if b is, as where knots coincide.
fn share(a: f64, b: f64) -> f64 {
    if b > 0.0 { a / b } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_basis_adds_up_to_one_and_its_derivatives_are_difference_quotients() {
        for spans in [1, 2, 3, 5] {
            assert_eq!(knots(spans).len(), basis_size(spans) + LOCAL);
            for k in 0..40 {
                let x = (f64::from(k) + 0.37) / 40.0;
                let step = 1e-5;
                let [here, before, after] = [x, x - step, x + step].map(|x| QuinticBasis::at(spans, x));
                assert!((here.derivatives[0].iter().sum::<f64>() - 1.0).abs() < 1e-14);
                for order in 1..4 {
                    for j in 0..LOCAL {
                        let [a, b] = [before, after].map(|basis| basis.derivatives[order - 1][j]);
                        let quotient = (b - a) / (2.0 * step);
                        let size = f64::powi(5.0 * spans as f64, order as i32 + 2);
                        let miss = (here.derivatives[order][j] - quotient).abs();
                        assert!(miss < 1e-8 * size, "{spans} spans, order {order} at {x}: {miss}");
                    }
                }
            }
        }
    }
}
