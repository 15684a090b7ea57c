//! The triangulation that a metric lives on.

use crate::arrays::copy_out;
use crate::guard;
use crate::mesh::{Shape, ricci_mesh};
use crate::metric::ricci_metric;
use crate::status::ricci_status;

/// The triangulation of a metric as an intrinsic mesh with the metric's lengths.
///
/// It is that of the mesh that the metric was made from until a flow flips edges. Two vertices may then share
/// several edges, and an edge may be a loop. The triangulation of a double (`doubled` of the summary) is
/// closed; its first vertices are the given ones, and its edges may run from one copy of the surface to the
/// other.
/// @return RICCI_OK, RICCI_NULL_POINTER.
///
/// @param metric  the metric.
/// @param mesh    out: the new handle, to be released by ricci_mesh_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_metric_mesh(
    metric: *const ricci_metric,
    mesh: *mut *mut ricci_mesh,
) -> ricci_status {
    guard::make("mesh", mesh, |door| {
        let ricci_metric { surface, lengths, .. } = door.shared(metric)?;
        let shape = Shape::Lengths(lengths.clone(), surface.metric().space);
        Ok(ricci_mesh::new(surface.mesh().clone(), shape))
    })
}

/// The mirror image of every vertex of the triangulation: itself, but inside a surface that was doubled.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
///
/// @param metric    the metric.
/// @param mirror    out: n_mesh_vertices vertex indices.
/// @param capacity  entries of `mirror`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_metric_mesh_mirror(
    metric: *const ricci_metric,
    mirror: *mut u32,
    capacity: usize,
) -> ricci_status {
    guard::call(|door| {
        let surface = &door.shared(metric)?.surface;
        let vertices = surface.mesh().vertices();
        let images: Vec<u32> = match surface.double() {
            Some(double) => vertices.map(|v| double.mirror(v).0).collect(),
            None => vertices.map(|v| v.0).collect(),
        };
        copy_out("mirror", &images, mirror, capacity)
    })
}

/// The variable u of every vertex of the triangulation: what ricci_metric_u gives, then that of the mirror
/// images, which is the same but for rounding.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
///
/// @param metric    the metric.
/// @param u         out: n_mesh_vertices values.
/// @param capacity  entries of `u`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_metric_mesh_u(
    metric: *const ricci_metric,
    u: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(metric, |metric| copy_out("u", &metric.surface.metric().u, u, capacity))
}

/// The length of every edge of the triangulation.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
///
/// @param metric    the metric.
/// @param lengths   out: n_edges lengths.
/// @param capacity  entries of `lengths`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_metric_lengths(
    metric: *const ricci_metric,
    lengths: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(metric, |metric| copy_out("lengths", &metric.lengths, lengths, capacity))
}

/// The weight eta of every edge of the triangulation.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
///
/// @param metric    the metric.
/// @param eta       out: n_edges weights.
/// @param capacity  entries of `eta`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_metric_eta(
    metric: *const ricci_metric,
    eta: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(metric, |metric| copy_out("eta", &metric.surface.metric().rounded_eta(), eta, capacity))
}
