//! What a flow did.

use crate::arrays::{check_buffer, copy_out};
use crate::guard::{self, Poison, handle};
use crate::integer::raw;
use crate::sized::{self, sized};
use crate::status::ricci_status;
use ricci::flow::{Report, StopReason};
use std::ffi::{CStr, c_char};
use std::mem::MaybeUninit;

/// What a flow did: why it stopped, how far it came, how long it took.
///
/// Errors at boundary vertices of a surface that was doubled count both copies: they are twice those of the
/// surface.
pub struct ricci_report {
    poison: Poison,
    report: Report,
}

handle!(ricci_report, "report");

impl ricci_report {
    pub(crate) fn new(report: Report) -> ricci_report {
        ricci_report { poison: Poison::default(), report }
    }
}

/// Why a flow stopped.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ricci_stop_reason {
    /// The curvature error is within the tolerance and no triangle is broken.
    RICCI_STOP_CONVERGED = 0,
    /// The error is as small as rounding allows on this mesh, which is above the tolerance asked for.
    RICCI_STOP_ROUNDING_FLOOR = 1,
    /// A minimum of the energy with broken triangles: no metric.
    RICCI_STOP_BROKEN_TRIANGLES = 2,
    /// The variables run away, and no obstruction was found.
    RICCI_STOP_DIVERGED = 3,
    /// No step lowers the error any more.
    RICCI_STOP_STALLED = 4,
    /// The iteration limit came first.
    RICCI_STOP_ITERATION_LIMIT = 5,
    /// No metric of the class on this triangulation has the target curvature: ricci_report_obstruction names
    /// vertices that prove it.
    RICCI_STOP_INFEASIBLE = 6,
}

use ricci_stop_reason::*;

/// Every reason with the name that reports use.
const NAMES: &[(ricci_stop_reason, &CStr)] = &[
    (RICCI_STOP_CONVERGED, c"converged"),
    (RICCI_STOP_ROUNDING_FLOOR, c"rounding_floor"),
    (RICCI_STOP_BROKEN_TRIANGLES, c"broken_triangles"),
    (RICCI_STOP_DIVERGED, c"diverged"),
    (RICCI_STOP_STALLED, c"stalled"),
    (RICCI_STOP_ITERATION_LIMIT, c"iteration_limit"),
    (RICCI_STOP_INFEASIBLE, c"infeasible"),
];

impl From<StopReason> for ricci_stop_reason {
    fn from(reason: StopReason) -> ricci_stop_reason {
        match reason {
            StopReason::Converged => RICCI_STOP_CONVERGED,
            StopReason::RoundingFloor { .. } => RICCI_STOP_ROUNDING_FLOOR,
            StopReason::BrokenTriangles => RICCI_STOP_BROKEN_TRIANGLES,
            StopReason::Diverged => RICCI_STOP_DIVERGED,
            StopReason::Stalled => RICCI_STOP_STALLED,
            StopReason::IterationLimit => RICCI_STOP_ITERATION_LIMIT,
            StopReason::Infeasible => RICCI_STOP_INFEASIBLE,
        }
    }
}

/// Figures of a report.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_report_summary {
    /// Bytes of this struct that are filled.
    pub size: usize,
    /// 1 if the curvature error is within `tolerance` and no triangle is broken, else 0.
    pub converged: i32,
    /// Why it stopped.
    pub stop_reason: ricci_stop_reason,
    /// Number of steps.
    pub iterations: usize,
    /// Number of edges flipped by this flow; those before it are in ricci_metric_summary.
    pub flips: usize,
    /// Number of triangles whose lengths break the triangle inequality.
    pub broken_triangles: usize,
    /// Largest |K - target| over the vertices, radians.
    pub max_curvature_error: f64,
    /// The tolerance that was used: the one asked for, or the rounding floor of the mesh where that is
    /// larger.
    pub tolerance: f64,
    /// Largest curvature error that rounding can cause at the final metric, radians; determined where a flow
    /// stalls, else 0.
    pub rounding_floor: f64,
    /// 1 if u, lengths and curvature were carried to twice the digits of a double (Newton in E2), else 0.
    pub double_double: i32,
    /// |sum of curvatures + lambda area - 2 pi chi| of the result.
    pub gauss_bonnet: f64,
    /// Seconds in the assembly of curvature and its derivative.
    pub seconds_assemble: f64,
    /// Seconds in the symbolic analysis.
    pub seconds_analyse: f64,
    /// Seconds in numeric factorisations.
    pub seconds_factor: f64,
    /// Seconds in solves.
    pub seconds_solve: f64,
    /// Seconds in edge flips.
    pub seconds_flip: f64,
    /// Seconds in all.
    pub seconds_total: f64,
    /// Entries of ricci_report_residuals.
    pub n_residuals: usize,
    /// Rows of ricci_report_trace.
    pub n_trace: usize,
    /// Entries of ricci_report_worst.
    pub n_worst: usize,
    /// Entries of ricci_report_obstruction; 0 unless the stop reason is RICCI_STOP_INFEASIBLE.
    pub n_obstruction: usize,
    /// Total target curvature at the vertices of the obstruction, radians; of a double, with their mirror
    /// images.
    pub obstruction_target: f64,
    /// Every metric of the class on this triangulation has a total curvature above this at the vertices of
    /// the obstruction, radians.
    pub obstruction_above: f64,
}

