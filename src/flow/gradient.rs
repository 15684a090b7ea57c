//! The gradient flow `du/dt = K̄ − K`, explicit in time [JKLLG08, Eqn 16].
//!
//! The energy `∫ Σ (K − K̄) du` falls at every step (except with plain Barzilai–Borwein steps): a step after which it would not have fallen
//! enough is shortened [Arm66]. The change of the energy along a step is computed as the integral of the slope, not as a difference of two
//! energies, so it keeps its digits near the solution. The integral is formed by the trapezoidal rule with its Euler–Maclaurin correction.

use super::Flow;
use super::evaluate::FlowState;
use super::newton::progress;
use super::options::StepRule;
use super::report::{Report, StopReason, TraceRow};
use super::seconds::timed;
use crate::control::{Control, Stage};
use crate::error::Result;
use crate::geometry::Space;
use crate::mesh::{EdgeId, FaceId, VertexId};

/// Largest factor by which a Barzilai–Borwein step may raise the largest residual (such steps are not monotone); a step that
/// raises it more is halved.
const GROWTH: f64 = 10.0;
/// Times that a step is shortened before the flow counts as stalled.
const SHORTENINGS: usize = 60;
/// Least fall of the energy, as a share of the fall that its slope at the start of the step promises: the usual constant of Armijo's rule.
const LEAST_FALL: f64 = 1e-4;
/// Least and largest factor by which a step is shortened at a time.
const SHORTER: [f64; 2] = [0.1, 0.5];

/// Largest number of rescalings until a metric has the area that is kept: one is exact in E², and in S² they converge linearly.
const RESCALINGS: usize = 20;
/// Largest shift of u still missing after the last rescaling: far below the tolerance of flows.
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
    /// The change of the energy from `state` to `trial`.
    energy_change: EnergyChange,
    /// The total area that is kept, if any.
    area: Option<f64>,
    /// `∫ Σ (K − K̄) du` up to `state`.
    energy: f64,
}

/// The change of the energy along a change `s` of u, from its slopes and second derivatives at both ends.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct EnergyChange {
    /// `(K − K̄)·s` at the start and at the end.
    slopes: [f64; 2],
    /// `sᵀ (∂K/∂u) s` at the start and at the end.
    second_derivatives: [f64; 2],
}

impl EnergyChange {
    /// The correction of the trapezoidal rule; its size is taken as the bound on the error of `estimate`.
    fn correction(&self) -> f64 {
        (self.second_derivatives[1] - self.second_derivatives[0]) / 12.0
    }

    fn estimate(&self) -> f64 {
        0.5 * (self.slopes[0] + self.slopes[1]) - self.correction()
    }

    /// True if the energy falls by enough, even if the estimate is off by the whole correction.
    fn is_enough(&self) -> bool {
        self.estimate() + self.correction().abs() <= LEAST_FALL * self.slopes[0]
    }

    /// The share of the step to try next: up to the lowest point of a parabola with these slopes.
    fn shorter(&self) -> f64 {
        let lowest = self.slopes[0] / (self.slopes[0] - self.slopes[1]);
        if lowest.is_finite() { lowest.clamp(SHORTER[0], SHORTER[1]) } else { SHORTER[1] }
    }
}

impl Flow {
    /// Runs the gradient flow from a state to the tolerance or to another reason to stop, and returns the last state. The first step is
    /// [`Flow::stable_step`]; later ones start from Barzilai–Borwein's length, with [`StepRule::Stable`] from that of the state, and fixed
    /// ones from h. All but [`StepRule::BarzilaiBorwein`] are shortened until the energy falls.
    pub(super) fn run_gradient_flow(
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
        // Steps are compared at one area, so the flow starts at it, if the class has such a metric.
        let mut at_area = state.clone();
        let state = if area.is_some() && self.evaluate_at_area(&mut at_area, area) { at_area } else { state };
        let [mut direction, next_direction] = [(); 2].map(|()| vec![0.0; self.mesh.n_vertices()]);
        let first = state.residual(&self.target, &self.pinned, &mut direction);
        let trial = FlowState::new(&self.start, &self.start_low);
        let (error, next_error, energy) = (first, first, 0.0);
        let energy_change = EnergyChange::default();
        let mut step = GradientStep {
            state,
            trial,
            direction,
            next_direction,
            error,
            next_error,
            energy_change,
            area,
            energy,
        };
        let mut next_size = 0.0;
        self.note(&step, next_size, report);
        report.stop_reason = loop {
            if step.error <= report.tolerance {
                break StopReason::Converged;
            }
            if report.iterations >= self.options.iteration_limit() {
                break StopReason::IterationLimit;
            }
            control.step(Stage::Flow, progress(first, step.error, report.tolerance))?;
            match self.options.gradient.step {
                StepRule::Fixed(h) => next_size = h,
                StepRule::Armijo | StepRule::BarzilaiBorwein if report.iterations > 0 => {}
                _ => next_size = timed(&mut report.seconds.assemble, || self.stable_step(&step.state)),
            }
            let Some(h) = self.take_step(&mut step, next_size, report, control)? else {
                break StopReason::Stalled;
            };
            next_size = step.finish(h, report.iterations);
            report.iterations += 1;
            self.note(&step, h, report);
        };
        report.max_curvature_error = step.error;
        Ok(step.state)
    }

