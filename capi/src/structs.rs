//! Structs that cross the boundary with their size, so that later versions of the library can add fields at their end. Zero is the
//! default of every field.
//!
//! Every such struct has 8-byte alignment in all versions, so a size is a multiple of 8 and never splits a
//! field.

use crate::failure::{Failure, Outcome};
use crate::status::*;

/// Most bytes of a struct of any version.
const MOST_BYTES: usize = 4096;

/// A `repr(C)` struct of 8-byte alignment whose first member is its size, a `usize`.
///
/// # Safety
/// All fields are numbers and raw pointers, so that any bytes are a valid value, zeros among them.
pub unsafe trait Sized64: Copy {
    /// The name of the struct in messages.
    const NAME: &'static str;
    /// The names and places of its fields of 32 bits that have no meaning yet.
    const RESERVED: &'static [(&'static str, usize)];
    /// The struct with another size in its first member.
    fn with_size(self, size: usize) -> Self;
}

/// Implements [`Sized64`] for a struct whose first member is `size: usize`; its reserved fields follow its name in messages. A comment at
/// each use says why its contract holds.
macro_rules! sized {
    ($type:ty, $name:literal $(, $reserved:ident)*) => {
        unsafe impl $crate::structs::Sized64 for $type {
            const NAME: &'static str = $name;
            const RESERVED: &'static [(&'static str, usize)] =
                &[$((stringify!($reserved), std::mem::offset_of!($type, $reserved))),*];
            fn with_size(self, size: usize) -> Self {
                Self { size, ..self }
            }
        }
    };
}
pub(crate) use sized;

/// Refuses a size that no struct can have.
pub fn check(name: &str, size: usize) -> Outcome {
    if !(16..=MOST_BYTES).contains(&size) || !size.is_multiple_of(8) {
        let message = format!("{name} has size {size}: pass sizeof, and let ricci_init write it");
        return Err(Failure::new(RICCI_STRUCT_SIZE, message));
    }
    Ok(())
}

/// Refuses a place for a struct that [`write()`] refuses, before anything else is written.
pub fn check_place<S: Sized64>(place: *mut S, size: usize) -> Outcome {
    if place.is_null() {
        return Err(Failure::null(S::NAME));
    }
    check(S::NAME, size)
}

/// Writes `value` to a caller's struct of `size` bytes: the fields that both know, and zeros in those that only the caller knows.
pub fn write<S: Sized64>(value: S, place: *mut S, size: usize) -> Outcome {
    const { assert!(align_of::<S>() == 8 && size_of::<usize>() == 8) };
    check_place(place, size)?;
    let filled = size.min(size_of::<S>());
    let value = value.with_size(filled);
    // SAFETY: the caller's memory has `size` bytes (contract of the header), of which `filled` are copied.
    unsafe {
        std::ptr::copy_nonoverlapping((&raw const value).cast::<u8>(), place.cast::<u8>(), filled);
        place.cast::<u8>().add(filled).write_bytes(0, size - filled);
    }
    Ok(())
}

/// The caller's number, or the usual one if the caller's is zero.
pub fn or<T: Default + PartialEq>(given: T, usual: T) -> T {
    if given == T::default() { usual } else { given }
}

/// Reads a caller's struct. Fields that an older caller's struct does not have are zero; all are for NULL.
pub fn read<S: Sized64>(place: *const S) -> Outcome<S> {
    // SAFETY: zeros are valid (`Sized64`).
    let mut value: S = unsafe { std::mem::zeroed() };
    if place.is_null() {
        return Ok(value);
    }
    // SAFETY: the first member of the struct is its size.
    let size = unsafe { place.cast::<usize>().read_unaligned() };
    check(S::NAME, size)?;
    // SAFETY: the caller's struct has `size` bytes; fields that this library does not know must be 0.
    if (size_of::<S>()..size).any(|i| unsafe { place.cast::<u8>().add(i).read() } != 0) {
        let message = format!("{} has fields that this version of the library does not know", S::NAME);
        return Err(Failure::new(RICCI_STRUCT_SIZE, message));
    }
    let known = size.min(size_of::<S>());
    // SAFETY: both structs have at least `known` bytes, and any bytes are valid (`Sized64`).
    unsafe { std::ptr::copy_nonoverlapping(place.cast::<u8>(), (&raw mut value).cast::<u8>(), known) };
    for &(field, at) in S::RESERVED {
        // SAFETY: the field lies inside the struct.
        let given = unsafe { (&raw const value).cast::<u8>().add(at).cast::<u32>().read() };
        if given != 0 {
            let message = format!("{}.{field} is {given}: it must be 0, as ricci_init leaves it", S::NAME);
            return Err(Failure::new(RICCI_STRUCT_SIZE, message));
        }
    }
    Ok(value.with_size(size_of::<S>()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[repr(C)]
    #[derive(Debug, Clone, Copy, PartialEq)]
    struct SampleOptions {
        size: usize,
        x: f64,
        n: u32,
        reserved: u32,
    }
    // SAFETY: numbers; 8-byte alignment, size first.
    sized!(SampleOptions, "options", reserved);

    const GIVEN: SampleOptions = SampleOptions { size: 24, x: 2.5, n: 7, reserved: 0 };

    /// The bytes of a struct at an odd address, followed by bytes of another value.
    fn bytes(size: usize, tail: u8) -> Vec<u8> {
        let fields = [&size.to_ne_bytes()[..], &2.5_f64.to_ne_bytes(), &7_u32.to_ne_bytes(), &[0; 4]];
        [&[0], &fields.concat()[..], &[tail; 16]].concat()
    }

    #[test]
    fn structs_of_any_size_and_alignment_are_read() {
        let read_at = |bytes: &[u8]| read::<SampleOptions>(bytes[1..].as_ptr().cast());
        assert_eq!(read_at(&bytes(24, 0)).unwrap(), GIVEN);
        // The struct of an older caller ends before n. The additional fields of a newer one must be zero.
        assert_eq!(read_at(&bytes(16, 0)).unwrap(), SampleOptions { n: 0, ..GIVEN });
        assert_eq!(read_at(&bytes(40, 0)).unwrap(), GIVEN);
        assert_eq!(read_at(&bytes(40, 1)).unwrap_err().status, RICCI_STRUCT_SIZE);
        for size in [0, 8, 23, 4104, usize::MAX] {
            assert_eq!(read_at(&bytes(size, 0)).unwrap_err().status, RICCI_STRUCT_SIZE, "{size}");
        }
        let mut used = bytes(24, 0);
        used[1 + 20] = 3;
        let failure = read_at(&used).unwrap_err();
        assert_eq!(failure.status, RICCI_STRUCT_SIZE);
        assert!(failure.message.contains("options.reserved is 3"), "{}", failure.message);
        let none = read::<SampleOptions>(std::ptr::null()).unwrap();
        assert_eq!(none, SampleOptions { size: 0, x: 0.0, n: 0, reserved: 0 });
    }

    #[test]
    fn structs_are_written_to_their_size_and_no_further() {
        for (size, filled) in [(16, 16), (24, 24), (40, 24)] {
            let mut place = [0xa5_u8; 49];
            write(GIVEN, place[1..].as_mut_ptr().cast(), size).unwrap();
            let expected = bytes(filled, 0);
            assert_eq!(place[1..=filled], expected[1..=filled]);
            assert!(place[1 + filled..=size].iter().all(|&b| b == 0));
            assert!(place[1 + size..].iter().all(|&b| b == 0xa5));
        }
        assert_eq!(write(GIVEN, std::ptr::null_mut(), 24).unwrap_err().status, RICCI_NULL_POINTER);
    }
}
