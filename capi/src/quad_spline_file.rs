//! Files of splines over quad layouts.

use crate::arrays;
use crate::bicubic::ricci_step_options;
use crate::failure::{Failure, Outcome};
use crate::guard;
use crate::memory;
use crate::optional::{write_quad_json, write_quad_step};
use crate::quad_spline::ricci_quad_spline;
use crate::spline_memory;
use crate::status::*;
use crate::structs;
use ricci::mesh::io::write_atomically;
use std::ffi::c_char;
use std::io::Write;
use std::path::Path;

/// Refuses another extension than these.
fn check_extension(path: &Path, known: &[&str]) -> Outcome {
    let extension = path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase());
    if extension.is_some_and(|extension| known.contains(&&*extension)) {
        return Ok(());
    }
    let message = format!("{}: unknown format; known are .{}", path.display(), known.join(", ."));
    Err(Failure::new(RICCI_UNKNOWN_FORMAT, message))
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_quad_spline_write_step(
    spline: *const ricci_quad_spline,
    options: *const ricci_step_options,
    path: *const c_char,
) -> ricci_status {
    guard::with(spline, |ricci_quad_spline { fit, .. }| {
        let (path, options) = (arrays::path(path)?, structs::read(options)?.read()?);
        check_extension(&path, &["step", "stp"])?;
        let points = fit.spline.space().n_control_points();
        let _reserve = memory::work(points, spline_memory::BICUBIC_TEXT)?;
        let mut bytes = Vec::new();
        write_quad_step(&fit.spline, &options, &mut bytes)?;
        Ok(write_atomically(&path, |out| out.write_all(&bytes))?)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_quad_spline_write_json(
    spline: *const ricci_quad_spline,
    path: *const c_char,
) -> ricci_status {
    guard::with(spline, |ricci_quad_spline { fit, .. }| {
        let path = arrays::path(path)?;
        check_extension(&path, &["json"])?;
        let points = fit.spline.space().n_control_points();
        let _reserve = memory::work(points, spline_memory::BICUBIC_TEXT)?;
        let mut bytes = Vec::new();
        write_quad_json(&fit.spline, &mut bytes)?;
        Ok(write_atomically(&path, |out| out.write_all(&bytes))?)
    })
}
