//! The matrices of balances: factorisations of those with symmetric weights, and products with the others.

use crate::error::{Error, Result};
use crate::linalg::{Cholesky, Pattern, Symmetric};
use crate::parallel;

/// The method by which Newton steps to the balance are found.
pub(super) enum BalanceSolver {
    /// By products with the matrix; the factors of the one with symmetric weights at the first step stand in for its inverse. At 160,000
    /// vertices a step took 3 to 11 s in place of 16 s by factors of the matrix itself.
    Products(Option<Box<SymmetricFactors>>),
    /// By factors of the matrix.
    Factors,
}

/// The factorisation of a matrix with symmetric weights, times −1.
pub(super) struct SymmetricFactors {
    pattern: Pattern,
    cholesky: Cholesky,
}

impl SymmetricFactors {
    /// For n unknowns and entries in these places.
    ///
    /// # Errors
    /// Those of [`Pattern::new`] and [`Cholesky::analyse`].
    pub fn new(n: usize, entries: &[(u32, u32, f64)]) -> Result<SymmetricFactors> {
        let pairs: Vec<_> = entries.iter().map(|e| (e.0, e.1)).collect();
        let pattern = Pattern::new(n, &pairs)?;
        let cholesky = Cholesky::analyse(&pattern)?;
        Ok(SymmetricFactors { pattern, cholesky })
    }

    /// Factorises the matrix with these entries: (row, column, value), those at the same place adding up.
    ///
    /// # Errors
    /// [`Error::Factorisation`] where it is not negative definite.
    pub fn factor(&mut self, entries: &[(u32, u32, f64)]) -> Result<()> {
        let mut values = vec![0.0; self.pattern.entries()];
        for &(i, j, value) in entries.iter().filter(|(i, j, _)| i >= j) {
            if let Some(k) = self.pattern.position(i as usize, j as usize) {
                values[k] -= value;
            }
        }
        let failed = |_| Error::Factorisation {
            size: self.pattern.size(),
            message: "not positive definite: an edge holds nothing".into(),
        };
        self.cholesky.factor(Symmetric { pattern: &self.pattern, values: &values }).map_err(failed)
    }

    /// Overwrites `x` with the solution for it, of the matrix that was factorised last.
    pub fn solve(&mut self, x: &mut [f64]) {
        self.cholesky.solve(x);
    }
}

/// A square matrix by rows.
pub(super) struct SparseRows {
    start: Vec<u32>,
    entries: Vec<(u32, f64)>,
}

impl SparseRows {
    /// Of n rows, from entries (row, column, value).
    pub fn new(n: usize, entries: Vec<(u32, u32, f64)>) -> SparseRows {
        let mut start = vec![0u32; n + 1];
        entries.iter().for_each(|e| start[e.0 as usize + 1] += 1);
        (0..n).for_each(|i| start[i + 1] += start[i]);
        let (mut next, mut sorted) = (start.clone(), vec![(0, 0.0); entries.len()]);
        for (i, j, value) in entries {
            sorted[next[i as usize] as usize] = (j, value);
            next[i as usize] += 1;
        }
        SparseRows { start, entries: sorted }
    }

    /// Sets y to the product with x.
    pub fn apply(&self, x: &[f64], y: &mut [f64]) {
        parallel::fill(y, |i| {
            let row = self.start[i] as usize..self.start[i + 1] as usize;
            self.entries[row].iter().map(|&(j, value)| value * x[j as usize]).sum()
        });
    }
}
