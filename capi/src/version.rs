//! The version of the library at run time, as text and as a number.

use std::ffi::{CString, c_char};
use std::sync::OnceLock;

#[unsafe(no_mangle)]
pub extern "C" fn ricci_version() -> *const c_char {
    static TEXT: OnceLock<CString> = OnceLock::new();
    TEXT.get_or_init(|| CString::new(env!("CARGO_PKG_VERSION")).unwrap_or_default()).as_ptr()
}

#[unsafe(no_mangle)]
pub extern "C" fn ricci_version_number() -> u32 {
    env!("CARGO_PKG_VERSION").split('.').fold(0, |n, part| 1000 * n + part.parse::<u32>().unwrap_or(0))
}
