//! Flat vertices to twice the digits of doubles.

use super::Flow;
use super::evaluate::State;
use super::solve::center;
use super::system::System;
use crate::control::Control;
use crate::error::Result;
use crate::geometry::{Space, largest};
use crate::mesh::PerVertex;
use std::mem::replace;

/// Corrections at most. Each brings the curvature down by the accuracy of a linear solution, 1e-12 and better.
const STEPS: usize = 4;
/// No correction is made below this: angles have 31 digits or so. That `twofold::exp` has 20 does not matter: it is a function
/// of u that is smooth where corrections of u below 1e-16 are concerned, so they make up for it.
const FLOOR: f64 = 1e-29;

impl Flow {
    /// Bring the curvature of all vertices from nearly 0 to 0, as far as twice the digits of doubles go: iterative refinement of the
    /// nonlinear system, residuals with twice the digits ([`crate::metric::Metric::angle_defects`]), corrections in doubles with one
    /// factorisation. The triangulation stays. Returns the largest |K| that is left.
    ///
    /// For a metric that a flow to K̄ = 0 has come to. Errors: [`crate::Error::Cancelled`].
    pub fn flatten(&mut self, control: &Control) -> Result<f64> {
        let Flow { mesh, metric, pinned, mirror, system, pool, .. } = self;
        if mirror.is_some() {
            // Its unknowns are those of one half; rounding differs between the two.
            *system = None;
        }
        let free_scale = metric.space == Space::E2 && !pinned.contains(&true);
        pool.run(|| {
            let mut residual = defects(metric.angle_defects(mesh)?, pinned);
            let mut error = largest(&residual);
            let mut fixed = pinned.clone();
            fixed[0] |= free_scale;
            let mut state = State::new(&metric.u, &metric.u_low);
            if error <= FLOOR || !state.evaluate(mesh, metric) {
                return Ok(error);
            }
            let kept = match system.take() {
                Some(kept) => kept.flipped(mesh, &fixed, None, 0)?,
                None => System::new(mesh, &fixed, None)?,
            };
            // Of other unknowns than the next solve's, where that keeps a mirror symmetry.
            let mut own;
            let system = match mirror {
                Some(_) => {
                    own = kept;
                    &mut own
                }
                None => system.insert(kept),
            };
            system.jacobian.assemble(mesh, metric, &state);
            control.check()?;
            if system.factor().is_err() {
                return Ok(error);
            }
            let mut step = vec![0.0; residual.len()];
            let mut next = State::new(&metric.u, &metric.u_low);
            for _ in 0..STEPS {
                control.check()?;
                if error <= FLOOR || !system.solve(&residual, 0.0, &mut step) {
                    break;
                }
                if free_scale {
                    center(&mut step);
                }
                next.set_step(&state, 1.0, &step);
                let before =
                    (replace(&mut metric.u, next.u.clone()), replace(&mut metric.u_low, next.low.clone()));
                let left = defects(metric.angle_defects(mesh)?, pinned);
                let now = largest(&left);
                if now >= error {
                    (metric.u, metric.u_low) = before;
                    break;
                }
                (residual, error) = (left, now);
                std::mem::swap(&mut state, &mut next);
            }
            Ok(error)
        })
    }
}

/// `K̄ − K` at the vertices that are not pinned.
fn defects(curvature: PerVertex<f64>, pinned: &[bool]) -> Vec<f64> {
    curvature.iter().zip(pinned).map(|(k, &pinned)| if pinned { 0.0 } else { -k }).collect()
}
