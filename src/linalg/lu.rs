//! Sparse square systems without symmetry, by faer's LU factorisation.
//!
//! ```
//! // [[2, 1], [0, 4]] x = [4, 8]
//! let mut x = [4.0, 8.0];
//! ricci::linalg::lu::solve(&[(0, 0, 2.0), (0, 1, 1.0), (1, 1, 4.0)], &mut x)?;
//! assert_eq!(x, [1.0, 2.0]);
//! # Ok::<(), ricci::Error>(())
//! ```

use crate::error::{Error, Result};
use faer::dyn_stack::{MemBuffer, MemStack, StackReq};
use faer::sparse::linalg::lu::{LuSymbolicParams, NumericLu, factorize_symbolic_lu};
use faer::sparse::{SparseColMat, Triplet};
use faer::{Conj, MatMut, Par, Spec};

/// Kernels of faer run on one thread, so that the rounding does not depend on the number of threads.
const PARTITION: Par = Par::Seq;

/// Overwrites `x`, n numbers, with `A⁻¹ x`. `entries`: (row, column, value) of the n×n matrix A; values at the same place add up.
///
/// # Errors
/// [`Error::Factorisation`] where A has no inverse to working precision, an entry lies outside it, or memory is lacking.
pub fn solve(entries: &[(u32, u32, f64)], x: &mut [f64]) -> Result<()> {
    let size = x.len();
    let failed = |message: String| Error::Factorisation { size, message };
    if size == 0 {
        return Ok(());
    }
    let triplets: Vec<Triplet<u32, u32, f64>> =
        entries.iter().map(|&(i, j, value)| Triplet::new(i, j, value)).collect();
    let matrix = SparseColMat::<u32, f64>::try_new_from_triplets(size, size, &triplets)
        .map_err(|e| failed(format!("assembly: {e:?}")))?;
    drop(triplets);
    let symbolic = factorize_symbolic_lu(matrix.symbolic(), LuSymbolicParams::default())
        .map_err(|e| failed(format!("analysis: {e:?}")))?;
    let need = StackReq::any_of(&[
        symbolic.factorize_numeric_lu_scratch::<f64>(PARTITION, Spec::default()),
        symbolic.solve_in_place_scratch::<f64>(1, PARTITION),
    ]);
    let mut scratch =
        MemBuffer::try_new(need).map_err(|_| failed("not enough memory for the factors".into()))?;
    let mut numeric = NumericLu::new();
    let factors = symbolic
        .factorize_numeric_lu(
            &mut numeric,
            matrix.as_ref(),
            PARTITION,
            MemStack::new(&mut scratch),
            Spec::default(),
        )
        .map_err(|e| failed(format!("{e:?}")))?;
    let column = MatMut::from_column_major_slice_mut(x, size, 1);
    factors.solve_in_place_with_conj(Conj::No, column, PARTITION, MemStack::new(&mut scratch));
    if x.iter().all(|x| x.is_finite()) {
        Ok(())
    } else {
        Err(failed("the matrix is singular to working precision".into()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn solution_leaves_no_residual() {
        let n = 400;
        let mut entries = Vec::new();
        for i in 0..n {
            entries.push((i, i, 4.0 + f64::from(i).sin()));
            entries.push((i, (i * 7 + 3) % n, 1.0));
            entries.push((i, (i * 11 + 5) % n, -0.5));
        }
        let b: Vec<f64> = (0..n).map(|i| f64::from(i).cos()).collect();
        let mut x = b.clone();
        solve(&entries, &mut x).unwrap();
        let mut rest = b;
        entries.iter().for_each(|&(i, j, a)| rest[i as usize] -= a * x[j as usize]);
        assert!(rest.iter().all(|r| r.abs() < 1e-12));
    }

    #[test]
    fn a_matrix_without_an_inverse_is_refused() {
        let entries = [(0, 0, 1.0), (0, 1, 2.0), (1, 0, 2.0), (1, 1, 4.0)];
        assert!(matches!(solve(&entries, &mut [1.0, 1.0]), Err(Error::Factorisation { size: 2, .. })));
    }
}
