//! What a call returns.

use crate::integer::raw;
use std::ffi::{CStr, c_char};
use std::mem::MaybeUninit;

/// What a call returns. 1-9 are errors of the call, 10-99 of the C face, 100s of files, 200s of meshes, 300s
/// of metrics, 400s of targets, 500s of solvers, 600s of layouts. A number is never given out again.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ricci_status {
    /// Done.
    RICCI_OK = 0,
    /// An array does not have the size the call needs.
    RICCI_WRONG_SIZE = 1,
    /// An argument or option is outside its range.
    RICCI_ARGUMENT = 2,
    /// More elements than a 32-bit index can number.
    RICCI_TOO_LARGE = 3,
    /// Cancelled through the ricci_control; inputs are unchanged.
    RICCI_CANCELLED = 4,
    /// A pointer that must not be NULL is NULL.
    RICCI_NULL_POINTER = 10,
    /// An internal error, a defect of the library; the handles the call was using are poisoned.
    RICCI_PANIC = 11,
    /// An earlier call on this handle ended in RICCI_PANIC; it can only be freed.
    RICCI_POISONED = 12,
    /// The caller's buffer is too small; the message says how many entries are needed.
    RICCI_BUFFER_TOO_SMALL = 13,
    /// A struct has a size that no version of the library knows.
    RICCI_STRUCT_SIZE = 14,
    /// A file could not be read or written.
    RICCI_IO = 100,
    /// A file's content is not what its format says.
    RICCI_PARSE = 101,
    /// No reader or writer for this file name.
    RICCI_UNKNOWN_FORMAT = 102,
    /// The faces do not form a connected oriented surface; ricci_diagnose_arrays lists every defect.
    RICCI_DEFECTS = 200,
    /// The gluing of an intrinsic surface is inconsistent.
    RICCI_GLUING = 201,
    /// A rule of the connectivity does not hold.
    RICCI_CONNECTIVITY = 202,
    /// An edge length is not finite and positive.
    RICCI_EDGE_LENGTH = 300,
    /// Edge lengths break the triangle inequality.
    RICCI_TRIANGLE_INEQUALITY = 301,
    /// The scheme cannot represent the metric on an edge.
    RICCI_EDGE_WEIGHT = 302,
    /// A conformal variable is outside the metric's domain.
    RICCI_DOMAIN = 303,
    /// A target curvature is too large at a vertex.
    RICCI_TARGET_AT_VERTEX = 400,
    /// The target curvatures do not add up to what Gauss-Bonnet asks for.
    RICCI_TARGET_TOTAL = 401,
    /// This kind of target does not exist here.
    RICCI_TARGET_KIND = 402,
    /// A target curvature is too small at a vertex.
    RICCI_TARGET_BELOW = 403,
    /// A linear system could not be factorised.
    RICCI_FACTORISATION = 500,
    /// The metric has no layout in this space.
    RICCI_LAYOUT = 600,
}

use ricci_status::*;

/// Every status with its sentence.
const TEXTS: &[(ricci_status, &CStr)] = &[
    (RICCI_OK, c"done"),
    (RICCI_WRONG_SIZE, c"an array does not have the size the call needs"),
    (RICCI_ARGUMENT, c"an argument or option is outside its range"),
    (RICCI_TOO_LARGE, c"more elements than a 32-bit index can number"),
    (RICCI_CANCELLED, c"cancelled by the caller; inputs are unchanged"),
    (RICCI_NULL_POINTER, c"a pointer that must not be NULL is NULL"),
    (RICCI_PANIC, c"internal error of the library; the handles in use are poisoned"),
    (RICCI_POISONED, c"an earlier call on this handle ended in an internal error; it can only be freed"),
    (RICCI_BUFFER_TOO_SMALL, c"the caller's buffer is too small"),
    (RICCI_STRUCT_SIZE, c"a struct has a size that no version of the library knows"),
    (RICCI_IO, c"a file could not be read or written"),
    (RICCI_PARSE, c"a file's content is not what its format says"),
    (RICCI_UNKNOWN_FORMAT, c"unknown file format"),
    (RICCI_DEFECTS, c"the faces do not form a connected oriented surface"),
    (RICCI_GLUING, c"the gluing of an intrinsic surface is inconsistent"),
    (RICCI_CONNECTIVITY, c"a rule of the connectivity does not hold"),
    (RICCI_EDGE_LENGTH, c"an edge length is not finite and positive"),
    (RICCI_TRIANGLE_INEQUALITY, c"edge lengths break the triangle inequality"),
    (RICCI_EDGE_WEIGHT, c"the scheme cannot represent the metric on an edge"),
    (RICCI_DOMAIN, c"a conformal variable is outside the metric's domain"),
    (RICCI_TARGET_AT_VERTEX, c"a target curvature is too large at a vertex"),
    (RICCI_TARGET_TOTAL, c"the target curvatures do not add up to what Gauss-Bonnet asks for"),
    (RICCI_TARGET_KIND, c"this kind of target does not exist here"),
    (RICCI_TARGET_BELOW, c"a target curvature is too small at a vertex"),
    (RICCI_FACTORISATION, c"a linear system could not be factorised"),
    (RICCI_LAYOUT, c"the metric has no layout in this space"),
];

impl ricci_status {
    /// The status of a library error with this code.
    pub fn from_code(code: u32) -> Option<ricci_status> {
        TEXTS.iter().map(|&(status, _)| status).find(|&status| status as u32 == code)
    }
}

/// One sentence on a status, in English; the text lives as long as the program.
///
/// Never fails: a number that is no status gives "unknown status".
/// @return a NUL-terminated UTF-8 string; not to be freed.
///
/// @param status  what a call returned.
#[unsafe(no_mangle)]
pub extern "C" fn ricci_status_text(status: MaybeUninit<ricci_status>) -> *const c_char {
    let code = raw(status);
    let text = TEXTS.iter().find(|(known, _)| *known as i32 == code);
    text.map_or(c"unknown status", |(_, text)| text).as_ptr()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The numbers in the body of `Error::code`, read from the source: the enum is non-exhaustive, and a
    /// variant added there must be added here.
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
            assert!(ricci_status::from_code(code).is_some(), "error {code} has no ricci_status");
        }
    }

    #[test]
    fn statuses_are_numbered_once() {
        let mut codes: Vec<i32> = TEXTS.iter().map(|&(status, _)| status as i32).collect();
        let n = codes.len();
        codes.sort_unstable();
        codes.dedup();
        assert_eq!(codes.len(), n);
    }
}
