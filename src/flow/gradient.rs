//! The flow `du/dt = K̄ − K` itself, explicit in time [JKLLG08, Eqn 16].

use super::evaluate::State;
use super::newton::progress;
use super::options::StepRule;
use super::report::{Report, StopReason, TraceRow, timed};
use super::solver::Run;
use crate::control::Stage;
use crate::error::Result;
use crate::geometry::Space;

/// A step that raises the largest residual more than this is halved (Barzilai–Borwein steps are not monotone).
const GROWTH: f64 = 10.0;
/// Halvings before the flow counts as stalled.
const HALVINGS: usize = 60;

impl Run<'_> {
    pub(super) fn gradient(&self, mut state: State, report: &mut Report) -> Result<State> {
        let n = self.mesh.n_vertices();
        let mut direction = vec![0.0; n];
        let mut next_direction = vec![0.0; n];
        let mut trial = State::new(self.mesh, self.start, self.start_low);
        // Pinned vertices hold their u: nothing is left to keep the area with.
        let area = match self.class.space {
            _ if self.pinned.contains(&true) => None,
            Space::S2 => Some(self.spherical_area()),
            Space::E2 if self.options.gradient.area_normalised => Some(state.area(self.mesh, self.class)),
            _ => None,
        };
        let mut error = state.residual(self.target, self.pinned, &mut direction);
        let (first, mut energy, mut step) = (error, 0.0, 0.0);
        report.trace.push(self.row(&state, 0, energy, error, step));
        report.residuals.push(error);
        report.stop_reason = loop {
            if error <= report.tolerance {
                break StopReason::Converged;
            }
            if report.iterations >= self.options.iteration_limit() {
                break StopReason::IterationLimit;
            }
            self.control.step(Stage::Flow, progress(first, error, report.tolerance))?;
            match self.options.gradient.step {
                StepRule::Fixed(h) => step = h,
                StepRule::BarzilaiBorwein if report.iterations > 0 => {}
                _ => step = timed(&mut report.seconds.assemble, || self.stable_step(&state)),
            }
            let mut h = step;
            let mut accepted = None;
            for _ in 0..HALVINGS {
                self.control.check()?;
                trial.set_step(&state, h, &direction);
                if timed(&mut report.seconds.assemble, || self.settle(&mut trial, area)) {
                    let now = trial.residual(self.target, self.pinned, &mut next_direction);
                    if now <= GROWTH * error {
                        accepted = Some(now);
                        break;
                    }
                }
                h *= 0.5;
            }
            let Some(now) = accepted else { break StopReason::Stalled };
            let (mut ss, mut sy, mut yy) = (0.0, 0.0, 0.0);
            for v in 0..n {
                let s = trial.u[v.into()] - state.u[v.into()];
                energy -= 0.5 * s * (direction[v] + next_direction[v]);
                ss += s * s;
                let y = direction[v] - next_direction[v];
                sy += s * y;
                yy += y * y;
            }
            // Barzilai–Borwein's long and short step in turn; no curvature along the step (a straight energy): keep it.
            step = match report.iterations % 2 {
                _ if sy <= 0.0 || ss <= 0.0 => h,
                0 => ss / sy,
                _ => sy / yy,
            };
            std::mem::swap(&mut state, &mut trial);
            std::mem::swap(&mut direction, &mut next_direction);
            error = now;
            report.iterations += 1;
            report.residuals.push(error);
            report.trace.push(self.row(&state, report.iterations, energy, error, h));
        };
        report.max_curvature_error = error;
        Ok(state)
    }

    fn row(&self, state: &State, step: usize, energy: f64, error: f64, step_size: f64) -> TraceRow {
        let area = state.area(self.mesh, self.class);
        TraceRow { step, energy, max_curvature_error: error, area, step_size }
    }

    /// The explicit scheme is stable for h < 2/λ_max, and λ_max ≤ 2 max_i Σ |w| c(l) (Gershgorin).
    fn stable_step(&self, state: &State) -> f64 {
        let space = self.class.space;
        let mut row = vec![0.0; self.mesh.n_vertices()];
        for f in self.mesh.faces() {
            let weights = state.weights[f.index()];
            for (h, (w, e)) in self
                .mesh
                .face_halfedges(f)
                .into_iter()
                .zip(weights.into_iter().zip(self.mesh.opposite_edges(f)))
            {
                let c = 1.0 - 2.0 * space.curvature() * state.edges[e.index()].q2;
                let side = self.mesh.next(h);
                row[self.mesh.origin(side).index()] += w.abs() * c;
                row[self.mesh.tip(side).index()] += w.abs() * c;
            }
        }
        1.0 / row.into_iter().fold(f64::MIN_POSITIVE, f64::max)
    }

    /// Evaluate `state.u`, after bringing it to the total area `area` (if given) by a constant.
    pub(super) fn settle(&self, state: &mut State, area: Option<f64>) -> bool {
        if area.is_none() && self.free_scale {
            state.center();
        }
        if !state.evaluate(self.mesh, self.class) {
            return false;
        }
        let Some(area) = area else { return state.area(self.mesh, self.class).is_finite() };
        // Area grows as e^{2u} (exactly in E²): a fixed point that contracts fast on the sphere too.
        for _ in 0..RESCALINGS {
            let now = state.area(self.mesh, self.class);
            let mut shift = 0.5 * (area / now).ln();
            if !shift.is_finite() {
                return false;
            }
            if shift.abs() <= 4.0 * f64::EPSILON {
                return true;
            }
            state.shift(shift);
            // Near the largest spherical metric of the class the area grows faster: come back half the way.
            while !state.evaluate(self.mesh, self.class) {
                shift *= 0.5;
                if shift.abs() <= 4.0 * f64::EPSILON {
                    return false;
                }
                state.shift(-shift);
            }
        }
        true
    }
}

/// Steps of the area's fixed point: one in E², where it is exact; linear convergence in S².
const RESCALINGS: usize = 20;
