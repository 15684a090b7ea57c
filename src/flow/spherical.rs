//! Damped Newton in S², where the energy is a saddle: convex but for the scale (and flat along Möbius maps).
//!
//! On the round sphere ∂K/∂u is (Laplacian − 2·area): −2 on constants, 0 on the three Möbius directions, positive
//! on the rest. Constants are taken out by keeping the total area at `2πχ − Σ K̄`; the rest is solved with
//! `∂K/∂u + μ·area`, which is positive definite for μ > 2 near the solution.

use super::Flow;
use super::evaluate::State;
use super::newton::progress;
use super::report::{Report, StopReason};
use super::seconds::timed;
use super::system::System;
use crate::control::{Control, Stage};
use crate::error::Result;
use crate::geometry::largest;
use std::f64::consts::PI;

/// Least damping: above 2, the size of the one negative eigenvalue on the round sphere.
const MIN_DAMPING: f64 = 2.1;
/// The flow gives up at this damping: steps are then far below the rounding of u.
const MAX_DAMPING: f64 = 1e15;
/// Factor by which the damping grows after a step that was refused.
const DAMPING_GROWTH: f64 = 4.0;

/// What damped Newton carries from step to step.
struct Damped {
    state: State,
    /// The state at the end of a step that is tried.
    trial: State,
    /// K̄ − K at `state`.
    residual: Vec<f64>,
    step: Vec<f64>,
    /// μ.
    damping: f64,
    /// The total area that is kept; none where pinned vertices fix the scale.
    area: Option<f64>,
}

impl Flow {
    /// Area that Gauss–Bonnet gives the target.
    pub(super) fn spherical_area(&self) -> f64 {
        2.0 * PI * self.mesh.euler() as f64 - self.target.iter().sum::<f64>()
    }

    pub(super) fn spherical(
        &mut self,
        mut state: State,
        report: &mut Report,
        control: &Control,
    ) -> Result<State> {
        let [mut residual, step] = [(); 2].map(|()| vec![0.0; self.mesh.n_vertices()]);
        let trial = State::new(&self.start, &self.start_low);
        let area = (!self.has_pins()).then(|| self.spherical_area());
        if !self.settle(&mut state, area) {
            return Ok(self.without_a_start(report));
        }
        let mut error = state.residual(&self.target, &self.pinned, &mut residual);
        let first = error;
        let mut at = Damped { state, trial, residual, step, damping: MIN_DAMPING, area };
        report.residuals.push(error);
        let mut system = self.take_system(report)?;
        report.stop_reason = loop {
            if error <= report.tolerance {
                break StopReason::Converged;
            }
            if report.iterations >= self.options.iteration_limit() {
                break StopReason::IterationLimit;
            }
            if at.damping > MAX_DAMPING {
                break StopReason::Stalled;
            }
            control.step(Stage::Flow, progress(first, error, report.tolerance))?;
            report.iterations += 1;
            if self.damped_step(&mut system, &mut at, report) {
                error = at.state.residual(&self.target, &self.pinned, &mut at.residual);
                report.residuals.push(error);
                at.damping = (0.5 * at.damping).max(MIN_DAMPING);
            } else {
                at.damping *= DAMPING_GROWTH;
            }
        };
        self.system = Some(system);
        report.max_curvature_error = error;
        Ok(at.state)
    }

    /// One step with the present damping; false, and `at.state` as it was, where there is none that lowers the norm of the residual.
    fn damped_step(&self, system: &mut System, at: &mut Damped, report: &mut Report) -> bool {
        timed(&mut report.seconds.assemble, || {
            let mass = at.state.vertex_areas(&self.mesh, self.metric.space, 1.0);
            system.jacobian.assemble(&self.mesh, &self.metric, &at.state);
            system.jacobian.add_diagonal(|v| at.damping * mass[v]);
        });
        let enough = self.enough();
        let solved = timed(&mut report.seconds.factor, || system.factor()).is_ok()
            && timed(&mut report.seconds.solve, || system.solve(&at.residual, enough, &mut at.step));
        if !solved || largest(&at.step) > self.options.max_step {
            return false;
        }
        let Damped { state, trial, step, area, .. } = at;
        trial.set_step(state, 1.0, step);
        let inside = timed(&mut report.seconds.assemble, || self.settle(trial, *area));
        let is_better = inside && self.norm_at(trial) < self.norm_at(state);
        if is_better {
            std::mem::swap(state, trial);
        }
        is_better
    }

    /// The start as it is, where no shift of it has the area of the target.
    fn without_a_start(&self, report: &mut Report) -> State {
        let mut state = State::new(&self.start, &self.start_low);
        state.evaluate(&self.mesh, &self.metric);
        let mut residual = vec![0.0; self.mesh.n_vertices()];
        report.stop_reason = StopReason::Stalled;
        report.max_curvature_error = state.residual(&self.target, &self.pinned, &mut residual);
        state
    }

    /// Euclidean norm of the residual.
    fn norm_at(&self, state: &State) -> f64 {
        let square = |(i, t): (usize, &f64)| {
            if self.pinned[i] { 0.0 } else { (t - state.curvature[i.into()]).powi(2) }
        };
        self.target.iter().enumerate().map(square).sum::<f64>().sqrt()
    }
}
