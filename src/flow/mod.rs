//! The flow `du/dt = K̄ − K` [JKLLG08, Eqn 16] to a prescribed curvature, by Newton's method on its convex energy
//! or by following it.

mod evaluate;
mod gradient;
mod jacobian;
mod newton;
mod obstruction;
pub mod options;
pub mod report;
mod solver;
mod spherical;
mod system;

pub use jacobian::curvature_derivative;
pub use obstruction::Obstruction;
pub use options::{Flips, Gradient, Method, Options, StepRule};
pub use report::{Report, Seconds, StopReason, TraceRow};
pub use solver::Solver;

use crate::control::Control;
use crate::error::Result;
use crate::mesh::{Mesh, PerVertex};
use crate::metric::Metric;

/// The metric with curvature `target` in the conformal class of `metric`, and how it was found.
///
/// `target`: V entries, radians, admissible (see [`crate::metric::target::check_admissible`]). A flow that does not
/// reach it is no error: the report says so and why, and the metric is the last one. For
/// several targets on one surface keep a [`Solver`].
pub fn flow(
    mesh: &Mesh,
    metric: &Metric,
    target: &PerVertex<f64>,
    options: &Options,
    control: &Control,
) -> Result<(Metric, Report)> {
    let mut solver = Solver::new(mesh.clone(), metric.clone(), options.clone())?;
    let report = solver.solve(target, control)?;
    Ok((solver.metric().clone(), report))
}
