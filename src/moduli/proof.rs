//! From energies to a period matrix, and the proof of its bound.
//!
//! Every symmetric X + iY with Y > 0 is a period matrix of a symplectic `Ĝ = (Y + X Y⁻¹ X, −X Y⁻¹; −Y⁻¹ X, Y⁻¹)`. Where `M ⪯ d Ĝ` for a
//! matrix M above the true energies G, which are symplectic as well, inversion gives `Ĝ/d ⪯ G ⪯ d Ĝ`. That `d Ĝ − M` is positive definite
//! is proven by a Cholesky factorisation in enclosures all of whose pivots are certainly greater than 0.

use super::gap::{inverse, product, transposed, wedge_in};
use crate::error::{Error, Result};
use crate::geometry::Enclosure;
use crate::geometry::complex::Complex;
use crate::linalg::dense::{cholesky, solve_definite, symmetric_eigenvalues, symmetric_eigenvectors};

/// Relative amount by which the eigenvalue that f64 finds is raised first, and number of times that the amount is made four times larger.
const FIRST_RAISE: f64 = 1e-15;
const RAISES: i32 = 40;

/// The period matrix of the geometric mean of energies (in the order a1, b1, a2, b2, …) and their lower bound.
///
/// # Errors
/// [`Error::Factorisation`] for energies that are not positive definite in f64.
pub(super) fn mean_period_matrix(energies: &[Vec<Enclosure>]) -> Result<Vec<Vec<Complex>>> {
    let upper: Vec<Vec<f64>> = energies.iter().map(|row| row.iter().map(|x| x.nearest()).collect()).collect();
    let lower = cholesky(&upper)?;
    let wedge = wedge_in(&inverse(&lower));
    // G # Sᵀ G⁻¹ S = L (Kᵀ K)^½ Lᵀ.
    let square = product(&transposed(&wedge), &wedge);
    let vectors = symmetric_eigenvectors(&square)?;
    let roots: Vec<f64> = symmetric_eigenvalues(&square)?.iter().map(|x| x.max(0.0).sqrt()).collect();
    let scaled: Vec<Vec<f64>> =
        vectors.iter().zip(&roots).map(|(v, r)| v.iter().map(|x| x * r).collect()).collect();
    let root = product(&transposed(&vectors), &scaled);
    let mean = product(&product(&lower, &root), &transposed(&lower));
    let g = mean.len() / 2;
    let block = |i: usize, j: usize| -> Vec<Vec<f64>> {
        (0..g).map(|k| (0..g).map(|l| mean[2 * k + i][2 * l + j]).collect()).collect()
    };
    let identity: Vec<Vec<f64>> =
        (0..g).map(|i| (0..g).map(|j| f64::from(u8::from(i == j))).collect()).collect();
    let imaginary = solve_definite(&block(1, 1), &identity)?;
    let real = product(&block(0, 1), &imaginary);
    let entry =
        |i: usize, j: usize| [-0.5 * (real[i][j] + real[j][i]), 0.5 * (imaginary[i][j] + imaginary[j][i])];
    Ok((0..g).map(|i| (0..g).map(|j| entry(i, j)).collect()).collect())
}

/// A proven d − 1 with `Ĝ/d ⪯ G ⪯ d Ĝ` for the true energies G, those of the symmetric `periods`, and `upper` above G.
///
/// # Errors
/// [`Error::Factorisation`] where no d is proven.
pub(super) fn proven_gap(periods: &[Vec<Complex>], upper: &[Vec<Enclosure>]) -> Result<f64> {
    let unproven = |message: String| Error::Factorisation { size: upper.len(), message };
    let mean = symplectic(periods)
        .ok_or_else(|| unproven("the imaginary part of a period matrix is indefinite".into()))?;
    let nearest = |m: &[Vec<Enclosure>]| -> Vec<Vec<f64>> {
        m.iter().map(|row| row.iter().map(|x| x.nearest()).collect()).collect()
    };
    let frame = inverse(&cholesky(&nearest(&mean))?);
    let seen = product(&product(&frame, &nearest(upper)), &transposed(&frame));
    let largest = symmetric_eigenvalues(&seen)?.last().copied().unwrap_or(f64::NAN);
    for k in 0..RAISES {
        let gap = (largest - 1.0).max(0.0) + FIRST_RAISE * 4f64.powi(k);
        let d = Enclosure::from(1.0) + gap.into();
        let entry = |i: usize, j: usize| d * mean[i][j] - upper[i][j];
        let n = upper.len();
        let difference: Vec<Vec<Enclosure>> = (0..n).map(|i| (0..n).map(|j| entry(i, j)).collect()).collect();
        if factor(&difference).is_some() {
            return Ok(gap);
        }
    }
    Err(unproven(format!("no bound of the period matrix is proven near d = {largest:e}")))
}

