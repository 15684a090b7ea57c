//! Newton's method for the angles around vertices and along loops, by least changes of the Penner coordinates.

use super::holonomy_state::{HolonomyState, HolonomyTarget, largest};
use super::least_norm::LeastNorm;
use super::opening::opening_step;
use crate::control::{Control, Stage};
use crate::error::{Error, Result};

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
/// Shares of steps below which they lead nowhere, and the number of such steps in a row after which the iteration is given up.
const SHORT_SHARE: f64 = 2e-3;
const SHORT_STEPS: usize = 6;

/// Halvings of an isometric step before the iteration ends.
const SHORTENINGS: usize = 12;
/// Most steps of Newton's method after an isometric step, and the largest error, radians, that they may leave.
const RETURN_STEPS: usize = 12;
const RETURNED: f64 = 5e-11;
/// Least relative gain of an isometric step after which another one is made.
const LEAST_GAIN: f64 = 1e-5;

/// The end of the iteration.
pub(super) struct NewtonEnd {
    pub state: HolonomyState,
    pub iterations: usize,
}

/// Moves the metric until curvature and turning are those of the target, or no step comes nearer.
///
/// # Errors
/// Those of [`HolonomyState::moved`]; [`Error::Cancelled`].
pub(super) fn reach_holonomy(
    mut state: HolonomyState,
    target: &HolonomyTarget,
    most_iterations: usize,
    control: &Control,
) -> Result<NewtonEnd> {
    let mut missing = state.residual(target);
    let (mut slow, mut short) = (0, 0);
    let mut equations = LeastNorm::default();
    for iterations in 0..most_iterations {
        control.step(Stage::Flow, iterations as f64 / most_iterations as f64)?;
        let error = largest(&missing);
        let end = |state| Ok(NewtonEnd { state, iterations });
        if error == 0.0 || slow > SLOW_STEPS || short > SHORT_STEPS {
            return end(state);
        }
        let step = match opening_step(&state, &missing, &mut equations, control) {
            // Triangles are so thin that no step can be told.
            Err(Error::Factorisation { .. }) => return end(state),
            step => step?,
        };
        let spread = step.iter().fold(0.0, |top: f64, x| top.max(*x))
            - step.iter().fold(0.0, |low: f64, x| low.min(*x));
        let mut factor = if spread > LARGEST_STEP { LARGEST_STEP / spread } else { 1.0 };
        let mut next = None;
        for _ in 0..HALVINGS {
            let tried = state.moved(&step, factor, control)?;
            let left = tried.residual(target);
            if !tried.is_broken && is_progress(&missing, &left) {
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
        short = if factor < SHORT_SHARE { short + 1 } else { 0 };
        slow = if left_error > STALLED * error { slow + 1 } else { 0 };
        (state, missing) = (tried, left);
    }
    Ok(NewtonEnd { state, iterations: most_iterations })
}

/// Goes on among the metrics with the target's angles and turning, towards the λ that are wanted: each step is the one of least distance
/// from there that keeps the angles to first order, shortened until that distance falls and Newton's method comes back to the target.
///
/// # Errors
/// Those of [`reach_holonomy`].
pub(super) fn come_near(
    mut end: NewtonEnd,
    target: &HolonomyTarget,
    steps: usize,
    control: &Control,
) -> Result<NewtonEnd> {
    let mut distance = end.state.length_change()?;
    let mut equations = LeastNorm::default();
    for k in 0..steps {
        control.step(Stage::Flow, k as f64 / steps as f64)?;
        let state = &end.state;
        let penner = state.penner_coordinates()?;
        let mut step: Vec<f64> = state.wanted.iter().zip(penner.iter()).map(|(to, is)| to - is).collect();
        let rows = state.derivatives();
        let along = |row: &Vec<(u32, f64)>| row.iter().map(|&(e, x)| x * step[e as usize]).sum::<f64>();
        let right: Vec<f64> =
            rows.iter().zip(state.residual(target)).map(|(row, missing)| missing - along(row)).collect();
        let back = match equations.solution(&rows, step.len(), &right, control) {
            Err(Error::Factorisation { .. }) => break,
            back => back?,
        };
        step.iter_mut().zip(back).for_each(|(x, back)| *x += back);
        let mut next = None;
        let mut factor = 1.0;
        for _ in 0..SHORTENINGS {
            let moved = state.moved(&step, factor, control)?;
            if !moved.is_broken {
                let tried = reach_holonomy(moved, target, RETURN_STEPS, &control.still())?;
                let left = tried.state.residual(target);
                let new_distance = tried.state.length_change()?;
                if largest(&left) < RETURNED && new_distance < distance {
                    next = Some((tried, new_distance));
                    break;
                }
            }
            factor *= 0.5;
        }
        let Some((tried, new_distance)) = next else { break };
        let is_settled = new_distance > (1.0 - LEAST_GAIN) * distance;
        let iterations = end.iterations + 1 + tried.iterations;
        (end, distance) = (NewtonEnd { state: tried.state, iterations }, new_distance);
        if is_settled {
            break;
        }
    }
    Ok(end)
}

/// True if a step leaves half of the error at most, or no more of it than before without having gone past the target.
fn is_progress(before: &[f64], after: &[f64]) -> bool {
    let square = |x: &[f64]| x.iter().map(|x| x * x).sum::<f64>();
    let (old, new) = (square(before).sqrt(), square(after).sqrt());
    let along: f64 = before.iter().zip(after).map(|(a, b)| a * b).sum();
    new.is_finite() && (new <= GOOD_SHARE * old || (new <= old && along >= 0.0))
}
