//! Damped Newton's method in S², where the energy has a saddle: it is convex except along the scale, and flat along Möbius maps.
//!
//! On the round sphere ∂K/∂u is (Laplacian − 2·area): −2 on constants, 0 on the three Möbius directions, positive
//! on the rest. Constants are taken out by keeping the total area at `2πχ − Σ K̄`; the rest is solved with
//! `∂K/∂u + μ·area`, which is positive definite for μ > 2 near the solution.

use super::Flow;
use super::evaluate::FlowState;
use super::newton::{Iterate, progress};
use super::report::{Report, StopReason};
use super::seconds::timed;
use super::system::{NewtonSystem, Precision};
use crate::control::{Control, Stage};
use crate::error::Result;
use crate::geometry::largest;
use std::f64::consts::PI;

/// Least damping: above 2, the size of the one negative eigenvalue on the round sphere.
const MIN_DAMPING: f64 = 2.1;
/// The flow gives up at this damping: steps are then far below the rounding of u.
const MAX_DAMPING: f64 = 1e15;
/// NewtonFactor by which the damping grows after a step that was refused.
const DAMPING_GROWTH: f64 = 4.0;

impl Flow {
    /// Area that Gauss–Bonnet gives the target.
    pub(super) fn spherical_area(&self) -> f64 {
        2.0 * PI * self.mesh.euler() as f64 - self.target.iter().sum::<f64>()
    }

    pub(super) fn spherical(
        &mut self,
        mut state: FlowState,
        report: &mut Report,
        control: &Control,
    ) -> Result<FlowState> {
        let area = (!self.has_pins()).then(|| self.spherical_area());
        if !self.evaluate_at_area(&mut state, area) {
            return Ok(self.without_a_start(report));
        }
        let mut at = Iterate::new(self, state);
        let first = at.error;
        at.shift = MIN_DAMPING;
        report.residuals.push(at.error);
        let system = self.take_system(report)?;
        let mut system = self.analysed(system, Precision::F64, report)?;
        report.stop_reason = loop {
            if at.error <= report.tolerance {
                break StopReason::Converged;
            }
            if report.iterations >= self.options.iteration_limit() {
                break StopReason::IterationLimit;
            }
            if at.shift > MAX_DAMPING {
                break StopReason::Stalled;
            }
            control.step(Stage::Flow, progress(first, at.error, report.tolerance))?;
            report.iterations += 1;
            if self.damped_step(&mut system, &mut at, area, report) {
                at.error = at.state.residual(&self.target, &self.pinned, &mut at.residual);
                report.residuals.push(at.error);
                at.shift = (0.5 * at.shift).max(MIN_DAMPING);
            } else {
                at.shift *= DAMPING_GROWTH;
            }
        };
        self.system = Some(system);
        report.max_curvature_error = at.error;
        Ok(at.end(&mut self.memory))
    }

    /// One step with the damping μ = `at.shift`, at the total area `area` if there is one; false, and `at.state` as it was, where that
    /// does not lower the norm of the residual.
    fn damped_step(
        &self,
        system: &mut NewtonSystem,
        at: &mut Iterate,
        area: Option<f64>,
        report: &mut Report,
    ) -> bool {
        timed(&mut report.seconds.assemble, || {
            let mass = at.state.vertex_areas(&self.mesh, &self.metric, 1.0);
            system.jacobian.assemble(&self.mesh, &self.metric, &at.state);
            system.jacobian.add_diagonal(|v| at.shift * mass[v]);
        });
        let enough = self.enough();
        report.factorisations += 1;
        let solved = timed(&mut report.seconds.factor, || system.factor()).is_ok()
            && timed(&mut report.seconds.solve, || system.solve(&at.residual, enough, &mut at.step));
        if !solved || largest(&at.step) > self.options.max_step {
            return false;
        }
        let Iterate { state, trial, step, .. } = at;
        trial.set_step(state, 1.0, step);
        let inside = timed(&mut report.seconds.assemble, || self.evaluate_at_area(trial, area));
        let is_better = inside && self.norm_at(trial) < self.norm_at(state);
        if is_better {
            std::mem::swap(state, trial);
        }
        is_better
    }

    /// The start as the result, if no shift of it has the area of the target.
    fn without_a_start(&self, report: &mut Report) -> FlowState {
        let mut state = FlowState::new(&self.start, &self.start_low);
        state.evaluate(&self.mesh, &self.metric);
        let mut residual = vec![0.0; self.mesh.n_vertices()];
        report.stop_reason = StopReason::Stalled;
        report.max_curvature_error = state.residual(&self.target, &self.pinned, &mut residual);
        state
    }

    /// Euclidean norm of the residual.
    fn norm_at(&self, state: &FlowState) -> f64 {
        let square = |(i, t): (usize, &f64)| {
            if self.pinned[i] { 0.0 } else { (t - state.curvature[i.into()]).powi(2) }
        };
        self.target.iter().enumerate().map(square).sum::<f64>().sqrt()
    }
}
