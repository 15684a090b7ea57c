//! Arrays from and to C. A caller's array may be unaligned; counts are checked before they are multiplied.

use crate::failure::{Failure, FailureElement, Outcome};
use crate::guard::output;
use crate::status::*;
use ricci::mesh::Point;
use std::ffi::{CStr, CString, c_char};
use std::path::PathBuf;

/// An empty list with room for `n` entries.
pub fn room<T>(what: &str, n: usize) -> Outcome<Vec<T>> {
    let mut items = Vec::new();
    match items.try_reserve_exact(n) {
        Ok(()) => Ok(items),
        Err(_) => Err(Failure::new(RICCI_NO_MEMORY, format!("{what}: no memory for {n} entries")).needs(n)),
    }
}

/// Copies `n` items that lie `stride` bytes apart in a caller's array.
fn gather<T: Copy>(what: &str, data: *const T, n: usize, stride: usize) -> Outcome<Vec<T>> {
    if n == 0 {
        return Ok(Vec::new());
    }
    if data.is_null() {
        return Err(Failure::null(what));
    }
    let extent = (n - 1).checked_mul(stride).and_then(|bytes| bytes.checked_add(size_of::<T>()));
    if extent.is_none_or(|bytes| bytes > isize::MAX as usize) {
        let message = format!("{what}: no array of {n} entries can exist in memory");
        return Err(Failure::new(RICCI_TOO_LARGE, message).needs(n));
    }
    let mut items = room(what, n)?;
    // SAFETY: the caller's array has n items, stride bytes apart (contract of the header); they are read
    // without regard to alignment.
    items.extend((0..n).map(|i| unsafe { data.cast::<u8>().add(i * stride).cast::<T>().read_unaligned() }));
    Ok(items)
}

/// A copy of a caller's array of `n` items.
pub fn array<T: Copy>(what: &str, data: *const T, n: usize) -> Outcome<Vec<T>> {
    gather(what, data, n, size_of::<T>())
}

/// A copy of a caller's array, which must have `needed` entries.
pub fn array_of<T: Copy>(what: &str, data: *const T, n: usize, needed: usize) -> Outcome<Vec<T>> {
    if n != needed {
        let message = format!("{what} has {n} entries, {needed} are needed");
        return Err(Failure::new(RICCI_WRONG_SIZE, message).needs(needed));
    }
    array(what, data, n)
}

/// A copy of a caller's array; NULL means that the caller leaves it out.
pub fn optional<T: Copy>(what: &str, data: *const f64, n: usize) -> Outcome<Option<Vec<T>>> {
    if data.is_null() { Ok(None) } else { array(what, data.cast(), n).map(Some) }
}

/// A caller's single value; NULL means that the caller leaves it out.
pub fn one<T: Copy>(data: *const T) -> Outcome<Option<T>> {
    Ok(array("value", data, usize::from(!data.is_null()))?.pop())
}

/// Copies `n` points; the coordinates x, y, z of successive points start `stride` bytes apart, 0 meaning tightly packed.
pub fn points(data: *const f64, stride: usize, n: usize) -> Outcome<Vec<Point>> {
    let stride = if stride == 0 { size_of::<Point>() } else { stride };
    if stride < size_of::<Point>() {
        return Err(Failure::argument(format!(
            "stride is {stride}: positions take at least 24 bytes (or 0 for tightly packed)"
        )));
    }
    gather("positions", data.cast::<Point>(), n, stride)
}

/// Copies `n` faces. An index of 2^31 or more is refused as a negative one: no mesh has so many vertices, and a caller may have
/// cast faces of `int32_t`.
pub fn faces(data: *const u32, n: usize) -> Outcome<Vec<[u32; 3]>> {
    let faces: Vec<[u32; 3]> = array("faces", data.cast(), n)?;
    for (f, face) in faces.iter().enumerate() {
        if let Some(k) = face.iter().position(|&v| (v as i32) < 0) {
            let v = face[k] as i32;
            let message = format!("face {f}, corner {k}: vertex {v} is negative; indices are 0-based");
            return Err(Failure::argument(message).at(FailureElement::Face, f));
        }
    }
    Ok(faces)
}

/// Refuses a buffer that cannot take `needed` entries.
pub fn check_buffer<T>(what: &str, needed: usize, buffer: *mut T, capacity: usize) -> Outcome {
    if capacity < needed {
        let message = format!("{what}: {needed} entries are needed, the buffer has room for {capacity}");
        let failure = Failure::new(RICCI_BUFFER_TOO_SMALL, message).needs(needed);
        return Err(Failure { is_question: buffer.is_null() && capacity == 0, ..failure });
    }
    if buffer.is_null() && needed > 0 { Err(Failure::null(what)) } else { Ok(()) }
}

/// An entry of a result: a number, or a row of numbers, which are copied to the caller one after the other.
pub trait CopiedRow: Copy {
    type Entry: Copy;
    fn entries(rows: &[Self]) -> &[Self::Entry];
}

macro_rules! entries {
    ($($number:ty)+) => {$(
        impl CopiedRow for $number {
            type Entry = $number;
            fn entries(rows: &[$number]) -> &[$number] {
                rows
            }
        }
    )+};
}
entries!(f64 u8 i32 u32 i64 usize);

impl<T: CopiedRow, const N: usize> CopiedRow for [T; N] {
    type Entry = T::Entry;
    fn entries(rows: &[[T; N]]) -> &[T::Entry] {
        T::entries(rows.as_flattened())
    }
}

