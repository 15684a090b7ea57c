//! Newton's method on the convex energy (E², H²): full steps with a line search on the slope.

use super::evaluate::State;
use super::report::{Report, StopReason, timed};
use super::solver::{Run, center};
use super::system::System;
use crate::control::Stage;
use crate::error::Result;
use crate::geometry::twofold::MAX_EXPONENT;
use crate::geometry::{Space, largest, worse};
use crate::metric::delaunay::boundary_fails;

/// Below this max |K − K̄| a smaller residual also accepts a step. Far from the solution only the slope does: mixing
/// the two there cycles.
const NEAR: f64 = 1e-2;
/// A convex energy that at the end of a step rises this much more slowly than it fell at its start has fallen all in all, unless its
/// slope jumps. Refusing every rise halves good steps: half of all flows then take twice as many.
const OVERSHOOT: f64 = 0.1;
/// Trials before the line search gives up: 2⁻⁵⁰ of a step is below the rounding of u.
const TRIALS: usize = 50;
/// Where vertices that are far smaller than all else have large curvature, dK/du changes within a tiny change of u, and a step meets
/// a bend of the energy that its start knows nothing of. A step that ends before the bend gains nothing, since the next one meets it
/// too; one that ends in it knows it. So the line search goes on until the slope is at most this share of that at the start …
const FLAT: f64 = 0.5;
/// … or so many more points were tried.
const BISECTIONS: usize = 10;
/// Flips there and back round η. Where triangles are so thin that this alone moves the error at one u by such a share, a search that
/// finds nothing has started from what is no longer so: it is made again, so often at most.
const MOVED: f64 = 1e-3;
const RESTARTS: usize = 20;
/// First shift of a matrix that is not positive definite, relative to its mean diagonal; grows by `SHIFT_GROWTH`.
const SHIFT: f64 = 1e-12;
const SHIFT_GROWTH: f64 = 100.0;
const SHIFT_TRIES: usize = 12;
/// The floor estimate counts every rounding once; a stalled residual within this factor of it is at the floor.
const FLOOR_SLACK: f64 = 8.0;
/// A floor above this is no floor but a degenerating triangle.
const MAX_FLOOR: f64 = 1e-7;
/// Iterations without a new best residual (by a tenth) after which a residual below `AT_THE_END` counts as stalled: Newton
/// converges quadratically there, and what does not is rounding. (Farther out the maximum norm proves nothing.)
const PATIENCE: usize = 8;
const AT_THE_END: f64 = 1e-8;
/// Once converged, the last factor is reused to bring the error down to this, each step at least halving it; in H², whose layouts magnify
/// errors by e^distance, as far as it goes.
const POLISH_TO: f64 = 1e-13;
const POLISH_STEPS: usize = 3;

