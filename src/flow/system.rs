//! The Newton system: ∂K/∂u with its factorisation.

use super::jacobian::Jacobian;
use crate::control::Control;
use crate::error::Result;
use crate::geometry::largest;
use crate::linalg::cholesky::NotPositiveDefinite;
use crate::linalg::conjugate::{ConjugateGradients, LinearProblem, ResidualBound};
use crate::linalg::{Cholesky, Pattern};

use crate::mesh::Mesh;

/// Residual of the linear solution at which its refinement stops, relative to the right-hand side: near the rounding of f64.
const REFINE_TO: f64 = 1e-13;
/// Largest number of refinement steps; each costs a solution and gains several digits.
const REFINE_STEPS: usize = 2;

/// Share of the edges that may be flipped before the order of elimination is made anew. An order that was made for another pattern has
/// much more fill: flips of 0.5 % of the edges make a factor of 400,000 rows so much larger that it takes ten times as long.
const FEW_FLIPS: f64 = 5e-4;

/// The precision of a factor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Precision {
    /// For [`NewtonSystem::solve_near`]: half the memory, and solutions in half the time.
    F32,
    /// For [`NewtonSystem::solve`] too.
    F64,
}

/// A factorisation, or memory for it.
enum NewtonFactor {
    F32(Cholesky<f32>),
    F64(Cholesky),
}

impl NewtonFactor {
    /// The same analysis, for a factor in this precision.
    fn held_in(self, precision: Precision) -> Result<NewtonFactor> {
        Ok(match (self, precision) {
            (NewtonFactor::F32(factor), Precision::F64) => NewtonFactor::F64(factor.held_in()?),
            (NewtonFactor::F64(factor), Precision::F32) => NewtonFactor::F32(factor.held_in()?),
            (same, _) => same,
        })
    }

    fn is_in(&self, precision: Precision) -> bool {
        matches!(self, NewtonFactor::F32(_)) == (precision == Precision::F32)
    }

    /// The analysis of another pattern, with the order of this one if that is to be kept. The memory of this factor is released before that
    /// of the new one is taken.
    fn analysed(self, pattern: &Pattern, keep_order: bool) -> Result<NewtonFactor> {
        if !keep_order {
            drop(self);
            return Ok(NewtonFactor::F64(Cholesky::analyse(pattern)?));
        }
        Ok(NewtonFactor::F64(match self {
            NewtonFactor::F32(factor) => factor.analyse_again(pattern)?,
            NewtonFactor::F64(factor) => factor.analyse_again(pattern)?,
        }))
    }

    fn entries(&self) -> usize {
        match self {
            NewtonFactor::F32(factor) => factor.factor_entries(),
            NewtonFactor::F64(factor) => factor.factor_entries(),
        }
    }
}

/// The matrix with the last factorisation, which may be that of an earlier one, and the vectors of a solution, whose memory is kept.
pub(super) struct NewtonSystem {
    pub jacobian: Jacobian,
    held: NewtonFactor,
    /// True if the present pattern has been analysed.
    is_analysed: bool,
    /// True if there is a factor.
    is_factored: bool,
    /// Flips since the order was made.
    age: usize,
    rhs: Vec<f64>,
    solution: Vec<f64>,
    correction: Vec<f64>,
    conjugate: ConjugateGradients,
}

impl NewtonSystem {
    /// Order and analyse for the unknowns of [`Jacobian::new`].
    pub fn new(mesh: &Mesh, fixed: &[bool], mirror: Option<&[u32]>) -> Result<NewtonSystem> {
        let jacobian = Jacobian::new(mesh, fixed, mirror)?;
        let held = NewtonFactor::F64(Cholesky::analyse(&jacobian.pattern)?);
        let n = jacobian.pattern.size();
        let zeros = vec![0.0; n];
        Ok(NewtonSystem {
            jacobian,
            held,
            is_analysed: true,
            is_factored: false,
            age: 0,
            rhs: zeros.clone(),
            solution: zeros.clone(),
            correction: zeros,
            conjugate: ConjugateGradients::default(),
        })
    }

    /// The same unknowns after `flips` more edge flips. The factor stays that of the last matrix; [`NewtonSystem::analysed`] prepares for another
    /// one.
    pub fn flipped(
        mut self,
        mesh: &Mesh,
        fixed: &[bool],
        mirror: Option<&[u32]>,
        flips: usize,
    ) -> Result<NewtonSystem> {
        self.jacobian.keep_pattern_alone();
        let jacobian = Jacobian::new(mesh, fixed, mirror)?;
        let is_analysed = self.is_analysed && jacobian.pattern == self.jacobian.pattern;
        Ok(NewtonSystem { jacobian, is_analysed, age: self.age + flips, ..self })
    }

