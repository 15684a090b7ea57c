//! Splines over whole surfaces: fits on a flat metric, and closest points.

use crate::arrays::{array, check_buffer, copy_out};
use crate::control::{self, ricci_control};
use crate::guard::{self, shared};
use crate::memory;
use crate::mesh::ricci_mesh;
use crate::metric::ricci_metric;
use crate::spline::ricci_spline;
use crate::spline_memory;
use crate::status::ricci_status;
use crate::structs::{self, or, sized};
use ricci::geometry::vector::{Vector, diagonal};
use ricci::mesh::VertexId;
use ricci::records::SplineFigures;
use ricci::spline::{
    FlatMetric, FlatMetricOptions, SingularVertices, SurfaceFit, SurfaceFitOptions, fit_surface,
    fit_surface_over, flat_curvatures,
};
use ricci::{Surface, flow};

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_spline_surface_options {
    pub size: usize,
    pub control_points: usize,
    pub tolerance: f64,
    pub fairness: f64,
    pub spread: f64,
    pub threads: usize,
    pub degree: u32,
    pub rounds: u32,
    pub corrections: i32,
    pub reserved: u32,
}
// SAFETY: numbers; 8-byte alignment, size first.
sized!(ricci_spline_surface_options, "options", reserved);

impl ricci_spline_surface_options {
    /// The library's options of the caller's. Options without a field in C keep their defaults.
    #[allow(clippy::needless_update)]
    fn read(&self) -> SurfaceFitOptions {
        let usual = SurfaceFitOptions::default();
        let count = |given: u32, usual: usize| if given == 0 { usual } else { given as usize };
        SurfaceFitOptions {
            degree: count(self.degree, usual.degree),
            control_points: (self.control_points > 0).then_some(self.control_points),
            tolerance: or(self.tolerance, usual.tolerance),
            rounds: count(self.rounds, usual.rounds),
            corrections: match self.corrections {
                0 => usual.corrections,
                given => usize::try_from(given).unwrap_or(0),
            },
            fairness: or(self.fairness, usual.fairness),
            spread: or(self.spread, usual.spread),
            threads: self.threads,
            ..usual
        }
    }
}

/// The number of singular vertices that stands for as few as are needed: RICCI_SPLINE_AUTO.
const AUTO: usize = usize::MAX;

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_spline_curvatures(
    mesh: *const ricci_mesh,
    singular: *const u32,
    n_singular: usize,
    range: f64,
    control: *const ricci_control,
    curvatures: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(mesh, |mesh| {
        let n = mesh.connectivity.n_vertices();
        check_buffer("curvatures", n, curvatures, capacity)?;
        let _reserve = memory::work(n, memory::UNIFORM)?;
        let usual = FlatMetricOptions::default();
        let singular = match n_singular {
            AUTO => SingularVertices::Auto,
            n if singular.is_null() => SingularVertices::Count(n),
            n => SingularVertices::At(array("singular", singular, n)?.into_iter().map(VertexId).collect()),
        };
        let options = FlatMetricOptions { singular, range: or(range, usual.range), ..usual };
        let found = flat_curvatures(mesh.surface()?, &options, &control::of(control)?)?;
        let found: Vec<f64> = found.iter().copied().collect();
        copy_out("curvatures", &found, curvatures, capacity)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_spline_fit_surface(
    flat: *const ricci_metric,
    options: *const ricci_spline_surface_options,
    control: *const ricci_control,
    fitted: *mut *mut ricci_spline,
) -> ricci_status {
    guard::make(fitted, || {
        let (solution, control) = (&shared(flat)?.0.solution, control::of(control)?);
        let options = structs::read(options)?.read();
        let surface = solution.surface();
        let _reserve = memory::work(surface.mesh().n_vertices(), spline_memory::FIT)?;
        let metric = FlatMetric::of(solution, &control.part(0.0, 0.1))?;
        let found = fit_surface(surface, &metric, &options, &control.part(0.1, 1.0))?;
        Ok(with_figures(found, surface, options.tolerance))
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_spline_fit_mesh(
    mesh: *const ricci_mesh,
    options: *const ricci_spline_surface_options,
    control: *const ricci_control,
    fitted: *mut *mut ricci_spline,
) -> ricci_status {
    guard::make(fitted, || {
        let (mesh, control) = (shared(mesh)?, control::of(control)?);
        let options = structs::read(options)?.read();
        let surface = mesh.surface()?;
        let _reserve = memory::work(surface.mesh().n_vertices(), spline_memory::FIT)?;
        let threads = flow::Options { threads: options.threads, ..flow::Options::default() };
        let flat = FlatMetricOptions { flow: threads, ..FlatMetricOptions::default() };
        let metrics = FlatMetric::candidates(surface, &flat, &control.part(0.0, 0.2))?;
        let (found, _) = fit_surface_over(surface, &metrics, &options, &control.part(0.2, 1.0))?;
        Ok(with_figures(found, surface, options.tolerance))
    })
}

/// The spline of a fit to a surface with its figures, in the units of the surface.
fn with_figures(found: SurfaceFit, surface: &Surface, tolerance: f64) -> ricci_spline {
    let size = surface.positions().map_or(0.0, |points| diagonal(points));
    let figures = SplineFigures {
        rms: found.rms * size,
        max: found.max * size,
        folds: found.folds.iter().map(|&patch| patch as u32).collect(),
        folded_share: found.folded_share(surface),
        holds: found.holds(tolerance),
    };
    ricci_spline { spline: found.spline, fitted: Some(figures) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_spline_closest(
    spline: *const ricci_spline,
    points: *const f64,
    n: usize,
    control: *const ricci_control,
    patches: *mut u32,
    values: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(spline, |ricci_spline { spline, .. }| {
        check_buffer("values", n.saturating_mul(6), values, capacity)?;
        check_buffer("patches", n, patches, if patches.is_null() { 0 } else { n })?;
        let _reserve = memory::work(n.saturating_add(spline.space().patches().len()), spline_memory::FIT)?;
        let points: Vec<Vector> = array("points", points.cast(), n)?;
        let (threads, control) = (control::threads(control), control::of(control)?);
        let found = spline.closest_points(threads, &control.part(0.0, 0.3))?.find(
            &points,
            threads,
            &control.part(0.3, 1.0),
        )?;
        let row = |at: &ricci::spline::ClosestPoint| {
            let [x, y, z] = at.point;
            [at.place.x, at.place.y, x, y, z, at.distance]
        };
        let numbers: Vec<u32> = found.iter().map(|at| at.place.patch).collect();
        copy_out("patches", &numbers, patches, n)?;
        copy_out("values", &found.iter().map(row).collect::<Vec<_>>(), values, capacity)
    })
}
