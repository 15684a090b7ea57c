//! The floating-point environment: the default one during a call, the host's own again after it.
//!
//! A host may run with traps enabled, another rounding mode or flush-to-zero. The library's results must not depend on that, and
//! its harmless 0/0 and inexact operations must not trap. Threads that a call starts inherit the environment of the call.

use std::ffi::c_int;

/// Room for any platform's `fenv_t` (the largest known, x86 glibc, has 32 bytes), aligned for all of them.
#[repr(C, align(16))]
struct Fenv([u8; 256]);

unsafe extern "C" {
    fn feholdexcept(environment: *mut Fenv) -> c_int;
    fn fesetenv(environment: *const Fenv) -> c_int;
    fn fesetround(mode: c_int) -> c_int;
}

/// `FE_TONEAREST`, 0 on every platform that has it.
const TO_NEAREST: c_int = 0;

/// The host's environment, which is put back when this is dropped.
pub struct Environment(Fenv);

impl Environment {
    /// Saves the host's environment and sets the default one.
    pub fn enter() -> Environment {
        let mut host = Environment(Fenv([0; 256]));
        // On other systems than Linux the host's flush-to-zero stays in force.
        // SAFETY: the buffer is large enough and aligned for `fenv_t`; `FE_DFL_ENV` is the pointer −1 in
        // glibc and musl, whose `fesetenv` also clears flush-to-zero.
        unsafe {
            feholdexcept(&mut host.0);
            if cfg!(target_os = "linux") {
                fesetenv(std::ptr::without_provenance(usize::MAX));
            } else {
                fesetround(TO_NEAREST);
            }
        }
        host
    }
}

impl Drop for Environment {
    fn drop(&mut self) {
        // SAFETY: written by `feholdexcept` above.
        unsafe {
            fesetenv(&self.0);
        }
    }
}
