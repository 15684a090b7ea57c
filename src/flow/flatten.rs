//! Corrects the curvature of flat vertices in double-double precision.

use super::Flow;
use super::evaluate::FlowState;
use super::solve::centre;
use super::system::{NewtonSystem, Precision};
use crate::control::Control;
use crate::error::Result;
use crate::geometry::largest;

/// Largest number of corrections. Each brings the curvature down by the accuracy of a linear solution, 1e-12 and better.
const STEPS: usize = 4;
/// Radians. Largest |K| below which no correction is made: angles have about 31 digits. That the exponential has only 20 digits does not
/// matter: its error is a smooth function of u at the scale of the corrections, which are below 1e-16, so they compensate it.
const FLOOR: f64 = 1e-29;

impl Flow {
    /// Bring the curvature of all vertices from nearly 0 to 0 in double-double precision: iterative refinement of the nonlinear system, with
    /// residuals in double-double precision ([`crate::metric::Metric::angle_defects`]) and corrections in f64 with one factorisation. The
    /// triangulation stays. Returns the largest remaining |K|, radians.
    ///
    /// The present metric has to be the result of a flow to K̄ = 0.
    ///
    /// # Errors
    /// Those of [`crate::metric::Metric::angle_defects`]; [`crate::Error::Cancelled`], [`crate::Error::Factorisation`].
    pub fn flatten(&mut self, control: &Control) -> Result<f64> {
        self.flatten_at(FlowState::new(&self.metric.u, &self.metric.u_low), control)
    }

    /// [`Flow::flatten`] of the present metric; `state` may hold measurements of it.
    pub(super) fn flatten_at(&mut self, mut state: FlowState, control: &Control) -> Result<f64> {
        let pool = self.pool.clone();
        pool.run(|| {
            let is_measured = state.is_measured() || state.evaluate(&self.mesh, &self.metric);
            if !is_measured {
                // This returns the error that names the first vertex or edge outside the domain.
                self.metric.check_domain(&self.mesh)?;
            }
            let residual = self.defects();
            let error = largest(&residual);
            if error <= FLOOR || !is_measured {
                return Ok(error);
            }
            let mut fixed = self.pinned.clone();
            fixed[0] |= self.free_scale();
            // Mirror images have an unknown each here, since rounding differs between them, and share one in a solve.
            let shared = self.mirror.is_some();
            let mut system = match self.system.take().filter(|_| !shared) {
                Some(kept) => {
                    kept.flipped(&self.mesh, &fixed, None, 0)?.analysed(&self.mesh, Precision::F64)?
                }
                None => NewtonSystem::new(&self.mesh, &fixed, None)?,
            };
            control.check()?;
            system.jacobian.assemble(&self.mesh, &self.metric, &state);
            control.check()?;
            let factored = system.factor();
            control.check()?;
            let left = match factored {
                Ok(()) => self.correct(&mut system, state, residual, control)?,
                Err(_) => error,
            };
            self.system = Some(system).filter(|system| !shared && system.has_factor());
            Ok(left)
        })
    }

    /// Corrections of a metric, measured at `state`, as long as they lower the largest residual, which is returned.
    fn correct(
        &mut self,
        system: &mut NewtonSystem,
        mut state: FlowState,
        mut residual: Vec<f64>,
        control: &Control,
    ) -> Result<f64> {
        let mut error = largest(&residual);
        let mut step = vec![0.0; residual.len()];
        let mut next = FlowState::new(&state.u, &state.low);
        for _ in 0..STEPS {
            control.check()?;
            if error <= FLOOR || !system.solve(&residual, 0.0, &mut step) {
                break;
            }
            if self.free_scale() {
                centre(&mut step);
            }
            next.set_step(&state, 1.0, &step);
            (self.now.metric.u, self.now.metric.u_low) = (next.u.clone(), next.low.clone());
            let left = self.defects();
            let now = largest(&left);
            // After a step out of the domain these numbers are NaN or huge, so that it is taken back here too.
            if now >= error {
                (self.now.metric.u, self.now.metric.u_low) = (state.u, state.low);
                break;
            }
            (residual, error) = (left, now);
            std::mem::swap(&mut state, &mut next);
        }
        Ok(error)
    }

    /// −K at the vertices that are not pinned, 0 at the others.
    fn defects(&self) -> Vec<f64> {
        let curvature = self.metric.angle_defects_inside(&self.mesh);
        curvature.iter().zip(&self.pinned).map(|(k, &pinned)| if pinned { 0.0 } else { -k }).collect()
    }
}
