//! Definite systems by conjugate gradients, with the factor of a matrix nearby as preconditioner.
//!
//! ```
//! use ricci::Control;
//! use ricci::linalg::conjugate::{Conjugate, Goal, Problem};
//! use ricci::linalg::{Cholesky, Pattern, Symmetric};
//! let pattern = Pattern::new(2, &[(0, 1)])?;
//! let mut factor = Cholesky::analyse(&pattern)?;
//! // [[2, 1], [1, 2]] is factorised, and [[2, 1], [1, 3]] x = [3, 4] is solved.
//! factor.factor(Symmetric { pattern: &pattern, values: &[2.0, 1.0, 2.0] }).unwrap();
//! let mut x = [3.0, 4.0];
//! let goal = Goal { left: 1e-14, sum: f64::INFINITY };
//! let matrix = Symmetric { pattern: &pattern, values: &[2.0, 1.0, 3.0] };
//! assert!(Conjugate::default().solve(Problem { matrix, goal }, &mut factor, &mut x, &Control::new())?);
//! assert!(x.iter().all(|x| (x - 1.0).abs() < 1e-14));
//! # Ok::<(), ricci::Error>(())
//! ```

use super::{Cholesky, Number, Symmetric, dot};
use crate::control::Control;
use crate::error::Result;

/// Iterations after which a factor of the matrix itself is the cheaper way: each costs a solution with the factor, of which 5 (50,000
/// unknowns) to 12 (850,000) take as long as a factorisation.
const ITERATIONS: u32 = 8;

/// What the residual `b − A x` of a solution may be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Goal {
    /// Its largest entry; positive.
    pub left: f64,
    /// Size of the sum of its entries; positive, infinite for any. Where the equations of all unknowns add up to 0 and one unknown is
    /// held, it is what is left of the equation of that one.
    pub sum: f64,
}

impl Goal {
    /// Iterations whose residuals say little of the speed: the largest entry may grow in the first one, while the error falls. Where the sum
    /// matters, one unknown is held, so that the vector of ones is nearly in the kernel of A, and a factor in single precision hardly knows
    /// how much of it belongs to a solution: the second iteration finds that.
    fn free_iterations(self) -> u32 {
        if self.sum.is_finite() { 2 } else { 1 }
    }

    /// How many times larger a residual is, at most 1 where the goal is reached; NaN where it is no number.
    fn excess(self, residual: &[f64]) -> f64 {
        let largest = residual.iter().fold(0.0, |most: f64, r| if r.abs() <= most { most } else { r.abs() });
        let (largest, sum) = (largest / self.left, residual.iter().sum::<f64>().abs() / self.sum);
        if sum <= largest { largest } else { sum }
    }
}

/// A matrix with what is asked of a solution.
#[derive(Debug, Clone, Copy)]
pub struct Problem<'a> {
    /// The matrix.
    pub matrix: Symmetric<'a>,
    /// What is asked.
    pub goal: Goal,
}

/// The vectors of a solution, whose memory is kept from one to the next.
#[derive(Default)]
pub struct Conjugate {
    residual: Vec<f64>,
    direction: Vec<f64>,
    image: Vec<f64>,
    corrected: Vec<f64>,
}

impl Conjugate {
    /// Overwrite `x`, which holds b, with a solution of `A x = b`, found by conjugate gradients \[HS52\] that are preconditioned by the
    /// last matrix that `near` has factorised. Sums are formed in one order whatever the threads.
    ///
    /// False, and `x` without meaning, where a factorisation of A is the better way: where A is found not to be positive definite, or the
    /// residuals fall more slowly than it takes to be there after a few steps.
    ///
    /// # Errors
    ///
    /// [`crate::Error::Cancelled`].
    ///
    /// # Panics
    ///
    /// If `x` or the preconditioner has not as many entries as A has rows.
    pub fn solve<T: Number>(
        &mut self,
        Problem { matrix, goal }: Problem<'_>,
        near: &mut Cholesky<T>,
        x: &mut [f64],
        control: &Control,
    ) -> Result<bool> {
        let Conjugate { residual, direction, image, corrected } = self;
        for vector in [&mut *residual, &mut *direction] {
            vector.clear();
            vector.extend_from_slice(x);
        }
        image.resize(x.len(), 0.0);
        corrected.resize(x.len(), 0.0);
        x.fill(0.0);
        let first = goal.excess(residual);
        if first <= 1.0 {
            return Ok(true);
        }
        near.solve(direction);
        let mut product = dot(residual, direction);
        for iteration in 1..=ITERATIONS {
            control.check()?;
            matrix.product(direction, image);
            let curvature = dot(direction, image);
            // The comparisons are false where something is no number.
            if !(curvature > 0.0 && product > 0.0) {
                return Ok(false);
            }
            let length = product / curvature;
            for (i, x) in x.iter_mut().enumerate() {
                *x += length * direction[i];
                residual[i] -= length * image[i];
            }
            let now = goal.excess(residual);
            if now <= 1.0 {
                return Ok(true);
            }
            let in_time = first.powf(1.0 - f64::from(iteration) / f64::from(ITERATIONS));
            if !(iteration <= goal.free_iterations() || now <= in_time) {
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
        let mut solved = |values: &[f64], left: f64| {
            let mut x = b.clone();
            let (matrix, goal) = (Symmetric { pattern: &pattern, values }, Goal { left, sum: left });
            let problem = Problem { matrix, goal };
            let found = Conjugate::default().solve(problem, &mut near, &mut x, &Control::new()).unwrap();
            let mut residual = b.clone();
            matrix.residual(&x, &b, &mut residual);
            (found, goal.excess(&residual))
        };
        for (bend, goal) in [(0.0, 1e-11), (1e-3, 1e-6)] {
            let (found, left) = solved(&chain(n, bend).1, goal);
            assert!(found && left <= 2.0, "{bend}: {left:e}");
        }
        // Too slow.
        assert!(!solved(&chain(n, 0.1).1, 1e-13).0 && !solved(&chain(n, 0.9).1, 1e-6).0);
        let negative: Vec<f64> = values.iter().map(|x| -x).collect();
        assert!(!solved(&negative, 1e-6).0);
        let (matrix, goal) =
            (Symmetric { pattern: &pattern, values: &values }, Goal { left: 1e-11, sum: 1e-11 });
        let cancelled = Control::new();
        cancelled.cancel();
        let problem = Problem { matrix, goal };
        assert!(Conjugate::default().solve(problem, &mut near, &mut b.clone(), &cancelled).is_err());
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
            let problem = Problem { matrix, goal: Goal { left: 1e-12, sum: 1e-12 } };
            let factored = near.factor(matrix);
            assert_eq!(factored.is_ok(), found.is_some(), "{scale:e}");
            if let Some(found) = found {
                let mut conjugate = Conjugate::default();
                assert_eq!(conjugate.solve(problem, &mut near, &mut x, &Control::new()).unwrap(), found);
            }
        }
    }
}
