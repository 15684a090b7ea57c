//! Arrays from and to C. Nothing here trusts alignment; counts are checked before they are multiplied.

use crate::failure::{Failure, Outcome};
use crate::guard::output;
use crate::status::ricci_status;
use ricci::mesh::Point;
use std::ffi::{CStr, c_char};
use std::path::PathBuf;

/// Bytes of `n` items that lie `stride` bytes apart, if an array of that size can exist.
fn check_extent(what: &str, n: usize, stride: usize, size: usize) -> Outcome {
    let extent = n.saturating_sub(1).checked_mul(stride).and_then(|bytes| bytes.checked_add(size));
    match extent {
        Some(bytes) if bytes <= isize::MAX as usize => Ok(()),
        _ => Err(Failure::new(
            ricci_status::RICCI_TOO_LARGE,
            format!("{what}: no array of {n} entries can exist in memory"),
        )),
    }
}

/// Copy `n` items that lie `stride` bytes apart.
fn gather<T: Copy>(what: &str, data: *const T, n: usize, stride: usize) -> Outcome<Vec<T>> {
    if n == 0 {
        return Ok(Vec::new());
    }
    if data.is_null() {
        return Err(Failure::null(what));
    }
    check_extent(what, n, stride, size_of::<T>())?;
    let mut items = Vec::new();
    items.try_reserve_exact(n).map_err(|_| {
        Failure::new(ricci_status::RICCI_TOO_LARGE, format!("{what}: no memory for {n} entries"))
    })?;
    // SAFETY: the caller's array has n items, stride bytes apart (contract of the header); nothing is
    // aligned.
    items.extend((0..n).map(|i| unsafe { data.cast::<u8>().add(i * stride).cast::<T>().read_unaligned() }));
    Ok(items)
}

/// An array of `n` items, copied.
pub fn array<T: Copy>(what: &str, data: *const T, n: usize) -> Outcome<Vec<T>> {
    gather(what, data, n, size_of::<T>())
}

/// An array that must have `needed` entries.
pub fn array_of<T: Copy>(what: &str, data: *const T, n: usize, needed: usize) -> Outcome<Vec<T>> {
    if n != needed {
        return Err(Failure::new(
            ricci_status::RICCI_WRONG_SIZE,
            format!("{what} has {n} entries, {needed} are needed"),
        ));
    }
    array(what, data, n)
}

/// `n` points whose coordinates x, y, z start `stride` bytes apart; 0 means tightly packed.
pub fn points(data: *const f64, stride: usize, n: usize) -> Outcome<Vec<Point>> {
    let stride = if stride == 0 { size_of::<Point>() } else { stride };
    if stride < size_of::<Point>() {
        return Err(Failure::argument(format!(
            "stride is {stride}: positions take at least 24 bytes (or 0 for tightly packed)"
        )));
    }
    gather("positions", data.cast::<Point>(), n, stride)
}

/// `n` faces of `uint32_t`.
pub fn faces(data: *const u32, n: usize) -> Outcome<Vec<[u32; 3]>> {
    array("faces", data.cast(), n)
}

/// `n` faces of `int32_t`; a negative index is refused by face and corner.
pub fn faces_i32(data: *const i32, n: usize) -> Outcome<Vec<[u32; 3]>> {
    let faces: Vec<[i32; 3]> = array("faces", data.cast(), n)?;
    for (f, face) in faces.iter().enumerate() {
        if let Some(k) = face.iter().position(|&v| v < 0) {
            return Err(Failure::argument(format!(
                "face {f}, corner {k}: vertex {} is negative; indices are 0-based",
                face[k]
            )));
        }
    }
    Ok(faces.into_iter().map(|face| face.map(|v| v as u32)).collect())
}

/// Refuse a buffer that cannot take `needed` entries.
pub fn check_buffer<T>(what: &str, needed: usize, buffer: *mut T, capacity: usize) -> Outcome {
    if capacity < needed {
        return Err(Failure::new(
            ricci_status::RICCI_BUFFER_TOO_SMALL,
            format!("{what}: {needed} entries are needed, the buffer has room for {capacity}"),
        ));
    }
    if buffer.is_null() && needed > 0 { Err(Failure::null(what)) } else { Ok(()) }
}

/// What results consist of: numbers, or rows of them, which are copied one after the other.
pub trait Row: Copy {
    type Entry: Copy;
    fn entries(rows: &[Self]) -> &[Self::Entry];
}

macro_rules! entries {
    ($($number:ty)+) => {$(
        impl Row for $number {
            type Entry = $number;
            fn entries(rows: &[$number]) -> &[$number] {
                rows
            }
        }
    )+};
}
entries!(f64 i8 u8 i32 u32 i64 usize);

impl<T: Row, const N: usize> Row for [T; N] {
    type Entry = T::Entry;
    fn entries(rows: &[[T; N]]) -> &[T::Entry] {
        T::entries(rows.as_flattened())
    }
}

/// Copy results into the caller's buffer of `capacity` entries.
pub fn copy_out<T: Row>(what: &str, values: &[T], buffer: *mut T::Entry, capacity: usize) -> Outcome {
    let values = T::entries(values);
    check_buffer(what, values.len(), buffer, capacity)?;
    if !values.is_empty() {
        let bytes = size_of_val(values);
        // SAFETY: the caller's buffer has room for `capacity` entries (contract of the header).
        unsafe { std::ptr::copy_nonoverlapping(values.as_ptr().cast::<u8>(), buffer.cast::<u8>(), bytes) };
    }
    Ok(())
}

/// Copy rows of different lengths: their entries one after the other, and where each row starts and the last one ends.
/// A buffer is given with its capacity in entries.
pub fn copy_rows<T: Row<Entry = T>>(
    what: &str,
    rows: impl IntoIterator<Item = impl IntoIterator<Item = T>>,
    buffer: (*mut T, usize),
    starts_buffer: (*mut usize, usize),
) -> Outcome {
    let (mut entries, mut starts) = (Vec::new(), vec![0]);
    for row in rows {
        entries.extend(row);
        starts.push(entries.len());
    }
    check_buffer(what, entries.len(), buffer.0, buffer.1)?;
    copy_out("starts", &starts, starts_buffer.0, starts_buffer.1)?;
    copy_out(what, &entries, buffer.0, buffer.1)
}

/// Copy results whose number the caller cannot know before, with that number; for no buffer of no entries the number alone.
pub fn copy_counted<T: Row<Entry = T>>(
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

/// Finite points in ambient coordinates.
pub fn ambient(what: &str, data: *const f64, n: usize) -> Outcome<Vec<[f64; 3]>> {
    let points: Vec<[f64; 3]> = array(what, data.cast(), n)?;
    match points.iter().position(|p| p.iter().any(|x| !x.is_finite())) {
        Some(i) => Err(Failure::argument(format!("{what}: row {i} is not finite"))),
        None => Ok(points),
    }
}

/// A file name.
pub fn path(what: &str, text: *const c_char) -> Outcome<PathBuf> {
    if text.is_null() {
        return Err(Failure::null(what));
    }
    // SAFETY: NUL-terminated (contract of the header).
    let text = unsafe { CStr::from_ptr(text) };
    #[cfg(unix)]
    return Ok(<std::ffi::OsStr as std::os::unix::ffi::OsStrExt>::from_bytes(text.to_bytes()).into());
    #[cfg(not(unix))]
    text.to_str().map(PathBuf::from).map_err(|_| Failure::argument(format!("{what} is not UTF-8")))
}
