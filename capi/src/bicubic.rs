//! Bicubic patches that approximate a spline, and their files for CAD.

use crate::arrays::{self, copy_counted};
use crate::choice::choices;
use crate::control::{self, ricci_control};
use crate::failure::{Failure, Outcome};
use crate::guard::{self, handle, shared};
use crate::memory;
use crate::optional::{LengthUnit, StepOptions, write_step};
use crate::spline::ricci_spline;
use crate::spline_memory;
use crate::status::*;
use crate::structs::{self, or, sized};
use ricci::mesh::io::write_atomically;
use ricci::spline::{BicubicFit, BicubicOptions, BicubicSurface};
use std::ffi::c_char;
use std::io::Write;
use std::path::Path;

pub struct ricci_bicubic(BicubicFit);
handle!(ricci_bicubic, "bicubic patches");

/// Number of places of a spline that are evaluated at a time while patches are made.
const BATCH: usize = 1 << 16;

choices!(enum BicubicFormat, FORMATS = "format", [
    RICCI_BICUBIC_STEP => Step,
    RICCI_BICUBIC_JSON => Json,
]);

choices!(UNITS: LengthUnit = "unit", [
    RICCI_UNIT_MILLIMETRE => LengthUnit::Millimetre,
    RICCI_UNIT_METRE => LengthUnit::Metre,
]);

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_bicubic_options {
    pub size: usize,
    pub tolerance: f64,
    pub angle: f64,
    pub threads: usize,
    pub control_points: usize,
    pub folds: u32,
    pub reserved: u32,
}
// SAFETY: numbers; 8-byte alignment, size first.
sized!(ricci_bicubic_options, "options", reserved);

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_step_options {
    pub size: usize,
    pub name: *const c_char,
    pub unit: u32,
    pub colours: u32,
}
// SAFETY: numbers and a raw pointer; 8-byte alignment, size first.
sized!(ricci_step_options, "options");

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_bicubic_summary {
    pub size: usize,
    pub n_patches: usize,
    pub n_curves: usize,
    pub n_control_points: usize,
    pub spans_min: usize,
    pub spans_max: usize,
    pub rounds: usize,
    pub n_open_sides: usize,
    pub closed: u32,
    pub reserved: u32,
    pub diagonal: f64,
    pub distance: f64,
    pub normal_jump_max: f64,
    pub normal_jump_mean: f64,
    pub normal_jump_of_spline: f64,
}
// SAFETY: numbers; 8-byte alignment, size first.
sized!(ricci_bicubic_summary, "summary", reserved);

impl ricci_bicubic_options {
    fn read(&self) -> BicubicOptions {
        let usual = BicubicOptions::default();
        BicubicOptions {
            tolerance: or(self.tolerance, usual.tolerance),
            angle: or(self.angle, usual.angle),
            control_points: (self.control_points > 0).then_some(self.control_points),
            folds: self.folds != 0,
            threads: self.threads,
        }
    }
}

impl ricci_step_options {
    pub(crate) fn read(&self) -> Outcome<StepOptions> {
        let name = if self.name.is_null() { "" } else { arrays::text("name", self.name)? };
        Ok(StepOptions { name: name.into(), unit: UNITS.choose(self.unit)?, colours: self.colours != 0 })
    }
}

/// The format that belongs to the extension of a file's name.
fn format_of(path: &Path) -> Outcome<BicubicFormat> {
    let extension = path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase());
    match extension.as_deref() {
        Some("step" | "stp") => Ok(BicubicFormat::Step),
        Some("json") => Ok(BicubicFormat::Json),
        _ => {
            let message = format!("{}: unknown format; known are .step, .stp, .json", path.display());
            Err(Failure::new(RICCI_UNKNOWN_FORMAT, message))
        }
    }
}

/// The content of a file of patches.
fn bytes(
    surface: &BicubicSurface,
    format: BicubicFormat,
    options: *const ricci_step_options,
) -> Outcome<Vec<u8>> {
    let options = structs::read(options)?.read()?;
    let _reserve = memory::work(surface.n_control_points(), spline_memory::BICUBIC_TEXT)?;
    let mut bytes = Vec::new();
    match format {
        BicubicFormat::Step => write_step(surface, &options, &mut bytes)?,
        BicubicFormat::Json => {
            surface.write_json(&mut bytes).map_err(|why| Failure::new(RICCI_IO, why.to_string()))?;
        }
    }
    Ok(bytes)
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_bicubic_new(
    spline: *const ricci_spline,
    options: *const ricci_bicubic_options,
    control: *const ricci_control,
    bicubic: *mut *mut ricci_bicubic,
) -> ricci_status {
    guard::make(bicubic, || {
        let (spline, options) = (&shared(spline)?.spline, structs::read(options)?.read());
        let _batch = memory::work(BATCH, spline_memory::POINT)?;
        let _reserve = memory::work(spline.space().patches().len(), spline_memory::BICUBIC)?;
        Ok(ricci_bicubic(spline.to_bicubic(&options, &control::of(control)?)?))
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_bicubic_free(bicubic: *mut ricci_bicubic) {
    guard::free(bicubic);
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_bicubic_summarise(
    bicubic: *const ricci_bicubic,
    summary: *mut ricci_bicubic_summary,
    size: usize,
) -> ricci_status {
    guard::with(bicubic, |ricci_bicubic(found)| {
        let surface = &found.surface;
        let figures = ricci_bicubic_summary {
            size,
            n_patches: surface.patches.len(),
            n_curves: surface.curves.len(),
            n_control_points: surface.n_control_points(),
            spans_min: found.spans[0],
            spans_max: found.spans[1],
            rounds: found.rounds,
            n_open_sides: surface.open_sides(),
            closed: surface.is_closed().into(),
            reserved: 0,
            diagonal: found.diagonal,
            distance: found.distance,
            normal_jump_max: found.angles.largest,
            normal_jump_mean: found.angles.mean,
            normal_jump_of_spline: found.angles.of_spline,
        };
        structs::write(figures, summary, size)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_bicubic_write(
    bicubic: *const ricci_bicubic,
    options: *const ricci_step_options,
    path: *const c_char,
) -> ricci_status {
    guard::with(bicubic, |ricci_bicubic(found)| {
        let path = arrays::path(path)?;
        let bytes = bytes(&found.surface, format_of(&path)?, options)?;
        Ok(write_atomically(&path, |out| out.write_all(&bytes))?)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_bicubic_text(
    bicubic: *const ricci_bicubic,
    format: u32,
    options: *const ricci_step_options,
    text: *mut c_char,
    capacity: usize,
    n_bytes: *mut usize,
) -> ricci_status {
    guard::with(bicubic, |ricci_bicubic(found)| {
        let mut bytes = bytes(&found.surface, FORMATS.choose(format)?, options)?;
        bytes.push(0);
        copy_counted("text", &bytes, text.cast(), capacity, n_bytes)
    })
}
