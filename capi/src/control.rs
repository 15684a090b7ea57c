//! Progress and cancellation of a running call.

use crate::choice::choices;
use crate::guard::{self, handle, output, shared};
use crate::status::ricci_status;
use ricci::Control;
use ricci::control::Stage;
use std::sync::atomic::{AtomicUsize, Ordering};

pub struct ricci_control {
    control: Control,
    /// Threads of calls that have no option for them, 0 for one per core.
    threads: AtomicUsize,
}
handle!(ricci_control, "control");

choices!(STAGES: Stage = "stage", [
    RICCI_STAGE_IDLE => Stage::Idle,
    RICCI_STAGE_READ => Stage::Read,
    RICCI_STAGE_BUILD => Stage::Build,
    RICCI_STAGE_FLOW => Stage::Flow,
    RICCI_STAGE_LAYOUT => Stage::Layout,
    RICCI_STAGE_WRITE => Stage::Write,
]);

/// The library's control of a handle; a new one for NULL.
pub(crate) fn of(control: *const ricci_control) -> Control {
    // SAFETY: NULL, or from this library and alive (contract of the header).
    unsafe { control.as_ref() }.map_or_else(Control::new, |control| control.control.clone())
}

/// The threads that a control asks for in calls without an option for them.
pub(crate) fn threads(control: *const ricci_control) -> usize {
    // SAFETY: as in `of`.
    unsafe { control.as_ref() }.map_or(0, |control| control.threads.load(Ordering::Relaxed))
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_control_new(control: *mut *mut ricci_control) -> ricci_status {
    guard::make(control, || Ok(ricci_control { control: Control::new(), threads: AtomicUsize::new(0) }))
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_control_set_threads(
    control: *const ricci_control,
    threads: usize,
) -> ricci_status {
    guard::with(control, |control| {
        control.threads.store(threads, Ordering::Relaxed);
        Ok(())
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_control_free(control: *mut ricci_control) {
    guard::free(control);
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_control_cancel(control: *const ricci_control) -> ricci_status {
    guard::with(control, |control| {
        control.control.cancel();
        Ok(())
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_control_progress(
    control: *const ricci_control,
    stage: *mut u32,
    fraction: *mut f64,
    since_cancel: *mut f64,
) -> ricci_status {
    guard::call(|| {
        let (stage, fraction) = (output("stage", stage)?, output("fraction", fraction)?);
        let control = &shared(control)?.control;
        let (now, done) = control.progress();
        stage.set(STAGES.number(now)?);
        fraction.set(done);
        if let Ok(seconds) = output("since_cancel", since_cancel) {
            seconds.set(control.since_cancel().map_or(-1.0, |time| time.as_secs_f64()));
        }
        Ok(())
    })
}
