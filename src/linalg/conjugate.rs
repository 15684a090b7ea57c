//! Symmetric positive definite systems, solved by conjugate gradients with the factor of a similar matrix as preconditioner.
//!
//! ```
//! use ricci::Control;
//! use ricci::linalg::conjugate::{ConjugateGradients, LinearProblem, ResidualBound};
//! use ricci::linalg::{Cholesky, Pattern, Symmetric};
//! let pattern = Pattern::new(2, &[(0, 1)])?;
//! let mut factor = Cholesky::analyse(&pattern)?;
//! // [[2, 1], [1, 2]] is factorised, and [[2, 1], [1, 3]] x = [3, 4] is solved.
//! factor.factor(Symmetric { pattern: &pattern, values: &[2.0, 1.0, 2.0] }).unwrap();
//! let mut x = [3.0, 4.0];
//! let problem = LinearProblem {
//!     matrix: Symmetric { pattern: &pattern, values: &[2.0, 1.0, 3.0] },
//!     bound: ResidualBound { largest: 1e-14, sum: f64::INFINITY },
//! };
//! assert!(ConjugateGradients::default().solve(problem, &mut factor, &mut x, &Control::new())?);
//! assert!(x.iter().all(|x| (x - 1.0).abs() < 1e-14));
//! # Ok::<(), ricci::Error>(())
//! ```

use super::{Cholesky, FactorNumber, Symmetric, dot};
use crate::control::Control;
use crate::error::Result;

/// Most iterations. Each costs one solution with the factor, and 5 (50,000 unknowns) to 12 (850,000) solutions take as long as a
/// factorisation, so that beyond this number factorising the matrix itself is faster.
const ITERATIONS: u32 = 8;

/// Bounds on the residual `b − A x` of a solution.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ResidualBound {
    /// Bound on the size of its largest entry; positive.
    pub largest: f64,
    /// Bound on the size of the sum of its entries; positive, infinite for none. Where the equations of all unknowns add up to 0 and one
    /// unknown is held at its value, this bounds the residual of that one's equation.
    pub sum: f64,
}

impl ResidualBound {
    /// Number of first iterations whose residuals do not show the speed of convergence. The largest entry may grow in the first one while
    /// the error falls. Where the sum is bounded, one unknown is held, so that the vector of ones is nearly in the kernel of A, and a
    /// factor in single precision hardly determines its share of a solution: the second iteration finds that.
    fn free_iterations(self) -> u32 {
        if self.sum.is_finite() { 2 } else { 1 }
    }

    /// The quotient of a residual by its bounds: at most 1 where they hold, NaN where an entry is NaN.
    fn excess(self, residual: &[f64]) -> f64 {
        let largest = residual.iter().fold(0.0, |most: f64, r| if r.abs() <= most { most } else { r.abs() });
        let (largest, sum) = (largest / self.largest, residual.iter().sum::<f64>().abs() / self.sum);
        if sum <= largest { largest } else { sum }
    }
}

/// A linear system with the accuracy that its solution must have.
#[derive(Debug, Clone, Copy)]
pub struct LinearProblem<'a> {
    /// The matrix.
    pub matrix: Symmetric<'a>,
    /// The bound on the residual.
    pub bound: ResidualBound,
}

/// The vectors of a solution; their memory is reused from one solution to the next.
#[derive(Default)]
pub struct ConjugateGradients {
    residual: Vec<f64>,
    direction: Vec<f64>,
    image: Vec<f64>,
    corrected: Vec<f64>,
}

