//! Strains of sheets that are cut by flat maps, and darts that keep them within the limits of a material.

use crate::arrays::{self, check_buffer, copy_out};
use crate::control::{self, ricci_control};
use crate::failure::Outcome;
use crate::flatten::{library_options, ricci_flatten_options};
use crate::guard::{self, shared};
use crate::memory;
use crate::mesh::ricci_mesh;
use crate::status::ricci_status;
use crate::structs::{self, or, sized};
use ricci::Control;
use ricci::flatten::{DartOptions, FlattenOptions, StrainLimits, flatten_with_darts, strains};

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_dart_options {
    pub size: usize,
    pub strain_warp: f64,
    pub strain_weft: f64,
    pub shear: f64,
    pub warp: f64,
    pub budget: f64,
    pub most: usize,
}
// SAFETY: numbers; 8-byte alignment, size first.
sized!(ricci_dart_options, "darts");

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_dart_summary {
    pub size: usize,
    pub n_darts: usize,
    pub n_vertices: usize,
    pub length: f64,
    pub before: f64,
    pub after: f64,
}
// SAFETY: numbers; 8-byte alignment, size first.
sized!(ricci_dart_summary, "summary");

fn library_darts(given: &ricci_dart_options) -> DartOptions {
    let limit = |x: f64| or(x, f64::INFINITY);
    let limits = StrainLimits {
        warp: limit(given.strain_warp),
        weft: limit(given.strain_weft),
        shear: limit(given.shear),
    };
    let most = or(given.most, DartOptions::default().most);
    DartOptions { limits, warp: given.warp, budget: limit(given.budget), most }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_flatten_darts(
    mesh: *const ricci_mesh,
    options: *const ricci_flatten_options,
    darts: *const ricci_dart_options,
    control: *const ricci_control,
    origins: *mut u32,
    capacity: usize,
    summary: *mut ricci_dart_summary,
    size: usize,
    opened: *mut *mut ricci_mesh,
) -> ricci_status {
    guard::make(opened, || {
        structs::check_place(summary, size)?;
        let mesh = shared(mesh)?;
        let options = library_options(&structs::read(options)?)?;
        let darts = library_darts(&structs::read(darts)?);
        let threads = control::threads(control);
        let control: Control = control::of(control)?;
        let _reserve = memory::work(mesh.connectivity.n_vertices(), memory::UNIFORM)?;
        let options = FlattenOptions { threads, ..options };
        let found = flatten_with_darts(mesh.surface()?, &options, &darts, &control)?;
        let from: Vec<u32> = found.origins.iter().map(|v| v.0).collect();
        if !origins.is_null() || capacity > 0 {
            check_buffer("origins", from.len(), origins, capacity)?;
            copy_out("origins", &from, origins, capacity)?;
        }
        let figures = ricci_dart_summary {
            size: 0,
            n_darts: found.darts.len(),
            n_vertices: from.len(),
            length: found.darts.iter().map(|dart| dart.length).sum(),
            before: found.taken[0],
            after: found.taken[1],
        };
        structs::write(figures, summary, size)?;
        let surface = found.surface;
        Ok(match surface.positions() {
            Some(positions) => ricci_mesh::in_space(surface.mesh().clone(), positions.clone()),
            None => {
                ricci_mesh::intrinsic(surface.mesh().clone(), surface.lengths().clone(), surface.geometry())
            }
        })
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_flatten_strains(
    mesh: *const ricci_mesh,
    points: *const f64,
    n_points: usize,
    warp: f64,
    values: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(mesh, |mesh| -> Outcome {
        let points = arrays::array::<[f64; 2]>("points", points.cast(), n_points)?;
        let found = strains(mesh.surface()?, &points, warp)?;
        let rows: Vec<[f64; 3]> = found.iter().map(|s| [s.warp, s.weft, s.shear]).collect();
        copy_out("values", &rows, values, capacity)
    })
}
