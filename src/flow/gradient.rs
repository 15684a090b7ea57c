//! The gradient flow `du/dt = K̄ − K`, explicit in time [JKLLG08, Eqn 16].

use super::Flow;
use super::evaluate::FlowState;
use super::newton::progress;
use super::options::StepRule;
use super::report::{Report, StopReason, TraceRow};
use super::seconds::timed;
use crate::control::{Control, Stage};
use crate::error::Result;
use crate::geometry::Space;

/// Largest factor by which a step may raise the largest residual; a longer step is halved (Barzilai–Borwein steps are not monotone).
const GROWTH: f64 = 10.0;
/// Halvings before the flow counts as stalled.
const HALVINGS: usize = 60;

/// Largest number of rescalings until a metric has the area that is kept: one is exact in E², and in S² they converge linearly.
const RESCALINGS: usize = 20;
/// Half the relative error of the area that is accepted after the last rescaling: far below the tolerance of flows.
const AREA_REACHED: f64 = 1e-12;

/// A step of the gradient flow: its start and its end.
struct GradientStep {
    state: FlowState,
    trial: FlowState,
    /// K̄ − K at `state`: the direction of the flow.
    direction: Vec<f64>,
    /// K̄ − K at `trial`.
    next_direction: Vec<f64>,
    /// Largest |K̄ − K| at `state`, and at `trial`.
    error: f64,
    next_error: f64,
    /// The total area that is kept, if any.
    area: Option<f64>,
    /// `∫ Σ (K − K̄) du` up to `state`.
    energy: f64,
}

impl Flow {
    pub(super) fn gradient(
        &self,
        state: FlowState,
        report: &mut Report,
        control: &Control,
    ) -> Result<FlowState> {
        // The area is kept by adding a constant to u, which pinned vertices do not allow.
        let area = match self.metric.space {
            _ if self.has_pins() => None,
            Space::S2 => Some(self.spherical_area()),
            Space::E2 if self.options.gradient.area_normalised => Some(state.area(&self.mesh, &self.metric)),
            _ => None,
        };
        let [mut direction, next_direction] = [(); 2].map(|()| vec![0.0; self.mesh.n_vertices()]);
        let first = state.residual(&self.target, &self.pinned, &mut direction);
        let trial = FlowState::new(&self.start, &self.start_low);
        let (error, next_error, energy) = (first, first, 0.0);
        let mut leg =
            GradientStep { state, trial, direction, next_direction, error, next_error, area, energy };
        let mut step = 0.0;
        self.note(&leg, step, report);
        report.stop_reason = loop {
            if leg.error <= report.tolerance {
                break StopReason::Converged;
            }
            if report.iterations >= self.options.iteration_limit() {
                break StopReason::IterationLimit;
            }
            control.step(Stage::Flow, progress(first, leg.error, report.tolerance))?;
            match self.options.gradient.step {
                StepRule::Fixed(h) => step = h,
                StepRule::BarzilaiBorwein if report.iterations > 0 => {}
                _ => step = timed(&mut report.seconds.assemble, || self.stable_step(&leg.state)),
            }
            let Some(h) = self.go(&mut leg, step, report, control)? else { break StopReason::Stalled };
            step = leg.finish(h, report.iterations);
            report.iterations += 1;
            self.note(&leg, h, report);
        };
        report.max_curvature_error = leg.error;
        Ok(leg.state)
    }

    /// Go `h` along the direction of a leg, or half as far, and so on, until the error there is not much larger. Returns the step size, or
    /// none if the error grows along every step.
    fn go(
        &self,
        leg: &mut GradientStep,
        mut h: f64,
        report: &mut Report,
        control: &Control,
    ) -> Result<Option<f64>> {
        for _ in 0..HALVINGS {
            control.check()?;
            leg.trial.set_step(&leg.state, h, &leg.direction);
            if timed(&mut report.seconds.assemble, || self.settle(&mut leg.trial, leg.area)) {
                leg.next_error = leg.trial.residual(&self.target, &self.pinned, &mut leg.next_direction);
                if leg.next_error <= GROWTH * leg.error {
                    return Ok(Some(h));
                }
            }
            h *= 0.5;
        }
        Ok(None)
    }

