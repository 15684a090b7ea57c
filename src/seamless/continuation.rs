//! Far targets, come to by way of targets between.

use super::holonomy_state::{HolonomyState, HolonomyTarget, largest};
use super::newton::{NewtonEnd, reach_holonomy};
use super::options::SeamlessOptions;
use crate::control::Control;
use crate::error::Result;

/// The share of the way that the first stage goes, and the least.
const FIRST_SHARE: f64 = 0.25;
const LEAST_SHARE: f64 = 1.0 / 128.0;
/// Most Newton steps of a stage, and the largest error, radians, that the next stage may begin with.
const STAGE_STEPS: usize = 10;
const STAGE_ERROR: f64 = 1e-3;
/// Most stages.
const STAGES: usize = 24;

/// Moves the metric to the target; where Newton's method does not reach it at once, along targets between what the metric has and what is
/// asked for. The end is the better one of both.
///
/// # Errors
/// Those of [`reach_holonomy`].
pub(super) fn reach_by_stages(
    state: HolonomyState,
    target: &HolonomyTarget,
    options: &SeamlessOptions,
    control: &Control,
) -> Result<NewtonEnd> {
    let first = state.clone();
    let at_once = reach_holonomy(state, target, options.max_iterations, &control.part(0.0, 0.5))?;
    let error = error_of(&at_once.state, target);
    if error <= options.tolerance {
        return Ok(at_once);
    }
    let mut iterations = at_once.iterations;
    let from = HolonomyTarget { angles: first.sector_angles(), turning: first.turning() };
    let (mut state, mut done, mut share) = (first, 0.0, FIRST_SHARE);
    for _ in 0..STAGES {
        let next = f64::min(done + share, 1.0);
        let between = between(&from, target, next);
        let end = reach_holonomy(
            state.clone(),
            &between,
            STAGE_STEPS.min(options.max_iterations),
            &control.part(0.5, 0.8),
        )?;
        iterations += end.iterations;
        if error_of(&end.state, &between) <= STAGE_ERROR {
            (state, done) = (end.state, next);
            share *= 2.0;
        } else {
            share *= 0.5;
        }
        if done >= 1.0 || share < LEAST_SHARE {
            break;
        }
    }
    let end = reach_holonomy(state, target, options.max_iterations, &control.part(0.8, 1.0))?;
    iterations += end.iterations;
    let best = if error_of(&end.state, target) < error { end } else { at_once };
    Ok(NewtonEnd { iterations, ..best })
}

/// The target this share of the way from one to another.
fn between(from: &HolonomyTarget, to: &HolonomyTarget, share: f64) -> HolonomyTarget {
    let mix = |from: &[f64], to: &[f64]| from.iter().zip(to).map(|(a, b)| a + share * (b - a)).collect();
    HolonomyTarget { angles: mix(&from.angles, &to.angles), turning: mix(&from.turning, &to.turning) }
}

fn error_of(state: &HolonomyState, target: &HolonomyTarget) -> f64 {
    largest(&state.residual(target))
}
