//! Flat maps of least stretch.

use crate::arrays::{self, check_buffer, copy_out};
use crate::choice::choices;
use crate::control::{self, ricci_control};
use crate::failure::Outcome;
use crate::guard;
use crate::memory;
use crate::mesh::ricci_mesh;
use crate::status::*;
use crate::structs::{self, or, sized};
use ricci::Control;
use ricci::flatten::{
    Distortion, DistortionEnergy, FlattenOptions, FlattenReport, FlattenStart, FlattenStop, flatten,
    flatten_sphere,
};
use ricci::mesh::VertexId;

choices!(ENERGIES: DistortionEnergy = "energy of a flat map", [
    RICCI_FLATTEN_ISOMETRIC => DistortionEnergy::Isometric,
    RICCI_FLATTEN_ARAP => DistortionEnergy::Arap,
    RICCI_FLATTEN_AREA => DistortionEnergy::Area,
    RICCI_FLATTEN_DISTANCE => DistortionEnergy::Distance,
]);

choices!(STARTS: FlattenStart = "start of a flat map", [
    RICCI_FLATTEN_FROM_CONFORMAL => FlattenStart::Conformal,
    RICCI_FLATTEN_FROM_TUTTE => FlattenStart::Tutte,
    RICCI_FLATTEN_FROM_UNTANGLED => FlattenStart::Untangled,
    RICCI_FLATTEN_FROM_SEAMLESS => FlattenStart::Seamless,
    RICCI_FLATTEN_FROM_COARSE => FlattenStart::CoarseToFine,
]);

choices!(STOPS: FlattenStop = "end of a flat map", [
    RICCI_FLATTEN_CONVERGED => FlattenStop::Converged,
    RICCI_FLATTEN_ROUNDING => FlattenStop::Rounding,
    RICCI_FLATTEN_MAX_ITERATIONS => FlattenStop::MaxIterations,
    RICCI_FLATTEN_BARRIER => FlattenStop::Barrier,
    RICCI_FLATTEN_NO_STEP => FlattenStop::NoStep,
    RICCI_FLATTEN_UNMET => FlattenStop::Unmet,
]);

