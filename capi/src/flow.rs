//! The flow, once or repeatedly.

use crate::arrays;
use crate::choice::{choice, choose, name};
use crate::control::{self, ricci_control};
use crate::failure::{Failure, Outcome};
use crate::guard::{self, Poison, handle, output};
use crate::metric::ricci_metric;
use crate::report::ricci_report;
use crate::sized::{self, sized};
use crate::status::ricci_status;
use ricci::Control;
use ricci::flow::{Flips, Gradient, Method, Options, StepRule};
use ricci::mesh::{EdgeId, PerVertex};
use ricci::{Flow, Target};
use std::mem::MaybeUninit;

/// How the flow is solved.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ricci_method {
    /// Newton's method on the convex energy.
    RICCI_METHOD_NEWTON = 0,
    /// The gradient flow du/dt = target - K, explicit in time, with a trace.
    RICCI_METHOD_GRADIENT = 1,
}

choice!(ricci_method, "method", Method, [
    RICCI_METHOD_NEWTON => Newton,
    RICCI_METHOD_GRADIENT => Gradient,
]);

/// Whether edges may be flipped while the metric flows.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ricci_flips {
    /// As often as needed, so that every admissible target is reached: the flow starts from the intrinsic
    /// Delaunay triangulation and keeps it (weighted) Delaunay; a surface with boundary flows on its double
    /// as soon as an edge is to be flipped across the boundary, unless vertices are pinned. Applies to Newton's method in E2 and H2 with vertex scaling, inversive
    /// distance and virtual radius; else edges stay as they are.
    RICCI_FLIPS_AUTO = 0,
    /// The triangulation of the metric stays as it is.
    RICCI_FLIPS_NEVER = 1,
}

choice!(ricci_flips, "flips", Flips, [
    RICCI_FLIPS_AUTO => Auto,
    RICCI_FLIPS_NEVER => Never,
]);

/// Step size of the gradient flow.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ricci_step {
    /// Barzilai-Borwein steps: far fewer steps, by other metrics than the continuous flow.
    RICCI_STEP_BARZILAI_BORWEIN = 0,
    /// The largest step that is stable by Gershgorin's bound.
    RICCI_STEP_STABLE = 1,
    /// Always `step_size`.
    RICCI_STEP_FIXED = 2,
}

choice!(ricci_step, "step", ricci_step, [
    RICCI_STEP_BARZILAI_BORWEIN => RICCI_STEP_BARZILAI_BORWEIN,
    RICCI_STEP_STABLE => RICCI_STEP_STABLE,
    RICCI_STEP_FIXED => RICCI_STEP_FIXED,
]);

/// How a flow is done. Let ricci_flow_options_init fill it, then change fields.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct ricci_flow_options {
    /// Bytes of this struct that are filled.
    pub size: usize,
    /// How it is solved; default RICCI_METHOD_NEWTON.
    pub method: MaybeUninit<ricci_method>,
    /// Whether edges may be flipped; default RICCI_FLIPS_AUTO.
    pub flips: MaybeUninit<ricci_flips>,
    /// Largest |K - target| of a converged metric, radians, positive; default 1e-10.
    pub tolerance: f64,
    /// Steps before giving up; default 0: 500 for Newton, 200,000 for the gradient flow.
    pub max_iterations: usize,
    /// Threads of this flow, in a pool of its own; default 0: one per core. The result does not depend on it.
    pub threads: usize,
    /// Largest change of any u in one Newton step, positive; default 3.
    pub max_step: f64,
    /// Step rule of the gradient flow; default RICCI_STEP_BARZILAI_BORWEIN.
    pub step: MaybeUninit<ricci_step>,
    /// Gradient flow in E2: 1 keeps the total area of the start; default 0.
    pub area_normalised: i32,
    /// The step of RICCI_STEP_FIXED, positive; default 0.
    pub step_size: f64,
    /// Edges that are not flipped, such as seams and feature lines: rows of ricci_mesh_edges of the mesh that
    /// the metric was made from; default NULL. Targets that only their flips would reach are then out of
    /// reach.
    pub fixed_edges: *const u32,
    /// Entries of `fixed_edges`; default 0.
    pub n_fixed_edges: usize,
}

