//! Supernodal Cholesky (faer) with analysis, factorisation and solution as separate steps; the example is in [`crate::linalg`].

use super::pattern::{Pattern, Symmetric};
use super::substitution;
use crate::error::{Error, Result};
use faer::dyn_stack::{MemBuffer, MemStack, StackReq};
use faer::linalg::cholesky::llt::factor::LltRegularization;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par, Side, Spec};

/// How faer divides the dense work inside a supernode: one fixed number, whatever the pool's size, so that the
/// rounding (and so every result of the library) does not depend on the number of threads. Two were slower anyway (134k
/// vertices, 8 factorisations: 1.33 to 1.50 s against 1.02 to 1.06 s).
const PARTITION: Par = Par::Seq;

/// The Cholesky factorisation `A = P L Lᵀ Pᵀ` of matrices with one pattern.
pub struct Cholesky {
    symbolic: SymbolicCholesky<u32>,
    factor: Vec<f64>,
    scratch: MemBuffer,
    /// A right-hand side in the order of elimination, and as much again.
    ordered: [Vec<f64>; 2],
}

/// The matrix is not positive definite to working precision.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NotPositiveDefinite;

impl Cholesky {
    /// Analyse a pattern: fill-reducing order (AMD \[ADD96\]), elimination tree, supernodes; memory for the factor.
    ///
    /// # Errors
    ///
    /// [`Error::Factorisation`] where the analysis fails or memory for the factor is lacking.
    pub fn analyse(pattern: &Pattern) -> Result<Cholesky> {
        Cholesky::with_order(pattern, SymmetricOrdering::Amd)
    }

    /// Analyse another pattern of the same size with the order found for this one. The order is most of the work of an analysis, and
    /// stays good where few entries differ. The factor of this pattern is released first. A pattern of another size is analysed from
    /// scratch.
    ///
    /// # Errors
    ///
    /// As [`Cholesky::analyse`].
    pub fn analyse_again(self, pattern: &Pattern) -> Result<Cholesky> {
        let Cholesky { symbolic, factor, scratch, .. } = self;
        drop((factor, scratch));
        match symbolic.perm() {
            Some(order) if order.len() == pattern.size() => {
                Cholesky::with_order(pattern, SymmetricOrdering::Custom(order))
            }
            _ => Cholesky::analyse(pattern),
        }
    }

    fn with_order(pattern: &Pattern, order: SymmetricOrdering<'_, u32>) -> Result<Cholesky> {
        let size = pattern.size();
        let failed = |message: String| Error::Factorisation { size, message };
        let symbolic = factorize_symbolic_cholesky(
            structure(pattern),
            Side::Lower,
            order,
            CholeskySymbolicParams {
                supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SUPERNODAL,
                ..CholeskySymbolicParams::default()
            },
        )
        .map_err(|e| failed(format!("analysis: {e}")))?;
        let need = StackReq::any_of(&[
            symbolic.factorize_numeric_llt_scratch::<f64>(PARTITION, Spec::default()),
            symbolic.solve_in_place_scratch::<f64>(1, PARTITION),
        ]);
        let memory = |_| failed("not enough memory for the factor".into());
        let scratch = MemBuffer::try_new(need).map_err(memory)?;
        let mut factor = Vec::new();
        factor
            .try_reserve_exact(symbolic.len_val())
            .map_err(|_| failed("not enough memory for the factor".into()))?;
        factor.resize(symbolic.len_val(), 0.0);
        Ok(Cholesky { symbolic, factor, scratch, ordered: [vec![0.0; size], vec![0.0; size]] })
    }

    /// Number of values in the factor.
    pub fn factor_entries(&self) -> usize {
        self.symbolic.len_val()
    }

    /// Factorise a matrix with the analysed pattern.
    ///
    /// # Errors
    ///
    /// [`NotPositiveDefinite`], after which there is no factor to solve with.
    pub fn factor(&mut self, matrix: Symmetric<'_>) -> std::result::Result<(), NotPositiveDefinite> {
        let a = SparseColMatRef::new(structure(matrix.pattern), matrix.values);
        self.symbolic
            .factorize_numeric_llt(
                &mut self.factor,
                a,
                Side::Lower,
                LltRegularization::default(),
                PARTITION,
                MemStack::new(&mut self.scratch),
                Spec::default(),
            )
            .map(|_| ())
            .map_err(|_| NotPositiveDefinite)
    }

