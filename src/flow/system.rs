//! The Newton system: ∂K/∂u with its factorisation.

use super::jacobian::Jacobian;
use crate::control::Control;
use crate::error::Result;
use crate::geometry::largest;
use crate::linalg::Cholesky;
use crate::linalg::cholesky::NotPositiveDefinite;
use crate::linalg::conjugate::{self, Goal};
use crate::mesh::Mesh;

/// Residual of the linear solution at which its refinement stops, relative to the right-hand side: near the rounding of doubles.
const REFINE_TO: f64 = 1e-13;
/// Refinement steps at most; each costs a solution and gains several digits.
const REFINE_STEPS: usize = 2;

/// Share of the edges that may be flipped before the order of elimination is made anew. Fill grows fast where the order does not
/// know the pattern: flips of 0.5 % of the edges make a factor of 400,000 rows so much larger that it takes ten times as long.
const FEW_FLIPS: f64 = 5e-4;

/// The matrix with the last factorisation, which may be that of an earlier one, and the vectors of a solution, whose memory is kept.
pub(super) struct System {
    pub jacobian: Jacobian,
    cholesky: Cholesky,
    /// Whether the factorisation knows the present pattern.
    is_analysed: bool,
    /// Whether there is a factor.
    is_factored: bool,
    /// Flips since the order was made.
    age: usize,
    rhs: Vec<f64>,
    solution: Vec<f64>,
    correction: Vec<f64>,
}

impl System {
    /// Order and analyse for the unknowns of [`Jacobian::new`].
    pub fn new(mesh: &Mesh, fixed: &[bool], mirror: Option<&[u32]>) -> Result<System> {
        let jacobian = Jacobian::new(mesh, fixed, mirror)?;
        let cholesky = Cholesky::analyse(&jacobian.pattern)?;
        let n = jacobian.pattern.size();
        let zeros = vec![0.0; n];
        Ok(System {
            jacobian,
            cholesky,
            is_analysed: true,
            is_factored: false,
            age: 0,
            rhs: zeros.clone(),
            solution: zeros.clone(),
            correction: zeros,
        })
    }

    /// The same unknowns after `flips` more edge flips. The factor stays that of the last matrix; [`System::analysed`] makes ready for
    /// another one.
    pub fn flipped(
        self,
        mesh: &Mesh,
        fixed: &[bool],
        mirror: Option<&[u32]>,
        flips: usize,
    ) -> Result<System> {
        let jacobian = Jacobian::new(mesh, fixed, mirror)?;
        let is_analysed = self.is_analysed && jacobian.pattern == self.jacobian.pattern;
        Ok(System { jacobian, is_analysed, age: self.age + flips, ..self })
    }

    /// Ready for [`System::factor`]: analysed, where the pattern has changed since the last analysis. The order is kept while few edges
    /// have been flipped since it was made.
    pub fn analysed(self, mesh: &Mesh) -> Result<System> {
        if self.is_analysed {
            return Ok(self);
        }
        let System { jacobian, cholesky, age, rhs, solution, correction, .. } = self;
        let keep = age as f64 <= FEW_FLIPS * mesh.n_edges() as f64;
        // One factor at a time: the old one is released before there is memory for the new.
        let cholesky = if keep {
            cholesky.analyse_again(&jacobian.pattern)?
        } else {
            drop(cholesky);
            Cholesky::analyse(&jacobian.pattern)?
        };
        let age = if keep { age } else { 0 };
        Ok(System {
            jacobian,
            cholesky,
            is_analysed: true,
            is_factored: false,
            age,
            rhs,
            solution,
            correction,
        })
    }

    pub fn unknowns(&self) -> usize {
        self.rhs.len()
    }

    pub fn factor_entries(&self) -> usize {
        self.cholesky.factor_entries()
    }

    pub fn is_analysed(&self) -> bool {
        self.is_analysed
    }

    /// Factorise the matrix, whose pattern has been analysed.
    pub fn factor(&mut self) -> std::result::Result<(), NotPositiveDefinite> {
        self.is_factored = false;
        self.cholesky.factor(self.jacobian.matrix())?;
        self.is_factored = true;
        Ok(())
    }

    /// [`System::solve`] as far as `goal` says, with the factor of an earlier matrix. False where there is none, and where a factor of the
    /// matrix itself is the better way.
    ///
    /// # Errors
    /// [`crate::Error::Cancelled`].
    pub fn solve_near(
        &mut self,
        residual: &[f64],
        goal: Goal,
        step: &mut [f64],
        control: &Control,
    ) -> Result<bool> {
        if !self.is_factored {
            return Ok(false);
        }
        self.gather(residual);
        self.solution.copy_from_slice(&self.rhs);
        let (matrix, near) = (self.jacobian.matrix(), &mut self.cholesky);
        let found = conjugate::solve(matrix, near, &mut self.solution, goal, control)?;
        Ok(found && self.scatter(step))
    }

    /// Solve `(∂K/∂u) step = residual` (both per vertex, 0 at fixed vertices) with the last factor, refined where
    /// the linear residual asks for it: what it leaves of the curvature error stays below `REFINE_TO` of that error, or below
    /// `enough` (radians). False when the solution is not finite.
    pub fn solve(&mut self, residual: &[f64], enough: f64, step: &mut [f64]) -> bool {
        self.gather(residual);
        self.solution.copy_from_slice(&self.rhs);
        self.cholesky.solve(&mut self.solution);
        let (scale, mut last) = (largest(&self.rhs), f64::INFINITY);
        for _ in 0..REFINE_STEPS {
            self.jacobian.matrix().residual(&self.solution, &self.rhs, &mut self.correction);
            let now = largest(&self.correction);
            // What is not finite ends the refinement too.
            let worth_it = now > f64::max(REFINE_TO * scale, enough) && now < 0.5 * last;
            if !worth_it {
                break;
            }
            last = now;
            self.cholesky.solve(&mut self.correction);
            self.solution.iter_mut().zip(&self.correction).for_each(|(x, c)| *x += c);
        }
        self.scatter(step)
    }

    /// The right-hand side from a residual per vertex.
    fn gather(&mut self, residual: &[f64]) {
        self.rhs.fill(0.0);
        self.jacobian.rows().for_each(|(v, row)| self.rhs[row] += residual[v]);
    }

    /// The solution as a step per vertex; whether it is finite.
    fn scatter(&self, step: &mut [f64]) -> bool {
        step.fill(0.0);
        self.jacobian.rows().for_each(|(v, row)| step[v] = self.solution[row]);
        self.solution.iter().all(|x| x.is_finite())
    }
}
