//! Layouts in the plane as geometry: flat meshes, and lines for cutting and folding.

use crate::arrays::{self, copy_each, copy_out};
use crate::choice::choices;
use crate::failure::{Failure, Outcome};
use crate::guard;
use crate::layout::ricci_layout;
use crate::metric::{ON, Triangulation};
use crate::status::*;
use ricci::embed::{FlatSurface, fold_edges};
use ricci::geometry::Space;
use ricci::mesh::io::{CuttingSheet, SheetLayer, SheetUnit};
use ricci::mesh::{EdgeId, PerEdge};
use std::ffi::c_char;

choices!(LAYERS: SheetLayer = "layer", [
    RICCI_LAYER_BOUNDARY => SheetLayer::Boundary,
    RICCI_LAYER_SEAMS => SheetLayer::Seams,
    RICCI_LAYER_FOLDS => SheetLayer::Folds,
    RICCI_LAYER_ALLOWANCE => SheetLayer::Allowance,
]);

choices!(UNITS: SheetUnit = "unit", [
    RICCI_SHEET_MILLIMETRE => SheetUnit::Millimetre,
    RICCI_SHEET_CENTIMETRE => SheetUnit::Centimetre,
    RICCI_SHEET_METRE => SheetUnit::Metre,
    RICCI_SHEET_INCH => SheetUnit::Inch,
]);

/// Calls `use_it` with the flat surface of a layout and the test whether an edge of it is a fold.
fn with_flat<T>(
    layout: &ricci_layout,
    on: Triangulation,
    fold_angle: f64,
    use_it: impl FnOnce(&FlatSurface<'_>, &dyn Fn(EdgeId) -> bool) -> Outcome<T>,
) -> Outcome<T> {
    if layout.layout.space != Space::E2 {
        let message = "the layout does not lie in the plane, so that it has no sheet";
        return Err(Failure::new(RICCI_LAYOUT, message));
    }
    if !(0.0..=std::f64::consts::PI).contains(&fold_angle) {
        return Err(Failure::argument(format!("fold_angle is {fold_angle}: it must be from 0 to pi")));
    }
    let solution = &layout.state.solution;
    let given = solution.given();
    let mut is_fold = PerEdge::filled(given.n_edges(), false);
    if let Some(positions) = solution.surface().positions() {
        fold_edges(given, positions, fold_angle).into_iter().for_each(|e| is_fold[e] = true);
    }
    match on {
        Triangulation::Input => {
            let on_input = layout.on_input()?;
            let flat = FlatSurface::of_input(given, on_input);
            use_it(&flat, &|e| is_fold[e])
        }
        _ => {
            let flat = FlatSurface::of_layout(&layout.layout);
            // The edges of the metric's own triangulation after flips are none of the mesh.
            let own = |e: EdgeId| Some(e).filter(|_| solution.is_unflipped());
            let subdivision = layout.layout.common_subdivision();
            let of_input = |e: EdgeId| subdivision.map_or_else(|| own(e), |r| r.edge(0, e));
            use_it(&flat, &|e| of_input(e).is_some_and(|e| is_fold[e]))
        }
    }
}

/// The lines of a layout, whose points are numbers of those of `ricci_layout_points`.
fn sheet_of(layout: &ricci_layout, on: u32, fold_angle: f64) -> Outcome<CuttingSheet> {
    let on = ON.choose(on)?;
    let mut sheet = with_flat(layout, on, fold_angle, |flat, is_fold| Ok(flat.sheet(is_fold)))?;
    if on == Triangulation::Input {
        let points = &layout.on_input()?.points;
        let lines = sheet.lines.iter_mut().flat_map(|line| &mut line.points);
        lines.for_each(|k| *k = points[*k as usize]);
        sheet.points = layout.points.clone();
    }
    Ok(sheet)
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_layout_lines(
    layout: *const ricci_layout,
    on: u32,
    fold_angle: f64,
    lines: *mut i32,
    capacity: usize,
) -> ricci_status {
    guard::with(layout, |layout| {
        let sheet = sheet_of(layout, on, fold_angle)?;
        let row = |line: &ricci::mesh::io::SheetLine| -> Outcome<[i32; 4]> {
            let seam = line.seam.map_or(-1, |seam| seam as i32);
            let layer = LAYERS.number(line.layer)? as i32;
            Ok([layer, seam, i32::from(line.is_closed), line.points.len() as i32])
        };
        let rows = sheet.lines.iter().map(row).collect::<Outcome<Vec<_>>>()?;
        copy_out("lines", &rows, lines, capacity)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_layout_line_points(
    layout: *const ricci_layout,
    on: u32,
    fold_angle: f64,
    points: *mut u32,
    capacity: usize,
) -> ricci_status {
    guard::with(layout, |layout| {
        let sheet = sheet_of(layout, on, fold_angle)?;
        let n = sheet.lines.iter().map(|line| line.points.len()).sum();
        copy_each(
            "points",
            n,
            sheet.lines.iter().flat_map(|line| line.points.iter().copied()),
            points,
            capacity,
        )
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_layout_write_flat(
    layout: *const ricci_layout,
    on: u32,
    fold_angle: f64,
    unit: u32,
    path: *const c_char,
) -> ricci_status {
    guard::with(layout, |layout| {
        let (on, unit, path) = (ON.choose(on)?, UNITS.choose(unit)?, arrays::path(path)?);
        with_flat(layout, on, fold_angle, |flat, is_fold| Ok(flat.write(&path, is_fold, unit)?))
    })
}
