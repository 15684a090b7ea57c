//! Targets: the prescribed curvature of every vertex, a plain array of the caller's.

use crate::arrays::{self, copy_out};
use crate::control::{self, ricci_control};
use crate::failure::{Failure, Outcome};
use crate::guard;
use crate::metric::ricci_metric;
use crate::status::ricci_status;
use ricci::Class;
use ricci::flow::auto_cones;
use ricci::geometry::space::Space;
use ricci::mesh::{PerVertex, VertexId};
use ricci::metric::target::Target;

impl ricci_metric {
    fn vertex(&self, v: u32) -> Outcome<VertexId> {
        let n = self.given().n_vertices();
        if (v as usize) < n {
            Ok(VertexId(v))
        } else {
            Err(Failure::argument(format!("vertex {v} does not exist: there are {n}")))
        }
    }

    pub(crate) fn vertices(&self, what: &str, data: *const u32, n: usize) -> Outcome<Vec<VertexId>> {
        arrays::array(what, data, n)?.into_iter().map(|v| self.vertex(v)).collect()
    }

    fn resolve(&self, target: &Target) -> Outcome<PerVertex<f64>> {
        let surface = &self.surface;
        let class = Class::new(surface.scheme()?, surface.metric().space);
        Ok(target.resolve(surface.surface(), class)?)
    }

    /// An admissible target from a caller's array.
    pub(crate) fn target(&self, target: *const f64, n: usize) -> Outcome<PerVertex<f64>> {
        let values = arrays::array_of("target", target, n, self.given().n_vertices())?;
        self.resolve(&Target::All(values.into()))
    }
}

/// The target that suits most: closed of genus >= 1: uniform; open: all curvature on the boundary; sphere:
/// four cones of pi.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_TARGET_KIND.
///
/// @param metric    the metric that will flow.
/// @param target    out: n_vertices curvatures, radians.
/// @param capacity  entries of `target`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_target_default(
    metric: *const ricci_metric,
    target: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(metric, |metric| {
        let surface = &metric.surface;
        let choice = Target::default_for(surface.surface(), surface.metric().space)?;
        copy_out("target", &metric.resolve(&choice)?, target, capacity)
    })
}

/// The same curvature everywhere: 2 pi chi / V on a closed surface in E2, 0 in H2 and S2.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_TARGET_KIND (open surface in E2),
/// RICCI_TARGET_TOTAL.
///
/// @param metric    the metric that will flow.
/// @param target    out: n_vertices curvatures, radians.
/// @param capacity  entries of `target`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_target_uniform(
    metric: *const ricci_metric,
    target: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(metric, |metric| copy_out("target", &metric.resolve(&Target::Uniform)?, target, capacity))
}

/// 0 inside, 2 pi chi shared over the boundary in proportion to adjacent boundary length. E2 only.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_TARGET_KIND (closed surface, or not
/// E2).
///
/// @param metric    the metric that will flow.
/// @param target    out: n_vertices curvatures, radians.
/// @param capacity  entries of `target`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_target_boundary(
    metric: *const ricci_metric,
    target: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(metric, |metric| copy_out("target", &metric.resolve(&Target::Boundary)?, target, capacity))
}

/// All curvature, 2 pi chi, at one vertex. E2 only.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT (no such vertex),
/// RICCI_TARGET_KIND, RICCI_TARGET_AT_VERTEX.
///
/// @param metric    the metric that will flow.
/// @param vertex    the vertex.
/// @param target    out: n_vertices curvatures, radians.
/// @param capacity  entries of `target`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_target_single(
    metric: *const ricci_metric,
    vertex: u32,
    target: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(metric, |metric| {
        let choice = Target::Single(metric.vertex(vertex)?);
        copy_out("target", &metric.resolve(&choice)?, target, capacity)
    })
}

/// Given curvatures at given vertices, 0 at every other one.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT (no such vertex),
/// RICCI_TARGET_AT_VERTEX, RICCI_TARGET_BELOW, RICCI_TARGET_TOTAL.
///
/// @param metric      the metric that will flow.
/// @param vertices    n_cones vertices.
/// @param curvatures  n_cones curvatures, radians, below 2 pi (pi on the boundary).
/// @param n_cones     number of cones.
/// @param target      out: n_vertices curvatures, radians.
/// @param capacity    entries of `target`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_target_cones(
    metric: *const ricci_metric,
    vertices: *const u32,
    curvatures: *const f64,
    n_cones: usize,
    target: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(metric, |metric| {
        let vertices = metric.vertices("vertices", vertices, n_cones)?;
        let curvatures = arrays::array("curvatures", curvatures, n_cones)?;
        let choice = Target::Cones(vertices.into_iter().zip(curvatures).collect());
        copy_out("target", &metric.resolve(&choice)?, target, capacity)
    })
}

/// Cones placed by the library: n_cones interior vertices, and their curvatures, such that a conformal map that is flat elsewhere
/// changes areas as little as it finds. On an open surface the boundary keeps its conformal factor, and has the curvature
/// that follows. E2 only.
///
/// Deterministic; one factorisation and about 6 n_cones solutions.
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_TARGET_KIND (not E2, or a number of cones
/// that the surface cannot have: closed of genus 0 needs 3, genus 1 none or 2, genus 2 or more 1), RICCI_FACTORISATION,
/// RICCI_CANCELLED.
///
/// @param metric    the metric that will flow, made from Euclidean lengths.
/// @param n_cones   number of cones, at most 256.
/// @param control   progress and cancellation; NULL for neither.
/// @param target    out: n_vertices curvatures, radians; the cones are the interior vertices where it is not 0.
/// @param capacity  entries of `target`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_target_auto(
    metric: *const ricci_metric,
    n_cones: usize,
    control: *const ricci_control,
    target: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::call(|door| {
        let surface = &door.shared(metric)?.surface;
        let spaces = [surface.metric().space, surface.initial().input_geometry];
        if spaces != [Space::E2; 2] {
            let message = "cones are placed in e2, by Euclidean lengths".to_string();
            return Err(Failure::new(ricci_status::RICCI_TARGET_KIND, message));
        }
        let placed =
            auto_cones(surface.given(), surface.surface().lengths(), n_cones, &control::of(control))?;
        copy_out("target", &placed.target, target, capacity)
    })
}

/// Whether a target is admissible: each curvature below 2 pi (pi on the boundary) and the total that
/// Gauss-Bonnet asks for. The flow asks the same.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_WRONG_SIZE, RICCI_ARGUMENT, RICCI_TARGET_AT_VERTEX,
/// RICCI_TARGET_BELOW, RICCI_TARGET_TOTAL; the message says where and by how much.
///
/// @param metric      the metric that will flow.
/// @param target      n_vertices curvatures, radians.
/// @param n_vertices  number of vertices.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_target_check(
    metric: *const ricci_metric,
    target: *const f64,
    n_vertices: usize,
) -> ricci_status {
    guard::call(|door| {
        door.shared(metric)?.target(target, n_vertices)?;
        Ok(())
    })
}