    /// Goes `h` along the direction of a step, or less far, until the energy has fallen enough there (with Barzilai–Borwein steps: until the
    /// error is not much larger). Returns the step size, or none if no trial fits.
    fn take_step(
        &self,
        step: &mut GradientStep,
        mut h: f64,
        report: &mut Report,
        control: &Control,
    ) -> Result<Option<f64>> {
        let falls = self.options.gradient.step != StepRule::BarzilaiBorwein;
        for _ in 0..SHORTENINGS {
            control.check()?;
            step.trial.set_step(&step.state, h, &step.direction);
            let mut shorter = 0.5;
            if timed(&mut report.seconds.assemble, || self.evaluate_at_area(&mut step.trial, step.area)) {
                step.next_error = step.trial.residual(&self.target, &self.pinned, &mut step.next_direction);
                step.energy_change = timed(&mut report.seconds.assemble, || self.energy_change(step));
                let fits = if falls {
                    step.energy_change.is_enough()
                } else {
                    step.next_error <= GROWTH * step.error
                };
                if fits {
                    return Ok(Some(h));
                }
                if falls {
                    shorter = step.energy_change.shorter();
                }
            }
            h *= shorter;
        }
        Ok(None)
    }

    /// The change of the energy from the start of a step to its trial.
    fn energy_change(&self, step: &GradientStep) -> EnergyChange {
        let change = step.change_of_u();
        let slope = |direction: &[f64]| -change.iter().zip(direction).map(|(s, d)| s * d).sum::<f64>();
        EnergyChange {
            slopes: [slope(&step.direction), slope(&step.next_direction)],
            second_derivatives: [&step.state, &step.trial]
                .map(|state| self.second_derivative(state, &change)),
        }
    }

    /// `sᵀ (∂K/∂u) s` at a state for a `change` s of u ([`super::jacobian`]); the faces that are broken there add nothing.
    fn second_derivative(&self, state: &FlowState, change: &[f64]) -> f64 {
        let twice = 2.0 * self.metric.space.curvature();
        let of_face = |f: FaceId| {
            let sides = self.mesh.opposite_edges(f).into_iter().zip(state.weights[f.index()]);
            let of_side = |(e, w): (EdgeId, f64)| {
                let [a, b] = self.mesh.ends(e).map(|v| change[v.index()]);
                w * ((a - b) * (a - b) - twice * state.squared_chord(e) * (a * a + b * b))
            };
            sides.map(of_side).sum::<f64>()
        };
        self.mesh.faces().map(of_face).sum()
    }

    /// Adds the current state to the report; `step_size` led to it.
    fn note(&self, step: &GradientStep, step_size: f64, report: &mut Report) {
        let area = step.state.area(&self.mesh, &self.metric);
        let (iteration, energy, max_curvature_error) = (report.iterations, step.energy, step.error);
        report.residuals.push(max_curvature_error);
        report.trace.push(TraceRow { step: iteration, energy, max_curvature_error, area, step_size });
    }