impl Run<'_> {
    pub(super) fn newton(
        &mut self,
        kept: &mut Option<System>,
        mut state: State,
        report: &mut Report,
    ) -> Result<State> {
        let n = self.mesh.n_vertices();
        let [mut residual, mut before, mut step] = [(); 3].map(|()| vec![0.0; n]);
        let mut trial = State::new(self.mesh, self.start, self.start_low);
        let mut error = state.residual(self.target, self.pinned, &mut residual);
        let (first, mut best, mut since_best, mut shift, mut factored) = (error, error, 0, 0.0, false);
        report.residuals.push(error);
        self.control.step(Stage::Flow, 0.0)?;
        let (mut flipped, mut restarts) = (report.flips, 0);
        report.stop_reason = loop {
            let at_limit = report.iterations >= self.options.iteration_limit();
            let fixed = &self.options.fixed_edges;
            if self.one_copy && !at_limit && boundary_fails(self.mesh, self.class, &state.u, fixed) {
                self.left = true;
                report.max_curvature_error = error;
                return Ok(state);
            }
            if error <= report.tolerance {
                break StopReason::Converged;
            }
            if self.class.space == Space::E2 && largest(state.u.iter()) > MAX_EXPONENT - self.options.max_step
            {
                break StopReason::Diverged;
            }
            if at_limit {
                break StopReason::IterationLimit;
            }
            self.control.step(Stage::Flow, progress(first, error, report.tolerance))?;
            if self.lopsided(&residual, error) {
                (self.mirror, *kept) = (None, None);
            }
            let more = report.flips - std::mem::replace(&mut flipped, report.flips);
            let system = self.prepare(kept, more, report)?;
            timed(&mut report.seconds.assemble, || system.jacobian.assemble(self.mesh, self.class, &state));
            self.control.check()?;
            factored = self.direction(system, &state, &residual, &mut step, &mut shift, report)?;
            if !factored {
                break StopReason::Stalled;
            }
            report.iterations += 1;
            state.hand_on(&mut trial);
            before.copy_from_slice(&residual);
            let accepted = self.line_search(&state, &mut trial, &mut residual, &step, error, report)?;
            let Some(now) = accepted else {
                // Back to the triangulation of the last metric, or one of the same.
                self.evaluate(&mut state, report)?;
                error = state.residual(self.target, self.pinned, &mut residual);
                let moved = before.iter().zip(&residual).map(|(a, b)| (a - b).abs()).fold(0.0, worse);
                if moved > MOVED * error && restarts < RESTARTS {
                    restarts += 1;
                    continue;
                }
                break StopReason::Stalled;
            };
            std::mem::swap(&mut state, &mut trial);
            error = now;
            report.residuals.push(error);
            log::debug!(
                "Newton step {}: max |K − K̄| = {error:.3e}, {} flips",
                report.iterations,
                report.flips
            );
            since_best += 1;
            if error < 0.9 * best {
                (best, since_best) = (error, 0);
            }
            if since_best >= PATIENCE && error < AT_THE_END {
                break StopReason::Stalled;
            }
        };
        // A factor of another triangulation is no good, and its matrix is of another pattern.
        factored &= flipped == report.flips;
        let system = self.prepare(kept, report.flips - flipped, report)?;
        if factored && report.stop_reason != StopReason::IterationLimit && error > self.polished() {
            self.polish(system, &mut state, &mut trial, &mut residual, &mut step, report, &mut error)?;
        }
        if !state.is_measured() {
            timed(&mut report.seconds.assemble, || state.evaluate(self.mesh, self.class));
        }
        report.max_curvature_error = error;
        if report.stop_reason == StopReason::Stalled && error <= report.tolerance {
            report.stop_reason = StopReason::Converged;
        }
        if report.stop_reason == StopReason::Stalled {
            timed(&mut report.seconds.assemble, || system.jacobian.assemble(self.mesh, self.class, &state));
            state.residual(self.target, self.pinned, &mut residual);
            let floor = system.jacobian.rounding_floor(self.mesh, self.class, &state);
            let most = largest(&floor);
            report.rounding_floor = Some(most);
            let at_floor = |(r, floor): (&f64, &f64)| r.abs() <= FLOOR_SLACK * floor;
            if FLOOR_SLACK * most <= MAX_FLOOR && residual.iter().zip(&floor).all(at_floor) {
                report.stop_reason = StopReason::RoundingFloor;
                report.tolerance = FLOOR_SLACK * most;
            }
        }
        Ok(state)
    }

    /// Whether what is left of the error differs between mirror images: flips in another order round η differently, which symmetric
    /// steps cannot make up for.
    fn lopsided(&self, residual: &[f64], error: f64) -> bool {
        let Some(mirror) = self.mirror else { return false };
        let even = |(r, &image): (&f64, &u32)| 0.5 * (r + residual[image as usize]).abs();
        residual.iter().zip(mirror).map(even).fold(0.0, worse) < 0.5 * error
    }

    /// The Newton direction into `step`; false when there is none.
    ///
    /// A vertex whose triangles all break has a zero row, and rounding can make the matrix indefinite. Where the matrix has
    /// no factor, its diagonal is raised at the vertices of broken triangles (at all, where none is broken), so far that no
    /// u moves further than `max_step`: capping the step instead would hold back the sound vertices for the loose ones.
    /// `shift` remembers by how much, for the next iteration.
    fn direction(
        &self,
        system: &mut System,
        state: &State,
        residual: &[f64],
        step: &mut [f64],
        shift: &mut f64,
        report: &mut Report,
    ) -> Result<bool> {
        let mut loose = vec![false; residual.len()];
        for f in self.mesh.faces().filter(|f| state.angles[f.index()].broken()) {
            self.mesh.face_vertices(f).into_iter().for_each(|v| loose[v.index()] = true);
        }
        if !loose.contains(&true) {
            loose.fill(true);
            *shift = 0.0;
        }
        let first = SHIFT * system.jacobian.mean_diagonal();
        let mut added = if *shift > SHIFT_GROWTH * first { *shift / SHIFT_GROWTH } else { 0.0 };
        system.jacobian.add_diagonal(|v| if loose[v] { added } else { 0.0 });
        let mut last = f64::INFINITY;
        for _ in 0..SHIFT_TRIES {
            self.control.check()?;
            let factored = timed(&mut report.seconds.factor, || system.factor()).is_ok();
            if factored && timed(&mut report.seconds.solve, || system.solve(residual, self.enough(), step)) {
                if self.free_scale {
                    center(step);
                }
                // A step that more shift does not shorten is not the loose vertices': the line search will cap it.
                let now = largest(&*step);
                let settled = now > 0.5 * last;
                last = now;
                if added == 0.0 || now <= self.options.max_step || settled {
                    *shift = added;
                    report.shifted += usize::from(added > 0.0);
                    return Ok(true);
                }
            }
            let more = if added == 0.0 { first } else { added * SHIFT_GROWTH };
            system.jacobian.add_diagonal(|v| if loose[v] { more } else { 0.0 });
            added += more;
        }
        Ok(false)
    }

    /// A fraction of `step` that is accepted, in `trial`; its error. The first tried is all of it (after the cap), then halves.
    ///
    /// Accepted: the energy still falls along the step at its end, `step·(K̄ − K) ≥ 0`, or rises there at no more than
    /// [`OVERSHOOT`] of the rate at which it fell at the start; near the solution a smaller residual will do. After a step that was
    /// too long the lowest point lies between: it is sought until the energy falls at no more than [`FLAT`] of that rate.
    /// `residual`: at the start, then of `trial`.
    fn line_search(
        &mut self,
        state: &State,
        trial: &mut State,
        residual: &mut [f64],
        step: &[f64],
        error: f64,
        report: &mut Report,
    ) -> Result<Option<f64>> {
        let slope = |residual: &[f64]| -> f64 { step.iter().zip(residual).map(|(d, r)| d * r).sum() };
        let first = slope(residual);
        let (mut short, mut long, mut between) = (0.0, None, 0);
        let mut t = (self.options.max_step / largest(step)).min(1.0);
        for _ in 0..TRIALS {
            self.control.check()?;
            trial.set_step(state, t, step);
            let real = self.evaluate(trial, report)?;
            let now = if real { trial.residual(self.target, self.pinned, residual) } else { f64::INFINITY };
            let slope = if real { slope(residual) } else { f64::NEG_INFINITY };
            let falls = slope >= -OVERSHOOT * first;
            let settled = long.is_none() || slope <= FLAT * first || between >= BISECTIONS;
            if (error < NEAR && now < error) || (falls && settled) {
                return Ok(Some(now));
            }
            match falls {
                true => short = t,
                false if t == short => (short, long) = (0.0, Some(t)),
                false => long = Some(t),
            }
            between += usize::from(short > 0.0);
            let long = long.unwrap_or(t);
            t = if short > 0.0 && between >= BISECTIONS { short } else { 0.5 * (short + long) };
        }
        Ok(None)
    }

    /// Compute a state at its u, on the Delaunay triangulation there if edges may be flipped.
    pub(super) fn evaluate(&mut self, state: &mut State, report: &mut Report) -> Result<bool> {
        if !self.flips() {
            return Ok(timed(&mut report.seconds.assemble, || state.evaluate(self.mesh, self.class)));
        }
        let (mesh, class) = (&mut *self.mesh, &mut *self.class);
        let mut record = |mesh: &_, e| self.followed.iter_mut().for_each(|normal| normal.record(mesh, e));
        let (real, flips) = state.evaluate_delaunay(
            mesh,
            class,
            &self.options.fixed_edges,
            &mut record,
            &mut report.seconds,
            self.control,
        )?;
        report.flips += flips;
        Ok(real)
    }

    /// An error that needs no more polish.
    fn polished(&self) -> f64 {
        if self.class.space == Space::H2 { 0.0 } else { POLISH_TO }
    }

    /// Steps with the last factor, as long as they at least halve the error: iterative refinement of the nonlinear
    /// system at the price of a solve.
    fn polish(
        &self,
        system: &mut System,
        state: &mut State,
        trial: &mut State,
        residual: &mut [f64],
        step: &mut [f64],
        report: &mut Report,
        error: &mut f64,
    ) -> Result<()> {
        let broken = state.broken();
        for _ in 0..POLISH_STEPS {
            self.control.check()?;
            state.residual(self.target, self.pinned, residual);
            if !timed(&mut report.seconds.solve, || system.solve(residual, self.enough(), step)) {
                return Ok(());
            }
            if self.free_scale {
                center(step);
            }
            let inside = timed(&mut report.seconds.assemble, || {
                trial.set_step(state, 1.0, step);
                state.hand_on(trial);
                trial.evaluate(self.mesh, self.class)
            });
            if !inside {
                return Ok(());
            }
            let now = trial.residual(self.target, self.pinned, residual);
            if now < *error && trial.broken() <= broken {
                std::mem::swap(state, trial);
            } else {
                return Ok(());
            }
            let halved = now <= 0.5 * *error;
            *error = now;
            if !halved || now <= self.polished() {
                return Ok(());
            }
        }
        Ok(())
    }
}

/// Fraction of the way from `first` to `goal` on a logarithmic scale.
pub(super) fn progress(first: f64, now: f64, goal: f64) -> f64 {
    if first > goal && now > 0.0 { (first / now).ln() / (first / goal).ln() } else { 1.0 }
}
