//! Polishes the result of Newton's method by steps with the factor of the last one.

use super::Flow;
use super::newton::Iterate;
use super::report::Report;
use super::seconds::timed;
use super::system::{NewtonSystem, Precision};
use crate::control::Control;
use crate::error::Result;
use crate::geometry::Space;

/// Radians. Once converged, the last matrix is reused to bring the error down to this, each step at least halving it; in H², whose
/// layouts magnify errors by e^distance, as far as it goes.
const POLISH_TO: f64 = 1e-13;
/// Largest number of such steps: each costs a solution, and the error falls to rounding in one or two.
const POLISH_STEPS: usize = 3;

/// Linear residual of such a step as a share of the right-hand side: far less than the step gains.
const POLISH_FORCING: f64 = 1e-6;

impl Flow {
    /// The error at which polishing ends.
    pub(super) fn polished(&self) -> f64 {
        if self.metric.space == Space::H2 { 0.0 } else { POLISH_TO }
    }

    /// Steps with the last matrix, as long as they at least halve the error and flip nothing: iterative refinement of the nonlinear
    /// system at the price of a few solutions with the last factor, or of one more factor if that is not good enough. Returns the system.
    pub(super) fn polish(
        &mut self,
        mut system: NewtonSystem,
        at: &mut Iterate,
        report: &mut Report,
        control: &Control,
    ) -> Result<NewtonSystem> {
        let broken = at.state.broken();
        for _ in 0..POLISH_STEPS {
            control.check()?;
            at.state.residual(&self.target, &self.pinned, &mut at.residual);
            if !timed(&mut report.seconds.solve, || {
                self.solve_near(&mut system, at, POLISH_FORCING, control)
            })? {
                system = self.analysed(system, Precision::F64, report)?;
                report.factorisations += 1;
                let factored = timed(&mut report.seconds.factor, || system.factor()).is_ok();
                if !(factored && self.solve_step(&mut system, at, report)?) {
                    return Ok(system);
                }
            }
            let Iterate { state, trial, residual, step, error, .. } = at;
            trial.set_step(state, 1.0, step);
            state.hand_on(trial);
            let flips = report.flips;
            if !self.evaluate(trial, report, control)? {
                return Ok(system);
            }
            let now = trial.residual(&self.target, &self.pinned, residual);
            if !(now < *error && trial.broken() <= broken) {
                return Ok(system);
            }
            std::mem::swap(state, trial);
            let halved = now <= 0.5 * *error;
            *error = now;
            if !halved || now <= self.polished() || report.flips != flips {
                return Ok(system);
            }
        }
        Ok(system)
    }
}