choices!(FIGURES: fn(&Distortion) -> f64 = "figure of distortion", [
    RICCI_DISTORTION_ENERGY => |d| d.energy,
    RICCI_DISTORTION_LEAST_STRETCH => |d| d.least_stretch,
    RICCI_DISTORTION_MOST_STRETCH => |d| d.most_stretch,
    RICCI_DISTORTION_MEAN_LENGTH_ERROR => |d| d.mean_length_error,
    RICCI_DISTORTION_MAX_LENGTH_ERROR => |d| d.max_length_error,
    RICCI_DISTORTION_MEAN_AREA_ERROR => |d| d.mean_area_error,
    RICCI_DISTORTION_MAX_AREA_ERROR => |d| d.max_area_error,
    RICCI_DISTORTION_MEAN_DILATATION => |d| d.mean_dilatation,
    RICCI_DISTORTION_MAX_DILATATION => |d| d.max_dilatation,
    RICCI_DISTORTION_AREA => |d| d.area,
]);

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_flatten_options {
    pub size: usize,
    pub conformal: f64,
    pub tolerance: f64,
    pub max_iterations: usize,
    pub energy: u32,
    pub injective: u32,
    pub weights: *const f64,
    pub n_weights: usize,
    pub pins: *const u32,
    pub places: *const f64,
    pub n_pins: usize,
    pub straight: *const u32,
    pub straight_sizes: *const u32,
    pub n_straight: usize,
    pub rings: usize,
}
// SAFETY: numbers and raw pointers; 8-byte alignment, size first.
sized!(ricci_flatten_options, "options");

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_flatten_summary {
    pub size: usize,
    pub n_energies: usize,
    pub n_unclamped: usize,
    pub energy: f64,
    pub decrement: f64,
    pub gradient: f64,
    pub overlap: f64,
    pub before: [f64; 10],
    pub after: [f64; 10],
    pub start: u32,
    pub stop: u32,
    pub misfit: f64,
    pub one_to_one: u32,
    pub reserved: u32,
}
// SAFETY: numbers; 8-byte alignment, size first.
sized!(ricci_flatten_summary, "summary", reserved);

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_flatten(
    mesh: *const ricci_mesh,
    options: *const ricci_flatten_options,
    control: *const ricci_control,
    points: *mut f64,
    capacity: usize,
    energies: *mut f64,
    energies_capacity: usize,
    summary: *mut ricci_flatten_summary,
    size: usize,
) -> ricci_status {
    guard::with(mesh, |mesh| {
        structs::check_place(summary, size)?;
        let options = library_options(&structs::read(options)?)?;
        let threads = control::threads(control);
        let control: Control = control::of(control)?;
        let _reserve = memory::work(mesh.connectivity.n_vertices(), memory::UNIFORM)?;
        let options = FlattenOptions { threads, ..options };
        let found = flatten(mesh.surface()?, &options, &control)?;
        let told = told(&found.report, energies, energies_capacity)?;
        let figures = figures_of(&found.report)?;
        copy_out("points", &found.points, points, capacity)?;
        copy_out("energies", told, energies, energies_capacity)?;
        structs::write(figures, summary, size)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_flatten_sphere(
    mesh: *const ricci_mesh,
    options: *const ricci_flatten_options,
    control: *const ricci_control,
    points: *mut f64,
    capacity: usize,
    energies: *mut f64,
    energies_capacity: usize,
    summary: *mut ricci_flatten_summary,
    size: usize,
) -> ricci_status {
    guard::with(mesh, |mesh| {
        structs::check_place(summary, size)?;
        let options = library_options(&structs::read(options)?)?;
        let threads = control::threads(control);
        let control: Control = control::of(control)?;
        let _reserve = memory::work(mesh.connectivity.n_vertices(), memory::UNIFORM)?;
        let options = FlattenOptions { threads, ..options };
        let found = flatten_sphere(mesh.surface()?, &options, &control)?;
        let told = told(&found.report, energies, energies_capacity)?;
        let figures = figures_of(&found.report)?;
        copy_out("points", &found.points, points, capacity)?;
        copy_out("energies", told, energies, energies_capacity)?;
        structs::write(figures, summary, size)
    })
}

/// The energies that there is room for.
pub(crate) fn told(report: &FlattenReport, energies: *mut f64, capacity: usize) -> Outcome<&[f64]> {
    let told = report.energies.len().min(capacity);
    check_buffer("energies", told, energies, capacity)?;
    Ok(&report.energies[..told])
}

/// The library's options but for the threads.
pub(crate) fn library_options(given: &ricci_flatten_options) -> Outcome<FlattenOptions> {
    let usual = FlattenOptions::default();
    let pins = arrays::array("pins", given.pins, given.n_pins)?;
    let places = arrays::array::<[f64; 2]>("places", given.places.cast(), given.n_pins)?;
    Ok(FlattenOptions {
        energy: ENERGIES.choose(given.energy)?,
        conformal: (given.conformal != 0.0).then_some(given.conformal),
        tolerance: if given.tolerance == 0.0 { usual.tolerance } else { given.tolerance },
        max_iterations: or(given.max_iterations, usual.max_iterations),
        rings: or(given.rings, usual.rings),
        injective: given.injective != 0,
        weights: arrays::array("weights", given.weights, given.n_weights)?,
        pins: pins.into_iter().map(VertexId).zip(places).collect(),
        straight: straight_pieces(given)?,
        threads: 0,
    })
}

/// The runs of vertices that become straight.
fn straight_pieces(given: &ricci_flatten_options) -> Outcome<Vec<Vec<VertexId>>> {
    let sizes = arrays::array("straight_sizes", given.straight_sizes, given.n_straight)?;
    let total = sizes.iter().fold(0usize, |sum, &n| sum.saturating_add(n as usize));
    let mut vertices = arrays::array("straight", given.straight, total)?.into_iter().map(VertexId);
    Ok(sizes.iter().map(|&n| vertices.by_ref().take(n as usize).collect()).collect())
}

pub(crate) fn figures_of(report: &FlattenReport) -> Outcome<ricci_flatten_summary> {
    let distortion = |of: &Distortion| std::array::from_fn(|k| FIGURES.values[k].1(of));
    Ok(ricci_flatten_summary {
        size: 0,
        n_energies: report.energies.len(),
        n_unclamped: report.unclamped,
        energy: report.energies.last().copied().unwrap_or(f64::NAN),
        decrement: report.decrement,
        gradient: report.gradient,
        overlap: report.overlap,
        before: distortion(&report.before),
        after: distortion(&report.after),
        start: STARTS.number(report.start)?,
        stop: STOPS.number(report.stop)?,
        misfit: report.misfit,
        one_to_one: report.one_to_one.into(),
        reserved: 0,
    })
}
