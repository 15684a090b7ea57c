//! Newton's method for the angles around vertices and along loops, by least changes of the Penner coordinates.

use super::holonomy_state::{HolonomyState, HolonomyTarget};
use super::least_norm::least_norm_solution;
use crate::control::{Control, Stage};
use crate::error::Result;

/// Largest difference between the changes of λ at two edges in one step.
const LARGEST_STEP: f64 = 2.5;
/// Halvings of a step before the iteration gives up.
const HALVINGS: usize = 30;
/// A step is taken whole where it leaves at most this share of what is missing, whichever way the rest points.
const GOOD_SHARE: f64 = 0.5;
/// Steps that leave more than this share of the error, once the error is below [`NEAR`], have come to rounding.
const STALLED: f64 = 0.5;
/// Below this error, radians, steps converge quadratically or are at the rounding floor.
const NEAR: f64 = 1e-7;
/// Steps in a row that do not halve the error, after which the iteration is given up.
const SLOW_STEPS: usize = 60;

/// The end of the iteration.
pub(super) struct NewtonEnd {
    pub state: HolonomyState,
    pub iterations: usize,
}

/// Moves the metric until curvature and turning are those of the target, or no step comes nearer.
///
/// # Errors
/// [`crate::Error::Factorisation`]; those of [`HolonomyState::moved`]; [`crate::Error::Cancelled`].
pub(super) fn reach_holonomy(
    mut state: HolonomyState,
    target: &HolonomyTarget,
    most_iterations: usize,
    control: &Control,
) -> Result<NewtonEnd> {
    let mut missing = state.residual(target);
    let mut slow = 0;
    for iterations in 0..most_iterations {
        control.step(Stage::Flow, iterations as f64 / most_iterations as f64)?;
        let error = largest(&missing);
        let end = |state| Ok(NewtonEnd { state, iterations });
        if error == 0.0 || slow > SLOW_STEPS {
            return end(state);
        }
        let step = least_norm_solution(&state.derivatives(), state.mesh.n_edges(), &missing)?;
        let spread = step.iter().fold(0.0, |top: f64, x| top.max(*x))
            - step.iter().fold(0.0, |low: f64, x| low.min(*x));
        let mut factor = if spread > LARGEST_STEP { LARGEST_STEP / spread } else { 1.0 };
        let mut next = None;
        for _ in 0..HALVINGS {
            let tried = state.moved(&step, factor, control)?;
            let left = tried.residual(target);
            if is_progress(&missing, &left) {
                next = Some((tried, left));
                break;
            }
            factor *= 0.5;
        }
        let Some((tried, left)) = next else { return end(state) };
        let left_error = largest(&left);
        if error < NEAR && left_error > STALLED * error {
            // Rounding is all that is left.
            return if left_error < error {
                Ok(NewtonEnd { state: tried, iterations: iterations + 1 })
            } else {
                end(state)
            };
        }
        slow = if left_error > STALLED * error { slow + 1 } else { 0 };
        (state, missing) = (tried, left);
    }
    Ok(NewtonEnd { state, iterations: most_iterations })
}

/// True if a step leaves half of the error at most, or no more of it than before without having gone past the target.
fn is_progress(before: &[f64], after: &[f64]) -> bool {
    let square = |x: &[f64]| x.iter().map(|x| x * x).sum::<f64>();
    let (old, new) = (square(before).sqrt(), square(after).sqrt());
    let along: f64 = before.iter().zip(after).map(|(a, b)| a * b).sum();
    new.is_finite() && (new <= GOOD_SHARE * old || (new <= old && along >= 0.0))
}

/// The largest absolute value.
fn largest(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |top: f64, x| top.max(x.abs()))
}