// SAFETY: numbers, a raw pointer and `MaybeUninit` enums: any bytes are valid; 8-byte alignment, size first.
sized!(ricci_flow_options, "options");

fn defaults() -> Outcome<ricci_flow_options> {
    let options = Options::default();
    Ok(ricci_flow_options {
        size: size_of::<ricci_flow_options>(),
        method: MaybeUninit::new(name(options.method)?),
        flips: MaybeUninit::new(name(options.flips)?),
        tolerance: options.tolerance,
        max_iterations: options.max_iterations,
        threads: options.threads,
        max_step: options.max_step,
        step: MaybeUninit::new(ricci_step::RICCI_STEP_BARZILAI_BORWEIN),
        area_normalised: options.gradient.area_normalised.into(),
        step_size: 0.0,
        fixed_edges: std::ptr::null(),
        n_fixed_edges: 0,
    })
}

/// The library's options; NULL gives the defaults.
fn read_options(options: *const ricci_flow_options) -> Outcome<Options> {
    let options = sized::read(defaults()?, options)?;
    let step = match choose(options.step)? {
        ricci_step::RICCI_STEP_BARZILAI_BORWEIN => StepRule::BarzilaiBorwein,
        ricci_step::RICCI_STEP_STABLE => StepRule::Stable,
        ricci_step::RICCI_STEP_FIXED => StepRule::Fixed(options.step_size),
    };
    let fixed = arrays::array("fixed_edges", options.fixed_edges, options.n_fixed_edges)?;
    Ok(Options {
        method: choose(options.method)?,
        fixed_edges: fixed.into_iter().map(EdgeId).collect(),
        pinned: Vec::new(),
        flips: choose(options.flips)?,
        tolerance: options.tolerance,
        max_iterations: options.max_iterations,
        threads: options.threads,
        max_step: options.max_step,
        gradient: Gradient { step, area_normalised: options.area_normalised != 0 },
    })
}

/// Fill options with their defaults.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE.
///
/// @param options  out: the defaults.
/// @param size     sizeof *options.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_flow_options_init(
    options: *mut ricci_flow_options,
    size: usize,
) -> ricci_status {
    guard::call(|_| sized::write(defaults()?, options, size))
}

/// Deform a metric in its conformal class to a prescribed curvature.
///
/// With flips the result lives on a triangulation of its own, and of a surface with boundary on its double
/// (ricci_metric_mesh); vertices keep their numbers, and ricci_layout_new leads back. A result that flows
/// again goes on from where it is; if it came of a flow without flips, or with other fixed edges, and edges
/// may be flipped now, it begins at the given lengths.
///
/// Whether it came that far is in the report: a flow that stops early is RICCI_OK and `converged` is 0.
/// Inputs are never changed.
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_WRONG_SIZE, RICCI_ARGUMENT, RICCI_STRUCT_SIZE,
/// RICCI_TARGET_AT_VERTEX, RICCI_TARGET_TOTAL, RICCI_TARGET_BELOW, RICCI_FACTORISATION, RICCI_CANCELLED.
///
/// @param metric      where the flow starts.
/// @param target      n_vertices curvatures, radians.
/// @param n_vertices  number of vertices.
/// @param options     how; NULL for the defaults.
/// @param control     progress and cancellation; NULL for neither.
/// @param result      out: the metric at the end, to be released by ricci_metric_free.
/// @param report      out: what was done, to be released by ricci_report_free; NULL if not wanted.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_flow(
    metric: *const ricci_metric,
    target: *const f64,
    n_vertices: usize,
    options: *const ricci_flow_options,
    control: *const ricci_control,
    result: *mut *mut ricci_metric,
    report: *mut *mut ricci_report,
) -> ricci_status {
    guard::call(|door| {
        let result = output("result", result)?;
        let metric = door.shared(metric)?;
        let target = metric.target(target, n_vertices)?;
        let options = read_options(options)?;
        let control = control::of(control);
        let mut flow = Flow::resume(&metric.surface, &options, &control)?;
        let (end, done) = advance(&mut flow, target, &control)?;
        if let Ok(report) = output("report", report) {
            report.hand_over(done);
        }
        result.hand_over(end);
        Ok(())
    })
}

