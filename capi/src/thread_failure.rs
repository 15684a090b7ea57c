//! The last failure of every thread, kept until the thread's next one.

use crate::failure::{Failure, FailureElement};
use crate::status::*;
use std::cell::{Cell, UnsafeCell};
use std::ffi::c_char;

/// Bytes of the buffer for a message, with its final NUL.
const TEXT_BYTES: usize = 1024;

/// The numbers of a failure.
#[derive(Clone, Copy)]
pub struct FailureNumbers {
    pub status: ricci_status,
    pub at: (FailureElement, usize),
    pub amount: f64,
    pub needed: usize,
}

thread_local! {
    /// The message, in a buffer that has no destructor, so that its address is valid until the thread ends.
    static TEXT: UnsafeCell<[u8; TEXT_BYTES]> = const { UnsafeCell::new([0; TEXT_BYTES]) };
    static NUMBERS: Cell<FailureNumbers> = const { Cell::new(NOTHING) };
}

const NOTHING: FailureNumbers =
    FailureNumbers { status: RICCI_OK, at: (FailureElement::None, 0), amount: 0.0, needed: 0 };

/// Keeps a failure for this thread. A NUL inside the message, which may come from a caller's path, becomes a question mark.
pub fn keep(failure: &Failure) {
    let text = &failure.message;
    let most = text.len().min(TEXT_BYTES - 1);
    let end = (0..=most).rev().find(|&i| text.is_char_boundary(i)).unwrap_or(0);
    let _ = TEXT.try_with(|buffer| {
        // SAFETY: no reference into the buffer lives on; C reads it through a pointer on this thread only.
        let buffer = unsafe { &mut *buffer.get() };
        let kept = text.as_bytes()[..end].iter().map(|&byte| if byte == 0 { b'?' } else { byte });
        buffer.iter_mut().zip(kept.chain([0])).for_each(|(place, byte)| *place = byte);
    });
    let &Failure { status, at, amount, needed, .. } = failure;
    let _ = NUMBERS.try_with(|last| last.set(FailureNumbers { status, at, amount, needed }));
}

/// The message of the last failure of this thread, NUL-terminated.
pub fn text() -> *const c_char {
    TEXT.try_with(|buffer| buffer.get().cast_const().cast()).unwrap_or(c"".as_ptr())
}

/// The numbers of the last failure of this thread.
pub fn numbers() -> FailureNumbers {
    NUMBERS.try_with(Cell::get).unwrap_or(NOTHING)
}
