//! The Newton system: ∂K/∂u with its factorisation.

use super::jacobian::Jacobian;
use crate::error::Result;
use crate::linalg::Cholesky;
use crate::linalg::cholesky::NotPositiveDefinite;
use crate::mesh::Mesh;

/// Refinement of the linear solution stops here, relative to the right-hand side.
const REFINE_TO: f64 = 1e-13;
/// and after this many steps.
const REFINE_STEPS: usize = 2;

pub(super) struct System {
    pub jacobian: Jacobian,
    cholesky: Cholesky,
    rhs: Vec<f64>,
    solution: Vec<f64>,
    correction: Vec<f64>,
}

impl System {
    /// Order and analyse for the unknowns {v : !fixed[v]}.
    pub fn new(mesh: &Mesh, fixed: &[bool]) -> Result<System> {
        let jacobian = Jacobian::new(mesh, fixed)?;
        let cholesky = Cholesky::analyse(&jacobian.pattern)?;
        let n = jacobian.pattern.size();
        Ok(System { jacobian, cholesky, rhs: vec![0.0; n], solution: vec![0.0; n], correction: vec![0.0; n] })
    }

    pub fn unknowns(&self) -> usize {
        self.rhs.len()
    }

    pub fn factor_entries(&self) -> usize {
        self.cholesky.factor_entries()
    }

    pub fn factor(&mut self) -> std::result::Result<(), NotPositiveDefinite> {
        self.cholesky.factor(self.jacobian.matrix())
    }

    /// Solve `(∂K/∂u) step = residual` (both per vertex, 0 at fixed vertices) with the last factor, refined where
    /// the linear residual asks for it: what it leaves of the curvature error stays below `REFINE_TO` of that error, or below
    /// `enough` (radians). False when the solution is not finite.
    pub fn solve(&mut self, residual: &[f64], enough: f64, step: &mut [f64]) -> bool {
        self.jacobian.rows().for_each(|(v, row)| self.rhs[row] = residual[v]);
        self.solution.copy_from_slice(&self.rhs);
        self.cholesky.solve(&mut self.solution);
        let norm = |x: &[f64]| x.iter().fold(0.0f64, |m, x| m.max(x.abs()));
        let (scale, mut last) = (norm(&self.rhs), f64::INFINITY);
        for _ in 0..REFINE_STEPS {
            self.jacobian.matrix().residual(&self.solution, &self.rhs, &mut self.correction);
            let now = norm(&self.correction);
            // A NaN compares false and ends the refinement too.
            let worth_it = now > f64::max(REFINE_TO * scale, enough) && now < 0.5 * last;
            if !worth_it {
                break;
            }
            last = now;
            self.cholesky.solve(&mut self.correction);
            self.solution.iter_mut().zip(&self.correction).for_each(|(x, c)| *x += c);
        }
        step.fill(0.0);
        self.jacobian.rows().for_each(|(v, row)| step[v] = self.solution[row]);
        self.solution.iter().all(|x| x.is_finite())
    }
}
