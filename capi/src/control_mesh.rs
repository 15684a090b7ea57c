//! Splines over control meshes of Catmull–Clark surfaces.

use crate::arrays;
use crate::control::{self, ricci_control};
use crate::failure::{Failure, FailureElement, Outcome};
use crate::guard;
use crate::memory;
use crate::quad_spline::{ricci_quad_spline, ricci_quad_spline_options};
use crate::spline_memory;
use crate::status::ricci_status;
use crate::structs::{self, sized};
use ricci::geometry::vector::diagonal;
use ricci::spline::{ControlMesh, fit_control_mesh};

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_control_mesh {
    pub size: usize,
    pub positions: *const f64,
    pub n_vertices: usize,
    pub quads: *const u32,
    pub n_quads: usize,
}
// SAFETY: numbers and raw pointers; 8-byte alignment, size first.
sized!(ricci_control_mesh, "control_mesh");

/// Quads of the surface that is fitted: for each of few, for each of many, and the number between.
const QUADS_OF_QUAD: usize = 256;
const LEAST_QUADS_OF_QUAD: usize = 16;
const QUADS: usize = 30_000;
/// Poles for each quad, about.
const POLES_OF_QUAD: usize = 16;

impl ricci_control_mesh {
    fn read(&self) -> Outcome<ControlMesh> {
        let positions = arrays::points(self.positions, 0, self.n_vertices)?;
        let quads: Vec<[u32; 4]> = arrays::array("quads", self.quads.cast(), self.n_quads)?;
        for (q, quad) in quads.iter().enumerate() {
            // An index of 2^31 or more is a negative one of a caller's `int32_t`.
            if let Some(k) = quad.iter().position(|&v| (v as i32) < 0) {
                let v = quad[k] as i32;
                let message = format!("quad {q}, corner {k}: vertex {v} is negative; indices are 0-based");
                return Err(Failure::argument(message).at(FailureElement::Face, q));
            }
        }
        let _reserve = memory::work(self.n_vertices + self.n_quads, memory::MESH)?;
        Ok(ControlMesh::new(positions, quads.iter().map(|quad| quad.to_vec()).collect())?)
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_quad_spline_fit_quads(
    control_mesh: *const ricci_control_mesh,
    options: *const ricci_quad_spline_options,
    control: *const ricci_control,
    spline: *mut *mut ricci_quad_spline,
) -> ricci_status {
    guard::make(spline, || {
        if control_mesh.is_null() {
            return Err(Failure::null("control_mesh"));
        }
        let given = structs::read(control_mesh)?;
        let (mesh, control) = (given.read()?, control::of(control)?);
        let options = structs::read(options)?.read();
        let n = mesh.faces().len();
        let fitted = (QUADS_OF_QUAD * n).min(QUADS).max(LEAST_QUADS_OF_QUAD * n);
        let _target = memory::work(fitted, spline_memory::QUAD_TARGET)?;
        let _fit = memory::work(POLES_OF_QUAD * n, spline_memory::QUAD_FIT)?;
        let found = fit_control_mesh(&mesh, &options, &control)?;
        let fit = found.fit;
        log::info!(
            "quad spline: {} patches, distances up to {:.1e} of the diagonal",
            fit.patch_max.len(),
            fit.max()
        );
        let (tolerance, converged) = (options.limit(&fit), options.is_met_by(&fit));
        let size = found.surface.positions().map_or(0.0, |positions| diagonal(positions));
        Ok(ricci_quad_spline::new(fit, size, tolerance, converged))
    })
}
