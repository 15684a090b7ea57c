//! Reserves of memory, by which a call returns a status where the system has no memory.
//!
//! Rust ends the program where a small allocation fails. Therefore every call holds a small reserve, and a long call holds as much as
//! its work is known to take. A call that cannot have its reserve fails before it has changed anything. When the system refuses
//! memory later, all reserves are released and the allocation is tried once more; and the call ends with a status at its next look at its
//! control, which comes long before it has used the reserves up.

use crate::failure::{Failure, Outcome};
use crate::status::RICCI_NO_MEMORY;
use ricci::control::EndQuestion;
use ricci::parallel::MAX_THREADS;
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::RefCell;
use std::num::NonZero;
use std::path::Path;
use std::ptr::null_mut;
use std::sync::atomic::{AtomicPtr, AtomicUsize, Ordering};
use std::sync::{Arc, OnceLock};

/// Bytes that a call without a reserve of its own may take, for messages, handles and short lists.
const LITTLE: usize = 1 << 18;
/// Bytes that a long call may take for files and tables, beside the bytes per element and per thread.
const WORK: usize = 1 << 22;
/// Bytes that a thread of a call may take: 2 MiB for its stack, and 4 MiB in which dense matrix products copy their factors.
const THREAD: usize = 6 << 20;
/// Most reserves that are held at one time; further calls only try whether the system has the memory.
const MOST_RESERVES: usize = 32;

/// Most bytes per vertex, or per two faces, for building a mesh: 1,220 were measured on a torus of 38,400 vertices. The numbers
/// below were measured on the same torus.
pub const MESH: usize = 1 << 11;
/// Most bytes per byte of a mesh file while it is read; `tests/mesh_memory.rs` bounds the files that expand to more.
pub const FILE: usize = 20;
/// Most bytes per element of a deck group while its neighbours are searched: words, motions, and the table of those that are known.
pub const ELEMENT: usize = 1 << 9;
/// Most bytes per element of a handle for copies of its numbers, a summary, or a file of them: 810 per vertex of a layout's file.
const COPY: usize = 1 << 10;
/// Most bytes per vertex for a flow with flips: 1,990 were measured; the factor of its matrix grows with the logarithm of the size.
pub const FLOW: usize = 1 << 12;
/// Most bytes per vertex for a layout (580), a common subdivision (810) or charts (2,780).
pub const LAYOUT: usize = 1 << 12;
/// Most bytes per vertex for a uniformization: 2,930 on a sphere.
pub const UNIFORM: usize = 1 << 13;
/// Most bytes per vertex and quad for a quad mesh: 4,000 for 60,000 quads on a torus of 8,192 vertices, and for each of the 64 quads of a unit
/// square of a layout 3,400.
pub const QUADS: usize = 3 << 11;
/// Most bytes per vertex and quad for what a spline over a quad layout is fitted to: 1,970 with all that the fit took over 18 patches of one span.
pub const QUAD_TARGET: usize = 1 << 12;
/// Most bytes per pole for the fit itself, mostly for the factor of its matrix: 44,900 with 42 patches of 3 × 3 spans, 49,500 with 6.
pub const QUAD_FIT: usize = 1 << 16;
/// Most bytes per control point for the search structure of a spline over a quad layout: 310 over 42 patches of up to 3 × 3 spans.
pub const QUAD_CELLS: usize = 1 << 12;
/// Most bytes per evaluated point of a spline (448 with its derivatives) or per face of a tessellation (340).
pub const POINT: usize = 1 << 9;
/// Most bytes per point and per control point of a fit: 2,980 of degree 5.
pub const FIT: usize = 1 << 12;
/// Most bytes per byte of a spline's file while it is read: 29 of degree 5.
pub const TEXT: usize = 1 << 5;
/// Most bytes per patch while the text of a spline is made: 8,430 of degree 5.
pub const SPLINE_TEXT: usize = 1 << 14;
/// Most bytes per patch of a spline while bicubic patches are made, beside the evaluated points: 13,400 with 8 spans a side.
pub const BICUBIC: usize = 1 << 14;
/// Most bytes per control point of bicubic patches while their text is made: 520 as STEP.
pub const BICUBIC_TEXT: usize = 1 << 10;

/// Most bytes per patch of a spline of this degree: 4,700 of degree 1 to 68,800 of degree 5 were measured.
pub fn patch(degree: usize) -> usize {
    1 << (12 + degree.min(ricci::spline::MAX_DEGREE))
}

/// A place for one reserve: its address and its size, both 0 while the slot is free.
struct ReserveSlot {
    place: AtomicPtr<u8>,
    bytes: AtomicUsize,
}

/// The reserves that are held. The first is the small one that every call may use.
static HELD: [ReserveSlot; MOST_RESERVES] =
    [const { ReserveSlot { place: AtomicPtr::new(null_mut()), bytes: AtomicUsize::new(0) } }; MOST_RESERVES];

