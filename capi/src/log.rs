//! Log messages of the library, which go to a callback of the host.

use crate::arrays::output_text;
use crate::choice::choices;
use crate::guard;
use crate::status::ricci_status;
use crate::wording::in_functions;
use log::{LevelFilter, Log, Metadata, Record};
use std::ffi::{c_char, c_void};
use std::sync::{PoisonError, RwLock};

choices!(LEVELS: LevelFilter = "level", [
    RICCI_LOG_OFF => LevelFilter::Off,
    RICCI_LOG_ERROR => LevelFilter::Error,
    RICCI_LOG_WARN => LevelFilter::Warn,
    RICCI_LOG_INFO => LevelFilter::Info,
    RICCI_LOG_DEBUG => LevelFilter::Debug,
    RICCI_LOG_TRACE => LevelFilter::Trace,
]);

pub type ricci_log_callback =
    Option<unsafe extern "C" fn(level: u32, message: *const c_char, user_data: *mut c_void)>;

/// The host's callback, with the data that it is called with.
struct LogSink {
    callback: unsafe extern "C" fn(u32, *const c_char, *mut c_void),
    user_data: *mut c_void,
}

// SAFETY: the header asks for a callback, and data, that may be used from any thread.
unsafe impl Send for LogSink {}
unsafe impl Sync for LogSink {}

static SINK: RwLock<Option<LogSink>> = RwLock::new(None);

/// The logger of the process, which hands every message to the callback that is in force.
struct SinkLogger;

impl Log for SinkLogger {
    fn enabled(&self, _: &Metadata<'_>) -> bool {
        true
    }

    fn log(&self, record: &Record<'_>) {
        let level = LEVELS.number(record.level().to_level_filter()).unwrap_or_default();
        let text = output_text(&in_functions(&record.args().to_string()));
        if let Some(sink) = &*SINK.read().unwrap_or_else(PoisonError::into_inner) {
            // SAFETY: the caller's function and data, valid until replaced (contract of the header).
            unsafe { (sink.callback)(level, text.as_ptr(), sink.user_data) };
        }
    }

    fn flush(&self) {}
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_log_set(
    callback: ricci_log_callback,
    user_data: *mut c_void,
    level: u32,
) -> ricci_status {
    guard::call(|| {
        let level = LEVELS.choose(level)?;
        let sink = callback.map(|callback| LogSink { callback, user_data });
        let level = if sink.is_some() { level } else { LevelFilter::Off };
        *SINK.write().unwrap_or_else(PoisonError::into_inner) = sink;
        // An error says that an earlier call has set the logger; then only the callback changes.
        let _ = log::set_logger(&SinkLogger);
        log::set_max_level(level);
        Ok(())
    })
}
