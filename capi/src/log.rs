//! Log messages of the library, handed to a callback of the host.

use crate::choice::{choice, choose};
use crate::guard;
use crate::status::ricci_status;
use log::{Level, LevelFilter, Log, Metadata, Record};
use std::ffi::{CString, c_char, c_void};
use std::mem::MaybeUninit;
use std::sync::{PoisonError, RwLock};

/// How much is logged; a message's own level is never RICCI_LOG_OFF.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ricci_log_level {
    /// Nothing.
    RICCI_LOG_OFF = 0,
    /// Internal errors.
    RICCI_LOG_ERROR = 1,
    /// Calls that fail, with their detail message.
    RICCI_LOG_WARN = 2,
    /// What was done: how each flow ended.
    RICCI_LOG_INFO = 3,
    /// Steps on the way.
    RICCI_LOG_DEBUG = 4,
    /// Everything.
    RICCI_LOG_TRACE = 5,
}

use ricci_log_level::*;

choice!(ricci_log_level, "level", LevelFilter, [
    RICCI_LOG_OFF => Off,
    RICCI_LOG_ERROR => Error,
    RICCI_LOG_WARN => Warn,
    RICCI_LOG_INFO => Info,
    RICCI_LOG_DEBUG => Debug,
    RICCI_LOG_TRACE => Trace,
]);

/// Receives one message. May be called from any thread, by several at once; it must not call into the
/// library. `message` is NUL-terminated UTF-8 and valid during the call only.
pub type ricci_log_callback =
    Option<unsafe extern "C" fn(level: ricci_log_level, message: *const c_char, user_data: *mut c_void)>;

struct Sink {
    callback: unsafe extern "C" fn(ricci_log_level, *const c_char, *mut c_void),
    user_data: *mut c_void,
}

// SAFETY: the header asks for a callback, and data, that may be used from any thread.
unsafe impl Send for Sink {}
unsafe impl Sync for Sink {}

static SINK: RwLock<Option<Sink>> = RwLock::new(None);

struct ToSink;

impl Log for ToSink {
    fn enabled(&self, _: &Metadata<'_>) -> bool {
        true
    }

    fn log(&self, record: &Record<'_>) {
        let level = match record.level() {
            Level::Error => RICCI_LOG_ERROR,
            Level::Warn => RICCI_LOG_WARN,
            Level::Info => RICCI_LOG_INFO,
            Level::Debug => RICCI_LOG_DEBUG,
            Level::Trace => RICCI_LOG_TRACE,
        };
        let text = CString::new(record.args().to_string().replace('\0', "\u{fffd}")).unwrap_or_default();
        if let Some(sink) = &*SINK.read().unwrap_or_else(PoisonError::into_inner) {
            // SAFETY: the caller's function and data, valid until replaced (contract of the header).
            unsafe { (sink.callback)(level, text.as_ptr(), sink.user_data) };
        }
    }

    fn flush(&self) {}
}

/// Send the library's log messages to a callback, for the whole process: the only global state there is.
///
/// Nothing is logged before the first call, and nothing is ever printed. When the call returns, the callback
/// that was set before is no longer running and will not be called again.
/// @return RICCI_OK, RICCI_ARGUMENT (unknown level).
///
/// @param callback   the function, or NULL to stop logging.
/// @param user_data  handed to the callback as it is; may be NULL.
/// @param level      the most detailed level that is sent.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_log_set(
    callback: ricci_log_callback,
    user_data: *mut c_void,
    level: MaybeUninit<ricci_log_level>,
) -> ricci_status {
    guard::call(|_| {
        let level = choose(level)?;
        let sink = callback.map(|callback| Sink { callback, user_data });
        let level = if sink.is_some() { level } else { LevelFilter::Off };
        *SINK.write().unwrap_or_else(PoisonError::into_inner) = sink;
        // Already set by an earlier call: the sink behind it is what changes.
        let _ = log::set_logger(&ToSink);
        log::set_max_level(level);
        Ok(())
    })
}
