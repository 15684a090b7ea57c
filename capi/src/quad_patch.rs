//! Patches and arcs of splines over quad layouts in memory: poles, knots, neighbours; the extraction matrix.

use crate::arrays::{check_buffer, copy_each, copy_out};
use crate::choice::choices;
use crate::failure::{Failure, FailureElement, Outcome};
use crate::guard;
use crate::quad_spline::ricci_quad_spline;
use crate::status::*;
use crate::structs::{self, sized};
use ricci::spline::{PatchCorner, QuadSpline};

// A direction of the parameters of a patch.
choices!(enum PatchDirection, DIRECTIONS = "along", [
    RICCI_ALONG_U => U,
    RICCI_ALONG_V => V,
]);

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_quad_patch {
    pub size: usize,
    pub degrees: [usize; 2],
    pub n_poles: [usize; 2],
    pub n_knots: [usize; 2],
    pub periodic: [usize; 2],
    pub arcs: [usize; 4],
    pub reversed: [usize; 4],
    pub neighbours: [i64; 4],
    pub neighbour_sides: [i64; 4],
    pub creases: [usize; 4],
}
// SAFETY: numbers; 8-byte alignment, size first.
sized!(ricci_quad_patch, "result");

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_quad_arc {
    pub size: usize,
    pub degree: usize,
    pub n_poles: usize,
    pub n_knots: usize,
    pub ends: [usize; 2],
    pub patches: [i64; 2],
    pub sides: [i64; 2],
    pub length: f64,
    pub crease: u32,
    pub reserved: u32,
}
// SAFETY: numbers; 8-byte alignment, size first.
sized!(ricci_quad_arc, "result", reserved);

impl PatchDirection {
    fn number(self) -> usize {
        match self {
            PatchDirection::U => 0,
            PatchDirection::V => 1,
        }
    }
}

/// Refuses a patch that does not exist.
fn check_patch(spline: &QuadSpline, patch: usize) -> Outcome {
    refuse_beyond("patch", patch, spline.space().layout().patches().len())
}

fn refuse_beyond(what: &str, number: usize, count: usize) -> Outcome {
    if number < count {
        return Ok(());
    }
    let message = format!("{what} {number} does not exist: there are {count}");
    Err(Failure::new(RICCI_SPLINE, message).at(FailureElement::Entry, number))
}

