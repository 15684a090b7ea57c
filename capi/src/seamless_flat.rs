//! Flat maps of least stretch with the seams of a seamless metric.

use crate::arrays::copy_out;
use crate::control::{self, ricci_control};
use crate::flatten::{figures_of, library_options, ricci_flatten_options, ricci_flatten_summary, told};
use crate::guard::{self, shared};
use crate::layout::ricci_layout;
use crate::memory;
use crate::metric::ricci_metric;
use crate::seamless::ricci_seamless;
use crate::status::ricci_status;
use crate::structs;
use ricci::Control;
use ricci::flatten::{FlattenOptions, flatten_seamless};

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_seamless_flatten(
    result: *const ricci_seamless,
    options: *const ricci_flatten_options,
    control: *const ricci_control,
    energies: *mut f64,
    capacity: usize,
    summary: *mut ricci_flatten_summary,
    size: usize,
    layout: *mut *mut ricci_layout,
) -> ricci_status {
    guard::make(layout, || {
        structs::check_place(summary, size)?;
        let ricci_seamless { found, .. } = shared(result)?;
        let options = library_options(&structs::read(options)?)?;
        let threads = control::threads(control);
        let control: Control = control::of(control)?;
        let _reserve = memory::work(found.solution.given().n_vertices(), memory::UNIFORM)?;
        let options = FlattenOptions { threads, ..options };
        let map = flatten_seamless(found, &options, &control)?;
        let energies_told = told(&map.report, energies, capacity)?;
        let figures = figures_of(&map.report)?;
        let state = ricci_metric::at(map.solution, None)?.0;
        let made = ricci_layout::of_lengths(state, map.layout, map.surface.lengths())?;
        copy_out("energies", energies_told, energies, capacity)?;
        structs::write(figures, summary, size)?;
        Ok(made)
    })
}
