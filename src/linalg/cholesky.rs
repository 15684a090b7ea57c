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
mod tests {
    use super::*;
    use crate::parallel::Pool;

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
    fn blocks_are_eliminated_in_an_order_of_their_own_pattern() {
        let (blocks, of_blocks) = grid(7);
        let (pattern, mut cholesky) = Cholesky::analyse_blocks(&blocks, 3).unwrap();
        // A block is its number on the diagonal, and 0.1 of it elsewhere.
        let mut pairs = Vec::new();
        let mut entries = Vec::new();
        for (i, j, x) in (Symmetric { pattern: &blocks, values: &of_blocks }).entries() {
            for (c, d) in (0..3).flat_map(|c| (0..3).map(move |d| (c, d))).filter(|(c, d)| i != j || c >= d) {
                pairs.push(((3 * i + c) as u32, (3 * j + d) as u32));
                entries.push((3 * i + c, 3 * j + d, if c == d { x } else { 0.1 * x }));
            }
        }
        assert_eq!(pattern, Pattern::new(3 * blocks.size(), &pairs).unwrap());
        let mut values = vec![0.0; pattern.entries()];
        entries.iter().for_each(|&(i, j, x)| values[pattern.position(i, j).unwrap()] = x);
        let matrix = Symmetric { pattern: &pattern, values: &values };
        cholesky.factor(matrix).unwrap();
        let right: Vec<f64> = (0..pattern.size()).map(|i| (i as f64).sin()).collect();
        let (mut x, mut residual) = (right.clone(), right.clone());
        cholesky.solve(&mut x);
        matrix.residual(&x, &right, &mut residual);
        assert!(residual.iter().all(|r| r.abs() < 1e-13), "{residual:?}");
    }

