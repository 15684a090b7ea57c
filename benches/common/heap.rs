//! The heap memory of some work: its peak, and all bytes that it asks for.

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicUsize, Ordering};

/// Counts bytes: live ones, their peak, and all that are asked for.
struct Counting;

static LIVE: AtomicUsize = AtomicUsize::new(0);
static PEAK: AtomicUsize = AtomicUsize::new(0);
static ASKED: AtomicUsize = AtomicUsize::new(0);
/// Allocations of at least this size are not counted: the matrix products under the factorisation reserve 960 MiB of address space once per
/// thread, of which they touch a few (resident memory shows it).
const RESERVATION: usize = 960 << 20;

impl Counting {
    fn add(size: usize) {
        if size < RESERVATION {
            let live = LIVE.fetch_add(size, Ordering::Relaxed) + size;
            PEAK.fetch_max(live, Ordering::Relaxed);
            ASKED.fetch_add(size, Ordering::Relaxed);
        }
    }
}

// SAFETY: forwards to the system allocator; the counters do not allocate.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        Counting::add(layout.size());
        // SAFETY: the caller's contract is the same.
        unsafe { System.alloc(layout) }
    }
    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        Counting::add(layout.size());
        // SAFETY: the caller's contract is the same.
        unsafe { System.alloc_zeroed(layout) }
    }
    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        if layout.size() < RESERVATION {
            LIVE.fetch_sub(layout.size(), Ordering::Relaxed);
        }
        // SAFETY: the caller's contract is the same.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// The number of live bytes.
pub fn live() -> usize {
    LIVE.load(Ordering::Relaxed)
}

/// The result of `work` and the number of bytes that it allocates, freed or not.
pub fn asked<R>(work: impl FnOnce() -> R) -> (usize, R) {
    let before = ASKED.load(Ordering::Relaxed);
    let result = work();
    (ASKED.load(Ordering::Relaxed) - before, result)
}

/// The result of `work` and the most bytes that were live meanwhile, those that were live before included.
pub fn peak<R>(work: impl FnOnce() -> R) -> (usize, R) {
    PEAK.store(LIVE.load(Ordering::Relaxed), Ordering::Relaxed);
    let result = work();
    (PEAK.load(Ordering::Relaxed), result)
}
