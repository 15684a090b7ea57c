//! Supernodal Cholesky (faer) with analysis, factorisation and solution as separate steps; the example is in [`crate::linalg`].

pub use super::front::NotPositiveDefinite;
use super::multifrontal::{self, FrontMemory};
use super::number::FactorNumber;
use super::order::postorder;
use super::pattern::{Pattern, Symmetric};
use super::pool::MemoryPool;
use super::substitution::{self, SubstitutionMemory};
use super::tree::{SupernodeTree, Supernodes};
use crate::error::{Error, Result};
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::perm::PermRef;
use faer::sparse::SymbolicSparseColMatRef;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
use faer::{Conj, MatMut, Par, Side};

/// Kernels of faer run on one thread: dense work is divided here, into parts that do not depend on the number of threads, so that the
/// rounding (and so every result of the library) does not depend on it either.
const PARTITION: Par = Par::Seq;

/// The Cholesky factorisation `A = P L Lᵀ Pᵀ` of matrices with one pattern. Inside a pool ([`crate::parallel`]) its threads share the
/// work. In single precision a factor is a preconditioner ([`super::conjugate`]).
pub struct Cholesky<T = f64> {
    symbolic: SymbolicCholesky<u32>,
    tree: SupernodeTree,
    factor: Vec<T>,
    front_memory: MemoryPool<FrontMemory<T>>,
    substitution_memory: MemoryPool<SubstitutionMemory<T>>,
    /// A right-hand side in the order of elimination, and memory for another one.
    ordered: [Vec<T>; 2],
}

impl Cholesky {
    /// Analyses a pattern: fill-reducing order (AMD \[ADD96\]), elimination tree, supernodes. Allocates the factor.
    ///
    /// # Errors
    ///
    /// [`Error::Factorisation`] where the analysis fails or memory for the factor is lacking.
    pub fn analyse(pattern: &Pattern) -> Result<Cholesky> {
        let symbolic = analysis(pattern, SymmetricOrdering::Amd)?;
        // The order is nearly always a postorder.
        match (tree(&symbolic, pattern), symbolic.perm()) {
            (Some(tree), _) => Cholesky::with_tree(symbolic, tree),
            (None, Some(order)) => Cholesky::with_postorder(pattern, order.arrays().0),
            (None, None) => Err(failed(pattern.size(), "analysis: no order")),
        }
    }

    /// Analyses the pattern of matrices with a block of `size` rows and columns for each entry of another pattern, and returns it too: the order
    /// is found for the blocks, which takes far less time.
    ///
    /// # Errors
    ///
    /// As [`Cholesky::analyse`] and [`Pattern::of_blocks`].
    pub fn analyse_blocks(blocks: &Pattern, size: usize) -> Result<(Pattern, Cholesky)> {
        let pattern = blocks.of_blocks(size)?;
        let symbolic = analysis(blocks, SymmetricOrdering::Amd)?;
        let order = symbolic.perm().map_or(&[][..], |order| order.arrays().0);
        let rows = |&block: &u32| (0..size as u32).map(move |c| size as u32 * block + c);
        let forward: Vec<u32> = order.iter().flat_map(rows).collect();
        let cholesky = Cholesky::with_postorder(&pattern, &forward)?;
        Ok((pattern, cholesky))
    }

    /// The analysis with the postorder of an order of elimination.
    fn with_postorder(pattern: &Pattern, forward: &[u32]) -> Result<Cholesky> {
        let forward = postorder(pattern, forward);
        let mut inverse = vec![0; forward.len()];
        (0..).zip(&forward).for_each(|(k, &i)| inverse[i as usize] = k);
        let order = PermRef::new_checked(&forward, &inverse, forward.len());
        let symbolic = analysis(pattern, SymmetricOrdering::Custom(order))?;
        match tree(&symbolic, pattern) {
            Some(tree) => Cholesky::with_tree(symbolic, tree),
            None => Err(failed(pattern.size(), "analysis: no tree of supernodes")),
        }
    }

    /// Overwrites each column of `x` with `A⁻¹` times it, A being the matrix factorised last. Several threads may do so at the same time;
    /// each allocates memory for its columns.
    ///
    /// # Errors
    ///
    /// [`Error::Factorisation`] where that memory is lacking.
    ///
    /// # Panics
    ///
    /// If the length of `x` is not a multiple of n.
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

impl<T: FactorNumber> Cholesky<T> {
    /// Analyses another pattern of the same size with the order found for this one. Finding the order is most of the work of an analysis,
    /// and it stays good where few entries differ. The factor of this pattern is released first. A pattern of another size is analysed
    /// from scratch.
    ///
    /// # Errors
    ///
    /// As [`Cholesky::analyse`].
    pub fn analyse_again(self, pattern: &Pattern) -> Result<Cholesky> {
        let symbolic = self.into_symbolic();
        match symbolic.perm() {
            Some(order) if order.len() == pattern.size() => {
                Cholesky::with_postorder(pattern, order.arrays().0)
            }
            _ => Cholesky::analyse(pattern),
        }
    }

