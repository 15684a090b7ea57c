//! Fits of splines over the plane to points.

use crate::arrays::array;
use crate::control::{self, ricci_control};
use crate::guard::{self, shared};
use crate::memory;
use crate::spline::ricci_spline;
use crate::spline_memory;
use crate::spline_places::{located, ricci_spline_places};
use crate::status::ricci_status;
use crate::structs::{self, or, sized};
use ricci::records::SplineFigures;
use ricci::spline::{FitOptions, fit};

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_spline_fit_options {
    pub size: usize,
    pub places: *const ricci_spline_places,
    pub fairness: f64,
    pub threads: usize,
}
// SAFETY: numbers and a raw pointer; 8-byte alignment, size first.
sized!(ricci_spline_fit_options, "options");

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_spline_fit(
    spline: *const ricci_spline,
    points: *const f64,
    n_points: usize,
    options: *const ricci_spline_fit_options,
    control: *const ricci_control,
    fitted: *mut *mut ricci_spline,
) -> ricci_status {
    guard::make(fitted, || {
        let (spline, given) = (&shared(spline)?.spline, structs::read(options)?);
        let space = spline.space();
        let _reserve = memory::work(n_points.saturating_add(space.n_control_points()), spline_memory::FIT)?;
        let control = control::of(control)?;
        let points: Vec<[f64; 3]> = array("points", points.cast(), n_points)?;
        let places = if given.places.is_null() {
            let over: Vec<[f64; 2]> = points.iter().map(|p| [p[0], p[1]]).collect();
            located(space, &over, &control)?
        } else {
            structs::read(given.places)?.read(space, &control)?
        };
        let usual = FitOptions::default();
        let fairness = or(given.fairness, usual.fairness);
        // A negative weight stands for none; the library refuses NaN, with a message.
        let fairness = if fairness < 0.0 { 0.0 } else { fairness };
        let options = FitOptions { fairness, threads: given.threads };
        let found = fit(space, &places, &points, &options, &control)?;
        Ok(ricci_spline {
            spline: found.spline,
            fitted: Some(SplineFigures { rms: found.rms, max: found.max, ..SplineFigures::default() }),
        })
    })
}
