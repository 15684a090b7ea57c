//! Splines as files and as text in memory.

use crate::arrays::{self, copy_counted};
use crate::control;
use crate::failure::Outcome;
use crate::guard;
use crate::memory;
use crate::spline::ricci_spline;
use crate::spline_memory;
use crate::status::ricci_status;
use ricci::control::Stage;
use ricci::spline::Spline;
use std::ffi::c_char;

/// The name of a text in memory, for messages.
const TEXT_NAME: &str = "text";

/// The spline that `make` reads, with a reserve for a text of this number of bytes.
fn made(bytes: usize, make: impl FnOnce() -> ricci::Result<Spline>) -> Outcome<ricci_spline> {
    let _reserve = memory::work(bytes, spline_memory::TEXT)?;
    control::of_thread()?.step(Stage::Read, 0.2)?;
    Ok(make()?.into())
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_spline_read(
    path: *const c_char,
    spline: *mut *mut ricci_spline,
) -> ricci_status {
    guard::make(spline, || {
        let path = arrays::path(path)?;
        // If the file does not exist, reading it fails with its name in the message.
        let bytes = std::fs::metadata(&path).map_or(0, |file| file.len() as usize);
        made(bytes, || Spline::read(&path))
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_spline_parse(
    text: *const c_char,
    spline: *mut *mut ricci_spline,
) -> ricci_status {
    guard::make(spline, || {
        let text = arrays::text("text", text)?;
        made(text.len(), || Spline::from_json(text, TEXT_NAME))
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_spline_write(
    spline: *const ricci_spline,
    path: *const c_char,
) -> ricci_status {
    guard::with(spline, |ricci_spline { spline, .. }| {
        let _reserve = memory::work(spline.space().patches().len(), spline_memory::SPLINE_TEXT)?;
        control::of_thread()?.step(Stage::Write, 0.2)?;
        Ok(spline.write(&arrays::path(path)?)?)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_spline_text(
    spline: *const ricci_spline,
    text: *mut c_char,
    capacity: usize,
    n_bytes: *mut usize,
) -> ricci_status {
    guard::with(spline, |ricci_spline { spline, .. }| {
        let _reserve = memory::work(spline.space().patches().len(), spline_memory::SPLINE_TEXT)?;
        let mut bytes = spline.to_json().into_bytes();
        bytes.push(0);
        copy_counted("text", &bytes, text.cast(), capacity, n_bytes)
    })
}
