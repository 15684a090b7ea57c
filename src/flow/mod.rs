//! The flow `du/dt = K̄ − K` [JKLLG08, Eqn 16] to a prescribed curvature, by Newton's method on its convex energy
//! or by following it.

mod cone_angles;
pub mod cones;
mod evaluate;
mod flatten;
mod gradient;
mod jacobian;
mod newton;
mod obstruction;
pub mod options;
pub mod report;
mod solver;
mod spherical;
pub mod surface;
mod system;

pub use cones::{AutoCones, auto_cones};
pub use jacobian::curvature_derivative;
pub use obstruction::Obstruction;
pub use options::{Flips, Gradient, Method, Options, StepRule};
pub use report::{Report, Seconds, StopReason, TraceRow};
pub use solver::Solver;
pub use surface::SurfaceFlow;

use crate::control::Control;
use crate::error::Result;
use crate::mesh::{Mesh, PerVertex};
use crate::metric::Metric;

/// The metric with curvature `target` in the conformal class of `metric`, the triangulation it is on, and how it was found.
///
/// `target`: V entries, radians, admissible (see [`crate::metric::target::check_admissible`]). A flow that does not
/// reach it is no error: the report says so and why, and the metric is the last one. For
/// several targets on one surface keep a [`Solver`]; for a surface with boundary, and for the way back to the triangulation it came
/// with, a [`SurfaceFlow`].
pub fn flow(
    mesh: &Mesh,
    metric: &Metric,
    target: &PerVertex<f64>,
    options: &Options,
    control: &Control,
) -> Result<(Mesh, Metric, Report)> {
    let mut solver = Solver::new(mesh.clone(), metric.clone(), options.clone())?;
    let report = solver.solve(target, control)?;
    Ok((solver.mesh().clone(), solver.metric().clone(), report))
}
