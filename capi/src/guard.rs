//! The one door: every entry point runs its body through [`call`] or [`free`].
//!
//! The body runs under the default floating-point environment, a panic ends in `RICCI_PANIC`, and every
//! handle that the body had opened is poisoned by it.

use crate::environment::Environment;
use crate::failure::{Failure, Outcome};
use crate::last_error;
use crate::status::ricci_status;
use std::any::Any;
use std::cell::{Cell, RefCell};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Once;
use std::sync::atomic::{AtomicBool, Ordering};

/// Set once a call on the handle has panicked.
#[derive(Default)]
pub struct Poison(AtomicBool);

/// What every opaque type has.
pub trait Handle: Sized {
    /// Its name in messages.
    const NAME: &'static str;
    fn poison(&self) -> &Poison;
}

/// Makes a struct with a field `poison` the opaque type of this name.
macro_rules! handle {
    ($type:ty, $name:literal) => {
        impl $crate::guard::Handle for $type {
            const NAME: &'static str = $name;
            fn poison(&self) -> &$crate::guard::Poison {
                &self.poison
            }
        }
    };
}
pub(crate) use handle;

/// The handles that a running body has opened.
#[derive(Default)]
pub struct Door(RefCell<Vec<*const Poison>>);

impl Door {
    /// A handle that is only read.
    pub fn shared<'a, H: Handle>(&self, handle: *const H) -> Outcome<&'a H> {
        // SAFETY: NULL, or from this library and alive (contract of the header).
        let handle = unsafe { handle.as_ref() }.ok_or_else(|| Failure::null(H::NAME))?;
        self.admit::<H>(handle.poison())?;
        Ok(handle)
    }

    /// A handle that is changed.
    pub fn exclusive<'a, H: Handle>(&self, handle: *mut H) -> Outcome<&'a mut H> {
        // SAFETY: NULL, or from this library, alive and used by this thread only (contract of the header).
        let handle = unsafe { handle.as_mut() }.ok_or_else(|| Failure::null(H::NAME))?;
        self.admit::<H>(handle.poison())?;
        Ok(handle)
    }

    fn admit<H: Handle>(&self, poison: &Poison) -> Outcome {
        if poison.0.load(Ordering::Acquire) {
            return Err(Failure::new(
                ricci_status::RICCI_POISONED,
                format!("an earlier call on this {} ended in an internal error; free it", H::NAME),
            ));
        }
        self.0.borrow_mut().push(poison);
        Ok(())
    }

    fn poison_all(&self) {
        for &poison in self.0.borrow().iter() {
            // SAFETY: the caller keeps handles alive for the whole call.
            unsafe { &*poison }.0.store(true, Ordering::Release);
        }
    }
}

/// Where a result goes.
pub struct Output<T>(*mut T);

impl<T> Output<T> {
    /// Write it. Only called when nothing can fail any more.
    pub fn set(self, value: T) {
        // SAFETY: not NULL, and the caller's memory for one `T` (contract of the header).
        unsafe { self.0.write_unaligned(value) }
    }
}

impl<H: Handle> Output<*mut H> {
    /// Hand a new handle to the caller.
    pub fn hand_over(self, handle: H) {
        self.set(Box::into_raw(Box::new(handle)));
    }
}

/// The place for a result, checked before any work is done.
pub fn output<T>(what: &str, place: *mut T) -> Outcome<Output<T>> {
    if place.is_null() { Err(Failure::null(what)) } else { Ok(Output(place)) }
}

/// Run the body of an entry point.
pub fn call(body: impl FnOnce(&Door) -> Outcome) -> ricci_status {
    let _host = Environment::enter();
    let door = Door::default();
    match guarded(|| body(&door)) {
        Ok(Ok(())) => ricci_status::RICCI_OK,
        Ok(Err(failure)) => {
            log::warn!("{}", failure.message);
            last_error::set(&failure.message);
            failure.status
        }
        Err(message) => {
            door.poison_all();
            log::error!("{message}");
            last_error::set(&message);
            ricci_status::RICCI_PANIC
        }
    }
}

/// Run the body of an entry point that reads one handle.
pub fn with<H: Handle>(handle: *const H, body: impl FnOnce(&H) -> Outcome) -> ricci_status {
    call(|door| body(door.shared(handle)?))
}

/// Run the body of an entry point that makes a handle, whose place is checked before any work is done.
pub fn make<H: Handle>(
    what: &str,
    place: *mut *mut H,
    body: impl FnOnce(&Door) -> Outcome<H>,
) -> ricci_status {
    call(|door| {
        let place = output(what, place)?;
        place.hand_over(body(door)?);
        Ok(())
    })
}

/// Release a handle; NULL is fine, and so is a poisoned one.
pub fn free<H>(handle: *mut H) {
    if handle.is_null() {
        return;
    }
    let _host = Environment::enter();
    // SAFETY: made by `Output::hand_over` and not freed before (contract of the header).
    if let Err(message) = guarded(|| drop(unsafe { Box::from_raw(handle) })) {
        last_error::set(&message);
    }
}

/// Run `body` and turn a panic into its message. Never inlined: no arithmetic of the body may move before the
/// change of the floating-point environment.
#[inline(never)]
fn guarded<R>(body: impl FnOnce() -> R) -> Result<R, String> {
    keep_panics_quiet();
    let outer = INSIDE.replace(true);
    let outcome = catch_unwind(AssertUnwindSafe(std::hint::black_box(body)));
    INSIDE.set(outer);
    outcome.map_err(|payload| format!("internal error: {}", words(payload)))
}

thread_local! {
    static INSIDE: Cell<bool> = const { Cell::new(false) };
}

/// A panic inside a call becomes a status, so nothing is printed about it. Everybody else's panics go to the
/// hook that was there before.
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

/// What a panic said. A payload of another type is leaked: its destructor is not ours to trust.
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
