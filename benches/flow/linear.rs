//! Times of the linear algebra of one Newton step by faer and by the flow's own factorisation.

use crate::common::seconds;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::LltRegularization;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymmetricOrdering, factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par, Side, Spec};
use ricci::flow::curvature_derivative;
use ricci::linalg::{Cholesky, Pattern, Symmetric};
use ricci::mesh::{Mesh, VertexId};
use ricci::metric::Metric;
use ricci::parallel::Pool;
use std::io::Write;

/// The measurements of one solver for one analysis, factorisation and solve.
#[derive(Clone)]
pub struct Linear {
    pub solver: String,
    /// Seconds.
    pub analyse: f64,
    pub factor: f64,
    pub solve: f64,
    /// Number of entries of the factor.
    pub entries: usize,
    /// Processor seconds per second of the factorisation.
    pub cores: f64,
    /// ‖A x − b‖∞ for the right-hand side of [`right_hand_side`].
    pub residual: f64,
}

impl Linear {
    /// Seconds of a Newton's method that would do nothing else.
    pub fn newton(&self, iterations: usize) -> f64 {
        iterations as f64 * (self.factor + self.solve) + self.analyse
    }

    /// Seconds of one analysis and one factorisation, which any Newton's method needs.
    pub fn once(&self) -> f64 {
        self.analyse + self.factor
    }
}

/// ∂K/∂u with the first vertex held.
pub struct Matrix {
    pattern: Pattern,
    values: Vec<f64>,
}

impl Matrix {
    pub fn new(mesh: &Mesh, metric: &Metric) -> Matrix {
        let free = |i: VertexId| i.0.checked_sub(1);
        let entries = curvature_derivative(mesh, metric).unwrap();
        let kept: Vec<_> = entries.iter().filter_map(|&(i, j, x)| Some((free(i)?, free(j)?, x))).collect();
        let pairs: Vec<_> = kept.iter().map(|&(i, j, _)| (i, j)).collect();
        let pattern = Pattern::new(mesh.n_vertices() - 1, &pairs).unwrap();
        let mut values = vec![0.0; pattern.entries()];
        for (i, j, x) in kept {
            values[pattern.position(i as usize, j as usize).unwrap()] = x;
        }
        Matrix { pattern, values }
    }

    fn symmetric(&self) -> Symmetric<'_> {
        Symmetric { pattern: &self.pattern, values: &self.values }
    }

    /// faer on one thread, analysis and numbers: the yardstick. The second factorisation and solve count: their memory is there already,
    /// as in all steps of Newton but the first. The peers do the same.
    pub fn faer(&self) -> Linear {
        let n = self.pattern.size();
        let starts: Vec<u32> = (0..n)
            .map(|j| self.pattern.diagonal(j))
            .chain([self.pattern.entries()])
            .map(|k| k as u32)
            .collect();
        let rows: Vec<u32> = self.symmetric().entries().map(|(i, ..)| i as u32).collect();
        let structure = SymbolicSparseColMatRef::new_checked(n, n, &starts, None, &rows);
        let params = CholeskySymbolicParams {
            supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SUPERNODAL,
            ..CholeskySymbolicParams::default()
        };
        let (analyse, symbolic) = seconds(|| {
            factorize_symbolic_cholesky(structure, Side::Lower, SymmetricOrdering::Amd, params).unwrap()
        });
        let need = symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, Spec::default());
        let mut memory = MemBuffer::new(need.or(symbolic.solve_in_place_scratch::<f64>(1, Par::Seq)));
        let mut values = vec![0.0; symbolic.len_val()];
        let matrix = SparseColMatRef::new(structure, &self.values[..]);
        let mut factor = |values: &mut [f64]| {
            let (regular, stack, spec) =
                (LltRegularization::default(), MemStack::new(&mut memory), Spec::default());
            symbolic
                .factorize_numeric_llt(values, matrix, Side::Lower, regular, Par::Seq, stack, spec)
                .unwrap();
        };
        factor(&mut values);
        let used = processor_seconds();
        let factored = seconds(|| factor(&mut values)).0;
        let cores = (processor_seconds() - used) / factored;
        let mut x: Vec<f64> = (0..n).map(right_hand_side).collect();
        let solve = seconds(|| {
            LltRef::new(&symbolic, &values).solve_in_place_with_conj(
                Conj::No,
                MatMut::from_column_major_slice_mut(&mut x, n, 1),
                Par::Seq,
                MemStack::new(&mut memory),
            );
        });
        let solver = "faer AMD".into();
        let (entries, residual) = (values.len(), self.residual(&x));
        Linear { solver, analyse, factor: factored, solve: solve.0, entries, cores, residual }
    }

    /// The factorisation of the flow, on so many threads.
    pub fn own(&self, threads: usize) -> Linear {
        let b: Vec<f64> = (0..self.pattern.size()).map(right_hand_side).collect();
        let (analyse, mut cholesky) = seconds(|| Cholesky::analyse(&self.pattern).unwrap());
        let mut x = b.clone();
        let [mut factor, mut solve] = [0.0; 2];
        Pool::new(threads).unwrap().run(|| {
            for _ in 0..2 {
                factor = seconds(|| cholesky.factor(self.symmetric()).unwrap()).0;
                x.copy_from_slice(&b);
                solve = seconds(|| cholesky.solve(&mut x)).0;
            }
        });
        Linear {
            solver: format!("own, {threads} thread{}", if threads == 1 { "" } else { "s" }),
            analyse,
            factor,
            solve,
            entries: cholesky.factor_entries(),
            cores: f64::NAN,
            residual: self.residual(&x),
        }
    }

    /// ‖A x − b‖∞
    fn residual(&self, x: &[f64]) -> f64 {
        let b: Vec<f64> = (0..x.len()).map(right_hand_side).collect();
        let mut residual = vec![0.0; x.len()];
        self.symmetric().residual(x, &b, &mut residual);
        residual.iter().fold(0.0, |m, r| r.abs().max(m))
    }

    /// The matrix in the format that benches/peers reads.
    pub fn write(&self, out: impl Write) -> std::io::Result<()> {
        let mut out = std::io::BufWriter::new(out);
        let (n, entries) = (self.pattern.size(), self.pattern.entries());
        [n as u64, entries as u64].iter().try_for_each(|x| out.write_all(&x.to_ne_bytes()))?;
        let starts = (0..n).map(|j| self.pattern.diagonal(j)).chain([entries]);
        starts.into_iter().try_for_each(|x| out.write_all(&(x as i32).to_ne_bytes()))?;
        self.symmetric().entries().try_for_each(|(i, ..)| out.write_all(&(i as i32).to_ne_bytes()))?;
        self.values.iter().try_for_each(|x| out.write_all(&x.to_ne_bytes()))?;
        out.flush()
    }
}

/// 1, −1, 1, −1, …: of mean about 0, so that the solution is of the size of the right-hand side.
fn right_hand_side(i: usize) -> f64 {
    if i.is_multiple_of(2) { 1.0 } else { -1.0 }
}

/// Processor seconds of this thread (faer runs on it alone); NaN where the system does not tell.
fn processor_seconds() -> f64 {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    text.split_whitespace().next().and_then(|ns| ns.parse::<f64>().ok()).map_or(f64::NAN, |ns| ns * 1e-9)
}
