//! Newton's method on the convex energy (E², H²): full steps with a line search on the slope.
//!
//! The first matrix is factorised. Later ones differ little from it, since a conformal change of the metric hardly changes the cotangents:
//! their steps come from conjugate gradients with that factor as preconditioner, as exactly as quadratic convergence asks. Flips change the
//! pattern of the matrix but not its unknowns, so the factor serves on. Where it does not serve well the matrix is factorised anew.

use super::Flow;
use super::evaluate::FlowState;
use super::line_search::LineSearch;
use super::memory::SolveMemory;
use super::report::{Report, StopReason};
use super::solve::MethodEnd;
use crate::control::{Control, Stage};
use crate::error::Result;
use crate::geometry::double_double::MAX_EXPONENT;
use crate::geometry::{Space, largest, worse};
use crate::metric::delaunay::boundary_fails;

/// Relative change of the residual, at unchanged u, above which a failed line search is repeated: flipping an edge and back rounds η,
/// which on needle triangles moves the residual, so that the search started from a wrong one.
const MOVED_BY_FLIPS: f64 = 1e-3;
/// Repetitions of that in one solve, at most.
const RESTARTS: usize = 20;
/// A stalled residual within this factor of the estimated rounding floor is at the floor: the estimate counts every rounding once.
const FLOOR_SLACK: f64 = 8.0;
/// Radians. A larger estimate of the rounding floor comes from a degenerating triangle and is not accepted.
const MAX_FLOOR: f64 = 1e-7;
/// Iterations without a new best residual (by a tenth) after which a residual below [`QUADRATIC`] counts as stalled: Newton's method
/// converges quadratically there, so that only rounding is left. (Farther out the maximum norm proves nothing.)
const PATIENCE: usize = 8;
/// Radians. Below this residual convergence is quadratic.
const QUADRATIC: f64 = 1e-8;

/// Number of steps over which the rate is measured at which proposed steps become shorter. At needles each is shorter by a share, on the
/// way to a far metric by about the length of the step taken.
const SETTLING_STEPS: usize = 20;

/// The state of a Newton solve between its steps.
pub(super) struct Iterate {
    pub state: FlowState,
    /// The state at the end of a step that is tried.
    pub trial: FlowState,
    /// K̄ − K at `state`.
    pub residual: Vec<f64>,
    /// The same at the end of a step that is tried.
    next_residual: Vec<f64>,
    pub step: Vec<f64>,
    /// Largest residual.
    pub error: f64,
    /// The shift of the last matrix.
    pub shift: f64,
    /// Least error so far, but for the last tenth, and the steps since.
    best: f64,
    since_best: usize,
    /// Of the present row of steps that were too long for the remaining iterations, the length of the first, and their number.
    too_long: (f64, usize),
    /// Flips in this solve when the last direction was found; none before the first one, and where the last one was not found.
    pub(super) solved_at: Option<usize>,
    /// The error before the last step.
    pub(super) last_error: f64,
    /// Steps that an earlier factor has failed to solve in a row, and the iteration from which on it is tried again.
    pub(super) misses: (u32, usize),
}

/// The next action of a solve.
enum NextStep {
    Step,
    Stop(StopReason),
    /// Leave the one copy of a surface with boundary, whose double would flip a boundary edge.
    Leave,
}

impl Iterate {
    pub fn new(flow: &mut Flow, state: FlowState) -> Iterate {
        let n = flow.mesh.n_vertices();
        let [mut residual, next_residual, step] = [(); 3].map(|()| flow.memory.zeros(n));
        let error = state.residual(&flow.target, &flow.pinned, &mut residual);
        let trial = flow.memory.state(&flow.start, &flow.start_low);
        let (shift, best, since_best, too_long) = (0.0, error, 0, (0.0, 0));
        let (solved_at, last_error, misses) = (None, error, (0, 0));
        Iterate {
            state,
            trial,
            residual,
            next_residual,
            step,
            error,
            shift,
            best,
            since_best,
            too_long,
            solved_at,
            last_error,
            misses,
        }
    }

    /// The state; the memory of the rest goes back to `memory`.
    pub fn end(self, memory: &mut SolveMemory) -> FlowState {
        memory.take_back(self.trial);
        memory.take_back_vectors([self.residual, self.next_residual, self.step]);
        self.state
    }

    /// True if the matrix is to be taken as it is.
    pub(super) fn is_sound(&self) -> bool {
        self.shift == 0.0 && self.state.broken() == 0
    }

