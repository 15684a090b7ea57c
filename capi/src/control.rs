//! Progress and cancellation of a running call.

use crate::guard::{self, output};
use crate::status::ricci_status;
use ricci::Control;
use ricci::control::Stage;

/// Progress of a long call and the means to cancel it. Every function on it may be called from any thread at
/// any time between ricci_control_new and ricci_control_free.
pub struct ricci_control(Control);

/// What a long call is doing.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ricci_stage {
    /// Nothing has started.
    RICCI_STAGE_IDLE = 0,
    /// Reading a file.
    RICCI_STAGE_READ = 1,
    /// Building connectivity.
    RICCI_STAGE_BUILD = 2,
    /// Solving for the metric.
    RICCI_STAGE_FLOW = 3,
    /// Laying the metric out.
    RICCI_STAGE_LAYOUT = 4,
    /// Writing a file.
    RICCI_STAGE_WRITE = 5,
}

impl From<Stage> for ricci_stage {
    fn from(stage: Stage) -> ricci_stage {
        match stage {
            Stage::Idle => ricci_stage::RICCI_STAGE_IDLE,
            Stage::Read => ricci_stage::RICCI_STAGE_READ,
            Stage::Build => ricci_stage::RICCI_STAGE_BUILD,
            Stage::Flow => ricci_stage::RICCI_STAGE_FLOW,
            Stage::Layout => ricci_stage::RICCI_STAGE_LAYOUT,
            Stage::Write => ricci_stage::RICCI_STAGE_WRITE,
        }
    }
}

/// The library's handle; a fresh one for NULL.
pub(crate) fn of(control: *const ricci_control) -> Control {
    // SAFETY: NULL, or from this library and alive (contract of the header).
    unsafe { control.as_ref() }.map_or_else(Control::new, |control| control.0.clone())
}

fn open<'a>(control: *const ricci_control) -> Result<&'a Control, crate::failure::Failure> {
    // SAFETY: as in `of`.
    unsafe { control.as_ref() }.map(|c| &c.0).ok_or_else(|| crate::failure::Failure::null("control"))
}

/// A fresh control: no progress, not cancelled. Use one per long call.
///
/// @return RICCI_OK, RICCI_NULL_POINTER.
///
/// @param control  out: the new handle, to be released by ricci_control_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_control_new(control: *mut *mut ricci_control) -> ricci_status {
    guard::call(|_| {
        output("control", control)?.set(Box::into_raw(Box::new(ricci_control(Control::new()))));
        Ok(())
    })
}

/// Release a control. A call that is still running with it keeps what it needs.
///
/// @param control  the handle, or NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_control_free(control: *mut ricci_control) {
    guard::free(control);
}

/// Ask the running call, and every later one with this control, to stop; it cannot be taken back.
///
/// The call returns RICCI_CANCELLED at its next check, its inputs unchanged and no output written; a
/// factorisation under way finishes first.
/// @return RICCI_OK, RICCI_NULL_POINTER.
///
/// @param control  the handle the call was given.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_control_cancel(control: *const ricci_control) -> ricci_status {
    guard::call(|_| {
        open(control)?.cancel();
        Ok(())
    })
}

/// What the call is doing and how far it is.
///
/// @return RICCI_OK, RICCI_NULL_POINTER.
///
/// @param control   the handle the call was given.
/// @param stage     out: what it is doing.
/// @param fraction  out: the part of this stage that is done, in [0, 1].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_control_progress(
    control: *const ricci_control,
    stage: *mut ricci_stage,
    fraction: *mut f64,
) -> ricci_status {
    guard::call(|_| {
        let (stage, fraction) = (output("stage", stage)?, output("fraction", fraction)?);
        let (now, done) = open(control)?.progress();
        stage.set(now.into());
        fraction.set(done);
        Ok(())
    })
}

/// Time since ricci_control_cancel; asked right after a call has returned RICCI_CANCELLED it is the latency.
///
/// @return RICCI_OK, RICCI_NULL_POINTER.
///
/// @param control  the handle.
/// @param seconds  out: seconds since the first cancel, or -1 if it was not cancelled.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_control_since_cancel(
    control: *const ricci_control,
    seconds: *mut f64,
) -> ricci_status {
    guard::call(|_| {
        let seconds = output("seconds", seconds)?;
        seconds.set(open(control)?.since_cancel().map_or(-1.0, |time| time.as_secs_f64()));
        Ok(())
    })
}
