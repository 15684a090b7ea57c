//! Memory that the system refuses: asked for before the work, and given back when it is needed.
//!
//! Rust ends the program where a small allocation fails, so the C face holds memory in reserve: a little for every call, and for long
//! calls as much as their work is known to take. A call that cannot have its reserve fails before it has changed anything. When
//! the system refuses memory later, all reserves are released and it is asked once more.

use crate::failure::{Failure, Outcome};
use crate::status::RICCI_NO_MEMORY;
use ricci::parallel::MAX_THREADS;
use std::alloc::{GlobalAlloc, Layout, System};
use std::num::NonZero;
use std::path::Path;
use std::ptr::null_mut;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicPtr, AtomicUsize, Ordering};

/// Bytes that calls without a reserve of their own may take: messages, handles, the lists of a few elements.
const LITTLE: usize = 1 << 18;
/// Bytes that a call with work to do may take beside what it takes per element and per thread: files, tables.
const WORK: usize = 1 << 22;
/// Bytes that a thread of a call may take: its stack of 2 MiB, and 4 MiB in which dense products lay out their factors.
const THREAD: usize = 6 << 20;
/// Reserves that are held at one time; calls beyond them only ask whether they could have one.
const MOST_RESERVES: usize = 32;

/// Bytes per vertex that building a mesh takes at most, or per face of a list: 1,220 on a torus of 38,400 vertices, as below.
pub const MESH: usize = 1 << 11;
/// That a byte of a mesh file takes at most while it is read, beside what odd files may unfold to (`tests/mesh_memory.rs`).
pub const FILE: usize = 20;
/// That an element of a deck group takes while its neighbours are looked at: words and motions, and the places where they are looked up.
pub const ELEMENT: usize = 1 << 9;
/// That a flow with flips takes: 1,990; the factor of its matrix grows with the logarithm of the size.
pub const FLOW: usize = 1 << 12;
/// That a layout (580), a refinement (810) or charts (2,780) take.
pub const LAYOUT: usize = 1 << 12;
/// That a uniformization takes: 2,930 on a sphere.
pub const UNIFORM: usize = 1 << 13;
/// That a point of a spline takes: 448 with its derivatives; a face of a tessellation 340.
pub const POINT: usize = 1 << 9;
/// That a point or a control point of a fit takes: 2,980 of degree 5.
pub const FIT: usize = 1 << 12;
/// That a byte of a spline's file takes: 29 of degree 5.
pub const TEXT: usize = 1 << 5;
/// That a patch takes while the text of its spline is made: 8,430 of degree 5.
pub const SPLINE_TEXT: usize = 1 << 14;
/// That a patch of a spline takes while bicubic patches are made, beside the points of a batch: 13,400 with 8 spans a side.
pub const BICUBIC: usize = 1 << 14;
/// That a control point of bicubic patches takes while their text is made: 520 as STEP.
pub const BICUBIC_TEXT: usize = 1 << 10;

/// That a patch of a spline takes: 4,700 bytes of degree 1 to 68,800 of degree 5.
pub fn patch(degree: usize) -> usize {
    1 << (12 + degree.min(ricci::spline::MAX_DEGREE))
}

struct ReserveSlot {
    place: AtomicPtr<u8>,
    bytes: AtomicUsize,
}

/// What is held; the first is the little that any call may take.
static HELD: [ReserveSlot; MOST_RESERVES] =
    [const { ReserveSlot { place: AtomicPtr::new(null_mut()), bytes: AtomicUsize::new(0) } }; MOST_RESERVES];

/// Address space of the process's own, beside every heap, so that what is given back serves any thread; NULL if there is none.
#[cfg(unix)]
fn map(bytes: usize) -> *mut u8 {
    use std::ffi::{c_int, c_void};
    unsafe extern "C" {
        fn mmap(near: *mut c_void, n: usize, allow: c_int, how: c_int, file: c_int, at: isize)
        -> *mut c_void;
    }
    const READ_WRITE: c_int = 3;
    const PRIVATE_ANONYMOUS: c_int = if cfg!(target_os = "linux") { 0x22 } else { 0x1002 };
    // SAFETY: new pages, of no file.
    let place = unsafe { mmap(null_mut(), bytes, READ_WRITE, PRIVATE_ANONYMOUS, -1, 0) };
    if place.addr() == usize::MAX { null_mut() } else { place.cast() }
}

/// Give back what [`map`] gave.
#[cfg(unix)]
unsafe fn unmap(place: *mut u8, bytes: usize) {
    use std::ffi::{c_int, c_void};
    unsafe extern "C" {
        fn munmap(place: *mut c_void, n: usize) -> c_int;
    }
    // SAFETY: mapped with this size (contract).
    unsafe { munmap(place.cast(), bytes) };
}