    /// Report the start of a leg, to which a step of this size has led.
    fn note(&self, leg: &GradientStep, step_size: f64, report: &mut Report) {
        let area = leg.state.area(&self.mesh, &self.metric);
        let (step, energy, max_curvature_error) = (report.iterations, leg.energy, leg.error);
        report.residuals.push(max_curvature_error);
        report.trace.push(TraceRow { step, energy, max_curvature_error, area, step_size });
    }

    /// The explicit scheme is stable for h < 2/λ_max, and λ_max ≤ 2 max_i Σ |w| c(l) (Gershgorin).
    fn stable_step(&self, state: &FlowState) -> f64 {
        let space = self.metric.space;
        let mut row = vec![0.0; self.mesh.n_vertices()];
        for f in self.mesh.faces() {
            let weights = state.weights[f.index()];
            for (h, w) in self.mesh.face_halfedges(f).into_iter().zip(weights) {
                let side = self.mesh.next(h);
                let c = 1.0 - 2.0 * space.curvature() * state.squared_chord(side.edge());
                row[self.mesh.origin(side).index()] += w.abs() * c;
                row[self.mesh.tip(side).index()] += w.abs() * c;
            }
        }
        1.0 / row.into_iter().fold(f64::MIN_POSITIVE, f64::max)
    }

    /// Evaluate `state.u`, after bringing it to the total area `area` (if given) by a constant; false where there is no such metric.
    pub(super) fn settle(&self, state: &mut FlowState, area: Option<f64>) -> bool {
        if area.is_none() && self.free_scale() {
            state.center();
        }
        if !state.evaluate(&self.mesh, &self.metric) {
            return false;
        }
        let Some(area) = area else { return state.has_finite_area(&self.mesh, &self.metric) };
        // Area grows as e^{2u} (exactly in E²): a fixed point that contracts fast on the sphere too.
        let missing = |state: &FlowState| 0.5 * (area / state.area(&self.mesh, &self.metric)).ln();
        for _ in 0..RESCALINGS {
            let mut shift = missing(state);
            if !shift.is_finite() {
                return false;
            }
            if shift.abs() <= 4.0 * f64::EPSILON {
                return true;
            }
            state.shift(shift);
            // Near the largest spherical metric of the class the area grows faster, and the shift may leave the domain: go back half the way.
            while !state.evaluate(&self.mesh, &self.metric) {
                shift *= 0.5;
                if shift.abs() <= 4.0 * f64::EPSILON {
                    return false;
                }
                state.shift(-shift);
            }
        }
        missing(state).abs() <= AREA_REACHED
    }
}

impl GradientStep {
    /// Let the next leg start at the end of this one, of size `h`, and add the change of the energy (trapezoidal rule). Returns the next
    /// step size: Barzilai–Borwein's long and short step in turn \[BB88\], or `h` again where the energy is straight along the leg.
    fn finish(&mut self, h: f64, iteration: usize) -> f64 {
        let (mut ss, mut sy, mut yy) = (0.0, 0.0, 0.0);
        for v in 0..self.direction.len() {
            let s = self.trial.u[v.into()] - self.state.u[v.into()];
            self.energy -= 0.5 * s * (self.direction[v] + self.next_direction[v]);
            ss += s * s;
            let y = self.direction[v] - self.next_direction[v];
            sy += s * y;
            yy += y * y;
        }
        std::mem::swap(&mut self.state, &mut self.trial);
        std::mem::swap(&mut self.direction, &mut self.next_direction);
        self.error = self.next_error;
        match iteration % 2 {
            _ if sy <= 0.0 || ss <= 0.0 => h,
            0 => ss / sy,
            _ => sy / yy,
        }
    }
}
