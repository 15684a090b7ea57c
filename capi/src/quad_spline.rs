//! Splines over the four-sided patches of quad layouts: the fit to a surface and its figures.

use crate::arrays::copy_each;
use crate::control::{self, ricci_control};
use crate::failure::Failure;
use crate::guard::{self, handle, shared};
use crate::memory;
use crate::mesh::ricci_mesh;
use crate::quad_layout::{coarsest, ricci_quad_layout};
use crate::seamless::ricci_seamless;
use crate::spline_memory;
use crate::status::ricci_status;
use crate::structs::{self, sized};
use ricci::geometry::vector::diagonal;
use ricci::seamless::sharp_edges;
use ricci::spline::{
    FewPatchesOptions, LayoutFit, LayoutFitOptions, NearestPlaces, QuadFit, fit_few_patches, fit_quad_layout,
};
use std::sync::OnceLock;

pub struct ricci_quad_spline {
    pub(crate) fit: QuadFit,
    /// The diagonal of the bounding box of the surface.
    pub(crate) diagonal: f64,
    /// The search structure for nearest places, which the first search makes.
    pub(crate) nearest: OnceLock<NearestPlaces>,
    pub(crate) figures: ricci_quad_spline_summary,
}
handle!(ricci_quad_spline, "quad_spline", |spline| spline.figures.n_control_points);

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_quad_spline_options {
    pub size: usize,
    pub tolerance: f64,
    pub bending: f64,
    pub threads: usize,
    pub most_spans: u32,
    pub reserved: u32,
}
// SAFETY: numbers; 8-byte alignment, size first.
sized!(ricci_quad_spline_options, "options", reserved);

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_quad_spline_summary {
    pub size: usize,
    pub n_patches: usize,
    pub n_arcs: usize,
    pub n_nodes: usize,
    pub degree: usize,
    pub most_spans: usize,
    pub n_control_points: usize,
    pub n_free: usize,
    pub n_entries: usize,
    pub n_folded_patches: usize,
    pub diagonal: f64,
    pub rms: f64,
    pub max: f64,
    pub vertex_rms: f64,
    pub vertex_max: f64,
    pub normal_error: f64,
    pub normal_jump: f64,
    pub noise: f64,
    pub tolerance: f64,
    pub converged: u32,
    pub reserved: u32,
    pub volume: f64,
}
// SAFETY: numbers; 8-byte alignment, size first.
sized!(ricci_quad_spline_summary, "summary", reserved);

impl ricci_quad_spline_options {
    pub(crate) fn read(&self) -> LayoutFitOptions {
        let usual = LayoutFitOptions::default();
        LayoutFitOptions {
            tolerance: (self.tolerance != 0.0).then_some(self.tolerance),
            most_spans: if self.most_spans == 0 { usual.most_spans } else { self.most_spans as usize },
            bending: (self.bending != 0.0).then_some(if self.bending < 0.0 { 0.0 } else { self.bending }),
            threads: self.threads,
        }
    }
}

/// Patches for which there is a reserve of memory where their number is not known before, and quads in each.
const RESERVED_PATCHES: usize = 60;
const QUADS_OF_PATCH: usize = 64;
/// Spans of a patch in each direction for which there is a reserve of memory.
const RESERVED_SPANS: usize = 4;

/// The poles of a patch with as many spans as most patches have at most. Few patches get more, for which there is no reserve.
fn usual_poles(options: &LayoutFitOptions) -> usize {
    (3 * options.most_spans.min(RESERVED_SPANS) + 3).pow(2)
}