/// Maps pages of the process's own, apart from every heap, so that any thread can use what is given back. NULL if there are none.
#[cfg(unix)]
fn map(bytes: usize) -> *mut u8 {
    use libc::{MAP_ANON, MAP_FAILED, MAP_PRIVATE, PROT_READ, PROT_WRITE};
    // SAFETY: new pages, of no file.
    let place =
        unsafe { libc::mmap(null_mut(), bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANON, -1, 0) };
    if place == MAP_FAILED { null_mut() } else { place.cast() }
}

/// Unmaps what [`map`] gave.
#[cfg(unix)]
unsafe fn unmap(place: *mut u8, bytes: usize) {
    // SAFETY: mapped with this size (contract).
    unsafe { libc::munmap(place.cast(), bytes) };
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
    /// Holds memory in this slot if the slot is free. The size is written before the address, by which others find the memory.
    fn fill(&self, place: *mut u8, bytes: usize) -> bool {
        self.bytes.compare_exchange(0, bytes, Ordering::AcqRel, Ordering::Relaxed).is_ok() && {
            self.place.store(place, Ordering::Release);
            true
        }
    }

    /// Gives back the memory of this slot; false if there was none.
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

/// The allocator of the C face: the system's, which is asked a second time after the reserves have been released.
struct RetryingAllocator;

#[global_allocator]
static ALLOCATOR: RetryingAllocator = RetryingAllocator;

/// The number of times that the system has refused memory. Calls that were under way at a refusal end at their next look at their control.
static REFUSALS: AtomicUsize = AtomicUsize::new(0);

/// The number of times that the system has refused memory so far.
pub fn refusals() -> usize {
    REFUSALS.load(Ordering::Relaxed)
}

/// The question whether the system has refused memory since this call.
pub fn end_at_refusal() -> Arc<dyn EndQuestion> {
    let before = refusals();
    Arc::new(move |_| refusals() != before)
}

/// The number of threads that are giving reserves back.
static RELEASING: AtomicUsize = AtomicUsize::new(0);

/// The memory that `ask` gives; if it gives none, all reserves are released and it is asked again.
fn again(ask: impl Fn() -> *mut u8) -> *mut u8 {
    let first = ask();
    if !first.is_null() {
        return first;
    }
    REFUSALS.fetch_add(1, Ordering::Relaxed);
    RELEASING.fetch_add(1, Ordering::AcqRel);
    HELD.iter().for_each(|slot| {
        slot.release();
    });
    RELEASING.fetch_sub(1, Ordering::AcqRel);
    // A thread that finds nothing to release waits for another one that is giving the reserves back.
    while RELEASING.load(Ordering::Acquire) > 0 {
        std::thread::yield_now();
    }
    ask()
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

/// Memory for the work of one call, which is given back at the end of the call if it was not released before.
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

/// Makes sure that the small reserve of every call is held. It stays for later calls.
pub fn little() -> Outcome {
    if HELD[0].bytes.load(Ordering::Acquire) == 0 {
        std::mem::forget(hold(LITTLE, &HELD[..1])?);
    }
    Ok(())
}

thread_local! {
    /// The reserves that this thread's call holds for the handles that it reads.
    static CALL: RefCell<Vec<Reserve>> = const { RefCell::new(Vec::new()) };
}

/// A reserve until the end of the call for copies of the numbers of so many elements; the small one is enough for few.
pub fn for_call(elements: usize) -> Outcome {
    let bytes = elements.saturating_mul(COPY);
    if bytes > LITTLE / 2 {
        let reserve = hold(bytes.saturating_add(LITTLE), &HELD[1..])?;
        CALL.with_borrow_mut(|held| held.push(reserve));
    }
    Ok(())
}

/// Gives back what the call of this thread has held.
pub fn end_call() {
    CALL.with_borrow_mut(Vec::clear);
}

/// Bytes that the threads of a call may take, with one thread on each core.
fn threads() -> usize {
    static CORES: OnceLock<usize> = OnceLock::new();
    let cores = *CORES.get_or_init(|| std::thread::available_parallelism().map_or(1, NonZero::get));
    cores.min(MAX_THREADS) * THREAD
}

/// A reserve for work on this number of elements.
pub fn work(elements: usize, bytes_each: usize) -> Outcome<Reserve> {
    hold(elements.saturating_mul(bytes_each).saturating_add(WORK + threads()), &HELD[1..])
}

/// A reserve for reading this mesh file. If the file does not exist, its reader reports that.
pub fn file(path: &Path) -> Outcome<Reserve> {
    let bytes = std::fs::metadata(path).map_or(0, |about| about.len());
    work(usize::try_from(bytes).unwrap_or(usize::MAX), FILE)
}