/// The patch and the side at a place, −1 for none.
fn numbers_of(at: Option<PatchCorner>) -> [i64; 2] {
    at.map_or([-1; 2], |at| [at.patch as i64, at.corner as i64])
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_quad_spline_patch(
    spline: *const ricci_quad_spline,
    patch: usize,
    result: *mut ricci_quad_patch,
    size: usize,
) -> ricci_status {
    guard::with(spline, |ricci_quad_spline { fit, .. }| {
        check_patch(&fit.spline, patch)?;
        let space = fit.spline.space();
        let layout = space.layout();
        let sides = layout.patches()[patch];
        let beyond =
            sides.map(|side| numbers_of(layout.beside(side.arc as usize)[usize::from(!side.reversed)]));
        let found = ricci_quad_patch {
            size,
            degrees: [fit.spline.degree(); 2],
            n_poles: space.sides(patch),
            n_knots: space.patch_spans(patch).map(|spans| spans + 1),
            periodic: [0; 2],
            arcs: sides.map(|side| side.arc as usize),
            reversed: sides.map(|side| side.reversed.into()),
            neighbours: beyond.map(|[patch, _]| patch),
            neighbour_sides: beyond.map(|[_, side]| side),
            creases: sides.map(|side| layout.arcs()[side.arc as usize].is_crease.into()),
        };
        structs::write(found, result, size)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_quad_spline_poles(
    spline: *const ricci_quad_spline,
    patch: usize,
    poles: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(spline, |ricci_quad_spline { fit, .. }| {
        check_patch(&fit.spline, patch)?;
        copy_out("poles", &fit.spline.net(patch).concat(), poles, capacity)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_quad_spline_knots(
    spline: *const ricci_quad_spline,
    patch: usize,
    along: u32,
    knots: *mut f64,
    knots_capacity: usize,
    multiplicities: *mut u32,
    multiplicities_capacity: usize,
) -> ricci_status {
    guard::with(spline, |ricci_quad_spline { fit, .. }| {
        check_patch(&fit.spline, patch)?;
        let along = DIRECTIONS.choose(along)?.number();
        let (mut distinct, mut counts): (Vec<f64>, Vec<u32>) = (Vec::new(), Vec::new());
        for knot in &fit.spline.knots(patch)[along] {
            match counts.last_mut() {
                Some(count) if distinct.last() == Some(knot) => *count += 1,
                _ => {
                    distinct.push(*knot);
                    counts.push(1);
                }
            }
        }
        check_buffer("multiplicities", counts.len(), multiplicities, multiplicities_capacity)?;
        copy_out("knots", &distinct, knots, knots_capacity)?;
        copy_out("multiplicities", &counts, multiplicities, multiplicities_capacity)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_quad_spline_controls(
    spline: *const ricci_quad_spline,
    patch: usize,
    controls: *mut u32,
    capacity: usize,
) -> ricci_status {
    guard::with(spline, |ricci_quad_spline { fit, .. }| {
        check_patch(&fit.spline, patch)?;
        copy_out("controls", fit.spline.space().control(patch), controls, capacity)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_quad_spline_arc(
    spline: *const ricci_quad_spline,
    arc: usize,
    result: *mut ricci_quad_arc,
    size: usize,
) -> ricci_status {
    guard::with(spline, |ricci_quad_spline { fit, .. }| {
        let space = fit.spline.space();
        let layout = space.layout();
        refuse_beyond("arc", arc, layout.arcs().len())?;
        let beside = layout.beside(arc).map(numbers_of);
        let of = &layout.arcs()[arc];
        let found = ricci_quad_arc {
            size,
            degree: fit.spline.degree(),
            n_poles: fit.spline.arc_control_points(arc)?.len(),
            n_knots: space.spans()[arc] + 1,
            ends: of.ends.map(|node| node as usize),
            patches: beside.map(|[patch, _]| patch),
            sides: beside.map(|[_, side]| side),
            length: of.length,
            crease: of.is_crease.into(),
            reserved: 0,
        };
        structs::write(found, result, size)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_quad_spline_arc_poles(
    spline: *const ricci_quad_spline,
    arc: usize,
    poles: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(spline, |ricci_quad_spline { fit, .. }| {
        refuse_beyond("arc", arc, fit.spline.space().layout().arcs().len())?;
        copy_out("poles", &fit.spline.arc_control_points(arc)?, poles, capacity)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_quad_spline_extraction(
    spline: *const ricci_quad_spline,
    columns: *mut u32,
    columns_capacity: usize,
    values: *mut f64,
    values_capacity: usize,
    starts: *mut usize,
    starts_capacity: usize,
) -> ricci_status {
    guard::with(spline, |ricci_quad_spline { fit, .. }| {
        let matrix = fit.spline.space().extraction();
        check_buffer("columns", matrix.columns.len(), columns, columns_capacity)?;
        check_buffer("values", matrix.values.len(), values, values_capacity)?;
        copy_out("starts", &matrix.starts, starts, starts_capacity)?;
        copy_out("columns", &matrix.columns, columns, columns_capacity)?;
        copy_out("values", &matrix.values, values, values_capacity)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_quad_spline_bezier(
    spline: *const ricci_quad_spline,
    patch: usize,
    along: u32,
    weights: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(spline, |ricci_quad_spline { fit, .. }| {
        check_patch(&fit.spline, patch)?;
        let along = DIRECTIONS.choose(along)?.number();
        let spans = &fit.spline.space().bezier_extraction(patch)[along];
        copy_each("weights", spans.len(), spans.iter().copied(), weights, capacity)
    })
}
