//! The integer behind an enum value that comes from C.

use std::mem::MaybeUninit;

/// The integer that C passed for an enum: any value of its width may come.
pub fn raw<E>(value: MaybeUninit<E>) -> i32 {
    const { assert!(size_of::<E>() == size_of::<i32>()) };
    // SAFETY: same size, and C passed an initialised `int32_t`.
    unsafe { value.as_ptr().cast::<i32>().read() }
}
