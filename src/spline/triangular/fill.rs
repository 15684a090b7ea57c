//! The filling of a hole that a spline leaves around a singular vertex: a uniform bicubic B-spline over the square −1 ≤ p, q ≤ 1.

use super::jet::Jet;
use crate::error::{Error, Result};
use crate::geometry::complex::Complex;
use crate::geometry::vector::Vector;
use std::f64::consts::SQRT_2;

/// Most cells along a side of the square: 361 coefficients, whose dense equations take milliseconds.
const MOST_CELLS: usize = 16;

/// A filling with k × k cells and (k + 3)² coefficients: that of i along p and j along q has the number i + (k + 3) j.
#[derive(Debug, Clone, PartialEq)]
pub struct Fill {
    cells: usize,
    coefficients: Vec<Vector>,
}

/// The four cubic B-splines that are not 0 at a coordinate: the number of the first, then value, first and second derivative of each.
fn basis(x: f64, cells: usize) -> (usize, [[f64; 3]; 4]) {
    let per_unit = 0.5 * cells as f64;
    let u = (x + 1.0) * per_unit;
    let first = (u.max(0.0) as usize).min(cells - 1);
    let s = u - first as f64;
    let r = 1.0 - s;
    let values = [
        [r * r * r / 6.0, -0.5 * r * r, r],
        [(s * s * (3.0 * s - 6.0) + 4.0) / 6.0, s * (1.5 * s - 2.0), 3.0 * s - 2.0],
        [(r * r * (3.0 * r - 6.0) + 4.0) / 6.0, -r * (1.5 * r - 2.0), 3.0 * r - 2.0],
        [s * s * s / 6.0, 0.5 * s * s, s],
    ];
    (first, values.map(|[value, d, dd]| [value, d * per_unit, dd * per_unit * per_unit]))
}

impl Fill {
    /// The filling with given coefficients.
    ///
    /// # Errors
    /// [`Error::Argument`] for another number than (k + 3)², k = 1 … 16; [`Error::Spline`] for one that is not finite.
    pub fn new(coefficients: Vec<Vector>) -> Result<Fill> {
        let Some(cells) = (1..=MOST_CELLS).find(|k| (k + 3) * (k + 3) == coefficients.len()) else {
            return Err(Error::argument(
                "coefficients of a hole",
                coefficients.len(),
                "(k + 3)² for a k from 1 to 16",
            ));
        };
        if let Some(at) = coefficients.iter().position(|c| !c.iter().all(|x| x.is_finite())) {
            let message = "it is no finite number".into();
            return Err(Error::Spline { what: "coefficient of a hole", index: at, message });
        }
        Ok(Fill { cells, coefficients })
    }

    /// A filling of zeros, with at most this number of coefficients but at least 16.
    pub fn blank(coefficients: usize) -> Fill {
        let side = coefficients.isqrt().clamp(4, MOST_CELLS + 3);
        Fill { cells: side - 3, coefficients: vec![[0.0; 3]; side * side] }
    }

    /// The numbers of the coefficients whose basis functions are not 0 at a place p + iq, with the values of these.
    pub(super) fn factors(&self, [p, q]: Complex) -> impl Iterator<Item = (usize, f64)> {
        let side = self.cells + 3;
        let ((i, along), (j, across)) = (basis(p, self.cells), basis(q, self.cells));
        (0..16).map(move |k| ((j + k / 4) * side + i + k % 4, across[k / 4][0] * along[k % 4][0]))
    }

    /// The second differences of the coefficients, as numbers and factors; mixed ones times √2, so that their squares count twice.
    pub(super) fn differences(&self) -> Vec<Vec<(usize, f64)>> {
        let side = self.cells + 3;
        let mut all = Vec::new();
        for at in 0..side * side {
            for (position, step) in [(at % side, 1), (at / side, side)] {
                if position + 2 < side {
                    all.push(vec![(at, 1.0), (at + step, -2.0), (at + 2 * step, 1.0)]);
                }
            }
            if at % side + 1 < side && at / side + 1 < side {
                let factors = [(at, 1.0), (at + 1, -1.0), (at + side, -1.0), (at + side + 1, 1.0)];
                all.push(factors.map(|(k, x)| (k, x * SQRT_2)).to_vec());
            }
        }
        all
    }

    /// The coefficients.
    pub fn coefficients(&self) -> &[Vector] {
        &self.coefficients
    }

    /// The coordinates of the point at (p, q), with derivatives up to order two by the variables in which the jets p and q are given.
    pub(super) fn at(&self, [p, q]: [Jet; 2]) -> [Jet; 3] {
        let side = self.cells + 3;
        let ((i, along), (j, across)) = (basis(p.0[0], self.cells), basis(q.0[0], self.cells));
        std::array::from_fn(|x| {
            // f, f_p, f_q, f_pp, f_pq, f_qq.
            let mut partial = [0.0; 6];
            for (k, b) in across.iter().enumerate() {
                for (l, a) in along.iter().enumerate() {
                    let c = self.coefficients[(j + k) * side + i + l][x];
                    let terms =
                        [a[0] * b[0], a[1] * b[0], a[0] * b[1], a[2] * b[0], a[1] * b[1], a[0] * b[2]];
                    partial.iter_mut().zip(terms).for_each(|(sum, term)| *sum += c * term);
                }
            }
            Jet::of_two(partial, [p, q])
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::dense::solve_definite;

    /// Cubic polynomials are reproduced, with their derivatives.
    #[test]
    fn cubics_are_reproduced() {
        let cubic = |p: f64, q: f64| [p, p * p * q - q * q * q, 1.0 + p * q];
        let places = (0..900).map(|k| [f64::from(k % 30) / 14.5 - 1.0, f64::from(k / 30) / 14.5 - 1.0]);
        let blank = Fill::blank(64);
        let (mut matrix, mut right) = (vec![vec![0.0; 64]; 64], vec![vec![0.0; 3]; 64]);
        for [p, q] in places {
            let row: Vec<(usize, f64)> = blank.factors([p, q]).collect();
            for &(i, a) in &row {
                row.iter().for_each(|&(j, b)| matrix[i][j] += a * b);
                (0..3).for_each(|x| right[i][x] += a * cubic(p, q)[x]);
            }
        }
        let solution = solve_definite(&matrix, &right).unwrap();
        let fill = Fill::new(solution.iter().map(|c| [c[0], c[1], c[2]]).collect()).unwrap();
        assert_eq!(fill.coefficients().len(), 64);
        let [p, q] = [0.31, -0.62];
        let variables = [Jet([p, 1.0, 0.0, 0.0, 0.0, 0.0]), Jet([q, 0.0, 1.0, 0.0, 0.0, 0.0])];
        let found = fill.at(variables)[1].0;
        let exact = [p * p * q - q * q * q, 2.0 * p * q, p * p - 3.0 * q * q, 2.0 * q, 2.0 * p, -6.0 * q];
        for (a, b) in found.iter().zip(exact) {
            assert!((a - b).abs() < 1e-9, "{found:?} {exact:?}");
        }
    }
}
