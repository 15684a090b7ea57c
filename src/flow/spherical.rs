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
use crate::control::{Control, Stage};
use crate::error::Result;
use std::f64::consts::PI;

/// Least damping: above 2, the size of the one negative eigenvalue on the round sphere.
const MIN_DAMPING: f64 = 2.1;
/// The flow gives up at this damping: steps are then far below the rounding of u.
const MAX_DAMPING: f64 = 1e15;

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
        let n = self.mesh.n_vertices();
        let (mut residual, mut step) = (vec![0.0; n], vec![0.0; n]);
        let mut trial = State::new(&self.start, &self.start_low);
        let area = (!self.has_pins()).then(|| self.spherical_area());
        if !self.settle(&mut state, area) {
            return Ok(self.without_a_start(report));
        }
        let mut error = state.residual(&self.target, &self.pinned, &mut residual);
        let (first, mut damping) = (error, MIN_DAMPING);
        report.residuals.push(error);
        let mut system = self.take_system(report)?;
        report.stop_reason = loop {
            if error <= report.tolerance {
                break StopReason::Converged;
            }
            if report.iterations >= self.options.iteration_limit() {
                break StopReason::IterationLimit;
            }
            if damping > MAX_DAMPING {
                break StopReason::Stalled;
            }
            control.step(Stage::Flow, progress(first, error, report.tolerance))?;
            let mass = self.vertex_areas(&state);
            timed(&mut report.seconds.assemble, || {
                system.jacobian.assemble(&self.mesh, &self.metric, &state);
                system.jacobian.add_diagonal(|v| damping * mass[v]);
            });
            report.iterations += 1;
            let solved = timed(&mut report.seconds.factor, || system.factor()).is_ok()
                && timed(&mut report.seconds.solve, || system.solve(&residual, self.enough(), &mut step));
            let largest = step.iter().fold(0.0f64, |m, x| m.max(x.abs()));
            if !solved || largest > self.options.max_step {
                damping *= 4.0;
                continue;
            }
            trial.set_step(&state, 1.0, &step);
            let inside = timed(&mut report.seconds.assemble, || self.settle(&mut trial, area));
            if inside && norm_of(&trial, self) < norm_of(&state, self) {
                std::mem::swap(&mut state, &mut trial);
                error = state.residual(&self.target, &self.pinned, &mut residual);
                report.residuals.push(error);
                damping = (0.5 * damping).max(MIN_DAMPING);
            } else {
                damping *= 4.0;
            }
        };
        self.system = Some(system);
        report.max_curvature_error = error;
        Ok(state)
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

    /// A third of the area of the faces at each vertex.
    fn vertex_areas(&self, state: &State) -> Vec<f64> {
        let mut areas = vec![0.0; self.mesh.n_vertices()];
        for f in self.mesh.faces() {
            let third = state.face_area(&self.mesh, self.metric.space, f) / 3.0;
            self.mesh.face_vertices(f).into_iter().for_each(|v| areas[v.index()] += third);
        }
        areas
    }
}

/// Euclidean norm of the residual.
fn norm_of(state: &State, flow: &Flow) -> f64 {
    let square =
        |(i, t): (usize, &f64)| if flow.pinned[i] { 0.0 } else { (t - state.curvature[i.into()]).powi(2) };
    flow.target.iter().enumerate().map(square).sum::<f64>().sqrt()
}
