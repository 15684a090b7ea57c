//! The status that every fallible call returns, as a number and as a sentence.

use std::ffi::{CStr, c_char};

pub type ricci_status = u32;

macro_rules! statuses {
    ($($name:ident = $number:literal => $text:literal,)+) => {
        $(pub const $name: ricci_status = $number;)+
        /// Every status with its name and its sentence.
        pub const STATUSES: &[(&str, ricci_status, &CStr)] = &[$((stringify!($name), $number, $text)),+];
    };
}

statuses! {
    RICCI_OK = 0 => c"done",
    RICCI_WRONG_SIZE = 1 => c"an array does not have the size the call needs",
    RICCI_ARGUMENT = 2 => c"an argument or option is outside its range",
    RICCI_TOO_LARGE = 3 => c"more elements than a 32-bit index can number",
    RICCI_CANCELLED = 4 => c"cancelled by the caller; inputs are unchanged",
    RICCI_NULL_POINTER = 10 => c"a pointer that must not be NULL is NULL",
    RICCI_PANIC = 11 => c"internal error of the library; the solver in use is poisoned",
    RICCI_POISONED = 12 => c"an earlier call on this solver ended in an internal error; it can only be freed",
    RICCI_BUFFER_TOO_SMALL = 13 => c"the caller's buffer is too small",
    RICCI_STRUCT_SIZE = 14 => c"a struct has a size or a field that this version of the library does not know",
    RICCI_NO_MEMORY = 15 => c"there is not enough memory; handles are unchanged",
    RICCI_LEFT_OUT = 16 => c"this part was left out when the library was built",
    RICCI_IO = 100 => c"a file could not be read or written",
    RICCI_PARSE = 101 => c"a file's content is not what its format says",
    RICCI_UNKNOWN_FORMAT = 102 => c"unknown file format",
    RICCI_DEFECTS = 200 => c"the faces do not form a connected oriented surface",
    RICCI_GLUING = 201 => c"the gluing of an intrinsic surface is inconsistent",
    RICCI_CONNECTIVITY = 202 => c"a rule of the connectivity does not hold",
    RICCI_EDGE_LENGTH = 300 => c"an edge length is not finite and positive",
    RICCI_TRIANGLE_INEQUALITY = 301 => c"edge lengths break the triangle inequality",
    RICCI_EDGE_WEIGHT = 302 => c"the scheme cannot represent the metric on an edge",
    RICCI_DOMAIN = 303 => c"a conformal variable is outside the metric's domain",
    RICCI_TARGET_AT_VERTEX = 400 => c"a target curvature is too large at a vertex",
    RICCI_TARGET_TOTAL = 401 => c"the target curvatures do not add up to what Gauss-Bonnet asks for",
    RICCI_TARGET_KIND = 402 => c"this kind of target does not exist here",
    RICCI_TARGET_BELOW = 403 => c"a target curvature is too small at a vertex",
    RICCI_FACTORISATION = 500 => c"a linear system could not be factorised",
    RICCI_LAYOUT = 600 => c"the metric has no layout in this space",
    RICCI_MATCHING = 650 => c"there is no map between two surfaces as it was asked for",
    RICCI_SPLINE = 700 => c"a spline, or what one is made from, is not what it must be",
}

#[unsafe(no_mangle)]
pub extern "C" fn ricci_status_text(status: ricci_status) -> *const c_char {
    let text = STATUSES.iter().find(|(_, known, _)| *known == status);
    text.map_or(c"unknown status", |(_, _, text)| text).as_ptr()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The numbers are read from the source of `Error::code`, because the enum is non-exhaustive: every variant of it must have a
    /// status here.
    #[test]
    fn every_error_of_the_library_has_a_status() {
        let source = include_str!("../../src/error.rs");
        let codes: Vec<u32> = source
            .lines()
            .filter_map(|line| line.trim().strip_prefix("Error::")?.split_once("=> "))
            .filter_map(|(_, code)| code.trim_end_matches(',').parse().ok())
            .collect();
        assert!(codes.len() >= 19, "only {} codes were found", codes.len());
        for code in codes {
            assert!(STATUSES.iter().any(|s| s.1 == code), "error {code} has no ricci_status");
        }
    }

    #[test]
    fn statuses_are_numbered_once() {
        assert!(STATUSES.windows(2).all(|pair| pair[0].1 < pair[1].1));
    }
}
