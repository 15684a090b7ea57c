//! The flow to a target curvature, in one call or by a solver that is used repeatedly.

use crate::arrays;
use crate::choice::choices;
use crate::control::{self, ricci_control};
use crate::failure::Outcome;
use crate::guard::{self, MutableHandle, handle, shared};
use crate::memory;
use crate::metric::ricci_metric;
use crate::status::ricci_status;
use crate::structs::{self, or, sized};
use crate::target::{ricci_target, target_of, vertices};
use ricci::flow::{Flips, Gradient, Method, Options, StepRule, with_cones_placed};
use ricci::mesh::EdgeId;
use ricci::{Class, Control, Flow, Target};
use std::mem::ManuallyDrop;

choices!(METHODS: Method = "method", [
    RICCI_METHOD_NEWTON => Method::Newton,
    RICCI_METHOD_GRADIENT => Method::Gradient,
]);

choices!(FLIPS: Flips = "flips", [
    RICCI_FLIPS_AUTO => Flips::Auto,
    RICCI_FLIPS_NEVER => Flips::Never,
]);

choices!(STEPS: StepRule = "step", [
    RICCI_STEP_ARMIJO => StepRule::Armijo,
    RICCI_STEP_STABLE => StepRule::Stable,
    RICCI_STEP_FIXED => StepRule::Fixed(0.0),
    RICCI_STEP_BARZILAI_BORWEIN => StepRule::BarzilaiBorwein,
]);

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_flow_options {
    pub size: usize,
    pub method: u32,
    pub flips: u32,
    pub tolerance: f64,
    pub max_iterations: usize,
    pub threads: usize,
    pub max_step: f64,
    pub fixed_edges: *const u32,
    pub n_fixed_edges: usize,
    pub step: u32,
    pub area_normalised: u32,
    pub step_size: f64,
}
// SAFETY: numbers and raw pointers; 8-byte alignment, size first.
sized!(ricci_flow_options, "options");

/// The library's options of a caller's; the defaults for NULL.
pub(crate) fn read_options(options: *const ricci_flow_options) -> Outcome<Options> {
    let given = structs::read(options)?;
    let step = match STEPS.choose(given.step)? {
        StepRule::Fixed(_) => StepRule::Fixed(given.step_size),
        rule => rule,
    };
    let fixed = arrays::array("fixed_edges", given.fixed_edges, given.n_fixed_edges)?;
    let default = Options::default();
    Ok(Options {
        method: METHODS.choose(given.method)?,
        fixed_edges: fixed.into_iter().map(EdgeId).collect(),
        pinned: Vec::new(),
        flips: FLIPS.choose(given.flips)?,
        tolerance: or(given.tolerance, default.tolerance),
        max_iterations: given.max_iterations,
        threads: given.threads,
        max_step: or(given.max_step, default.max_step),
        gradient: Gradient { step, area_normalised: given.area_normalised != 0 },
    })
}

/// Flows to the target and returns the metric at the end.
fn advance(flow: &mut Flow, target: &Target, control: &Control) -> Outcome<ricci_metric> {
    let end = flow.solve(target, control)?;
    if let Some(report) = end.report() {
        log::info!(
            "flow: {} after {} iterations, {} flips and {:.3} s, max |K - target| = {:.1e}",
            report.stop_reason,
            report.iterations,
            report.flips,
            report.seconds.total,
            report.max_curvature_error
        );
    }
    ricci_metric::at(end, None)
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_flow(
    metric: *const ricci_metric,
    target: *const ricci_target,
    options: *const ricci_flow_options,
    control: *const ricci_control,
    result: *mut *mut ricci_metric,
) -> ricci_status {
    guard::make(result, || {
        let solution = &shared(metric)?.0.solution;
        let _reserve = memory::work(solution.mesh().n_vertices(), memory::FLOW)?;
        let (surface, space, control) = (solution.surface(), solution.metric().space, control::of(control)?);
        let options = read_options(options)?;
        let target = target_of(target, surface, space)?;
        let target = with_cones_placed(&target, surface, space, &control)?;
        target.check(surface, Class::new(solution.scheme()?, space))?;
        advance(&mut Flow::resume(solution, &options, &control)?, &target, &control)
    })
}

pub struct ricci_solver {
    poisoned: bool,
    /// The process whose threads the flow keeps. One that is forked from it has none of them.
    process: u32,
    flow: ManuallyDrop<Flow>,
}
handle!(ricci_solver, "solver");

impl ricci_solver {
    fn is_of_this_process(&self) -> bool {
        self.process == std::process::id()
    }
}

impl MutableHandle for ricci_solver {
    fn poisoned(&mut self) -> &mut bool {
        self.poisoned |= !self.is_of_this_process();
        &mut self.poisoned
    }
}

impl Drop for ricci_solver {
    fn drop(&mut self) {
        if self.is_of_this_process() {
            // SAFETY: dropped once, here. In another process the end of threads that are not there would be waited for: it keeps the memory.
            unsafe { ManuallyDrop::drop(&mut self.flow) };
        }
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_solver_new(
    metric: *const ricci_metric,
    options: *const ricci_flow_options,
    solver: *mut *mut ricci_solver,
) -> ricci_status {
    guard::make(solver, || {
        let solution = &shared(metric)?.0.solution;
        let _reserve = memory::work(solution.mesh().n_vertices(), memory::FLOW)?;
        let flow = Flow::resume(solution, &read_options(options)?, &control::of_thread()?)?;
        Ok(ricci_solver { poisoned: false, process: std::process::id(), flow: ManuallyDrop::new(flow) })
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_solver_free(solver: *mut ricci_solver) {
    guard::free(solver);
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_solver_pin(
    solver: *mut ricci_solver,
    pinned: *const u32,
    n_pinned: usize,
) -> ricci_status {
    guard::call(|| {
        guard::change(solver, |ricci_solver { flow, .. }| {
            let pinned = vertices(flow.surface(), pinned, n_pinned)?;
            Ok(flow.pin(&pinned, &control::of_thread()?)?)
        })
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_solver_solve(
    solver: *mut ricci_solver,
    target: *const ricci_target,
    control: *const ricci_control,
    result: *mut *mut ricci_metric,
) -> ricci_status {
    guard::make(result, || {
        let control = control::of(control)?;
        guard::change(solver, |ricci_solver { flow, .. }| {
            let _reserve = memory::work(flow.mesh().n_vertices(), memory::FLOW)?;
            let target = target_of(target, flow.surface(), flow.metric().space)?;
            advance(flow, &target, &control)
        })
    })
}
