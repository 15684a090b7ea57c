//! The guard of the C boundary: every entry point runs its body through [`call`] or [`free`].
//!
//! The body runs in the default floating-point environment, and a panic becomes `RICCI_PANIC`. It poisons a handle that the body
//! was changing; handles that the body only reads stay valid.

use crate::call_control;
use crate::failure::{Failure, Outcome};
use crate::float_environment::HostFloatEnvironment;
use crate::memory;
use crate::status::*;
use crate::thread_failure;
use std::any::Any;
use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Once;

#[cfg(not(panic = "unwind"))]
compile_error!("the C face catches panics, which needs panic = \"unwind\"");

/// An opaque type of the C face.
pub trait OpaqueHandle: Sized {
    /// The name of the type in messages.
    const NAME: &'static str;

    /// The number of elements, mostly vertices, in proportion to which a call that reads the handle takes memory.
    fn n_elements(&self) -> usize {
        0
    }
}

macro_rules! handle {
    ($type:ty, $name:literal) => {
        impl $crate::guard::OpaqueHandle for $type {
            const NAME: &'static str = $name;
        }
    };
    ($type:ty, $name:literal, $n_elements:expr) => {
        impl $crate::guard::OpaqueHandle for $type {
            const NAME: &'static str = $name;

            fn n_elements(&self) -> usize {
                let count: fn(&$type) -> usize = $n_elements;
                count(self)
            }
        }
    };
}
pub(crate) use handle;

/// The object of a handle that is only read. Until the end of the call there is memory in reserve for copies of its numbers.
pub fn shared<'a, H: OpaqueHandle>(handle: *const H) -> Outcome<&'a H> {
    // SAFETY: NULL, or from this library and alive (contract of the header).
    let object = unsafe { handle.as_ref() }.ok_or_else(|| Failure::null(H::NAME))?;
    memory::for_call(object.n_elements())?;
    Ok(object)
}

/// The place in the caller's memory to which a result is written.
pub struct Output<T>(*mut T);

impl<T> Output<T> {
    /// Writes the result. It is called when nothing can fail any more.
    pub fn set(self, value: T) {
        // SAFETY: not NULL, and the caller's memory for one `T` (contract of the header).
        unsafe { self.0.write_unaligned(value) }
    }
}

/// The place for a result, which is checked before any work is done.
pub fn output<T>(what: &str, place: *mut T) -> Outcome<Output<T>> {
    if place.is_null() { Err(Failure::null(what)) } else { Ok(Output(place)) }
}

/// Runs the body of an entry point.
pub fn call(body: impl FnOnce() -> Outcome) -> ricci_status {
    let mut body = Some(body);
    run(&mut || body.take().map_or(Ok(()), |body| body()))
}

/// Runs a body for [`call`]. This function is not generic: a copy for each entry point would take a fifth of a megabyte.
fn run(body: &mut dyn FnMut() -> Outcome) -> ricci_status {
    let _host = HostFloatEnvironment::replace_by_default();
    let refusals = memory::refusals();
    let result = guarded(&mut || memory::little().and_then(|()| body()));
    memory::end_call();
    let is_wanted = call_control::end(matches!(result, Ok(Ok(()))));
    let failure = match result {
        Ok(Ok(())) => return RICCI_OK,
        Ok(Err(failure)) => {
            // Nobody has cancelled the call, and memory was refused meanwhile: this has ended it, or made its work fail.
            let is_refused = is_wanted && memory::refusals() != refusals && failure.status != RICCI_NO_MEMORY;
            let failure = if is_refused { failure.for_want_of_memory() } else { failure };
            if !failure.is_question {
                log::warn!("{}", failure.message);
            }
            failure
        }
        Err(message) => {
            log::error!("{message}");
            Failure::new(RICCI_PANIC, message)
        }
    };
    thread_failure::keep(&failure);
    failure.status
}

/// Runs the body of an entry point that reads one handle.
pub fn with<H: OpaqueHandle>(handle: *const H, body: impl FnOnce(&H) -> Outcome) -> ricci_status {
    call(|| body(shared(handle)?))
}

/// Runs the body of an entry point that makes a handle. The place for the handle is checked before any work is done.
pub fn make<H: OpaqueHandle>(place: *mut *mut H, body: impl FnOnce() -> Outcome<H>) -> ricci_status {
    call(|| {
        let place = output(H::NAME, place)?;
        place.set(boxed(body()?));
        Ok(())
    })
}

/// An object as a handle, which the caller frees.
pub fn boxed<H: OpaqueHandle>(object: H) -> *mut H {
    let handle = Box::into_raw(Box::new(object));
    live::add(handle);
    handle
}

/// A handle that calls change.
pub trait MutableHandle: OpaqueHandle {
    /// True while a call changes the handle, and for ever if that call panics.
    fn poisoned(&mut self) -> &mut bool;
}

/// Runs a body that changes a handle. A panic leaves the handle poisoned.
pub fn change<H: MutableHandle, T>(handle: *mut H, body: impl FnOnce(&mut H) -> Outcome<T>) -> Outcome<T> {
    // SAFETY: NULL, or from this library, alive and used by this thread only (contract of the header).
    let handle = unsafe { handle.as_mut() }.ok_or_else(|| Failure::null(H::NAME))?;
    if std::mem::replace(handle.poisoned(), true) {
        let message = format!(
            "an earlier call on this {} ended in an internal error, or it belongs to the process from which this one was forked; free it",
            H::NAME
        );
        return Err(Failure::new(RICCI_POISONED, message));
    }
    let result = body(handle);
    *handle.poisoned() = false;
    result
}

