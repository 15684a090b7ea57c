//! Reports of flows: the stop reason, the residuals, the seconds, and the vertices with the largest errors.

use crate::arrays::{copy_each, copy_out};
use crate::choice::choices;
use crate::failure::{Failure, Outcome};
use crate::guard;
use crate::metric::{report_of, ricci_metric};
use crate::status::ricci_status;
use crate::structs::{self, sized};
use ricci::flow::{Report, StopReason};
use std::ffi::{CStr, c_char};

choices!(STOP_REASONS: &'static CStr = "stop reason", [
    RICCI_STOP_CONVERGED => c"converged",
    RICCI_STOP_ROUNDING_FLOOR => c"rounding_floor",
    RICCI_STOP_BROKEN_TRIANGLES => c"broken_triangles",
    RICCI_STOP_DIVERGED => c"diverged",
    RICCI_STOP_STALLED => c"stalled",
    RICCI_STOP_ITERATION_LIMIT => c"iteration_limit",
    RICCI_STOP_INFEASIBLE => c"infeasible",
    RICCI_STOP_OUT_OF_REACH => c"out_of_reach",
]);

/// The number of a stop reason, and its name.
pub(crate) fn stop_reason(reason: StopReason) -> Outcome<(u32, *const c_char)> {
    let named = STOP_REASONS.values.iter().find(|(_, text)| text.to_str() == Ok(reason.name()));
    let (_, text) = named.ok_or_else(|| Failure::argument("a stop reason has no number in C"))?;
    Ok((STOP_REASONS.number(text)?, text.as_ptr()))
}

choices!(enum ReportValues, VALUES = "which", [
    RICCI_REPORT_TARGET => Target,
    RICCI_REPORT_RESIDUALS => Residuals,
    RICCI_REPORT_TRACE => Trace,
    RICCI_REPORT_WORST_ERRORS => Worst,
]);

choices!(enum ReportVertices, VERTICES = "which", [
    RICCI_REPORT_CONES => Cones,
    RICCI_REPORT_WORST => Worst,
    RICCI_REPORT_OBSTRUCTION => Obstruction,
]);

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_report_summary {
    pub size: usize,
    pub converged: u32,
    pub stop_reason: u32,
    pub stop_reason_text: *const c_char,
    pub iterations: usize,
    pub flips: usize,
    pub broken_triangles: usize,
    pub max_curvature_error: f64,
    pub tolerance: f64,
    pub rounding_floor: f64,
    pub gauss_bonnet: f64,
    pub seconds_assemble: f64,
    pub seconds_analyse: f64,
    pub seconds_factor: f64,
    pub seconds_solve: f64,
    pub seconds_flip: f64,
    pub seconds_total: f64,
    pub n_cones: usize,
    pub n_residuals: usize,
    pub n_trace: usize,
    pub n_worst: usize,
    pub n_obstruction: usize,
    pub obstruction_target: f64,
    pub obstruction_above: f64,
    pub double_double: u32,
    pub reserved: u32,
}
// SAFETY: numbers and a raw pointer; 8-byte alignment, size first.
sized!(ricci_report_summary, "summary", reserved);

/// The vertices of the obstruction, their total curvature in the target, and the bound that it violates: every metric of the class has
/// more curvature there.
fn obstruction(report: &Report) -> (&[ricci::mesh::VertexId], f64, f64) {
    report.obstruction.as_ref().map_or((&[], 0.0, 0.0), |o| (&o.vertices, o.curvature, o.least))
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_report_summarise(
    metric: *const ricci_metric,
    summary: *mut ricci_report_summary,
    size: usize,
) -> ricci_status {
    guard::with(metric, |ricci_metric(state)| {
        let report = report_of(state)?;
        let seconds = &report.seconds;
        let (stop_reason, stop_reason_text) = stop_reason(report.stop_reason)?;
        let (vertices, obstruction_target, obstruction_above) = obstruction(report);
        let figures = ricci_report_summary {
            size,
            converged: report.converged().into(),
            stop_reason,
            stop_reason_text,
            iterations: report.iterations,
            flips: report.flips,
            broken_triangles: report.broken_triangles,
            max_curvature_error: report.max_curvature_error,
            tolerance: report.tolerance,
            rounding_floor: report.rounding_floor.unwrap_or(0.0),
            gauss_bonnet: report.gauss_bonnet,
            seconds_assemble: seconds.assemble,
            seconds_analyse: seconds.analyse,
            seconds_factor: seconds.factor,
            seconds_solve: seconds.solve,
            seconds_flip: seconds.flip,
            seconds_total: seconds.total,
            n_cones: state.solution.cones().len(),
            n_residuals: report.residuals.len(),
            n_trace: report.trace.len(),
            n_worst: report.worst.len(),
            n_obstruction: vertices.len(),
            obstruction_target,
            obstruction_above,
            double_double: report.double_double.into(),
            reserved: 0,
        };
        structs::write(figures, summary, size)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_report_values(
    metric: *const ricci_metric,
    which: u32,
    values: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(metric, |ricci_metric(state)| {
        let report = report_of(state)?;
        match VALUES.choose(which)? {
            ReportValues::Target => {
                let target = state.solution.target().map_or(&[][..], |target| target);
                copy_out("values", target, values, capacity)
            }
            ReportValues::Residuals => copy_out("values", &report.residuals, values, capacity),
            ReportValues::Trace => {
                let rows = report.trace.iter().map(|row| {
                    [row.step as f64, row.energy, row.max_curvature_error, row.area, row.step_size]
                });
                copy_each("values", report.trace.len(), rows, values, capacity)
            }
            ReportValues::Worst => {
                let errors = report.worst.iter().map(|&(_, error)| error);
                copy_each("values", report.worst.len(), errors, values, capacity)
            }
        }
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_report_vertices(
    metric: *const ricci_metric,
    which: u32,
    vertices: *mut u32,
    capacity: usize,
) -> ricci_status {
    guard::with(metric, |ricci_metric(state)| {
        let report = report_of(state)?;
        let names: Vec<u32> = match VERTICES.choose(which)? {
            ReportVertices::Cones => state.solution.cones().iter().map(|v| v.0).collect(),
            ReportVertices::Worst => report.worst.iter().map(|(v, _)| v.0).collect(),
            ReportVertices::Obstruction => obstruction(report).0.iter().map(|v| v.0).collect(),
        };
        copy_out("vertices", &names, vertices, capacity)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_stop_reason_has_a_number() {
        for reason in [
            StopReason::Converged,
            StopReason::RoundingFloor { size: 1e-8 },
            StopReason::BrokenTriangles,
            StopReason::Diverged,
            StopReason::Stalled,
            StopReason::IterationLimit,
            StopReason::Infeasible,
            StopReason::OutOfReach { step: 1e4 },
        ] {
            assert!(stop_reason(reason).is_ok(), "{}", reason.name());
        }
    }
}
