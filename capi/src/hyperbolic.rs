//! Layouts of hyperbolic metrics.

use crate::choice::choose;
use crate::control::{self, ricci_control};
use crate::guard;
use crate::layout::{cones, ricci_layout, unroll};
use crate::metric::ricci_metric;
use crate::model::ricci_model;
use crate::status::ricci_status;
use ricci::geometry::Space;
use std::mem::MaybeUninit;

/// Unroll a hyperbolic metric, of a closed surface or one with boundary, into the hyperbolic plane about its centre.
///
/// The surface is cut open along edges of the mesh, as little as its topology asks for, and through every interior vertex whose target is more
/// than 1e-10 off 0; the metric should have curvature -1 at all others, and `consistency` says how far its corners are apart, as a distance.
/// Of a metric whose edges were flipped the common refinement is unrolled. A closed surface with its deck group: ricci_quotient_from_metric.
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_WRONG_SIZE, RICCI_ARGUMENT (RICCI_MODEL_HYPERBOLOID), RICCI_TRIANGLE_INEQUALITY,
/// RICCI_LAYOUT (not H2; points beyond the reach of doubles), RICCI_DOMAIN, RICCI_EDGE_WEIGHT, RICCI_TOO_LARGE (the refinement),
/// RICCI_CANCELLED.
///
/// @param metric      the metric, in H2.
/// @param target      the n_vertices curvatures it was made for.
/// @param n_vertices  number of vertices of the mesh that the metric was made from.
/// @param model       coordinates of the points; in the Klein disk the map is projective on every piece.
/// @param control     progress and cancellation; NULL for neither.
/// @param layout      out: the new handle, to be released by ricci_layout_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_layout_hyperbolic(
    metric: *const ricci_metric,
    target: *const f64,
    n_vertices: usize,
    model: MaybeUninit<ricci_model>,
    control: *const ricci_control,
    layout: *mut *mut ricci_layout,
) -> ricci_status {
    guard::make("layout", layout, |door| {
        let metric = door.shared(metric)?;
        let cones = cones(metric.given(), target, n_vertices)?;
        unroll(metric, cones, Space::H2, choose(model)?, &control::of(control))
    })
}
