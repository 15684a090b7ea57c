//! Queries of the last failure of the calling thread.

use crate::choice::choices;
use crate::failure::FailureElement;
use crate::guard;
use crate::status::ricci_status;
use crate::structs::{self, sized};
use crate::thread_failure::{self, FailureNumbers};
use std::ffi::c_char;

choices!(ELEMENTS: FailureElement = "element", [
    RICCI_ELEMENT_NONE => FailureElement::None,
    RICCI_ELEMENT_VERTEX => FailureElement::Vertex,
    RICCI_ELEMENT_EDGE => FailureElement::Edge,
    RICCI_ELEMENT_FACE => FailureElement::Face,
    RICCI_ELEMENT_ENTRY => FailureElement::Entry,
    RICCI_ELEMENT_LINE => FailureElement::Line,
    RICCI_ELEMENT_BYTE => FailureElement::Byte,
]);

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_failure {
    pub size: usize,
    pub status: ricci_status,
    pub element: u32,
    pub index: i64,
    pub amount: f64,
    pub needed: usize,
}
// SAFETY: numbers; 8-byte alignment, size first.
sized!(ricci_failure, "failure");

#[unsafe(no_mangle)]
pub extern "C" fn ricci_last_error() -> *const c_char {
    thread_failure::text()
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_last_failure(failure: *mut ricci_failure, size: usize) -> ricci_status {
    guard::call(|| {
        let FailureNumbers { status, at: (element, index), amount, needed } = thread_failure::numbers();
        let index = if element == FailureElement::None { -1 } else { index as i64 };
        let element = ELEMENTS.number(element)?;
        structs::write(ricci_failure { size, status, element, index, amount, needed }, failure, size)
    })
}
