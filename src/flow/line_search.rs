//! The line search along a Newton step: the full step if the convex energy falls, else a bisection on its slope.

use crate::geometry::largest;

/// Radians. Below this max |K − K̄| a smaller residual also accepts a step. Far from the solution only the slope does, since mixing the
/// two criteria can cycle there.
const NEAR_SOLUTION: f64 = 1e-2;
/// Largest slope of the energy at the end of a step, as a share of the rate at which it fell at the start. A convex energy has then fallen
/// all in all, unless its slope jumps. Without this tolerance good steps are halved, and half of all flows take twice as many steps.
const OVERSHOOT: f64 = 0.1;
/// Trials before the line search gives up: 2⁻⁵⁰ of a step is below the rounding of u.
const TRIALS: usize = 50;
/// Share of the first slope at which a bisection ends. At vertices with large curvature whose triangles are far smaller than all others,
/// dK/du changes within a tiny change of u, and a step meets a bend of the energy that is not seen at its start. A step that ends before
/// the bend gains nothing, since the next one meets it again; a step that ends inside it does.
const SETTLED_SLOPE: f64 = 0.5;
/// Points tried between a short and a long step before the short one is taken.
const BISECTIONS: usize = 10;

/// A search for the fraction of a step to take. The first tried is all of it (after the cap), then halves.
///
/// Accepted: the energy still falls along the step at its end, `step·(K̄ − K) ≥ 0`, or rises there at no more than [`OVERSHOOT`] of
/// the rate at which it fell at the start; near the solution a smaller residual will do. After a step that was too long the lowest
/// point lies between: it is sought until the energy falls at no more than [`SETTLED_SLOPE`] of that rate.
pub(super) struct LineSearch<'a> {
    step: &'a [f64],
    /// Slope and error at the start.
    first: f64,
    error: f64,
    t: f64,
    short: f64,
    long: Option<f64>,
    between: usize,
    trials: usize,
}

impl<'a> LineSearch<'a> {
    /// Along `step`, no u moving by more than `max_step`; `residual` and `error` are those of its start.
    pub fn new(step: &'a [f64], residual: &[f64], max_step: f64, error: f64) -> LineSearch<'a> {
        let t = (max_step / largest(step)).min(1.0);
        let first = slope(step, residual);
        LineSearch { step, first, error, t, short: 0.0, long: None, between: 0, trials: 0 }
    }

    /// The next fraction to try, or none: the search has failed.
    pub fn next(&mut self) -> Option<f64> {
        self.trials += 1;
        (self.trials <= TRIALS).then_some(self.t)
    }

    /// True if the last fraction is accepted: `error` and `residual` are those at its end, no error outside the metric's domain.
    pub fn accepts(&mut self, error: Option<f64>, residual: &[f64]) -> bool {
        let slope = error.map_or(f64::NEG_INFINITY, |_| slope(self.step, residual));
        let falls = slope >= -OVERSHOOT * self.first;
        let settled =
            self.long.is_none() || slope <= SETTLED_SLOPE * self.first || self.between >= BISECTIONS;
        let smaller = self.error < NEAR_SOLUTION && error.is_some_and(|now| now < self.error);
        if smaller || (falls && settled) {
            return true;
        }
        if falls {
            self.short = self.t;
        } else if self.t == self.short {
            (self.short, self.long) = (0.0, Some(self.t));
        } else {
            self.long = Some(self.t);
        }
        self.between += usize::from(self.short > 0.0);
        let long = self.long.unwrap_or(self.t);
        let give_in = self.short > 0.0 && self.between >= BISECTIONS;
        self.t = if give_in { self.short } else { 0.5 * (self.short + long) };
        false
    }
}

/// The rate at which the energy falls along a step.
fn slope(step: &[f64], residual: &[f64]) -> f64 {
    step.iter().zip(residual).map(|(d, r)| d * r).sum()
}