    /// Prepare for [`NewtonSystem::factor`] in this precision: analyse the pattern if it has changed since the last analysis. The order is kept
    /// while few edges have been flipped since it was made.
    pub fn analysed(mut self, mesh: &Mesh, precision: Precision) -> Result<NewtonSystem> {
        if self.is_ready(precision) {
            return Ok(self);
        }
        let NewtonSystem { held, is_analysed, jacobian, .. } = self;
        self.is_factored = false;
        let keep = self.age as f64 <= FEW_FLIPS * mesh.n_edges() as f64;
        let held = if is_analysed { held } else { held.analysed(&jacobian.pattern, keep)? };
        let age = if keep || is_analysed { self.age } else { 0 };
        Ok(NewtonSystem {
            held: held.held_in(precision)?,
            is_analysed: true,
            is_factored: false,
            jacobian,
            age,
            ..self
        })
    }

    pub fn unknowns(&self) -> usize {
        self.rhs.len()
    }

    pub fn factor_entries(&self) -> usize {
        self.held.entries()
    }

    /// True if a matrix has been factorised.
    pub fn has_factor(&self) -> bool {
        self.is_factored
    }

    /// True if the matrix can be factorised in this precision.
    pub fn is_ready(&self, precision: Precision) -> bool {
        self.is_analysed && self.held.is_in(precision)
    }

    /// Factorise the matrix, whose pattern has been analysed, in the precision that this was made ready for.
    pub fn factor(&mut self) -> std::result::Result<(), NotPositiveDefinite> {
        self.is_factored = false;
        match &mut self.held {
            NewtonFactor::F32(factor) => factor.factor(self.jacobian.matrix())?,
            NewtonFactor::F64(factor) => factor.factor(self.jacobian.matrix())?,
        }
        self.is_factored = true;
        Ok(())
    }

    /// [`NewtonSystem::solve`] by conjugate gradients within `bound`, with the factor of an earlier matrix as preconditioner. False if there is no
    /// factor, and if a factor of the matrix itself would be quicker.
    ///
    /// # Errors
    /// [`crate::Error::Cancelled`].
    pub fn solve_near(
        &mut self,
        residual: &[f64],
        bound: ResidualBound,
        step: &mut [f64],
        control: &Control,
    ) -> Result<bool> {
        if !self.is_factored {
            return Ok(false);
        }
        self.gather(residual);
        self.solution.copy_from_slice(&self.rhs);
        let NewtonSystem { jacobian, held, solution, conjugate, .. } = self;
        let problem = LinearProblem { matrix: jacobian.matrix(), bound };
        let found = match held {
            NewtonFactor::F32(near) => conjugate.solve(problem, near, solution, control)?,
            NewtonFactor::F64(near) => conjugate.solve(problem, near, solution, control)?,
        };
        Ok(found && self.scatter(step))
    }

    /// Solve `(∂K/∂u) step = residual` (both per vertex, 0 at fixed vertices) with the last factor. The solution is refined until the linear
    /// residual is below [`REFINE_TO`] of the right-hand side, or below `enough` (radians). False if the solution is not finite, and for a
    /// factor in f32.
    pub fn solve(&mut self, residual: &[f64], enough: f64, step: &mut [f64]) -> bool {
        self.gather(residual);
        let NewtonFactor::F64(factor) = &mut self.held else { return false };
        self.solution.copy_from_slice(&self.rhs);
        factor.solve(&mut self.solution);
        let (scale, mut last) = (largest(&self.rhs), f64::INFINITY);
        for _ in 0..REFINE_STEPS {
            self.jacobian.matrix().residual(&self.solution, &self.rhs, &mut self.correction);
            let now = largest(&self.correction);
            // The comparison is false for NaN, which ends the refinement too.
            let worth_it = now > f64::max(REFINE_TO * scale, enough) && now < 0.5 * last;
            if !worth_it {
                break;
            }
            last = now;
            factor.solve(&mut self.correction);
            self.solution.iter_mut().zip(&self.correction).for_each(|(x, c)| *x += c);
        }
        self.scatter(step)
    }

    /// The right-hand side from a residual per vertex.
    fn gather(&mut self, residual: &[f64]) {
        self.rhs.fill(0.0);
        self.jacobian.rows().for_each(|(v, row)| self.rhs[row] += residual[v]);
    }

    /// Write the solution as a step per vertex; true if it is finite.
    fn scatter(&self, step: &mut [f64]) -> bool {
        step.fill(0.0);
        self.jacobian.rows().for_each(|(v, row)| step[v] = self.solution[row]);
        self.solution.iter().all(|x| x.is_finite())
    }
}
