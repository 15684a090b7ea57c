//! Metrics: a point (ε, η, u) of a conformal class on a mesh, with what it says about lengths and curvature.

use crate::arrays::{self, copy_out};
use crate::choice::{choose, name};
use crate::failure::Outcome;
use crate::guard::{self, Poison, handle};
use crate::mesh::ricci_mesh;
use crate::scheme::ricci_scheme;
use crate::sized::{self, sized};
use crate::space::ricci_space;
use crate::status::ricci_status;
use ricci::flow::Solution;
use ricci::mesh::{Mesh, PerEdge, Point};
use ricci::{Class, Surface};
use std::mem::MaybeUninit;
use std::sync::Arc;

/// A metric of a surface in a conformal class: types, weights and one variable u per vertex. It never
/// changes; the flow makes a new one.
///
/// Arrays per vertex are those of the vertices of the mesh that the metric was made from, in its numbers. A
/// flow that flips edges leads to another triangulation, on which edges and faces have numbers of their own
/// (ricci_metric_mesh), and of a surface with boundary to one of its double; ricci_layout_new leads back.
pub struct ricci_metric {
    poison: Poison,
    pub(crate) surface: Solution,
    /// Of the edges of its triangulation.
    pub(crate) lengths: Arc<PerEdge<f64>>,
    /// Of the given vertices.
    pub(crate) positions: Option<Arc<Vec<Point>>>,
}

handle!(ricci_metric, "metric");

impl ricci_metric {
    fn start(surface: Surface, class: Class) -> Outcome<ricci_metric> {
        let metric = Solution::initial_of(surface, class)?;
        let initial = metric.initial();
        if initial.clamped_edges > 0 {
            log::info!(
                "metric: {} keeps {} edge weights at a bound, lengths change by up to {:.2} %",
                class.scheme,
                initial.clamped_edges,
                100.0 * initial.max_length_change
            );
        }
        ricci_metric::at(metric)
    }

    /// A metric of a surface.
    pub(crate) fn at(surface: Solution) -> Outcome<ricci_metric> {
        let lengths = Arc::new(surface.metric().lengths(surface.mesh())?);
        let positions = surface.surface().positions().cloned();
        Ok(ricci_metric { poison: Poison::default(), surface, lengths, positions })
    }

    /// The given triangulation.
    pub(crate) fn given(&self) -> &Mesh {
        self.surface.given()
    }

    /// The first entries, those of the given vertices.
    fn given_part<'a, T>(&self, values: &'a [T]) -> &'a [T] {
        &values[..self.given().n_vertices()]
    }
}

/// Figures of a metric.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_metric_summary {
    /// Bytes of this struct that are filled.
    pub size: usize,
    /// The geometry of its triangles.
    pub space: ricci_space,
    /// The geometry in which the input lengths were read.
    pub input_geometry: ricci_space,
    /// Its scheme.
    pub scheme: ricci_scheme,
    /// 1 if its triangulation is one of the double of the surface: two copies glued along the boundary.
    pub doubled: i32,
    /// V of the mesh it was made from, the entries of per-vertex arrays.
    pub n_vertices: usize,
    /// E of its triangulation, the entries of per-edge arrays.
    pub n_edges: usize,
    /// F of its triangulation.
    pub n_faces: usize,
    /// Area of the surface, in units of the input length squared (E2) or of 1/|curvature|.
    pub area: f64,
    /// |sum of curvatures + lambda area - 2 pi chi| of its triangulation, lambda the curvature of the space:
    /// rounding only.
    pub gauss_bonnet: f64,
    /// Number of triangles whose lengths break the triangle inequality.
    pub broken_triangles: usize,
    /// Edges whose initial weight the scheme had to change (Thurston).
    pub clamped_edges: usize,
    /// Largest relative change of an edge length by going over to the scheme.
    pub max_length_change: f64,
    /// V of its triangulation: those of the mesh, and of a double the mirror images of interior vertices
    /// behind them.
    pub n_mesh_vertices: usize,
    /// Edge flips from the mesh it was made from to its triangulation.
    pub n_flips: usize,
    /// Those of them that come before the flow and change no distance on the surface.
    pub n_start_flips: usize,
}

// SAFETY: only ever written by the library; 8-byte alignment, size first.
sized!(ricci_metric_summary, "summary");

/// The initial metric of a mesh in the conformal class of its lengths.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT, RICCI_EDGE_LENGTH, RICCI_TRIANGLE_INEQUALITY,
/// RICCI_EDGE_WEIGHT, RICCI_DOMAIN.
///
/// @param mesh    the mesh; lengths are measured in space, or those of an intrinsic mesh.
/// @param scheme  how lengths depend on u.
/// @param space   the geometry in which the metric will live.
/// @param metric  out: the new handle, to be released by ricci_metric_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_metric_new(
    mesh: *const ricci_mesh,
    scheme: MaybeUninit<ricci_scheme>,
    space: MaybeUninit<ricci_space>,
    metric: *mut *mut ricci_metric,
) -> ricci_status {
    guard::make("metric", metric, |door| {
        let class = Class::new(choose(scheme)?, choose(space)?);
        ricci_metric::start(door.shared(mesh)?.surface()?, class)
    })
}