/// The symplectic energies of a symmetric period matrix, in the order a1, b1, …; `None` where Y is not certainly positive definite.
pub(super) fn symplectic(periods: &[Vec<Complex>]) -> Option<Vec<Vec<Enclosure>>> {
    let g = periods.len();
    let part = |k: usize| -> Vec<Vec<Enclosure>> {
        periods.iter().map(|row| row.iter().map(|z| z[k].into()).collect()).collect()
    };
    let [x, y] = [part(0), part(1)];
    let lower = factor(&y)?;
    // The columns of L⁻¹, and Y⁻¹ = L⁻ᵀ L⁻¹.
    let mut inverse = vec![vec![Enclosure::from(0.0); g]; g];
    for i in 0..g {
        for j in 0..=i {
            let start = Enclosure::from(f64::from(u8::from(i == j)));
            let sum = (j..i).fold(start, |sum, k| sum - lower[i][k] * inverse[k][j]);
            inverse[i][j] = sum / lower[i][i];
        }
    }
    let sum = |terms: &dyn Fn(usize) -> Enclosure| (0..g).fold(Enclosure::from(0.0), |sum, k| sum + terms(k));
    let square = |a: &dyn Fn(usize) -> Vec<Enclosure>| -> Vec<Vec<Enclosure>> {
        let columns: Vec<Vec<Enclosure>> = (0..g).map(a).collect();
        (0..g).map(|i| (0..g).map(|j| sum(&|k| columns[i][k] * columns[j][k])).collect()).collect()
    };
    let of_y = square(&|j| (0..g).map(|k| inverse[k][j]).collect());
    let times = |a: &[Vec<Enclosure>], b: &[Vec<Enclosure>], i: usize, j: usize| sum(&|k| a[i][k] * b[k][j]);
    let slope: Vec<Vec<Enclosure>> =
        (0..g).map(|i| (0..g).map(|j| times(&x, &of_y, i, j)).collect()).collect();
    let entry = |i: usize, j: usize| match (i % 2, j % 2) {
        (0, 0) => y[i / 2][j / 2] + times(&slope, &x, i / 2, j / 2),
        (0, _) => -slope[i / 2][j / 2],
        (_, 0) => -slope[j / 2][i / 2],
        _ => of_y[i / 2][j / 2],
    };
    Some((0..2 * g).map(|i| (0..2 * g).map(|j| entry(i, j)).collect()).collect())
}

/// The lower triangle L with `L Lᵀ` = a symmetric matrix in enclosures; `None` unless it is certainly positive definite.
fn factor(a: &[Vec<Enclosure>]) -> Option<Vec<Vec<Enclosure>>> {
    let n = a.len();
    let mut lower = vec![vec![Enclosure::from(0.0); n]; n];
    for i in 0..n {
        for j in 0..=i {
            let sum = (0..j).fold(a[i][j], |sum, k| sum - lower[i][k] * lower[j][k]);
            if i == j {
                lower[i][i] = Some(sum.sqrt()).filter(|root| sum.is_positive() && root.is_positive())?;
            } else {
                lower[i][j] = sum / lower[j][j];
            }
        }
    }
    Some(lower)
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    /// Energies that are 1 + x times those of a period matrix have this matrix as their mean, and the gap x.
    #[test]
    fn energies_of_a_period_matrix_lead_back_to_it() {
        let periods = vec![vec![[0.3, 1.5], [-0.2, 0.4]], vec![[-0.2, 0.4], [0.1, 0.9]]];
        let mean = symplectic(&periods).unwrap();
        for x in [0.0, 1e-9, 1e-3, 0.5] {
            let raised: Vec<Vec<Enclosure>> =
                mean.iter().map(|row| row.iter().map(|&e| e * (1.0 + x).into()).collect()).collect();
            let found = mean_period_matrix(&raised).unwrap();
            for (row, expected) in found.iter().zip(&periods) {
                for (z, w) in row.iter().zip(expected) {
                    assert!((z[0] - w[0]).hypot(z[1] - w[1]) < 1e-14, "{x}: {z:?} {w:?}");
                }
            }
            let gap = proven_gap(&periods, &raised).unwrap();
            assert!(gap >= x && gap < x + 1e-13, "{x}: {gap}");
        }
    }

    /// A matrix with an eigenvalue 0 is not proven to be positive definite, one with 1e-28 is.
    #[test]
    fn pivots_near_zero_prove_nothing() {
        let matrix = |x: f64| {
            let corner = Enclosure::from(1.0) + x.into();
            vec![vec![1.0.into(), 1.0.into()], vec![1.0.into(), corner]]
        };
        assert!(factor(&matrix(0.0)).is_none() && factor(&matrix(-1e-3)).is_none());
        assert!(factor(&matrix(1e-27)).is_some());
    }
}