/// Releases a handle, which may be NULL or poisoned. With debug assertions one that is not alive is refused, with a message and a log entry.
pub fn free<H: OpaqueHandle>(handle: *mut H) {
    if handle.is_null() {
        return;
    }
    let _host = HostFloatEnvironment::replace_by_default();
    if !live::remove(handle) {
        let message = format!("this {} was freed before, or is not one of this library", H::NAME);
        log::error!("{message}");
        thread_failure::keep(&Failure::argument(message));
        return;
    }
    // SAFETY: made by `make` and not freed before (contract of the header).
    let mut release = || {
        drop(unsafe { Box::from_raw(handle) });
        Ok(())
    };
    if let Err(message) = guarded(&mut release) {
        thread_failure::keep(&Failure::new(RICCI_PANIC, message));
    }
}

/// The handles that are alive, which only builds with debug assertions keep.
mod live {
    use std::collections::BTreeSet;
    use std::sync::{Mutex, PoisonError};

    static LIVE: Mutex<BTreeSet<usize>> = Mutex::new(BTreeSet::new());

    pub fn add<H>(handle: *mut H) {
        if cfg!(debug_assertions) {
            LIVE.lock().unwrap_or_else(PoisonError::into_inner).insert(handle.addr());
        }
    }

    /// True if the handle was alive, and without debug assertions always.
    pub fn remove<H>(handle: *mut H) -> bool {
        !cfg!(debug_assertions) || LIVE.lock().unwrap_or_else(PoisonError::into_inner).remove(&handle.addr())
    }
}

/// Runs `body` and turns a panic into its message. It is never inlined, so that no arithmetic of the body is moved before the
/// change of the floating-point environment.
#[inline(never)]
fn guarded(body: &mut dyn FnMut() -> Outcome) -> Result<Outcome, String> {
    keep_panics_quiet();
    let outer = INSIDE.replace(true);
    let outcome = catch_unwind(AssertUnwindSafe(std::hint::black_box(body)));
    INSIDE.set(outer);
    outcome.map_err(|payload| format!("internal error: {}", words(payload)))
}

thread_local! {
    static INSIDE: Cell<bool> = const { Cell::new(false) };
}

/// Installs a panic hook that prints nothing about panics inside a call, which become a status. Other panics of the process go to
/// the previous hook.
fn keep_panics_quiet() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        let previous = std::panic::take_hook();
        std::panic::set_hook(Box::new(move |info| {
            let worker = || std::thread::current().name().is_some_and(|name| name.starts_with("ricci-"));
            if !INSIDE.try_with(Cell::get).unwrap_or(false) && !worker() {
                previous(info);
            }
        }));
    });
}

/// The message of a panic. A payload that is no text is leaked, because its destructor could panic again.
fn words(payload: Box<dyn Any + Send>) -> String {
    match payload.downcast::<String>() {
        Ok(text) => *text,
        Err(payload) => match payload.downcast::<&str>() {
            Ok(text) => (*text).into(),
            Err(payload) => {
                std::mem::forget(payload);
                "unknown".into()
            }
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ricci::parallel::Pool;
    use std::ffi::CStr;

    struct Box2 {
        poisoned: bool,
        value: i32,
    }
    handle!(Box2, "box");
    impl MutableHandle for Box2 {
        fn poisoned(&mut self) -> &mut bool {
            &mut self.poisoned
        }
    }

    fn last() -> String {
        // SAFETY: NUL-terminated, of this thread.
        unsafe { CStr::from_ptr(thread_failure::text()) }.to_string_lossy().into_owned()
    }

    /// The panic happens on a thread of the library's pool, whose panics must become a status too.
    #[test]
    fn a_panic_is_a_status_and_poisons_what_was_changed() {
        let mut changed = Box2 { poisoned: false, value: 1 };
        let (handle, read) = (&raw mut changed, Box2 { poisoned: false, value: 2 });
        let status = call(|| {
            let read = shared(&read)?;
            change(handle, |h| Pool::new(2)?.run(|| panic!("{} and {}", h.value, read.value)))
        });
        assert_eq!((status, last().as_str()), (RICCI_PANIC, "internal error: 1 and 2"));
        assert_eq!(call(|| change(handle, |_| Ok(()))), RICCI_POISONED);
        assert_eq!(with(&read, |_| Ok(())), RICCI_OK);
        assert_eq!(call(|| Err(Failure::argument("x").needs(3))), RICCI_ARGUMENT);
        assert_eq!(last(), "x");
    }

    /// What would be undefined in a release build has a message in one with debug assertions.
    #[test]
    #[cfg(debug_assertions)]
    fn a_second_release_is_refused() {
        let mut handle: *mut Box2 = std::ptr::null_mut();
        assert_eq!(make(&raw mut handle, || Ok(Box2 { poisoned: false, value: 1 })), RICCI_OK);
        assert_eq!(call(|| Err(Failure::argument("x"))), RICCI_ARGUMENT);
        free(handle);
        assert_eq!(last(), "x");
        free(handle);
        assert_eq!(last(), "this box was freed before, or is not one of this library");
    }
}
