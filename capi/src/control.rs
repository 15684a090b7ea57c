//! Progress and cancellation of a running call.

use crate::call_control::{self, HostControl};
use crate::choice::choices;
use crate::failure::{Failure, Outcome};
use crate::guard::{self, handle, output, shared};
use crate::status::ricci_status;
use ricci::Control;
use ricci::control::Stage;
use std::sync::Arc;

pub struct ricci_control(Arc<HostControl>);
handle!(ricci_control, "control");

choices!(STAGES: Stage = "stage", [
    RICCI_STAGE_IDLE => Stage::Idle,
    RICCI_STAGE_READ => Stage::Read,
    RICCI_STAGE_BUILD => Stage::Build,
    RICCI_STAGE_FLOW => Stage::Flow,
    RICCI_STAGE_LAYOUT => Stage::Layout,
    RICCI_STAGE_WRITE => Stage::Write,
]);

fn host<'a>(control: *const ricci_control) -> Option<&'a HostControl> {
    // SAFETY: NULL, or from this library and alive (contract of the header).
    unsafe { control.as_ref() }.map(|control| &*control.0)
}

/// The library's control of the call that this thread is in: that of the handle; for NULL the one that the thread uses; else a new one. One
/// that was cancelled ends the call here.
pub(crate) fn of(control: *const ricci_control) -> Outcome<Control> {
    let control = call_control::begin(host(control));
    control.check()?;
    Ok(control)
}

/// [`of`] for a call that takes no handle.
pub(crate) fn of_thread() -> Outcome<Control> {
    of(std::ptr::null())
}

/// The threads that a control asks for in calls without an option for them.
pub(crate) fn threads(control: *const ricci_control) -> usize {
    call_control::threads(host(control))
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_control_new(control: *mut *mut ricci_control) -> ricci_status {
    guard::make(control, || Ok(ricci_control(Arc::new(HostControl::new()))))
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_control_use(control: *const ricci_control) -> ricci_status {
    guard::call(|| {
        // SAFETY: as in `host`.
        call_control::use_in_thread(unsafe { control.as_ref() }.map(|control| control.0.clone()));
        Ok(())
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_control_part(
    control: *const ricci_control,
    from: f64,
    to: f64,
) -> ricci_status {
    guard::with(control, |control| {
        if !(0.0 <= from && from <= to && to <= 1.0) {
            let message = format!("the part {from} to {to} of the progress does not lie in 0 to 1");
            return Err(Failure::argument(message));
        }
        control.0.set_range([from, to]);
        Ok(())
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_control_set_threads(
    control: *const ricci_control,
    threads: usize,
) -> ricci_status {
    guard::with(control, |control| {
        control.0.set_threads(threads);
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
        control.0.control.cancel();
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
        let control = &shared(control)?.0.control;
        let (now, done) = control.progress();
        stage.set(STAGES.number(now)?);
        fraction.set(done);
        if let Ok(seconds) = output("since_cancel", since_cancel) {
            seconds.set(control.since_cancel().map_or(-1.0, |time| time.as_secs_f64()));
        }
        Ok(())
    })
}
