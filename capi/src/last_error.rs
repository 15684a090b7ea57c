//! The detail message of the last failure, one per thread.

use std::cell::RefCell;
use std::ffi::{CString, c_char};

thread_local! {
    static MESSAGE: RefCell<CString> = RefCell::default();
}

/// Keep the message of a failure. A NUL inside it (from a caller's path) would cut it short, so it is
/// replaced.
pub(crate) fn set(message: &str) {
    let text = CString::new(message.replace('\0', "\u{fffd}")).unwrap_or_default();
    let _ = MESSAGE.try_with(|last| last.replace(text));
}

/// The detail message of the last call of this thread that failed: which element, by how much, what to do.
///
/// Successful calls leave it alone. Empty if no call has failed.
/// @return a NUL-terminated UTF-8 string, valid until the next call of this thread; not to be freed.
#[unsafe(no_mangle)]
pub extern "C" fn ricci_last_error() -> *const c_char {
    MESSAGE.try_with(|last| last.borrow().as_ptr()).unwrap_or(c"".as_ptr())
}