/// Solve, and the metric that the flow has come to.
fn advance(
    flow: &mut Flow,
    target: PerVertex<f64>,
    control: &Control,
) -> Outcome<(ricci_metric, ricci_report)> {
    let end = flow.solve(&Target::All(target), control)?;
    let Some(report) = end.report().cloned() else {
        return Err(Failure::argument("a solve has left no report"));
    };
    log::info!(
        "flow: {} after {} iterations, {} flips and {:.3} s, max |K - target| = {:.1e}",
        report.stop_reason,
        report.iterations,
        report.flips,
        report.seconds.total,
        report.max_curvature_error
    );
    Ok((ricci_metric::at(end)?, ricci_report::new(report)))
}

/// A solver for many targets on one metric: it keeps its analysis, its threads and the last solution, from
/// which the next solve starts.
pub struct ricci_solver {
    poison: Poison,
    flow: Flow,
}

handle!(ricci_solver, "solver");

/// A solver for many targets.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT, RICCI_STRUCT_SIZE, RICCI_FACTORISATION.
///
/// @param metric   where the first solve starts; it is copied.
/// @param options  how; NULL for the defaults.
/// @param solver   out: the new handle, to be released by ricci_solver_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_solver_new(
    metric: *const ricci_metric,
    options: *const ricci_flow_options,
    solver: *mut *mut ricci_solver,
) -> ricci_status {
    guard::make("solver", solver, |door| {
        let metric = door.shared(metric)?;
        let flow = Flow::resume(&metric.surface, &read_options(options)?, &Control::new())?;
        Ok(ricci_solver { poison: Poison::default(), flow })
    })
}

/// Release a solver.
///
/// @param solver  the handle, or NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_solver_free(solver: *mut ricci_solver) {
    guard::free(solver);
}

/// Hold u fixed at some vertices in the following solves; their curvature is then free.
///
/// Replaces the vertices that were pinned before. A surface with boundary flows on its double if edges are
/// flipped across the boundary and no vertex is pinned: there the first pin, and the release of all, begin the
/// flow anew from the given lengths.
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT (no such vertex).
///
/// @param solver      the solver.
/// @param vertices    n_vertices vertices; NULL if there are none.
/// @param n_vertices  number of vertices; 0 releases all.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_solver_pin(
    solver: *mut ricci_solver,
    vertices: *const u32,
    n_vertices: usize,
) -> ricci_status {
    guard::call(|door| {
        let solver = door.exclusive(solver)?;
        let n = solver.flow.surface().mesh().n_vertices();
        let vertices = arrays::array("vertices", vertices, n_vertices)?;
        if let Some(v) = vertices.iter().find(|&&v| v as usize >= n) {
            return Err(Failure::argument(format!("vertex {v} does not exist: there are {n}")));
        }
        let vertices: Vec<_> = vertices.into_iter().map(ricci::mesh::VertexId).collect();
        Ok(solver.flow.pin(&vertices, &Control::new())?)
    })
}

/// ricci_flow from where the last solve ended, reusing what the solver has kept.
///
/// After RICCI_CANCELLED or another failure the solver is where it was before the call.
/// @return as ricci_flow.
///
/// @param solver      the solver.
/// @param target      n_vertices curvatures, radians; those of pinned vertices are ignored.
/// @param n_vertices  number of vertices.
/// @param control     progress and cancellation; NULL for neither.
/// @param result      out: the metric at the end, to be released by ricci_metric_free.
/// @param report      out: what was done, to be released by ricci_report_free; NULL if not wanted.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_solver_solve(
    solver: *mut ricci_solver,
    target: *const f64,
    n_vertices: usize,
    control: *const ricci_control,
    result: *mut *mut ricci_metric,
    report: *mut *mut ricci_report,
) -> ricci_status {
    guard::call(|door| {
        let result = output("result", result)?;
        let solver = door.exclusive(solver)?;
        let n = solver.flow.surface().mesh().n_vertices();
        let target = PerVertex::from(arrays::array_of("target", target, n_vertices, n)?);
        let (end, done) = advance(&mut solver.flow, target, &control::of(control))?;
        if let Ok(report) = output("report", report) {
            report.hand_over(done);
        }
        result.hand_over(end);
        Ok(())
    })
}