impl ConjugateGradients {
    /// Overwrites `x`, which holds b, with a solution of `A x = b`, found by conjugate gradients \[HS52\] that are preconditioned by the
    /// matrix that `near` has factorised last. Sums are formed in a fixed order for any number of threads.
    ///
    /// Returns false, with meaningless `x`, where factorising A is faster or needed: A is found not to be positive definite, or after a
    /// few steps the residuals fall too slowly to end within the limit of steps.
    ///
    /// # Errors
    ///
    /// [`crate::Error::Cancelled`].
    ///
    /// # Panics
    ///
    /// If `x` or the preconditioner does not have as many entries as A has rows.
    pub fn solve<T: FactorNumber>(
        &mut self,
        LinearProblem { matrix, bound }: LinearProblem<'_>,
        near: &mut Cholesky<T>,
        x: &mut [f64],
        control: &Control,
    ) -> Result<bool> {
        let ConjugateGradients { residual, direction, image, corrected } = self;
        for vector in [&mut *residual, &mut *direction] {
            vector.clear();
            vector.extend_from_slice(x);
        }
        image.resize(x.len(), 0.0);
        corrected.resize(x.len(), 0.0);
        x.fill(0.0);
        let first = bound.excess(residual);
        if first <= 1.0 {
            return Ok(true);
        }
        near.solve(direction);
        let mut product = dot(residual, direction);
        for iteration in 1..=ITERATIONS {
            control.check()?;
            matrix.product(direction, image);
            let curvature = dot(direction, image);
            // The comparisons are false for NaN.
            if !(curvature > 0.0 && product > 0.0) {
                return Ok(false);
            }
            let length = product / curvature;
            for (i, x) in x.iter_mut().enumerate() {
                *x += length * direction[i];
                residual[i] -= length * image[i];
            }
            let now = bound.excess(residual);
            if now <= 1.0 {
                return Ok(true);
            }
            let in_time = first.powf(1.0 - f64::from(iteration) / f64::from(ITERATIONS));
            if !(iteration <= bound.free_iterations() || now <= in_time) {
                return Ok(false);
            }
            corrected.copy_from_slice(residual);
            near.solve(corrected);
            let next = dot(residual, corrected);
            let keep = next / product;
            direction.iter_mut().zip(&*corrected).for_each(|(d, c)| *d = c + keep * *d);
            product = next;
        }
        Ok(false)
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::linalg::Pattern;

    /// A chain of springs of stiffness `1 + bend · sin(i)`, held at both ends.
    fn chain(n: usize, bend: f64) -> (Pattern, Vec<f64>) {
        let pairs: Vec<(u32, u32)> = (1..n as u32).map(|i| (i, i - 1)).collect();
        let pattern = Pattern::new(n, &pairs).unwrap();
        let mut values = vec![0.0; pattern.entries()];
        for i in 0..=n {
            let stiffness = 1.0 + bend * (i as f64).sin();
            (i.saturating_sub(1)..=i.min(n - 1)).for_each(|j| values[pattern.diagonal(j)] += stiffness);
            if i > 0 && i < n {
                values[pattern.position(i, i - 1).unwrap()] -= stiffness;
            }
        }
        (pattern, values)
    }

    #[test]
    fn matrices_near_the_factorised_one_are_solved_and_others_are_given_up() {
        let n = 500;
        let (pattern, values) = chain(n, 0.0);
        let mut near = Cholesky::analyse(&pattern).unwrap();
        near.factor(Symmetric { pattern: &pattern, values: &values }).unwrap();
        let b: Vec<f64> = (0..n).map(|i| (0.1 * i as f64).cos()).collect();
        let mut solved = |values: &[f64], largest: f64| {
            let mut x = b.clone();
            let bound = ResidualBound { largest, sum: largest };
            let problem = LinearProblem { matrix: Symmetric { pattern: &pattern, values }, bound };
            let found = ConjugateGradients::default().solve(problem, &mut near, &mut x, &Control::new());
            let mut residual = b.clone();
            problem.matrix.residual(&x, &b, &mut residual);
            (found.unwrap(), bound.excess(&residual))
        };
        for (bend, largest) in [(0.0, 1e-11), (1e-3, 1e-6)] {
            let (found, excess) = solved(&chain(n, bend).1, largest);
            assert!(found && excess <= 2.0, "{bend}: {excess:e}");
        }
        // Convergence is too slow.
        assert!(!solved(&chain(n, 0.1).1, 1e-13).0 && !solved(&chain(n, 0.9).1, 1e-6).0);
        let negative: Vec<f64> = values.iter().map(|x| -x).collect();
        assert!(!solved(&negative, 1e-6).0);
        let bound = ResidualBound { largest: 1e-11, sum: 1e-11 };
        let problem = LinearProblem { matrix: Symmetric { pattern: &pattern, values: &values }, bound };
        let cancelled = Control::new();
        cancelled.cancel();
        let mut gradients = ConjugateGradients::default();
        assert!(gradients.solve(problem, &mut near, &mut b.clone(), &cancelled).is_err());
    }

    #[test]
    fn what_is_beyond_single_precision_is_refused_or_given_up() {
        let n = 50;
        let (pattern, values) = chain(n, 0.0);
        // With 1e-37 it is the solution that is too large.
        for (scale, found) in [(1.0, Some(true)), (1e-37, Some(false)), (1e-60, None), (1e90, None)] {
            let values: Vec<f64> = values.iter().map(|x| scale * x).collect();
            let matrix = Symmetric { pattern: &pattern, values: &values };
            let mut near = Cholesky::analyse(&pattern).unwrap().held_in::<f32>().unwrap();
            let mut x: Vec<f64> = (0..n).map(|i| (0.1 * i as f64).cos()).collect();
            let problem = LinearProblem { matrix, bound: ResidualBound { largest: 1e-12, sum: 1e-12 } };
            let factored = near.factor(matrix);
            assert_eq!(factored.is_ok(), found.is_some(), "{scale:e}");
            if let Some(found) = found {
                let mut conjugate = ConjugateGradients::default();
                assert_eq!(conjugate.solve(problem, &mut near, &mut x, &Control::new()).unwrap(), found);
            }
        }
    }
}
