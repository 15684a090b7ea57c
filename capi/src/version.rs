//! The version, in macros for the compiler and at run time for the loader.

use std::ffi::{CString, c_char};
use std::sync::OnceLock;

/// Version of this header: incompatible changes.
pub const RICCI_VERSION_MAJOR: i32 = 0;
/// Version of this header: additions.
pub const RICCI_VERSION_MINOR: i32 = 1;
/// Version of this header: corrections.
pub const RICCI_VERSION_PATCH: i32 = 0;

/// Version of the library that is running, "major.minor.patch".
///
/// Never fails; the text lives as long as the program.
/// @return a NUL-terminated string; not to be freed.
#[unsafe(no_mangle)]
pub extern "C" fn ricci_version() -> *const c_char {
    static TEXT: OnceLock<CString> = OnceLock::new();
    TEXT.get_or_init(|| CString::new(env!("CARGO_PKG_VERSION")).unwrap_or_default()).as_ptr()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn macros_agree_with_the_package() {
        let header = format!("{RICCI_VERSION_MAJOR}.{RICCI_VERSION_MINOR}.{RICCI_VERSION_PATCH}");
        assert_eq!(header, env!("CARGO_PKG_VERSION"));
    }
}
