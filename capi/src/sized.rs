//! Structs that cross the boundary with their size, so that later versions can add fields at their end.
//!
//! Every such struct has 8-byte alignment in all versions, so a size is a multiple of 8 and never splits a
//! field.

use crate::failure::{Failure, Outcome};
use crate::status::ricci_status;

/// A `repr(C)` struct of 8-byte alignment whose first member is its size, `usize`, and that any bytes
/// written by C make valid.
///
/// # Safety
/// As it says; enums inside are `MaybeUninit` or only ever written by the library.
pub unsafe trait Sized64: Copy {
    /// Its name in messages.
    const NAME: &'static str;
    /// Set the first member.
    fn with_size(self, size: usize) -> Self;
}

/// Makes a struct whose first member is `size: usize` one that crosses the boundary with its size. Whoever calls this says why the
/// contract of [`Sized64`] holds.
macro_rules! sized {
    ($type:ty, $name:literal) => {
        unsafe impl $crate::sized::Sized64 for $type {
            const NAME: &'static str = $name;
            fn with_size(self, size: usize) -> Self {
                Self { size, ..self }
            }
        }
    };
}
pub(crate) use sized;

fn check<S: Sized64>(size: usize) -> Outcome {
    const { assert!(align_of::<S>() == 8 && size_of::<usize>() == 8) };
    if size < 16 || !size.is_multiple_of(8) {
        return Err(Failure::new(
            ricci_status::RICCI_STRUCT_SIZE,
            format!("{} has size {size}: pass sizeof, and let its init function fill it", S::NAME),
        ));
    }
    Ok(())
}

/// Write `value` to a caller whose struct has `size` bytes: the fields it knows.
pub fn write<S: Sized64>(value: S, place: *mut S, size: usize) -> Outcome {
    if place.is_null() {
        return Err(Failure::null(S::NAME));
    }
    check::<S>(size)?;
    let filled = size.min(size_of::<S>());
    let value = value.with_size(filled);
    // SAFETY: the caller's memory has `size` bytes (contract of the header), of which `filled` are written.
    unsafe { std::ptr::copy_nonoverlapping((&raw const value).cast::<u8>(), place.cast::<u8>(), filled) };
    Ok(())
}

/// Read a caller's struct over `default`: fields it does not know keep their default. NULL is the default.
pub fn read<S: Sized64>(default: S, place: *const S) -> Outcome<S> {
    if place.is_null() {
        return Ok(default);
    }
    // SAFETY: the first member of the struct is its size.
    let size = unsafe { place.cast::<usize>().read_unaligned() };
    check::<S>(size)?;
    // SAFETY: the caller's struct has `size` bytes; fields beyond ours are newer than this library and must
    // be 0.
    let rest = (size_of::<S>()..size.min(4096)).any(|i| unsafe { place.cast::<u8>().add(i).read() } != 0);
    if size > 4096 || rest {
        return Err(Failure::new(
            ricci_status::RICCI_STRUCT_SIZE,
            format!("{} has fields that this version of the library does not know", S::NAME),
        ));
    }
    let mut value = default;
    let known = size.min(size_of::<S>());
    // SAFETY: both have `known` bytes, and any bytes are valid (`Sized64`).
    unsafe { std::ptr::copy_nonoverlapping(place.cast::<u8>(), (&raw mut value).cast::<u8>(), known) };
    Ok(value.with_size(size_of::<S>()))
}
