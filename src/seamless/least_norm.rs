//! The least change of lengths that meets linear equations for angles.

use super::holonomy_state::DerivativeRows;
use crate::control::Control;
use crate::error::{Error, Result};
use crate::linalg::{Cholesky, Pattern, Symmetric};
use sprs::{CsMat, TriMat};

/// Shifts of the normal equations, relative to their mean diagonal, of which the first is taken with which they have a factor, if they have
/// none without: on translation surfaces two of the equations depend on the others, and on cylinders between features one does.
const SHIFTS: [f64; 3] = [1e-13, 1e-11, 1e-9];
/// Times that the solution is improved by its residual: the normal equations have the squared condition number of the rows.
const REFINEMENTS: usize = 2;

/// The solution d of `J d = right` of least norm, `d = Jᵀ (J Jᵀ)⁻¹ right`; one entry for each of the `columns`.
///
/// # Errors
/// [`Error::Factorisation`] where the rows depend on each other by more than rounding and a small shift mend; [`Error::Cancelled`].
pub(super) fn least_norm_solution(
    rows: &DerivativeRows,
    columns: usize,
    right: &[f64],
    control: &Control,
) -> Result<Vec<f64>> {
    let n = rows.len();
    let mut entries = TriMat::new((n, columns));
    for (i, row) in rows.iter().enumerate() {
        row.iter().for_each(|&(e, x)| entries.add_triplet(i, e as usize, x));
    }
    let jacobian: CsMat<f64> = entries.to_csr();
    let normal = &jacobian * &jacobian.transpose_view();
    let lower = || normal.iter().filter(|(_, (i, j))| i >= j).map(|(x, (i, j))| (i, j, *x));
    let pattern = Pattern::new(n, &lower().map(|(i, j, _)| (i as u32, j as u32)).collect::<Vec<_>>())?;
    let mut values = vec![0.0; pattern.entries()];
    for (i, j, x) in lower() {
        if let Some(at) = pattern.position(i, j) {
            values[at] += x;
        }
    }
    control.check()?;
    let mut cholesky = Cholesky::analyse(&pattern)?;
    control.check()?;
    let mean = (0..n).map(|i| values[pattern.diagonal(i)]).sum::<f64>() / n.max(1) as f64;
    let mut has_factor_with = |shift: f64| {
        let mut shifted = values.clone();
        (0..n).for_each(|i| shifted[pattern.diagonal(i)] += shift * mean);
        cholesky.factor(Symmetric { pattern: &pattern, values: &shifted }).is_ok()
    };
    if ![0.0].iter().chain(&SHIFTS).any(|&shift| has_factor_with(shift)) {
        return Err(Error::Factorisation {
            size: n,
            message: "equations for angles around vertices and handles depend on each other".into(),
        });
    }
    control.check()?;
    let matrix = Symmetric { pattern: &pattern, values: &values };
    let mut multipliers = right.to_vec();
    cholesky.solve(&mut multipliers);
    let mut residual = vec![0.0; n];
    for _ in 0..REFINEMENTS {
        control.check()?;
        matrix.residual(&multipliers, right, &mut residual);
        cholesky.solve(&mut residual);
        multipliers.iter_mut().zip(&residual).for_each(|(x, r)| *x += r);
    }
    let mut solution = vec![0.0; columns];
    for (row, multiplier) in rows.iter().zip(&multipliers) {
        row.iter().for_each(|&(e, x)| solution[e as usize] += x * multiplier);
    }
    Ok(solution)
}
