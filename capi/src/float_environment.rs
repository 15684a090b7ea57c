//! The floating-point environment: the default one during a call, the host's own again after it. On Linux that is the whole default
//! environment; elsewhere traps are off and rounding is to nearest, but flush-to-zero stays as the host has it. Exception flags that are
//! raised during the call are discarded.
//!
//! A host may run with traps enabled, another rounding mode or flush-to-zero. The library's results must not depend on that (on
//! flush-to-zero they do outside Linux), and its harmless 0/0 and inexact operations must not trap. Threads that a call starts inherit
//! the environment of the call.

use std::ffi::c_int;

/// Room for any platform's `fenv_t` (the largest known, x86 glibc, has 32 bytes), aligned for all of them.
#[repr(C, align(16))]
struct Fenv([u8; 256]);

unsafe extern "C" {
    fn feholdexcept(environment: *mut Fenv) -> c_int;
    fn fesetenv(environment: *const Fenv) -> c_int;
    fn fesetround(mode: c_int) -> c_int;
}

/// The value of `FE_TONEAREST`, 0 on every platform we know.
const TO_NEAREST: c_int = 0;

/// The host's environment, which is put back when this is dropped.
pub struct HostFloatEnvironment(Fenv);

impl HostFloatEnvironment {
    /// Saves the host's environment and sets the default one.
    pub fn replace_by_default() -> HostFloatEnvironment {
        let mut host = HostFloatEnvironment(Fenv([0; 256]));
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

impl Drop for HostFloatEnvironment {
    fn drop(&mut self) {
        // SAFETY: written by `feholdexcept` above.
        unsafe {
            fesetenv(&self.0);
        }
    }
}
