//! The Newton matrix ∂K/∂u on a fixed pattern: filled from per-face weights, factorised, solved.
//!
//! One unknown per vertex that is neither pinned nor the gauge. With the edge weights `W_e = Σ w` over the two
//! triangles at e and `c = 1, cosh l, cos l`
//!
//! ```text
//! (∂K/∂u)_ij = −Σ W_e over the edges e from i to j,     (∂K/∂u)_ii = Σ W_e c(l_e) over the half-edges leaving i
//! ```
//!
//! (a loop adds `2 W (c − 1)` to its vertex). Size n×n, symmetric; semidefinite in E², definite in H².

use super::evaluate::State;
use crate::error::Result;
use crate::linalg::cholesky::NotPositiveDefinite;
use crate::linalg::{Cholesky, Pattern, Symmetric};
use crate::mesh::{FaceId, Mesh};
use crate::metric::Metric;
use crate::parallel::fill;

/// No unknown, no entry.
const NONE: u32 = u32::MAX;

pub(super) struct System {
    pattern: Pattern,
    cholesky: Cholesky,
    /// Per vertex: its unknown, or `NONE`.
    unknown: Vec<u32>,
    /// Per edge: the position of its off-diagonal entry, or `NONE`.
    entry: Vec<u32>,
    /// Per face: ∂θ/∂u weights of the edges opposite its corners.
    weights: Vec<[f64; 3]>,
    values: Vec<f64>,
    rhs: Vec<f64>,
    correction: Vec<f64>,
}

/// Refinement of the linear solution stops here, relative to the right-hand side.
const REFINE_TO: f64 = 1e-13;
/// and after this many steps.
const REFINE_STEPS: usize = 2;

impl System {
    /// Order and analyse for the unknowns {v : !fixed[v]}.
    pub fn new(mesh: &Mesh, fixed: &[bool]) -> Result<System> {
        let mut unknown = vec![NONE; mesh.n_vertices()];
        let mut n = 0u32;
        for (v, unknown) in unknown.iter_mut().enumerate() {
            if !fixed[v] {
                *unknown = n;
                n += 1;
            }
        }
        let ends = |e| mesh.ends(e).map(|v| unknown[v.index()]);
        let unknown_pairs = mesh.edges().map(ends).filter(|[i, j]| *i != NONE && *j != NONE);
        let pairs: Vec<(u32, u32)> = unknown_pairs.map(|[i, j]| (i, j)).collect();
        let pattern = Pattern::new(n as usize, &pairs)?;
        drop(pairs);
        let entry = |[i, j]: [u32; 2]| {
            let outside = i == NONE || j == NONE || i == j;
            (!outside).then(|| pattern.position(i as usize, j as usize)).flatten().map_or(NONE, |p| p as u32)
        };
        let entry = mesh.edges().map(ends).map(entry).collect();
        let cholesky = Cholesky::analyse(&pattern)?;
        Ok(System {
            values: vec![0.0; pattern.entries()],
            rhs: vec![0.0; n as usize],
            correction: vec![0.0; n as usize],
            weights: vec![[0.0; 3]; mesh.n_faces()],
            pattern,
            cholesky,
            unknown,
            entry,
        })
    }

    pub fn unknowns(&self) -> usize {
        self.pattern.size()
    }

    pub fn factor_entries(&self) -> usize {
        self.cholesky.factor_entries()
    }

    /// Fill the matrix at a state.
    pub fn assemble(&mut self, mesh: &Mesh, class: &Metric, state: &State) {
        let space = class.space;
        fill(&mut self.weights, |f| state.weights(mesh, space, FaceId::from(f)));
        self.values.fill(0.0);
        for f in mesh.faces() {
            let opposite = mesh.opposite_edges(f);
            let rows = mesh.face_vertices(f).map(|v| self.unknown[v.index()]);
            for k in 0..3 {
                let (e, w) = (opposite[k].index(), self.weights[f.index()][k]);
                let (i, j) = (rows[(k + 1) % 3], rows[(k + 2) % 3]);
                // c(l) = 1 − 2 λ q²
                let diagonal = w * (1.0 - 2.0 * space.curvature() * state.edges[e].q2);
                for row in [i, j].into_iter().filter(|&row| row != NONE) {
                    self.values[self.pattern.diagonal(row as usize)] += diagonal;
                }
                if self.entry[e] != NONE {
                    self.values[self.entry[e] as usize] -= w;
                } else if i == j && i != NONE {
                    self.values[self.pattern.diagonal(i as usize)] -= 2.0 * w;
                }
            }
        }
    }

    /// Add `mass[v]` to the diagonal.
    pub fn add_diagonal(&mut self, mass: impl Fn(usize) -> f64) {
        for (v, &row) in self.unknown.iter().enumerate().filter(|(_, row)| **row != NONE) {
            self.values[self.pattern.diagonal(row as usize)] += mass(v);
        }
    }

    pub fn mean_diagonal(&self) -> f64 {
        let n = self.unknowns().max(1);
        (0..self.unknowns()).map(|j| self.values[self.pattern.diagonal(j)].abs()).sum::<f64>() / n as f64
    }

    /// Largest absolute row sum.
    pub fn norm(&self) -> f64 {
        Symmetric { pattern: &self.pattern, values: &self.values }.norm()
    }

    pub fn factor(&mut self) -> std::result::Result<(), NotPositiveDefinite> {
        self.cholesky.factor(Symmetric { pattern: &self.pattern, values: &self.values })
    }

    /// Solve `(∂K/∂u) step = residual` (both per vertex, 0 at fixed vertices) with the last factor, refined where
    /// the linear residual asks for it. False when the solution is not finite.
    pub fn solve(&mut self, residual: &[f64], step: &mut [f64]) -> bool {
        for (v, &row) in self.unknown.iter().enumerate().filter(|(_, row)| **row != NONE) {
            self.rhs[row as usize] = residual[v];
        }
        let mut solution = self.rhs.clone();
        self.cholesky.solve(&mut solution);
        let norm = |x: &[f64]| x.iter().fold(0.0f64, |m, x| m.max(x.abs()));
        let matrix = Symmetric { pattern: &self.pattern, values: &self.values };
        let (scale, mut last) = (norm(&self.rhs), f64::INFINITY);
        for _ in 0..REFINE_STEPS {
            matrix.residual(&solution, &self.rhs, &mut self.correction);
            let now = norm(&self.correction);
            // Written so that a NaN ends the refinement too.
            if !(now > REFINE_TO * scale && now < 0.5 * last) {
                break;
            }
            last = now;
            self.cholesky.solve(&mut self.correction);
            solution.iter_mut().zip(&self.correction).for_each(|(x, c)| *x += c);
        }
        step.fill(0.0);
        for (v, &row) in self.unknown.iter().enumerate().filter(|(_, row)| **row != NONE) {
            step[v] = solution[row as usize];
        }
        solution.iter().all(|x| x.is_finite())
    }
}
