//! Metrics: a point (ε, η, u) of a conformal class on a mesh, with what it says about lengths and curvature.

use crate::arrays::{self, copy_out};
use crate::choice::{choose, name};
use crate::failure::Outcome;
use crate::guard::{self, Handle, Poison, output};
use crate::mesh::{Shape, ricci_mesh};
use crate::scheme::ricci_scheme;
use crate::sized::{self, Sized64};
use crate::space::ricci_space;
use crate::status::ricci_status;
use ricci::geometry::space::Space;
use ricci::mesh::{Mesh, PerEdge, Point};
use ricci::metric::Metric;
use ricci::metric::curvature::Curvature;
use ricci::metric::initial::{Initial, initial_metric};
use ricci::metric::scheme::Scheme;
use std::mem::MaybeUninit;
use std::sync::Arc;

/// A metric on a mesh in a conformal class: types, weights and one variable u per vertex. It never changes;
/// the flow makes a new one.
pub struct ricci_metric {
    poison: Poison,
    /// The triangulation the metric lives on.
    pub(crate) mesh: Arc<Mesh>,
    pub(crate) metric: Metric,
    lengths: Arc<PerEdge<f64>>,
    pub(crate) origin: Arc<Origin>,
}

/// What a metric and all that flow from it start from.
pub(crate) struct Origin {
    pub(crate) positions: Option<Arc<Vec<Point>>>,
    pub(crate) mesh: Arc<Mesh>,
    pub(crate) lengths: Arc<PerEdge<f64>>,
    pub(crate) scheme: Scheme,
    pub(crate) initial: Initial,
}

impl Handle for ricci_metric {
    const NAME: &'static str = "metric";
    fn poison(&self) -> &Poison {
        &self.poison
    }
}

impl ricci_metric {
    fn start(
        mesh: &ricci_mesh,
        lengths: Arc<PerEdge<f64>>,
        geometry: Space,
        scheme: Scheme,
        space: Space,
    ) -> Outcome<ricci_metric> {
        let connectivity = mesh.connectivity.clone();
        let initial = initial_metric(&connectivity, &lengths, geometry, scheme, space)?;
        if initial.clamped_edges > 0 {
            log::info!(
                "metric: {scheme} keeps {} edge weights at a bound, lengths change by up to {:.2} %",
                initial.clamped_edges,
                100.0 * initial.max_length_change
            );
        }
        let metric = initial.metric.clone();
        let positions = match &mesh.shape {
            Shape::Positions(positions) => Some(positions.clone()),
            Shape::Lengths(..) => None,
        };
        let origin = Origin { positions, mesh: connectivity.clone(), lengths, scheme, initial };
        ricci_metric::at(connectivity, metric, Arc::new(origin))
    }

    /// A metric that another one has become, on a triangulation of its own.
    pub(crate) fn at(mesh: Arc<Mesh>, metric: Metric, origin: Arc<Origin>) -> Outcome<ricci_metric> {
        let lengths = Arc::new(metric.lengths(&mesh)?);
        Ok(ricci_metric { poison: Poison::default(), mesh, metric, lengths, origin })
    }

    pub(crate) fn lengths(&self) -> &PerEdge<f64> {
        &self.lengths
    }

    fn curvature(&self) -> Outcome<Curvature> {
        Ok(self.metric.curvature(&self.mesh)?)
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
    /// 0.
    pub reserved: i32,
    /// V, the entries of per-vertex arrays.
    pub n_vertices: usize,
    /// E, the entries of per-edge arrays.
    pub n_edges: usize,
    /// F.
    pub n_faces: usize,
    /// Sum of the triangles' areas, in units of the input length squared (E2) or of 1/|curvature|.
    pub area: f64,
    /// |sum of curvatures + lambda area - 2 pi chi|, lambda the curvature of the space: rounding only.
    pub gauss_bonnet: f64,
    /// Number of triangles whose lengths break the triangle inequality.
    pub broken_triangles: usize,
    /// Edges whose initial weight the scheme had to change (Thurston).
    pub clamped_edges: usize,
    /// Largest relative change of an edge length by going over to the scheme.
    pub max_length_change: f64,
}

// SAFETY: only ever written by the library; 8-byte alignment, size first.
unsafe impl Sized64 for ricci_metric_summary {
    const NAME: &'static str = "summary";
    fn with_size(self, size: usize) -> Self {
        Self { size, ..self }
    }
}

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
    guard::call(|door| {
        let metric = output("metric", metric)?;
        let (mesh, scheme, space) = (door.shared(mesh)?, choose(scheme)?, choose(space)?);
        let (lengths, geometry) = mesh.lengths()?;
        metric.hand_over(ricci_metric::start(mesh, lengths, geometry, scheme, space)?);
        Ok(())
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
    guard::call(|door| {
        let metric = output("metric", metric)?;
        let mesh = door.shared(mesh)?;
        let lengths = arrays::array_of("lengths", lengths, n_edges, mesh.connectivity.n_edges())?;
        let (geometry, scheme, space) = (choose(geometry)?, choose(scheme)?, choose(space)?);
        let lengths = Arc::new(lengths.into());
        metric.hand_over(ricci_metric::start(mesh, lengths, geometry, scheme, space)?);
        Ok(())
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
        let metric = door.shared(metric)?;
        let (curvature, initial) = (metric.curvature()?, &metric.origin.initial);
        let figures = ricci_metric_summary {
            size,
            space: name(metric.metric.space)?,
            input_geometry: name(initial.input_geometry)?,
            scheme: name(metric.origin.scheme)?,
            reserved: 0,
            n_vertices: metric.mesh.n_vertices(),
            n_edges: metric.mesh.n_edges(),
            n_faces: metric.mesh.n_faces(),
            area: curvature.area,
            gauss_bonnet: curvature.gauss_bonnet,
            broken_triangles: curvature.broken.len(),
            clamped_edges: initial.clamped_edges,
            max_length_change: initial.max_length_change,
        };
        sized::write(figures, summary, size)
    })
}

/// The triangulation of a metric as an intrinsic mesh with the metric's lengths.
///
/// @return RICCI_OK, RICCI_NULL_POINTER.
///
/// @param metric  the metric.
/// @param mesh    out: the new handle, to be released by ricci_mesh_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_metric_mesh(
    metric: *const ricci_metric,
    mesh: *mut *mut ricci_mesh,
) -> ricci_status {
    guard::call(|door| {
        let mesh = output("mesh", mesh)?;
        let metric = door.shared(metric)?;
        let shape = Shape::Lengths(metric.lengths.clone(), metric.metric.space);
        mesh.hand_over(ricci_mesh::new(metric.mesh.clone(), shape));
        Ok(())
    })
}

/// The length of every edge.
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
    guard::call(|door| copy_out("lengths", &door.shared(metric)?.lengths, lengths, capacity))
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
    guard::call(|door| copy_out("curvature", &door.shared(metric)?.curvature()?.at, curvature, capacity))
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
    guard::call(|door| copy_out("u", &door.shared(metric)?.metric.u, u, capacity))
}

/// The weight eta of every edge.
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
    guard::call(|door| copy_out("eta", &door.shared(metric)?.metric.eta, eta, capacity))
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
    guard::call(|door| copy_out("epsilon", &door.shared(metric)?.metric.epsilon, epsilon, capacity))
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
        let metric = door.shared(metric)?;
        let values = metric.origin.initial.conformal_factor(&metric.metric)?;
        copy_out("factor", &values, factor, capacity)
    })
}