    /// The explicit scheme is stable for h < 2/λ_max. By Gershgorin `λ_max ≤ max_i Σ |w| (1 + |c(l)|)` with c(l) = 1, cos l, cosh l, since
    /// the diagonal entries of ∂K/∂u are sums of w c and the others of −w. In H², where c ≥ 1, the larger bound `2 Σ |w| c` is taken.
    fn stable_step(&self, state: &FlowState) -> f64 {
        let space = self.metric.space;
        let mut row = vec![0.0; self.mesh.n_vertices()];
        for f in self.mesh.faces() {
            let weights = state.weights[f.index()];
            for (h, w) in self.mesh.face_halfedges(f).into_iter().zip(weights) {
                let side = self.mesh.next(h);
                let c = 1.0 - 2.0 * space.curvature() * state.squared_chord(side.edge());
                // Half of the bound, which is 1 in E².
                let share = if space == Space::S2 { 0.5 * (1.0 + c.abs()) } else { c };
                row[self.mesh.origin(side).index()] += w.abs() * share;
                row[self.mesh.tip(side).index()] += w.abs() * share;
            }
        }
        1.0 / row.into_iter().fold(f64::MIN_POSITIVE, f64::max)
    }

    /// Evaluates `state.u`; then shifts it by a constant until the area is `area`, or, with a free scale and no area, centres it before.
    /// False where there is no such metric.
    pub(super) fn evaluate_at_area(&self, state: &mut FlowState, area: Option<f64>) -> bool {
        if area.is_none() && self.free_scale() {
            state.centre();
        }
        if !state.evaluate(&self.mesh, &self.metric) {
            return false;
        }
        let Some(area) = area else { return state.has_finite_area(&self.mesh, &self.metric) };
        // Shift by ½ log(wanted/actual): exact in E², a fast contraction in S².
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
    /// The change of u from the start to the trial. Near the solution it may be smaller than the rounding of u, so the low-order parts of u
    /// are added.
    fn change_of_u(&self) -> Vec<f64> {
        let change = |v: usize| {
            let v = VertexId::from(v);
            (self.trial.u[v] - self.state.u[v]) + (self.trial.low[v] - self.state.low[v])
        };
        (0..self.direction.len()).map(change).collect()
    }

    /// Lets the next step start at the end of this one, of size `h`, and adds the change of the energy. Returns the next step size to try:
    /// Barzilai–Borwein's long and short step in turn \[BB88\], or `h` again where the energy is not convex along the step.
    fn finish(&mut self, h: f64, iteration: usize) -> f64 {
        let (mut ss, mut sy, mut yy) = (0.0, 0.0, 0.0);
        for (v, s) in self.change_of_u().into_iter().enumerate() {
            ss += s * s;
            let y = self.direction[v] - self.next_direction[v];
            sy += s * y;
            yy += y * y;
        }
        self.energy += self.energy_change.estimate();
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

#[cfg(test)]
mod tests {
    use super::*;

    /// The energy e^x − x along a step from a to b, where its slope and second derivative are e^x − 1 and e^x.
    fn along(a: f64, b: f64) -> EnergyChange {
        let s = b - a;
        EnergyChange {
            slopes: [a, b].map(|x| s * x.exp_m1()),
            second_derivatives: [a, b].map(|x| s * s * x.exp()),
        }
    }

    #[test]
    fn the_change_of_the_energy_is_known_to_the_fifth_power_of_the_step() {
        let exact = |a: f64, b: f64| (b.exp() - b) - (a.exp() - a);
        for step in [0.8, 0.4, 0.2] {
            let off = (along(-1.0, -1.0 + step).estimate() - exact(-1.0, -1.0 + step)).abs();
            // The integral of a function f has the error h⁵ f⁗/720.
            assert!(off < step.powi(5) / 720.0, "{step}: {off:e}");
        }
        // Near the lowest point the change is far below the rounding of the energy itself, which is about 1.
        let near = along(-2e-10, 1e-10).estimate();
        assert!((near + 1.5e-20).abs() < 1e-28, "{near:e}");
    }

    #[test]
    fn steps_beyond_twice_the_distance_to_the_minimum_are_shortened() {
        assert!(along(-0.1, 0.05).is_enough());
        assert!(!along(-0.1, 0.11).is_enough());
        assert!(!along(-0.1, 3.0).is_enough());
        let t = along(-0.1, 0.11).shorter();
        assert!((0.4..=0.5).contains(&t), "{t}");
        assert_eq!(along(-0.1, 9.0).shorter(), SHORTER[0]);
    }
}
