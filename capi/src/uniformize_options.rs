//! How a closed surface is uniformized.

use crate::arrays;
use crate::choice::{choose, name};
use crate::failure::Outcome;
use crate::flow::ricci_flips;
use crate::guard;
use crate::homotopy::vertex_or_none;
use crate::scheme::ricci_scheme;
use crate::sized::{self, sized};
use crate::status::ricci_status;
use ricci::canonical::QuotientOptions;
use ricci::flow::Options;
use ricci::mesh::EdgeId;
use std::mem::MaybeUninit;

/// How a surface is uniformized. Let ricci_uniformize_options_init fill it, then change fields.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct ricci_uniformize_options {
    /// Bytes of this struct that are filled.
    pub size: usize,
    /// How lengths depend on u; default RICCI_SCHEME_YAMABE.
    pub scheme: MaybeUninit<ricci_scheme>,
    /// Whether edges may be flipped; default RICCI_FLIPS_AUTO.
    pub flips: MaybeUninit<ricci_flips>,
    /// The vertex at a quotient's origin, where the loops of its homotopy basis meet; default -1: one from which no vertex is far.
    /// Of a sphere the vertex that is sent to infinity; default -1: one from which sizes differ least.
    pub base: i64,
    /// Largest |K| of a converged metric, radians, positive; default 1e-10. It is then lowered as far as twice the digits of a double
    /// allow (`angle_defect`).
    pub tolerance: f64,
    /// Steps before giving up; default 0: 500.
    pub max_iterations: usize,
    /// Threads, in a pool of the call's own; default 0: one per core. The result does not depend on it.
    pub threads: usize,
    /// Largest change of any u in one step, positive; default 3.
    pub max_step: f64,
    /// Edges that are not flipped: rows of ricci_mesh_edges; default NULL.
    pub fixed_edges: *const u32,
    /// Entries of `fixed_edges`; default 0.
    pub n_fixed_edges: usize,
}

// SAFETY: numbers, a raw pointer and `MaybeUninit` enums: any bytes are valid; 8-byte alignment, size first.
sized!(ricci_uniformize_options, "options");

fn defaults() -> Outcome<ricci_uniformize_options> {
    let QuotientOptions { scheme, flow, .. } = QuotientOptions::default();
    Ok(ricci_uniformize_options {
        size: size_of::<ricci_uniformize_options>(),
        scheme: MaybeUninit::new(name(scheme)?),
        flips: MaybeUninit::new(name(flow.flips)?),
        base: -1,
        tolerance: flow.tolerance,
        max_iterations: flow.max_iterations,
        threads: flow.threads,
        max_step: flow.max_step,
        fixed_edges: std::ptr::null(),
        n_fixed_edges: 0,
    })
}

/// The library's options; NULL gives the defaults.
pub(crate) fn read_options(options: *const ricci_uniformize_options) -> Outcome<QuotientOptions> {
    let options = sized::read(defaults()?, options)?;
    let fixed = arrays::array("fixed_edges", options.fixed_edges, options.n_fixed_edges)?;
    Ok(QuotientOptions {
        scheme: choose(options.scheme)?,
        base: vertex_or_none("base", options.base)?,
        flow: Options {
            fixed_edges: fixed.into_iter().map(EdgeId).collect(),
            flips: choose(options.flips)?,
            tolerance: options.tolerance,
            max_iterations: options.max_iterations,
            threads: options.threads,
            max_step: options.max_step,
            ..Options::default()
        },
    })
}

/// Fill options with their defaults.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE.
///
/// @param options  out: the defaults.
/// @param size     sizeof *options.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_uniformize_options_init(
    options: *mut ricci_uniformize_options,
    size: usize,
) -> ricci_status {
    guard::call(|_| sized::write(defaults()?, options, size))
}