    /// Count the step that has led here; true if there have been too many without a better residual.
    fn is_out_of_patience(&mut self) -> bool {
        self.since_best += 1;
        if self.error < 0.9 * self.best {
            (self.best, self.since_best) = (self.error, 0);
        }
        self.since_best >= PATIENCE && self.error < QUADRATIC
    }
}

impl Flow {
    pub(super) fn newton(
        &mut self,
        state: FlowState,
        report: &mut Report,
        control: &Control,
    ) -> Result<MethodEnd> {
        let mut at = Iterate::new(self, state);
        report.residuals.push(at.error);
        control.step(Stage::Flow, 0.0)?;
        let Some(reason) = self.iterate(&mut at, report, control)? else {
            report.max_curvature_error = at.error;
            return Ok(MethodEnd { state: at.end(&mut self.memory), left: true });
        };
        report.stop_reason = reason;
        // A step within bounds may begin where another one has ended, at the tolerance. Polishing needs a factor, which it has not yet.
        let begins_at_end = self.is_bounded && report.iterations == 0 && at.error > self.polished();
        if begins_at_end && report.stop_reason == StopReason::Converged {
            self.direction(&mut at, report, control)?;
        }
        let far = matches!(report.stop_reason, StopReason::IterationLimit | StopReason::OutOfReach { .. });
        let is_solved = at.solved_at == Some(report.flips);
        let is_near = is_solved || (at.solved_at.is_some() && at.state.is_measured());
        if is_near && !far && at.error > self.polished() {
            let mut system = self.take_system(report)?;
            if !is_solved {
                // The last step has led to another triangulation, whose matrix the factor serves too.
                self.assemble(&mut system, &at.state, report);
            }
            self.system = Some(self.polish(system, &mut at, report, control)?);
        }
        if !at.state.is_measured() {
            // The last point that was tried was not taken, so go back to the triangulation of the one before.
            self.evaluate(&mut at.state, report, control)?;
            at.error = at.state.residual(&self.target, &self.pinned, &mut at.residual);
            if report.stop_reason == StopReason::Converged && at.error > report.tolerance {
                report.stop_reason = StopReason::Stalled;
            }
        }
        report.max_curvature_error = at.error;
        if report.stop_reason == StopReason::Stalled {
            report.stop_reason = self.stalled(&mut at, report)?;
        }
        Ok(MethodEnd { state: at.end(&mut self.memory), left: false })
    }

    /// Steps until there is a reason to stop, or none where the flow leaves the one copy of a surface with boundary.
    fn iterate(
        &mut self,
        at: &mut Iterate,
        report: &mut Report,
        control: &Control,
    ) -> Result<Option<StopReason>> {
        let (first, mut restarts) = (at.error, 0);
        loop {
            match self.next(at, report) {
                NextStep::Step => control.step(Stage::Flow, progress(first, at.error, report.tolerance))?,
                NextStep::Stop(reason) => return Ok(Some(reason)),
                NextStep::Leave => return Ok(None),
            }
            if self.is_lopsided(at) {
                (self.mirror, self.system, at.solved_at) = (None, None, None);
            }
            if !self.direction(at, report, control)? {
                return Ok(Some(StopReason::Stalled));
            }
            if let Some(reason) = self.out_of_reach(at, report) {
                return Ok(Some(reason));
            }
            report.iterations += 1;
            if !self.step(at, report, control)? {
                if self.is_moved_by_flips(at, report, control)? && restarts < RESTARTS {
                    restarts += 1;
                    continue;
                }
                return Ok(Some(StopReason::Stalled));
            }
            report.residuals.push(at.error);
            let (steps, flips) = (report.iterations, report.flips);
            log::debug!("Newton step {steps}: max |K − K̄| = {:.3e}, {flips} flips", at.error);
            if at.is_out_of_patience() {
                return Ok(Some(StopReason::Stalled));
            }
        }
    }

    /// The next action: a step, or a reason to stop or to leave the copy.
    fn next(&self, at: &Iterate, report: &Report) -> NextStep {
        let at_limit = report.iterations >= self.options.iteration_limit();
        let leaves = || boundary_fails(&self.mesh, &self.metric, &at.state.u, &self.fixed);
        let most = MAX_EXPONENT - self.options.max_step;
        if self.one_copy && !at_limit && leaves() {
            NextStep::Leave
        } else if at.error <= report.tolerance {
            NextStep::Stop(StopReason::Converged)
        } else if self.metric.space == Space::E2 && largest(at.state.u.iter()) > most {
            NextStep::Stop(StopReason::Diverged)
        } else if at_limit {
            NextStep::Stop(StopReason::IterationLimit)
        } else {
            NextStep::Step
        }
    }