impl ricci_quad_spline {
    /// The handle of a spline that was to be within a tolerance, and is if it `converged`.
    pub(crate) fn new(fit: QuadFit, diagonal: f64, tolerance: f64, converged: bool) -> ricci_quad_spline {
        let (spline, space) = (&fit.spline, fit.spline.space());
        let figures = ricci_quad_spline_summary {
            size: 0,
            n_patches: space.layout().patches().len(),
            n_arcs: space.layout().arcs().len(),
            n_nodes: space.layout().n_nodes(),
            degree: spline.degree(),
            most_spans: space.spans().iter().copied().max().unwrap_or(0),
            n_control_points: space.n_control_points(),
            n_free: space.dimension(),
            n_entries: (0..space.n_control_points()).map(|c| space.combination(c).len()).sum(),
            n_folded_patches: fit.folded_patches.len(),
            diagonal,
            rms: fit.to_target.rms,
            max: fit.to_target.max,
            vertex_rms: fit.of_vertices.rms,
            vertex_max: fit.of_vertices.max,
            normal_error: fit.normal_error,
            normal_jump: spline.normal_jump(),
            noise: fit.noise,
            tolerance,
            converged: converged.into(),
            reserved: 0,
            volume: if space.layout().is_closed() { spline.volume() } else { f64::NAN },
        };
        ricci_quad_spline { fit, diagonal, nearest: OnceLock::new(), figures }
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_quad_spline_fit_mesh(
    mesh: *const ricci_mesh,
    feature_angle: f64,
    options: *const ricci_quad_spline_options,
    control: *const ricci_control,
    spline: *mut *mut ricci_quad_spline,
) -> ricci_status {
    guard::make(spline, || {
        let (mesh, control) = (shared(mesh)?, control::of(control)?);
        let fit = structs::read(options)?.read();
        let surface = mesh.surface()?;
        let Some(positions) = surface.positions() else {
            return Err(Failure::argument("a spline near a mesh needs one with positions"));
        };
        if !(feature_angle.is_finite() && feature_angle >= 0.0) {
            return Err(Failure::argument("the angle of features is to be a finite number from 0 on"));
        }
        let features = if feature_angle > 0.0 { sharp_edges(surface, feature_angle)? } else { Vec::new() };
        let n = mesh.connectivity.n_vertices();
        let _metric = memory::work(n, memory::FLOW)?;
        let _target = memory::work(n + RESERVED_PATCHES * QUADS_OF_PATCH, spline_memory::QUAD_TARGET)?;
        let _fit = memory::work(RESERVED_PATCHES * usual_poles(&fit), spline_memory::QUAD_FIT)?;
        let options = FewPatchesOptions { cones: None, features, fit };
        let LayoutFit { layout, fit, .. } = fit_few_patches(surface, &options, &control)?;
        log::info!(
            "quad spline: {} patches, distances up to {:.1e} of the diagonal",
            layout.patches.len(),
            fit.max()
        );
        let (tolerance, converged) = (options.fit.limit(&fit), options.fit.is_met_by(&fit));
        Ok(ricci_quad_spline::new(fit, diagonal(positions), tolerance, converged))
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_quad_spline_fit(
    seamless: *const ricci_seamless,
    layout: *const ricci_quad_layout,
    options: *const ricci_quad_spline_options,
    control: *const ricci_control,
    spline: *mut *mut ricci_quad_spline,
) -> ricci_status {
    guard::make(spline, || {
        let (seamless, control) = (shared(seamless)?, control::of(control)?);
        let options = structs::read(options)?.read();
        let solution = &seamless.found.solution;
        let layout = if layout.is_null() {
            coarsest(&seamless.found, options.threads, &control.part(0.0, 0.2))?
        } else {
            shared(layout)?.of_seamless(seamless)?
        };
        let (quads, patches) = (layout.mesh.quads.len(), layout.patches.len());
        let _target = memory::work(solution.given().n_vertices() + quads, spline_memory::QUAD_TARGET)?;
        let _fit = memory::work(patches * usual_poles(&options), spline_memory::QUAD_FIT)?;
        let fit = fit_quad_layout(&seamless.found, &layout, &options, &control.part(0.2, 1.0))?;
        log::info!("quad spline: {} patches, distances up to {:.1e} of the diagonal", patches, fit.max());
        let diagonal = solution.surface().positions().map_or(0.0, |positions| diagonal(positions));
        let (tolerance, converged) = (options.limit(&fit), options.is_met_by(&fit));
        Ok(ricci_quad_spline::new(fit, diagonal, tolerance, converged))
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_quad_spline_free(spline: *mut ricci_quad_spline) {
    guard::free(spline);
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_quad_spline_summarise(
    spline: *const ricci_quad_spline,
    summary: *mut ricci_quad_spline_summary,
    size: usize,
) -> ricci_status {
    guard::with(spline, |spline| {
        structs::write(ricci_quad_spline_summary { size, ..spline.figures }, summary, size)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_quad_spline_folds(
    spline: *const ricci_quad_spline,
    patches: *mut u32,
    capacity: usize,
) -> ricci_status {
    guard::with(spline, |ricci_quad_spline { fit, .. }| {
        let folded = fit.folded_patches.iter().map(|&patch| patch as u32);
        copy_each("patches", folded.len(), folded, patches, capacity)
    })
}
