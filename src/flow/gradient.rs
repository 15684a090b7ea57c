//! The gradient flow `du/dt = K̄ − K`, explicit in time [JKLLG08, Eqn 16].
//!
//! The energy `∫ Σ (K − K̄) du` falls at every step (except with plain Barzilai–Borwein steps): a step after which it would not have fallen
//! enough is shortened [Arm66]. The change of the energy along a step is small near the solution, but it is no difference of large numbers: it
//! is the integral of the slope, by the trapezoidal rule with its Euler–Maclaurin correction.

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

/// Largest factor by which a Barzilai–Borwein step may raise the largest residual (such steps are not monotone); a longer step is halved.
const GROWTH: f64 = 10.0;
/// Times that a step is shortened before the flow counts as stalled.
const SHORTENINGS: usize = 60;
/// Least fall of the energy, as a share of the fall that its slope at the start of the step promises: the usual constant of Armijo's rule.
const LEAST_FALL: f64 = 1e-4;
/// Least and largest factor by which a step is shortened at a time.
const SHORTER: [f64; 2] = [0.1, 0.5];

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
    /// The change of the energy from `state` to `trial`.
    fall: EnergyChange,
    /// The total area that is kept, if any.
    area: Option<f64>,
    /// `∫ Σ (K − K̄) du` up to `state`.
    energy: f64,
}

/// The change of the energy along a step `s` of u, from its slopes and curvatures at both ends.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct EnergyChange {
    /// `(K − K̄)·s` at the start and at the end.
    slopes: [f64; 2],
    /// `sᵀ (∂K/∂u) s` at the start and at the end.
    curvatures: [f64; 2],
}

impl EnergyChange {
    /// The correction of the trapezoidal rule, which also bounds its error where the energy is smooth along the step.
    fn correction(&self) -> f64 {
        (self.curvatures[1] - self.curvatures[0]) / 12.0
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
        let (error, next_error, energy, fall) = (first, first, 0.0, EnergyChange::default());
        let mut leg =
            GradientStep { state, trial, direction, next_direction, error, next_error, fall, area, energy };
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
                StepRule::Armijo | StepRule::BarzilaiBorwein if report.iterations > 0 => {}
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

    /// Go `h` along the direction of a leg, or less far, until the energy has fallen enough there (with Barzilai–Borwein steps: until the
    /// error is not much larger). Returns the step size, or none if that holds along no step.
    fn go(
        &self,
        leg: &mut GradientStep,
        mut h: f64,
        report: &mut Report,
        control: &Control,
    ) -> Result<Option<f64>> {
        let falls = self.options.gradient.step != StepRule::BarzilaiBorwein;
        for _ in 0..SHORTENINGS {
            control.check()?;
            leg.trial.set_step(&leg.state, h, &leg.direction);
            let mut shorter = 0.5;
            if timed(&mut report.seconds.assemble, || self.settle(&mut leg.trial, leg.area)) {
                leg.next_error = leg.trial.residual(&self.target, &self.pinned, &mut leg.next_direction);
                leg.fall = timed(&mut report.seconds.assemble, || self.energy_change(leg));
                let fits = if falls { leg.fall.is_enough() } else { leg.next_error <= GROWTH * leg.error };
                if fits {
                    return Ok(Some(h));
                }
                if falls {
                    shorter = leg.fall.shorter();
                }
            }
            h *= shorter;
        }
        Ok(None)
    }

    /// The change of the energy from the start of a leg to its trial.
    fn energy_change(&self, leg: &GradientStep) -> EnergyChange {
        let step = leg.step();
        let slope = |direction: &[f64]| -step.iter().zip(direction).map(|(s, d)| s * d).sum::<f64>();
        EnergyChange {
            slopes: [slope(&leg.direction), slope(&leg.next_direction)],
            curvatures: [&leg.state, &leg.trial].map(|state| self.second_derivative(state, &step)),
        }
    }

    /// `sᵀ (∂K/∂u) s` at a state ([`super::jacobian`]); the faces that are broken there add nothing.
    fn second_derivative(&self, state: &FlowState, step: &[f64]) -> f64 {
        let twice = 2.0 * self.metric.space.curvature();
        let of_face = |f: FaceId| {
            let sides = self.mesh.opposite_edges(f).into_iter().zip(state.weights[f.index()]);
            let of_side = |(e, w): (EdgeId, f64)| {
                let [a, b] = self.mesh.ends(e).map(|v| step[v.index()]);
                w * ((a - b) * (a - b) - twice * state.squared_chord(e) * (a * a + b * b))
            };
            sides.map(of_side).sum::<f64>()
        };
        self.mesh.faces().map(of_face).sum()
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
    /// The change of u from the start to the trial. Near the solution it may be smaller than the rounding of u, so low parts count.
    fn step(&self) -> Vec<f64> {
        let change = |v: usize| {
            let v = VertexId::from(v);
            (self.trial.u[v] - self.state.u[v]) + (self.trial.low[v] - self.state.low[v])
        };
        (0..self.direction.len()).map(change).collect()
    }

    /// Let the next leg start at the end of this one, of size `h`, and add the change of the energy. Returns the next step size to try:
    /// Barzilai–Borwein's long and short step in turn \[BB88\], or `h` again where the energy is straight along the leg.
    fn finish(&mut self, h: f64, iteration: usize) -> f64 {
        let (mut ss, mut sy, mut yy) = (0.0, 0.0, 0.0);
        for (v, s) in self.step().into_iter().enumerate() {
            ss += s * s;
            let y = self.direction[v] - self.next_direction[v];
            sy += s * y;
            yy += y * y;
        }
        self.energy += self.fall.estimate();
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

    /// The energy e^x − x along a step from a to b, where its slope and curvature are e^x − 1 and e^x.
    fn along(a: f64, b: f64) -> EnergyChange {
        let s = b - a;
        EnergyChange { slopes: [a, b].map(|x| s * x.exp_m1()), curvatures: [a, b].map(|x| s * s * x.exp()) }
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
    fn steps_beyond_twice_the_lowest_point_are_shortened() {
        assert!(along(-0.1, 0.05).is_enough());
        assert!(!along(-0.1, 0.11).is_enough());
        assert!(!along(-0.1, 3.0).is_enough());
        let t = along(-0.1, 0.11).shorter();
        assert!((0.4..=0.5).contains(&t), "{t}");
        assert_eq!(along(-0.1, 9.0).shorter(), SHORTER[0]);
    }
}