/// Copies results into the caller's buffer of `capacity` entries.
pub fn copy_out<T: CopiedRow>(what: &str, values: &[T], buffer: *mut T::Entry, capacity: usize) -> Outcome {
    let values = T::entries(values);
    check_buffer(what, values.len(), buffer, capacity)?;
    if !values.is_empty() {
        let bytes = size_of_val(values);
        // SAFETY: the caller's buffer has room for `capacity` entries (contract of the header).
        unsafe { std::ptr::copy_nonoverlapping(values.as_ptr().cast::<u8>(), buffer.cast::<u8>(), bytes) };
    }
    Ok(())
}

/// Copies the `n` values of an iterator into the caller's buffer.
pub fn copy_each<T: CopiedRow>(
    what: &str,
    n: usize,
    values: impl IntoIterator<Item = T>,
    buffer: *mut T::Entry,
    capacity: usize,
) -> Outcome {
    check_buffer(what, n * (size_of::<T>() / size_of::<T::Entry>()), buffer, capacity)?;
    let mut all = room(what, n)?;
    all.extend(values);
    copy_out(what, &all, buffer, capacity)
}

/// A caller's buffer, and its capacity in entries.
pub struct CallerBuffer<T>(pub *mut T, pub usize);

/// Copies rows of different lengths into two buffers: the entries of all rows one after the other, and the offsets at which each
/// row starts and the last one ends.
pub fn copy_rows<T: CopiedRow<Entry = T>>(
    what: &str,
    rows: impl IntoIterator<Item = impl IntoIterator<Item = T>>,
    to: CallerBuffer<T>,
    starts_to: CallerBuffer<usize>,
) -> Outcome {
    let (mut entries, mut starts) = (Vec::new(), vec![0]);
    for row in rows {
        entries.extend(row);
        starts.push(entries.len());
    }
    check_buffer(what, entries.len(), to.0, to.1)?;
    copy_out("starts", &starts, starts_to.0, starts_to.1)?;
    copy_out(what, &entries, to.0, to.1)
}

/// Copies results whose number the caller cannot know before, and writes that number to `count`. NULL with capacity 0 asks for the
/// number alone.
pub fn copy_counted<T: CopiedRow<Entry = T>>(
    what: &str,
    values: &[T],
    buffer: *mut T,
    capacity: usize,
    count: *mut usize,
) -> Outcome {
    let count = output("the place for the number of entries", count)?;
    if !buffer.is_null() || capacity > 0 {
        copy_out(what, values, buffer, capacity)?;
    }
    count.set(values.len());
    Ok(())
}

/// Copies `n` points in ambient coordinates, which must be finite.
pub fn ambient(what: &str, data: *const f64, n: usize) -> Outcome<Vec<[f64; 3]>> {
    let points: Vec<[f64; 3]> = array(what, data.cast(), n)?;
    match points.iter().position(|p| p.iter().any(|x| !x.is_finite())) {
        Some(i) => {
            Err(Failure::argument(format!("{what}: row {i} is not finite")).at(FailureElement::Entry, i))
        }
        None => Ok(points),
    }
}

/// A caller's text, which must be UTF-8.
pub fn text<'a>(what: &str, text: *const c_char) -> Outcome<&'a str> {
    if text.is_null() {
        return Err(Failure::null(what));
    }
    // SAFETY: NUL-terminated (contract of the header), and alive during the call.
    let text = unsafe { CStr::from_ptr(text) };
    text.to_str().map_err(|_| Failure::argument(format!("{what} is not UTF-8")))
}

/// A text of a result as C has it; a zero in it would end it.
pub fn output_text(text: &str) -> CString {
    CString::new(text.replace('\0', "\u{fffd}")).unwrap_or_default()
}

/// A caller's file name.
pub fn path(name: *const c_char) -> Outcome<PathBuf> {
    text("path", name).map(PathBuf::from)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arrays_are_read_at_any_address_and_stride() {
        let numbers: Vec<u8> = (0..9).flat_map(|i| f64::from(i).to_ne_bytes()).collect();
        let odd = [&[0], &numbers[..]].concat();
        let at = odd[1..].as_ptr().cast::<f64>();
        assert_eq!(array("x", at, 9).unwrap(), (0..9).map(f64::from).collect::<Vec<_>>());
        assert_eq!(points(at, 0, 3).unwrap()[2], [6.0, 7.0, 8.0]);
        assert_eq!(points(at, 32, 2).unwrap(), [[0.0, 1.0, 2.0], [4.0, 5.0, 6.0]]);
        assert_eq!(points(at, 23, 2).unwrap_err().status, RICCI_ARGUMENT);
        assert_eq!(array("x", at, usize::MAX / 2).unwrap_err().status, RICCI_TOO_LARGE);
        assert_eq!(array("x", std::ptr::null::<f64>(), 1).unwrap_err().status, RICCI_NULL_POINTER);
        assert!(array("x", std::ptr::null::<f64>(), 0).unwrap().is_empty());
    }

    #[test]
    fn results_are_written_whole_or_not_at_all() {
        let (mut place, rows) = ([0xa5_u8; 33], [[1_u32, 2], [3, 4]]);
        let at = place[1..].as_mut_ptr().cast::<u32>();
        let small = copy_out("x", &rows, at, 3).unwrap_err();
        assert_eq!((small.status, small.needed, small.is_question), (RICCI_BUFFER_TOO_SMALL, 4, false));
        copy_out("x", &rows, at, 7).unwrap();
        let written: Vec<u8> = rows.as_flattened().iter().flat_map(|n| n.to_ne_bytes()).collect();
        assert_eq!(place[1..17], written);
        assert!(place[17..].iter().all(|&b| b == 0xa5));
        assert!(copy_out("x", &rows, std::ptr::null_mut(), 0).unwrap_err().is_question);
        assert_eq!(copy_out("x", &rows, std::ptr::null_mut(), 8).unwrap_err().status, RICCI_NULL_POINTER);
    }
}
