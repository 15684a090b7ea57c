//! Metrics of constant curvature in the conformal classes of the surfaces.

use crate::control::Control;
use crate::error::{Error, Result};
use crate::flow::{Flow, Options, Solution};
use crate::geometry::Space;
use crate::mesh::PerVertex;
use crate::metric::{Class, Surface, Target};
use std::fmt::Display;

/// The metric with these curvatures beside that of the space, and the steps to it.
///
/// # Errors
/// [`Error::Matching`] where the flow does not come to its target; those of [`Flow::new`]; [`Error::Cancelled`].
pub(super) fn canonical_metric(
    surface: &Surface,
    space: Space,
    curvature: PerVertex<f64>,
    options: &Options,
    control: &Control,
) -> Result<(Solution, usize)> {
    let mut flow = Flow::new(surface.clone(), Class::yamabe(space), options, control)?;
    let metric = flow.solve(&Target::All(curvature), control)?;
    let iterations = metric.report().map_or(0, |report| report.iterations);
    if !metric.converged() {
        let reason = metric.report().map(|report| report.stop_reason.to_string()).unwrap_or_default();
        return Err(not_found(iterations, reason));
    }
    Ok((metric, iterations))
}

/// What is said of a flow that does not come to its target.
pub(super) fn not_found(iterations: usize, reason: impl Display) -> Error {
    Error::Matching(format!("the canonical metric was not found after {iterations} steps: {reason}"))
}