    /// Overwrite `x` with `A⁻¹ x`, A being the matrix factorised last.
    ///
    /// # Panics
    ///
    /// If `x` does not have n entries.
    pub fn solve(&mut self, x: &mut [f64]) {
        let Cholesky { symbolic, factor, scratch, ordered: [y, below] } = self;
        let (n, order) = (symbolic.nrows(), symbolic.perm());
        assert_eq!(x.len(), n, "one entry per row");
        match (symbolic.raw(), order) {
            (SymbolicCholeskyRaw::Supernodal(supernodes), Some(order)) => {
                let (forward, _) = order.arrays();
                y.iter_mut().zip(forward).for_each(|(y, &i)| *y = x[i as usize]);
                substitution::solve(supernodes, factor, y, below);
                forward.iter().zip(&*y).for_each(|(&i, y)| x[i as usize] = *y);
            }
            _ => LltRef::new(symbolic, factor).solve_in_place_with_conj(
                Conj::No,
                MatMut::from_column_major_slice_mut(x, n, 1),
                PARTITION,
                MemStack::new(scratch),
            ),
        }
    }

    /// Overwrite the columns of `x`, one after the other, with `A⁻¹` times them, A being the matrix factorised last. Several threads may
    /// do so at the same time; each needs memory for its columns.
    ///
    /// # Errors
    ///
    /// [`Error::Factorisation`] where that memory is lacking.
    ///
    /// # Panics
    ///
    /// If `x` is no whole number of columns of n entries.
    pub fn solve_columns(&self, x: &mut [f64]) -> Result<()> {
        let n = self.symbolic.nrows();
        let columns = x.len() / n.max(1);
        assert_eq!(x.len(), n * columns, "columns have {n} entries each");
        let need = self.symbolic.solve_in_place_scratch::<f64>(columns, PARTITION);
        let mut scratch = MemBuffer::try_new(need).map_err(|_| Error::Factorisation {
            size: n,
            message: "not enough memory to solve with the factor".into(),
        })?;
        LltRef::new(&self.symbolic, &self.factor).solve_in_place_with_conj(
            Conj::No,
            MatMut::from_column_major_slice_mut(x, n, columns),
            PARTITION,
            MemStack::new(&mut scratch),
        );
        Ok(())
    }
}

fn structure(pattern: &Pattern) -> SymbolicSparseColMatRef<'_, u32> {
    let n = pattern.size();
    SymbolicSparseColMatRef::new_checked(n, n, &pattern.column_start, None, &pattern.row)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Five-point Laplacian plus the identity on a k×k grid.
    fn grid(k: usize) -> (Pattern, Vec<f64>) {
        let id = |x: usize, y: usize| (y * k + x) as u32;
        let mut pairs = Vec::new();
        for y in 0..k {
            for x in 0..k {
                if x + 1 < k {
                    pairs.push((id(x, y), id(x + 1, y)));
                }
                if y + 1 < k {
                    pairs.push((id(x, y), id(x, y + 1)));
                }
            }
        }
        let pattern = Pattern::new(k * k, &pairs).unwrap();
        let mut values = vec![0.0; pattern.entries()];
        (0..k * k).for_each(|j| values[pattern.diagonal(j)] = 1.0);
        for (i, j) in pairs {
            values[pattern.position(i as usize, j as usize).unwrap()] = -1.0;
            values[pattern.diagonal(i as usize)] += 1.0;
            values[pattern.diagonal(j as usize)] += 1.0;
        }
        (pattern, values)
    }

    #[test]
    fn solution_leaves_no_residual() {
        for k in [1, 7, 40] {
            let (pattern, values) = grid(k);
            let matrix = Symmetric { pattern: &pattern, values: &values };
            let b: Vec<f64> = (0..k * k).map(|i| (i as f64).sin()).collect();
            let mut cholesky = Cholesky::analyse(&pattern).unwrap();
            cholesky.factor(matrix).unwrap();
            let (mut x, mut r) = (b.clone(), b.clone());
            cholesky.solve(&mut x);
            matrix.residual(&x, &b, &mut r);
            assert!(r.iter().all(|r| r.abs() < 1e-13));
            let mut columns = [b.clone(), b.iter().map(|x| 2.0 * x).collect()].concat();
            cholesky.solve_columns(&mut columns).unwrap();
            let [once, twice] = [0, 1].map(|c| &columns[c * k * k..(c + 1) * k * k]);
            assert!((0..k * k).all(|i| (once[i] - x[i]).abs() < 1e-13 && twice[i] == 2.0 * once[i]));
        }
    }

    #[test]
    fn an_indefinite_matrix_is_refused() {
        let (pattern, mut values) = grid(9);
        values[pattern.diagonal(40)] = -1.0;
        let mut cholesky = Cholesky::analyse(&pattern).unwrap();
        assert_eq!(
            cholesky.factor(Symmetric { pattern: &pattern, values: &values }),
            Err(NotPositiveDefinite)
        );
    }

    #[test]
    fn a_pattern_keeps_each_entry_once() {
        let pattern = Pattern::new(3, &[(0, 1), (1, 0), (2, 2), (1, 2)]).unwrap();
        assert_eq!(pattern.entries(), 5);
        assert_eq!(pattern.position(0, 1), pattern.position(1, 0));
        assert_eq!(pattern.position(0, 2), None);
        assert_eq!(pattern.position(2, 2), Some(pattern.diagonal(2)));
    }
}
