//! The least change of lengths that meets linear equations for angles.

use super::holonomy_state::{DerivativeRows, largest};
use crate::control::Control;
use crate::error::{Error, Result};
use crate::linalg::conjugate::{ConjugateGradients, LinearProblem, ResidualBound};
use crate::linalg::{Cholesky, Pattern, Symmetric};

/// Shifts of the normal equations, relative to their mean diagonal, of which the first is taken with which they have a factor, if they have
/// none without: on translation surfaces two of the equations depend on the others, and on cylinders between features one does.
const SHIFTS: [f64; 3] = [1e-13, 1e-11, 1e-9];
/// Most times that a solution is improved by its residual: the normal equations have the squared condition number of the rows.
const REFINEMENTS: usize = 2;
/// A residual of the normal equations, relative to the right side, that is not improved.
const REFINE_TO: f64 = 1e-14;
/// The largest and the smallest residual, relative to the right side, that conjugate gradients leave; between them as much as is missing,
/// radians, so that steps still converge quadratically.
const LEFT: [f64; 2] = [1e-2, 1e-10];

/// The equations that are solved one after the other on the way to a metric, with the factor of one of the last ones.
#[derive(Default)]
pub(super) struct LeastNorm {
    last: Option<NormalFactor>,
    conjugate: ConjugateGradients,
}

/// The factor of normal equations.
struct NormalFactor {
    cholesky: Cholesky,
    pattern: Pattern,
    /// True if the equations have this factor without a shift.
    is_theirs: bool,
}

impl LeastNorm {
    /// The solution d of `J d = right` of least norm, `d = Jᵀ (J Jᵀ)⁻¹ right`; one entry for each of the `columns`. Where the equations are
    /// near those of the last factor, by conjugate gradients with it, to a residual that is small beside the square of the right side.
    ///
    /// # Errors
    /// [`Error::Factorisation`] where the rows depend on each other by more than rounding and a small shift mend; [`Error::Cancelled`].
    pub fn solution(
        &mut self,
        rows: &DerivativeRows,
        columns: usize,
        right: &[f64],
        control: &Control,
    ) -> Result<Vec<f64>> {
        let (pattern, values) = normal_equations(rows, columns)?;
        control.check()?;
        let matrix = Symmetric { pattern: &pattern, values: &values };
        let mut multipliers = right.to_vec();
        if !self.solve_near(matrix, &mut multipliers, control)? {
            self.factor(matrix, control)?;
            multipliers.copy_from_slice(right);
            self.solve(matrix, &mut multipliers, control)?;
        }
        let mut solution = vec![0.0; columns];
        for (row, multiplier) in rows.iter().zip(&multipliers) {
            row.iter().for_each(|&(e, x)| solution[e as usize] += x * multiplier);
        }
        Ok(solution)
    }

    /// Overwrites the right side with a solution by conjugate gradients, if the last factor is near enough; false if not.
    fn solve_near(&mut self, matrix: Symmetric<'_>, x: &mut [f64], control: &Control) -> Result<bool> {
        let Some(last) = &mut self.last else { return Ok(false) };
        let missing = largest(x);
        if !last.is_theirs || last.pattern.size() != x.len() || missing == 0.0 {
            return Ok(false);
        }
        let bound = ResidualBound { largest: missing * missing.clamp(LEFT[1], LEFT[0]), sum: f64::INFINITY };
        self.conjugate.solve(LinearProblem { matrix, bound }, &mut last.cholesky, x, control)
    }

    /// Factorises the equations, in the order of the last ones.
    fn factor(&mut self, matrix: Symmetric<'_>, control: &Control) -> Result<()> {
        let (pattern, n) = (matrix.pattern, matrix.pattern.size());
        let mut cholesky = match self.last.take() {
            Some(last) if last.pattern == *pattern => last.cholesky,
            Some(last) => last.cholesky.analyse_again(pattern)?,
            None => Cholesky::analyse(pattern)?,
        };
        control.check()?;
        let mean = (0..n).map(|i| matrix.values[pattern.diagonal(i)]).sum::<f64>() / n.max(1) as f64;
        let mut has_factor_with = |shift: f64| {
            let mut shifted = matrix.values.to_vec();
            (0..n).for_each(|i| shifted[pattern.diagonal(i)] += shift * mean);
            cholesky.factor(Symmetric { pattern, values: &shifted }).is_ok()
        };
        let is_theirs = has_factor_with(0.0);
        if !is_theirs && !SHIFTS.into_iter().any(has_factor_with) {
            return Err(Error::Factorisation {
                size: n,
                message: "equations for angles around vertices and handles depend on each other".into(),
            });
        }
        self.last = Some(NormalFactor { cholesky, pattern: pattern.clone(), is_theirs });
        Ok(())
    }

    /// Overwrites the right side with the solution by the factor.
    fn solve(&mut self, matrix: Symmetric<'_>, x: &mut [f64], control: &Control) -> Result<()> {
        let Some(NormalFactor { cholesky, .. }) = &mut self.last else { return Ok(()) };
        let right = x.to_vec();
        cholesky.solve(x);
        let mut residual = vec![0.0; x.len()];
        for _ in 0..REFINEMENTS {
            control.check()?;
            matrix.residual(x, &right, &mut residual);
            if largest(&residual) <= REFINE_TO * largest(&right) {
                break;
            }
            cholesky.solve(&mut residual);
            x.iter_mut().zip(&residual).for_each(|(x, r)| *x += r);
        }
        Ok(())
    }
}

/// The matrix `J Jᵀ`.
fn normal_equations(rows: &DerivativeRows, columns: usize) -> Result<(Pattern, Vec<f64>)> {
    let mut start = vec![0; columns + 1];
    rows.iter().flatten().for_each(|&(e, _)| start[e as usize + 1] += 1);
    (0..columns).for_each(|e| start[e + 1] += start[e]);
    let mut by_column = vec![(0, 0.0); start[columns]];
    let mut end = start.clone();
    for (i, row) in (0u32..).zip(rows) {
        for &(e, x) in row {
            by_column[end[e as usize]] = (i, x);
            end[e as usize] += 1;
        }
    }
    let column = |e: usize| &by_column[start[e]..start[e + 1]];
    let mut pairs = Vec::new();
    for e in 0..columns {
        for (k, &(i, _)) in column(e).iter().enumerate() {
            pairs.extend(column(e)[..k].iter().map(|&(j, _)| (i, j)));
        }
    }
    let pattern = Pattern::new(rows.len(), &pairs)?;
    let mut values = vec![0.0; pattern.entries()];
    for e in 0..columns {
        for (k, &(i, x)) in column(e).iter().enumerate() {
            for &(j, y) in &column(e)[..=k] {
                if let Some(at) = pattern.position(i as usize, j as usize) {
                    values[at] += x * y;
                }
            }
        }
    }
    Ok((pattern, values))
}