// SAFETY: only ever written by the library; 8-byte alignment, size first.
sized!(ricci_report_summary, "summary");

/// The name of a stop reason as reports spell it, such as "rounding_floor".
///
/// Never fails: a number that is no stop reason gives "unknown".
/// @return a NUL-terminated string; not to be freed.
///
/// @param reason  the reason.
#[unsafe(no_mangle)]
pub extern "C" fn ricci_stop_reason_text(reason: MaybeUninit<ricci_stop_reason>) -> *const c_char {
    let number = raw(reason);
    let name = NAMES.iter().find(|(known, _)| *known as i32 == number);
    name.map_or(c"unknown", |(_, name)| name).as_ptr()
}

/// Release a report.
///
/// @param report  the handle, or NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_report_free(report: *mut ricci_report) {
    guard::free(report);
}

/// The figures of a report.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE.
///
/// @param report   the report.
/// @param summary  out: the figures.
/// @param size     sizeof *summary.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_report_summarise(
    report: *const ricci_report,
    summary: *mut ricci_report_summary,
    size: usize,
) -> ricci_status {
    guard::call(|door| {
        let report = &door.shared(report)?.report;
        let seconds = &report.seconds;
        let figures = ricci_report_summary {
            size,
            converged: report.converged().into(),
            stop_reason: report.stop_reason.into(),
            iterations: report.iterations,
            flips: report.flips,
            broken_triangles: report.broken_triangles,
            max_curvature_error: report.max_curvature_error,
            tolerance: report.tolerance,
            rounding_floor: report.rounding_floor.unwrap_or(0.0),
            double_double: report.double_double.into(),
            gauss_bonnet: report.gauss_bonnet,
            seconds_assemble: seconds.assemble,
            seconds_analyse: seconds.analyse,
            seconds_factor: seconds.factor,
            seconds_solve: seconds.solve,
            seconds_flip: seconds.flip,
            seconds_total: seconds.total,
            n_residuals: report.residuals.len(),
            n_trace: report.trace.len(),
            n_worst: report.worst.len(),
            n_obstruction: report.obstruction.as_ref().map_or(0, |o| o.vertices.len()),
            obstruction_target: report.obstruction.as_ref().map_or(0.0, |o| o.curvature),
            obstruction_above: report.obstruction.as_ref().map_or(0.0, |o| o.least),
        };
        sized::write(figures, summary, size)
    })
}

/// Largest |K - target| at the start and after every Newton step.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
///
/// @param report     the report.
/// @param residuals  out: n_residuals values, radians.
/// @param capacity   entries of `residuals`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_report_residuals(
    report: *const ricci_report,
    residuals: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(report, |report| copy_out("residuals", &report.report.residuals, residuals, capacity))
}

/// The trace of a gradient flow.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
///
/// @param report    the report.
/// @param trace     out: n_trace x 5: step, energy, largest |K - target|, area, step size.
/// @param capacity  entries of `trace`, at least 5 n_trace.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_report_trace(
    report: *const ricci_report,
    trace: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::call(|door| {
        let rows: Vec<[f64; 5]> = door
            .shared(report)?
            .report
            .trace
            .iter()
            .map(|row| [row.step as f64, row.energy, row.max_curvature_error, row.area, row.step_size])
            .collect();
        copy_out("trace", &rows, trace, capacity)
    })
}

/// The vertices that are farthest from their target, farthest first.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
///
/// @param report    the report.
/// @param vertices  out: n_worst vertices.
/// @param errors    out: n_worst values K - target, radians.
/// @param capacity  entries of `vertices` and of `errors`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_report_worst(
    report: *const ricci_report,
    vertices: *mut u32,
    errors: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::call(|door| {
        let (names, values): (Vec<u32>, Vec<f64>) =
            door.shared(report)?.report.worst.iter().map(|&(v, error)| (v.0, error)).unzip();
        check_buffer("errors", values.len(), errors, capacity)?;
        copy_out("vertices", &names, vertices, capacity)?;
        copy_out("errors", &values, errors, capacity)
    })
}

/// Vertices that prove that the target cannot be reached: the totals are in the summary.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
///
/// @param report    the report.
/// @param vertices  out: n_obstruction vertices, ascending.
/// @param capacity  entries of `vertices`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_report_obstruction(
    report: *const ricci_report,
    vertices: *mut u32,
    capacity: usize,
) -> ricci_status {
    guard::call(|door| {
        let obstruction = &door.shared(report)?.report.obstruction;
        let names: Vec<u32> = obstruction.iter().flat_map(|o| &o.vertices).map(|v| v.0).collect();
        copy_out("vertices", &names, vertices, capacity)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reasons_are_spelt_as_in_the_library() {
        for reason in [
            StopReason::Converged,
            StopReason::RoundingFloor { size: 1e-8 },
            StopReason::BrokenTriangles,
            StopReason::Diverged,
            StopReason::Stalled,
            StopReason::IterationLimit,
            StopReason::Infeasible,
        ] {
            let number = ricci_stop_reason::from(reason);
            let name =
                NAMES.iter().find(|(known, _)| *known == number).map(|(_, name)| name.to_str().unwrap());
            assert_eq!(name, Some(reason.name()));
        }
    }
}
