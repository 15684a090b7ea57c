//! `ricci_init`, which zeroes a caller's struct and writes its size.

use crate::failure::Failure;
use crate::guard;
use crate::status::ricci_status;
use crate::structs;
use std::ffi::c_void;

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_init(options: *mut c_void, size: usize) -> ricci_status {
    guard::call(|| {
        if options.is_null() {
            return Err(Failure::null("options"));
        }
        structs::check("options", size)?;
        // SAFETY: the caller's memory has `size` bytes (contract of the header).
        unsafe {
            options.cast::<u8>().write_bytes(0, size);
            options.cast::<usize>().write_unaligned(size);
        }
        Ok(())
    })
}