    /// The reason to stop if the proposed step is longer than all remaining steps together, and becomes shorter too slowly to be reached
    /// before the iteration limit. In the second half of the iterations it is too late to save time.
    fn out_of_reach(&self, at: &mut Iterate, report: &Report) -> Option<StopReason> {
        let (step, limit) = (largest(&at.step), self.options.iteration_limit());
        let left = (limit - report.iterations) as f64;
        if step <= self.options.max_step * left || 2.0 * left <= limit as f64 {
            at.too_long = (step, 0);
            return None;
        }
        let (first, steps) = at.too_long;
        if steps == 0 {
            at.too_long.0 = step;
        }
        at.too_long.1 += 1;
        let shorter = (first - step) * left / steps as f64;
        (steps >= SETTLING_STEPS && step > shorter).then_some(StopReason::OutOfReach { step })
    }

    /// Go back to a Delaunay triangulation of the last metric after a search that found nothing. Returns true if the residual there has
    /// changed so much that the search is worth repeating.
    fn is_moved_by_flips(
        &mut self,
        at: &mut Iterate,
        report: &mut Report,
        control: &Control,
    ) -> Result<bool> {
        let before = at.residual.clone();
        self.evaluate(&mut at.state, report, control)?;
        at.error = at.state.residual(&self.target, &self.pinned, &mut at.residual);
        let moved = before.iter().zip(&at.residual).map(|(a, b)| (a - b).abs()).fold(0.0, worse);
        Ok(moved > MOVED_BY_FLIPS * at.error)
    }

    /// Take the step of `at` as far as the line search goes; false, and `at.residual` as it was, where it finds nothing.
    fn step(&mut self, at: &mut Iterate, report: &mut Report, control: &Control) -> Result<bool> {
        at.state.hand_on(&mut at.trial);
        let Iterate { state, trial, step, error, residual, next_residual, .. } = at;
        let mut search = LineSearch::new(step, residual, self.options.max_step, *error);
        while let Some(t) = search.next() {
            control.check()?;
            trial.set_step(state, t, step);
            let real = self.evaluate(trial, report, control)?;
            let now = real.then(|| trial.residual(&self.target, &self.pinned, next_residual));
            if search.accepts(now, next_residual) {
                std::mem::swap(state, trial);
                std::mem::swap(residual, next_residual);
                at.last_error = at.error;
                at.error = now.unwrap_or(f64::INFINITY);
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// The stop reason of a flow that no step takes further.
    fn stalled(&mut self, at: &mut Iterate, report: &mut Report) -> Result<StopReason> {
        if at.error <= report.tolerance {
            return Ok(StopReason::Converged);
        }
        let mut system = self.take_system(report)?;
        self.assemble(&mut system, &at.state, report);
        at.state.residual(&self.target, &self.pinned, &mut at.residual);
        let floor = system.jacobian.rounding_floor(&self.mesh, &self.metric, &at.state);
        self.system = Some(system);
        let most = largest(&floor);
        report.rounding_floor = Some(most);
        let is_rounding = |(r, floor): (&f64, &f64)| r.abs() <= FLOOR_SLACK * floor;
        let size = FLOOR_SLACK * most;
        let at_floor = size <= MAX_FLOOR && at.residual.iter().zip(&floor).all(is_rounding);
        Ok(if at_floor { StopReason::RoundingFloor { size } } else { StopReason::Stalled })
    }

    /// True if most of the remaining error differs between mirror images: flips in another order round η differently, which symmetric steps
    /// cannot correct.
    fn is_lopsided(&self, at: &Iterate) -> bool {
        let Some(mirror) = &self.mirror else { return false };
        let even = |(r, &image): (&f64, &u32)| 0.5 * (r + at.residual[image as usize]).abs();
        at.residual.iter().zip(mirror).map(even).fold(0.0, worse) < 0.5 * at.error
    }
}

/// Fraction of the way from `first` to `goal` on a logarithmic scale.
pub(super) fn progress(first: f64, now: f64, goal: f64) -> f64 {
    if first > goal && now > 0.0 { (first / now).ln() / (first / goal).ln() } else { 1.0 }
}
