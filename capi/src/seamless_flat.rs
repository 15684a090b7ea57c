//! Flat maps of least stretch with the seams of a seamless metric.

use crate::arrays::copy_out;
use crate::control::{self, ricci_control};
use crate::failure::Outcome;
use crate::flatten::{figures_of, library_options, ricci_flatten_options, ricci_flatten_summary, told};
use crate::guard::{self, shared};
use crate::layout::ricci_layout;
use crate::memory;
use crate::metric::{MetricState, ricci_metric};
use crate::seamless::ricci_seamless;
use crate::status::ricci_status;
use crate::structs;
use ricci::Control;
use ricci::embed::Layout;
use ricci::flatten::{FlattenOptions, flatten_seamless};
use ricci::geometry::Model;
use ricci::mesh::PerEdge;
use std::sync::{Arc, OnceLock};

impl ricci_layout {
    /// A layout in the plane whose metric is its own, so that its distortion is that against these lengths.
    pub(crate) fn of_lengths(
        state: Arc<MetricState>,
        layout: Layout,
        lengths: &PerEdge<f64>,
    ) -> Outcome<ricci_layout> {
        let [quality, of_input] =
            [layout.quality(layout.mesh(), lengths)?, layout.quality(layout.mesh(), lengths)?];
        let mut made = ricci_layout::new(state, layout, Model::Poincare)?;
        (made.quality, made.of_input) = (Some(quality), OnceLock::from(Some(of_input)));
        Ok(made)
    }
}

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