#[cfg(not(unix))]
fn map(bytes: usize) -> *mut u8 {
    // SAFETY: the size is not zero.
    Layout::from_size_align(bytes, 16).map_or(null_mut(), |layout| unsafe { System.alloc(layout) })
}

#[cfg(not(unix))]
unsafe fn unmap(place: *mut u8, bytes: usize) {
    if let Ok(layout) = Layout::from_size_align(bytes, 16) {
        // SAFETY: allocated with this layout (contract).
        unsafe { System.dealloc(place, layout) };
    }
}

impl ReserveSlot {
    /// Hold memory here, if the place is free. Its size is written before the memory can be found.
    fn fill(&self, place: *mut u8, bytes: usize) -> bool {
        self.bytes.compare_exchange(0, bytes, Ordering::AcqRel, Ordering::Relaxed).is_ok() && {
            self.place.store(place, Ordering::Release);
            true
        }
    }

    /// Give back what is held here; whether there was any.
    fn release(&self) -> bool {
        let place = self.place.swap(null_mut(), Ordering::AcqRel);
        if place.is_null() {
            return false;
        }
        // SAFETY: mapped by `hold` with this size; the swap has made it ours alone.
        unsafe { unmap(place, self.bytes.swap(0, Ordering::AcqRel)) };
        true
    }
}

/// The allocator of the C face: the system's, which is asked again once reserves have been released.
struct RetryingAllocator;

#[global_allocator]
static ALLOCATOR: RetryingAllocator = RetryingAllocator;

/// What `ask` gives; if that is nothing, what it gives once the reserves are released.
fn again(ask: impl Fn() -> *mut u8) -> *mut u8 {
    let first = ask();
    // Every reserve counts, so there is no stopping at the first.
    if first.is_null() && HELD.iter().filter(|slot| slot.release()).count() > 0 { ask() } else { first }
}

// SAFETY: the system's allocator, with its contract; nothing here unwinds or allocates by itself.
unsafe impl GlobalAlloc for RetryingAllocator {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        again(|| unsafe { System.alloc(layout) })
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        again(|| unsafe { System.alloc_zeroed(layout) })
    }

    unsafe fn dealloc(&self, place: *mut u8, layout: Layout) {
        unsafe { System.dealloc(place, layout) }
    }

    unsafe fn realloc(&self, place: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        again(|| unsafe { System.realloc(place, layout, size) })
    }
}

/// Memory for the work of one call, given back at its end if it was not needed before.
#[must_use]
pub struct Reserve(Option<&'static ReserveSlot>);

impl Drop for Reserve {
    fn drop(&mut self) {
        if let Some(slot) = self.0 {
            slot.release();
        }
    }
}

fn hold(bytes: usize, slots: &'static [ReserveSlot]) -> Outcome<Reserve> {
    let place = if bytes > isize::MAX as usize { null_mut() } else { map(bytes) };
    if place.is_null() {
        let failure = Failure::new(RICCI_NO_MEMORY, "the system has no memory for the work of this call");
        return Err(failure.needs(bytes));
    }
    let slot = slots.iter().find(|slot| slot.fill(place, bytes));
    if slot.is_none() {
        // SAFETY: mapped above, with this size.
        unsafe { unmap(place, bytes) };
    }
    Ok(Reserve(slot))
}

/// The little that any call may take is there, or taken now. It stays for the calls to come.
pub fn little() -> Outcome {
    if HELD[0].bytes.load(Ordering::Acquire) == 0 {
        std::mem::forget(hold(LITTLE, &HELD[..1])?);
    }
    Ok(())
}

/// Bytes that the threads of a call may take, one on each core.
fn threads() -> usize {
    static CORES: OnceLock<usize> = OnceLock::new();
    let cores = *CORES.get_or_init(|| std::thread::available_parallelism().map_or(1, NonZero::get));
    cores.min(MAX_THREADS) * THREAD
}

/// A reserve for the work on so many elements.
pub fn work(elements: usize, bytes_each: usize) -> Outcome<Reserve> {
    hold(elements.saturating_mul(bytes_each).saturating_add(WORK + threads()), &HELD[1..])
}

/// A reserve for reading a mesh file of this size. A file that is not there is for its reader to name.
pub fn file(path: &Path) -> Outcome<Reserve> {
    let bytes = std::fs::metadata(path).map_or(0, |about| about.len());
    work(usize::try_from(bytes).unwrap_or(usize::MAX), FILE)
}