    #[test]
    fn solution_leaves_no_residual() {
        for k in [0, 1, 7, 40] {
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
    fn a_factor_in_single_precision_solves_to_seven_digits_with_the_same_bits_for_any_threads() {
        let k = 150;
        let (pattern, values) = grid(k);
        let matrix = Symmetric { pattern: &pattern, values: &values };
        let b: Vec<f64> = (0..k * k).map(|i| (i as f64).sin()).collect();
        let mut in_f64 = Cholesky::analyse(&pattern).unwrap();
        in_f64.factor(matrix).unwrap();
        let mut exact = b.clone();
        in_f64.solve(&mut exact);
        let mut single: Cholesky<f32> = in_f64.held_in().unwrap();
        let mut solved = |threads| {
            let mut x = b.clone();
            Pool::new(threads).unwrap().run(|| {
                single.factor(matrix).unwrap();
                single.solve(&mut x);
            });
            x
        };
        let first = solved(1);
        let apart = first.iter().zip(&exact).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max);
        assert!(apart > 0.0 && apart < 1e-6, "{apart:e}");
        assert!(solved(2) == first && solved(8) == first);
        // And back to f64.
        let mut in_f64: Cholesky = single.held_in().unwrap();
        in_f64.factor(matrix).unwrap();
        let mut x = b.clone();
        in_f64.solve(&mut x);
        assert!(x == exact);
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

    /// The solution by faer's own factorisation, in its order.
    fn by_faer(pattern: &Pattern, values: &[f64], b: &[f64]) -> Vec<f64> {
        use faer::linalg::cholesky::llt::factor::LltRegularization;
        use faer::sparse::SparseColMatRef;
        use faer::{Par, Spec};
        let symbolic = analysis(pattern, SymmetricOrdering::Amd).unwrap();
        let mut factor = vec![0.0; symbolic.len_val()];
        let need = symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, Spec::default());
        let matrix = SparseColMatRef::new(structure(pattern), values);
        let mut memory = MemBuffer::new(need.or(symbolic.solve_in_place_scratch::<f64>(1, Par::Seq)));
        let stack = MemStack::new(&mut memory);
        let (regular, spec) = (LltRegularization::default(), Spec::default());
        symbolic
            .factorize_numeric_llt(&mut factor, matrix, Side::Lower, regular, Par::Seq, stack, spec)
            .unwrap();
        let mut x = b.to_vec();
        LltRef::new(&symbolic, &factor).solve_in_place_with_conj(
            Conj::No,
            MatMut::from_column_major_slice_mut(&mut x, b.len(), 1),
            Par::Seq,
            MemStack::new(&mut memory),
        );
        x
    }

    #[test]
    fn the_solution_is_that_of_faer_and_has_the_same_bits_for_any_threads() {
        // The larger ones have several bundles and heavy supernodes of several panels.
        for k in [3, 30, 90, 220] {
            let (pattern, values) = grid(k);
            let matrix = Symmetric { pattern: &pattern, values: &values };
            let b: Vec<f64> = (0..k * k).map(|i| (i as f64).sin()).collect();
            let expected = by_faer(&pattern, &values, &b);
            let mut cholesky = Cholesky::analyse(&pattern).unwrap();
            assert!(k < 90 || cholesky.tree.segments.iter().filter(|s| s.is_heavy).count() > 2);
            let mut before: Option<(Vec<f64>, Vec<f64>)> = None;
            for threads in [1, 2, 8, 2] {
                let mut x = b.clone();
                Pool::new(threads).unwrap().run(|| {
                    cholesky.factor(matrix).unwrap();
                    cholesky.solve(&mut x);
                });
                assert!(x.iter().zip(&expected).all(|(x, y)| (x - y).abs() < 1e-13));
                let now = (cholesky.factor.clone(), x);
                assert!(before.as_ref().is_none_or(|before| *before == now), "{k}, {threads} threads");
                before = Some(now);
            }
        }
    }

    /// Pairs of rows: a star, a path, a dense block, separate pieces, and edges all over.
    fn graphs() -> [(usize, Vec<(u32, u32)>); 5] {
        let star = (1..30_000).map(|i| (0, i)).collect();
        let path = (1..30_000).map(|i| (i - 1, i)).collect();
        let dense = (0..500).flat_map(|i| (0..i).map(move |j| (i, j))).collect();
        let pieces = (0..20_000).filter(|i| i % 10 > 2).map(|i| (i, i - i % 10)).collect();
        let all_over =
            (1..2_000u32).flat_map(|i| [(i, i * 7919 % 2_000), (i, i * i % 1_999), (i, i - 1)]).collect();
        [(30_000, star), (30_000, path), (500, dense), (20_000, pieces), (2_000, all_over)]
    }

    #[test]
    fn matrices_of_every_shape_are_solved_with_the_same_bits_for_any_threads() {
        let pools = [1, 2].map(|threads| Pool::new(threads).unwrap());
        for (k, (n, pairs)) in graphs().into_iter().enumerate() {
            let pattern = Pattern::new(n, &pairs).unwrap();
            // Each pair counts once, by its place among the entries.
            let mut values = vec![0.0; pattern.entries()];
            for (i, j) in pairs.into_iter().map(|(i, j)| (i as usize, j as usize)).filter(|(i, j)| i != j) {
                let at = pattern.position(i, j).unwrap();
                if values[at] == 0.0 {
                    values[at] = -1.0;
                    [i, j].into_iter().for_each(|i| values[pattern.diagonal(i)] += 1.0);
                }
            }
            (0..n).for_each(|i| values[pattern.diagonal(i)] += 0.5);
            let matrix = Symmetric { pattern: &pattern, values: &values };
            let b: Vec<f64> = (0..n).map(|i| (i as f64).sin()).collect();
            let mut cholesky = Cholesky::analyse(&pattern).unwrap();
            let [first, second] = [0, 1].map(|p| {
                let mut x = b.clone();
                pools[p].run(|| {
                    cholesky.factor(matrix).unwrap();
                    cholesky.solve(&mut x);
                });
                x
            });
            assert!(first == second, "graph {k}");
            let mut left = b.clone();
            matrix.residual(&first, &b, &mut left);
            assert!(left.iter().all(|r| r.abs() < 1e-11), "graph {k}");
        }
    }

    fn analysis_in(pattern: &Pattern, forward: &[u32]) -> SymbolicCholesky<u32> {
        let mut inverse = vec![0; forward.len()];
        (0..).zip(forward).for_each(|(k, &i)| inverse[i as usize] = k);
        let order = PermRef::new_checked(forward, &inverse, forward.len());
        analysis(pattern, SymmetricOrdering::Custom(order)).unwrap()
    }

    #[test]
    fn an_order_that_is_no_postorder_serves_as_well() {
        let k = 40;
        let (pattern, values) = grid(k);
        // Every row once, by steps that have no divisor in common with their number.
        let mut forward: Vec<u32> = (0..(k * k) as u32).map(|i| i * 997 % (k * k) as u32).collect();
        forward.reverse();
        assert!(tree(&analysis_in(&pattern, &forward), &pattern).is_none());
        let mut cholesky = Cholesky::with_postorder(&pattern, &forward).unwrap();
        let matrix = Symmetric { pattern: &pattern, values: &values };
        cholesky.factor(matrix).unwrap();
        let b: Vec<f64> = (0..k * k).map(|i| (i as f64).cos()).collect();
        let (mut x, mut left) = (b.clone(), b.clone());
        cholesky.solve(&mut x);
        matrix.residual(&x, &b, &mut left);
        assert!(left.iter().all(|r| r.abs() < 1e-12));
    }

    #[test]
    fn a_matrix_is_refused_wherever_it_is_not_positive() {
        let k = 120;
        let (pattern, values) = grid(k);
        let mut cholesky = Cholesky::analyse(&pattern).unwrap();
        assert!(cholesky.tree.segments.len() > 2);
        let pool = Pool::new(2).unwrap();
        let order = cholesky.symbolic.perm().unwrap().arrays().0.to_vec();
        // From the first row that is eliminated to the last.
        for at in [0, k * k / 3, k * k - 400, k * k - 1] {
            for bad in [-1.0, f64::NAN] {
                let mut values = values.clone();
                values[pattern.diagonal(order[at] as usize)] = bad;
                let matrix = Symmetric { pattern: &pattern, values: &values };
                assert_eq!(pool.run(|| cholesky.factor(matrix)), Err(NotPositiveDefinite), "{at}");
            }
        }
        let matrix = Symmetric { pattern: &pattern, values: &values };
        assert_eq!(pool.run(|| cholesky.factor(matrix)), Ok(()));
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
