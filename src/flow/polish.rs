//! Newton's last digits: steps with the matrix of the last step.

use super::Flow;
use super::newton::Iterate;
use super::report::Report;
use super::seconds::timed;
use super::system::{Precision, System};
use crate::control::Control;
use crate::error::Result;
use crate::geometry::Space;

/// Radians. Once converged, the last matrix is reused to bring the error down to this, each step at least halving it; in H², whose
/// layouts magnify errors by e^distance, as far as it goes.
const POLISH_TO: f64 = 1e-13;
/// Such steps at most: each costs a solution, and the error falls to rounding in one or two.
const POLISH_STEPS: usize = 3;

/// Share of the right-hand side that a step leaves which polishes: far less than the polish gains.
const POLISH_FORCING: f64 = 1e-6;

impl Flow {
    /// An error that needs no more polish.
    pub(super) fn polished(&self) -> f64 {
        if self.metric.space == Space::H2 { 0.0 } else { POLISH_TO }
    }

    /// Steps with the last matrix, as long as they at least halve the error and flip nothing: iterative refinement of the nonlinear
    /// system at the price of a few solutions with the last factor, or of one more where that does not serve. Returns the system.
    pub(super) fn polish(
        &mut self,
        mut system: System,
        at: &mut Iterate,
        report: &mut Report,
        control: &Control,
    ) -> Result<System> {
        let broken = at.state.broken();
        for _ in 0..POLISH_STEPS {
            control.check()?;
            at.state.residual(&self.target, &self.pinned, &mut at.residual);
            if !self.solve_near(&mut system, at, POLISH_FORCING, (report, control))? {
                system = self.analysed(system, Precision::Double, report)?;
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