/// ricci_metric_new with lengths of the caller's in place of the mesh's own.
///
/// @return as ricci_metric_new; RICCI_WRONG_SIZE.
///
/// @param mesh      the mesh.
/// @param lengths   n_edges lengths, finite and positive, in the order of ricci_mesh_edges.
/// @param n_edges   number of edges of the mesh.
/// @param geometry  the geometry in which the lengths are meant.
/// @param scheme    how lengths depend on u.
/// @param space     the geometry in which the metric will live.
/// @param metric    out: the new handle, to be released by ricci_metric_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_metric_from_lengths(
    mesh: *const ricci_mesh,
    lengths: *const f64,
    n_edges: usize,
    geometry: MaybeUninit<ricci_space>,
    scheme: MaybeUninit<ricci_scheme>,
    space: MaybeUninit<ricci_space>,
    metric: *mut *mut ricci_metric,
) -> ricci_status {
    guard::make("metric", metric, |door| {
        let mesh = door.shared(mesh)?;
        let lengths = arrays::array_of("lengths", lengths, n_edges, mesh.connectivity.n_edges())?;
        let class = Class::new(choose(scheme)?, choose(space)?);
        ricci_metric::start(mesh.surface_with(lengths, choose(geometry)?)?, class)
    })
}

/// Release a metric.
///
/// @param metric  the handle, or NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_metric_free(metric: *mut ricci_metric) {
    guard::free(metric);
}

/// Kind, counts, area and Gauss-Bonnet residual of a metric.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE.
///
/// @param metric   the metric.
/// @param summary  out: the figures.
/// @param size     sizeof *summary.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_metric_summarise(
    metric: *const ricci_metric,
    summary: *mut ricci_metric_summary,
    size: usize,
) -> ricci_status {
    guard::call(|door| {
        let surface = &door.shared(metric)?.surface;
        let (curvature, initial, mesh) = (surface.curvature()?, surface.initial(), surface.mesh());
        let figures = ricci_metric_summary {
            size,
            space: name(surface.metric().space)?,
            input_geometry: name(initial.input_geometry)?,
            scheme: name(surface.scheme()?)?,
            doubled: surface.double().is_some().into(),
            n_vertices: surface.given().n_vertices(),
            n_edges: mesh.n_edges(),
            n_faces: mesh.n_faces(),
            area: curvature.area,
            gauss_bonnet: curvature.gauss_bonnet,
            broken_triangles: curvature.broken.len(),
            clamped_edges: initial.clamped_edges,
            max_length_change: initial.max_length_change,
            n_mesh_vertices: mesh.n_vertices(),
            n_flips: surface.flips(),
            n_start_flips: surface.start_flips(),
        };
        sized::write(figures, summary, size)
    })
}

/// The curvature of every vertex: 2 pi minus its angles inside, pi minus its angles on the boundary.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
///
/// @param metric     the metric.
/// @param curvature  out: n_vertices curvatures, radians.
/// @param capacity   entries of `curvature`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_metric_curvature(
    metric: *const ricci_metric,
    curvature: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(metric, |metric| copy_out("curvature", &metric.surface.curvature()?.at, curvature, capacity))
}

/// The variable u of every vertex.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
///
/// @param metric    the metric.
/// @param u         out: n_vertices values.
/// @param capacity  entries of `u`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_metric_u(
    metric: *const ricci_metric,
    u: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(metric, |metric| copy_out("u", metric.given_part(&metric.surface.metric().u), u, capacity))
}

/// The type epsilon of every vertex: 1 circle, 0 vertex scaling, -1 imaginary circle.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
///
/// @param metric    the metric.
/// @param epsilon   out: n_vertices types.
/// @param capacity  entries of `epsilon`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_metric_epsilon(
    metric: *const ricci_metric,
    epsilon: *mut i8,
    capacity: usize,
) -> ricci_status {
    guard::with(metric, |metric| {
        copy_out("epsilon", metric.given_part(&metric.surface.metric().epsilon), epsilon, capacity)
    })
}

/// The conformal factor of every vertex against the initial metric: the change of u (vertex scaling), or the
/// logarithm of the change of radius (circle packings).
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
///
/// @param metric    the metric.
/// @param factor    out: n_vertices logarithms.
/// @param capacity  entries of `factor`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_metric_conformal_factor(
    metric: *const ricci_metric,
    factor: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::call(|door| {
        let values = door.shared(metric)?.surface.conformal_factor()?;
        copy_out("factor", &values, factor, capacity)
    })
}
