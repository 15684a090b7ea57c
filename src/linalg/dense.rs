//! Small dense matrices, given as rows.
//!
//! ```
//! use ricci::linalg::dense::{solve_definite, symmetric_eigenvalues};
//! let a = [vec![2.0, 1.0], vec![1.0, 2.0]];
//! assert!((symmetric_eigenvalues(&a)?[0] - 1.0).abs() < 1e-15);
//! let x = solve_definite(&a, &[vec![3.0], vec![3.0]])?;
//! assert!((x[0][0] - 1.0).abs() < 1e-15);
//! # Ok::<(), ricci::Error>(())
//! ```

use crate::error::{Error, Result};
use faer::linalg::solvers::Solve;
use faer::{Mat, Side};

/// `a⁻¹ b` for a symmetric positive definite matrix (n×n), whose lower triangle is read, and n rows `b`.
///
/// # Errors
/// [`Error::Factorisation`] for a matrix that is not positive definite to working precision.
///
/// # Panics
/// If rows have different lengths.
pub fn solve_definite(a: &[Vec<f64>], b: &[Vec<f64>]) -> Result<Vec<Vec<f64>>> {
    let message = "the dense matrix is not positive definite".to_string();
    let factor = matrix(a).llt(Side::Lower).map_err(|_| Error::Factorisation { size: a.len(), message })?;
    let x = factor.solve(matrix(b));
    Ok((0..x.nrows()).map(|i| (0..x.ncols()).map(|j| x[(i, j)]).collect()).collect())
}

/// The lower triangle L with `L Lᵀ = a` for a symmetric positive definite matrix (n×n), whose lower triangle is read.
///
/// # Errors
/// As [`solve_definite`].
///
/// # Panics
/// If rows have different lengths.
pub fn cholesky(a: &[Vec<f64>]) -> Result<Vec<Vec<f64>>> {
    let message = "the dense matrix is not positive definite".to_string();
    let factor = matrix(a).llt(Side::Lower).map_err(|_| Error::Factorisation { size: a.len(), message })?;
    let lower = factor.L();
    let entry = |i: usize, j: usize| if j <= i { lower[(i, j)] } else { 0.0 };
    Ok((0..a.len()).map(|i| (0..a.len()).map(|j| entry(i, j)).collect()).collect())
}

/// The eigenvalues of a symmetric matrix (n×n), whose lower triangle is read, ascending.
///
/// # Errors
/// [`Error::Factorisation`] where the iteration does not converge, as for entries that are not finite.
///
/// # Panics
/// If rows have different lengths.
pub fn symmetric_eigenvalues(a: &[Vec<f64>]) -> Result<Vec<f64>> {
    let message = "the eigenvalues of the dense matrix were not found".to_string();
    matrix(a)
        .self_adjoint_eigenvalues(Side::Lower)
        .map_err(|_| Error::Factorisation { size: a.len(), message })
}

/// The eigenvectors of a symmetric matrix (n×n), whose lower triangle is read, orthonormal, by ascending eigenvalue.
///
/// # Errors
/// As [`symmetric_eigenvalues`].
///
/// # Panics
/// If rows have different lengths.
pub fn symmetric_eigenvectors(a: &[Vec<f64>]) -> Result<Vec<Vec<f64>>> {
    symmetric_eigenpairs(a).map(|pairs| pairs.into_iter().map(|(_, vector)| vector).collect())
}

/// The eigenvalues of a symmetric matrix (n×n), whose lower triangle is read, ascending, each with its eigenvector; these are orthonormal.
///
/// # Errors
/// As [`symmetric_eigenvalues`].
///
/// # Panics
/// If rows have different lengths.
pub fn symmetric_eigenpairs(a: &[Vec<f64>]) -> Result<Vec<(f64, Vec<f64>)>> {
    let message = "the eigenvectors of the dense matrix were not found".to_string();
    let eigen = matrix(a)
        .self_adjoint_eigen(Side::Lower)
        .map_err(|_| Error::Factorisation { size: a.len(), message })?;
    let (vectors, values) = (eigen.U(), eigen.S().column_vector());
    let pair = |j| (values[j], (0..vectors.nrows()).map(|i| vectors[(i, j)]).collect());
    Ok((0..vectors.ncols()).map(pair).collect())
}

/// Partial sums of a scalar product, which do not wait for each other.
const LANES: usize = 8;

/// The scalar product of two rows of the same length, by partial sums in a fixed order.
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; LANES];
    let (a, b) = (a.chunks_exact(LANES), b.chunks_exact(LANES));
    let rest: f64 = a.remainder().iter().zip(b.remainder()).map(|(a, b)| a * b).sum();
    for (a, b) in a.zip(b) {
        sums.iter_mut().zip(a.iter().zip(b)).for_each(|(sum, (a, b))| *sum += a * b);
    }
    sums.iter().sum::<f64>() + rest
}

fn matrix(rows: &[Vec<f64>]) -> Mat<f64> {
    Mat::from_fn(rows.len(), rows.first().map_or(0, Vec::len), |i, j| rows[i][j])
}