    fn with_tree(symbolic: SymbolicCholesky<u32>, tree: SupernodeTree) -> Result<Cholesky<T>> {
        let (size, entries) = (symbolic.nrows(), symbolic.len_val());
        // The allocation is tried first, since `vec!` ends the process where memory is lacking. Nothing is written: pages belong to the
        // threads that write to them first, which are those that factorise.
        Vec::<T>::new()
            .try_reserve_exact(entries)
            .map_err(|_| failed(size, "not enough memory for the factor"))?;
        let factor = vec![T::ZERO; entries];
        let ordered = [vec![T::ZERO; size], vec![T::ZERO; size]];
        let (front_memory, substitution_memory) = Default::default();
        Ok(Cholesky { symbolic, tree, factor, front_memory, substitution_memory, ordered })
    }

    /// The same analysis for a factor in another type of number; this factor is released first.
    ///
    /// # Errors
    ///
    /// [`Error::Factorisation`] where memory for the factor is lacking.
    pub fn held_in<U: FactorNumber>(self) -> Result<Cholesky<U>> {
        let Cholesky { symbolic, tree, factor, front_memory, substitution_memory, ordered } = self;
        drop((factor, front_memory, substitution_memory, ordered));
        Cholesky::with_tree(symbolic, tree)
    }

    fn into_symbolic(self) -> SymbolicCholesky<u32> {
        self.symbolic
    }

    /// Number of values in the factor.
    pub fn factor_entries(&self) -> usize {
        self.symbolic.len_val()
    }

    /// Factorises a matrix with the analysed pattern.
    ///
    /// # Errors
    ///
    /// [`NotPositiveDefinite`]; there is then no factor to solve with.
    pub fn factor(&mut self, matrix: Symmetric<'_>) -> std::result::Result<(), NotPositiveDefinite> {
        let Cholesky { symbolic, tree, factor, front_memory, .. } = self;
        match supernodes(symbolic, tree) {
            Some(supernodes) => multifrontal::factor(supernodes, matrix.values, factor, front_memory),
            // The matrix has no rows.
            None => Ok(()),
        }
    }

    /// Overwrites `x` with `A⁻¹ x`, A being the matrix factorised last.
    ///
    /// # Panics
    ///
    /// If `x` does not have n entries.
    pub fn solve(&mut self, x: &mut [f64]) {
        let Cholesky { symbolic, tree, factor, substitution_memory, ordered: [y, solved], .. } = self;
        assert_eq!(x.len(), symbolic.nrows(), "one entry per row");
        if let (Some(supernodes), Some(order)) = (supernodes(symbolic, tree), symbolic.perm()) {
            let (forward, _) = order.arrays();
            y.iter_mut().zip(forward).for_each(|(y, &i)| *y = T::nearest(x[i as usize]));
            substitution::solve(supernodes, factor, [y, solved], substitution_memory);
            forward.iter().zip(&*y).for_each(|(&i, y)| x[i as usize] = y.to_f64());
        }
    }
}

fn failed(size: usize, message: &str) -> Error {
    Error::Factorisation { size, message: message.into() }
}

fn analysis(pattern: &Pattern, order: SymmetricOrdering<'_, u32>) -> Result<SymbolicCholesky<u32>> {
    let params = CholeskySymbolicParams {
        supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SUPERNODAL,
        ..CholeskySymbolicParams::default()
    };
    factorize_symbolic_cholesky(structure(pattern), Side::Lower, order, params)
        .map_err(|e| failed(pattern.size(), &format!("analysis: {e}")))
}

/// The tree of an analysis, if its order is a postorder.
fn tree(symbolic: &SymbolicCholesky<u32>, pattern: &Pattern) -> Option<SupernodeTree> {
    let SymbolicCholeskyRaw::Supernodal(supernodes) = symbolic.raw() else {
        return (pattern.size() == 0).then(SupernodeTree::default);
    };
    SupernodeTree::new(supernodes, pattern, symbolic.perm()?.arrays().1)
}

fn supernodes<'a>(symbolic: &'a SymbolicCholesky<u32>, tree: &'a SupernodeTree) -> Option<Supernodes<'a>> {
    match symbolic.raw() {
        SymbolicCholeskyRaw::Supernodal(symbolic) => Some(Supernodes { symbolic, tree }),
        SymbolicCholeskyRaw::Simplicial(_) => None,
    }
}

fn structure(pattern: &Pattern) -> SymbolicSparseColMatRef<'_, u32> {
    let n = pattern.size();
    SymbolicSparseColMatRef::new_checked(n, n, &pattern.column_start, None, &pattern.row)
}

#[cfg(test)]
#[path = "cholesky_tests.rs"]
mod tests;
