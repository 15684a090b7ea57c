//! The control of the call that a thread is in, and the one that the thread uses for calls that are given none.

use crate::memory;
use ricci::Control;
use std::cell::RefCell;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

/// A host's control of calls, one after the other.
pub struct HostControl {
    pub control: Control,
    /// The fractions of the progress that the next calls fill.
    range: Mutex<[f64; 2]>,
    /// Threads of calls that have no option for them, 0 for one per core.
    threads: AtomicUsize,
}

impl HostControl {
    pub fn new() -> HostControl {
        HostControl { control: Control::new(), range: Mutex::new([0.0, 1.0]), threads: AtomicUsize::new(0) }
    }

    pub fn set_range(&self, range: [f64; 2]) {
        *self.range.lock().unwrap_or_else(PoisonError::into_inner) = range;
    }

    pub fn set_threads(&self, threads: usize) {
        self.threads.store(threads, Ordering::Relaxed);
    }

    /// The library's control for a call, whose progress begins at 0 unless the host has asked for a part.
    fn for_call(&self) -> Control {
        let [from, to] = *self.range.lock().unwrap_or_else(PoisonError::into_inner);
        if [from, to] == [0.0, 1.0] {
            self.control.restart();
        }
        self.control.part(from, to)
    }
}

thread_local! {
    static USED: RefCell<Option<Arc<HostControl>>> = const { RefCell::new(None) };
    static CALL: RefCell<Option<Control>> = const { RefCell::new(None) };
}

/// This control serves the thread's calls that are given none, from now on.
pub fn use_in_thread(control: Option<Arc<HostControl>>) {
    USED.set(control);
}

/// The control that is given to a call, or else the thread's.
fn with_host<T>(given: Option<&HostControl>, work: impl FnOnce(&HostControl) -> T) -> Option<T> {
    match given {
        Some(control) => Some(work(control)),
        None => USED.with_borrow(|used| used.as_deref().map(work)),
    }
}

/// The control of the call that the thread is in: the first time the one that is given, else the thread's, else a new one. Checks of it fail
/// also after the system has refused memory.
pub fn begin(given: Option<&HostControl>) -> Control {
    if let Some(control) = CALL.with_borrow(Option::clone) {
        return control;
    }
    let control = with_host(given, HostControl::for_call).unwrap_or_default();
    let control = control.asking(memory::end_at_refusal());
    CALL.set(Some(control.clone()));
    control
}

/// The number of threads for a call that has no option for it.
pub fn threads(given: Option<&HostControl>) -> usize {
    with_host(given, |control| control.threads.load(Ordering::Relaxed)).unwrap_or(0)
}

/// The call of this thread has ended: its progress is whole if it has succeeded. False if its control was cancelled.
pub fn end(has_succeeded: bool) -> bool {
    let Some(control) = CALL.take() else { return true };
    if has_succeeded {
        control.finish();
    }
    !control.is_cancelled()
}
