//! Metrics: a point (ε, η, u) of a conformal class on a mesh, with its lengths and curvature, and the report of the flow that led there.

use crate::arrays::{copy_each, copy_out};
use crate::choice::choices;
use crate::failure::{Failure, Outcome};
use crate::guard::{self, handle, shared};
use crate::memory;
use crate::mesh::{SPACES, ricci_mesh};
use crate::status::ricci_status;
use crate::structs::{self, sized};
use ricci::flow::{Report, Solution};
use ricci::mesh::PerEdge;
use ricci::metric::CommonSubdivision;
use ricci::metric::curvature::Curvature;
use ricci::metric::scheme::Scheme;
use ricci::{Class, Control};
use std::sync::{Arc, OnceLock};

choices!(pub(crate) SCHEMES: Scheme = "scheme", [
    RICCI_SCHEME_YAMABE => Scheme::Yamabe,
    RICCI_SCHEME_INVERSIVE => Scheme::Inversive,
    RICCI_SCHEME_THURSTON => Scheme::Thurston,
    RICCI_SCHEME_TANGENTIAL => Scheme::Tangential,
    RICCI_SCHEME_VIRTUAL => Scheme::Virtual,
]);

/// The triangulation that a question is about.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Triangulation {
    /// The caller's mesh.
    Input,
    /// The metric's own triangulation.
    Metric,
    /// The common subdivision of both.
    Subdivision,
}

choices!(pub(crate) ON: Triangulation = "on", [
    RICCI_ON_INPUT => Triangulation::Input,
    RICCI_ON_METRIC => Triangulation::Metric,
    RICCI_ON_REFINEMENT => Triangulation::Subdivision,
]);

// A kind of numbers that a metric has.
choices!(enum MetricQuantity, QUANTITIES = "which", [
    RICCI_METRIC_FACTOR => Factor,
    RICCI_METRIC_CURVATURE => Curvature,
    RICCI_METRIC_U => U,
    RICCI_METRIC_TYPE => Type,
    RICCI_METRIC_LENGTH => Lengths,
    RICCI_METRIC_ETA => Eta,
    RICCI_METRIC_MESH_U => MeshU,
]);

/// A metric of a surface, which the handles that are made from it share, with values that are computed once, when they are first needed.
pub(crate) struct MetricState {
    pub solution: Solution,
    /// The report of the flow that led to the metric; none of an initial metric.
    pub report: Option<Report>,
    /// The lengths of the edges of the metric's triangulation.
    pub lengths: Arc<PerEdge<f64>>,
    curvature: OnceLock<Curvature>,
    subdivision: OnceLock<Arc<CommonSubdivision>>,
}

pub struct ricci_metric(pub(crate) Arc<MetricState>);
handle!(ricci_metric, "metric", |metric| metric.0.solution.mesh().n_vertices());

/// The value of a cell, which is computed at the first question.
fn computed_once<T>(cell: &OnceLock<T>, make: impl FnOnce() -> ricci::Result<T>) -> Outcome<&T> {
    match cell.get() {
        Some(value) => Ok(value),
        None => {
            let value = make()?;
            Ok(cell.get_or_init(|| value))
        }
    }
}

impl MetricState {
    fn curvature(&self) -> Outcome<&Curvature> {
        computed_once(&self.curvature, || self.solution.curvature())
    }

    /// The common subdivision of the given mesh and the metric's triangulation.
    pub fn subdivision(&self, control: &Control) -> Outcome<&Arc<CommonSubdivision>> {
        computed_once(&self.subdivision, || Ok(Arc::new(self.solution.common_subdivision(control)?)))
    }

    /// The same; none where both triangulations are one.
    pub fn subdivision_if_flipped(&self, control: &Control) -> Outcome<Option<&Arc<CommonSubdivision>>> {
        if self.solution.is_unflipped() { Ok(None) } else { self.subdivision(control).map(Some) }
    }
}

impl ricci_metric {
    /// The handle of a metric. `report` is used where the solution has no report of its own.
    pub(crate) fn at(solution: Solution, report: Option<Report>) -> Outcome<ricci_metric> {
        let lengths = Arc::new(solution.metric().lengths(solution.mesh())?);
        let report = solution.report().cloned().or(report);
        let (curvature, subdivision) = (OnceLock::new(), OnceLock::new());
        Ok(ricci_metric(Arc::new(MetricState { solution, report, lengths, curvature, subdivision })))
    }
}

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_metric_summary {
    pub size: usize,
    pub space: u32,
    pub input_geometry: u32,
    pub scheme: u32,
    pub doubled: u32,
    pub n_vertices: usize,
    pub n_mesh_vertices: usize,
    pub n_edges: usize,
    pub n_faces: usize,
    pub area: f64,
    pub gauss_bonnet: f64,
    pub broken_triangles: usize,
    pub clamped_edges: usize,
    pub max_length_change: f64,
    pub n_flips: usize,
    pub n_start_flips: usize,
    pub max_log_length: f64,
    pub mean_log_length: f64,
    pub max_dilatation: f64,
    pub mean_dilatation: f64,
    pub far: u32,
    pub reserved: u32,
}
// SAFETY: numbers; 8-byte alignment, size first.
sized!(ricci_metric_summary, "summary", reserved);

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_metric_new(
    mesh: *const ricci_mesh,
    scheme: u32,
    space: u32,
    metric: *mut *mut ricci_metric,
) -> ricci_status {
    guard::make(metric, || {
        let class = Class::new(SCHEMES.choose(scheme)?, SPACES.choose(space)?);
        let mesh = shared(mesh)?;
        let _reserve = memory::work(mesh.connectivity.n_vertices(), memory::MESH)?;
        let metric = Solution::initial_of(mesh.surface()?.clone(), class)?;
        let initial = metric.initial();
        if initial.clamped_edges > 0 {
            log::info!(
                "metric: {} keeps {} edge weights at a bound, lengths change by up to {:.2} %",
                class.scheme,
                initial.clamped_edges,
                100.0 * initial.max_length_change
            );
        }
        ricci_metric::at(metric, None)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_metric_free(metric: *mut ricci_metric) {
    guard::free(metric);
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_metric_summarise(
    metric: *const ricci_metric,
    summary: *mut ricci_metric_summary,
    size: usize,
) -> ricci_status {
    guard::with(metric, |ricci_metric(state)| {
        let MetricState { solution, .. } = &**state;
        let (curvature, initial, mesh) = (state.curvature()?, solution.initial(), solution.mesh());
        let figures = ricci_metric_summary {
            size,
            space: SPACES.number(solution.metric().space)?,
            input_geometry: SPACES.number(initial.input_geometry)?,
            scheme: SCHEMES.number(solution.scheme()?)?,
            doubled: solution.double().is_some().into(),
            n_vertices: solution.given().n_vertices(),
            n_mesh_vertices: mesh.n_vertices(),
            n_edges: mesh.n_edges(),
            n_faces: mesh.n_faces(),
            area: curvature.area,
            gauss_bonnet: curvature.gauss_bonnet,
            broken_triangles: curvature.broken.len(),
            clamped_edges: initial.clamped_edges,
            max_length_change: initial.max_length_change,
            n_flips: solution.flips(),
            n_start_flips: solution.start_flips(),
            max_log_length: initial.distance.max_log_length,
            mean_log_length: initial.distance.mean_log_length,
            max_dilatation: initial.distance.max_dilatation,
            mean_dilatation: initial.distance.mean_dilatation,
            far: initial.distance.is_far().into(),
            reserved: 0,
        };
        structs::write(figures, summary, size)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_metric_values(
    metric: *const ricci_metric,
    which: u32,
    values: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(metric, |ricci_metric(state)| {
        let MetricState { solution, lengths, .. } = &**state;
        let (metric, n) = (solution.metric(), solution.given().n_vertices());
        let copy = |all: &[f64]| copy_out("values", all, values, capacity);
        match QUANTITIES.choose(which)? {
            MetricQuantity::Factor => copy(&solution.conformal_factor()?),
            MetricQuantity::Curvature => copy(&state.curvature()?.at),
            MetricQuantity::U => copy(metric.u.split_at(n).0),
            MetricQuantity::Type => {
                let types = metric.epsilon.iter().take(n).map(|&e| f64::from(e));
                copy_each("values", n, types, values, capacity)
            }
            MetricQuantity::Lengths => copy(lengths),
            MetricQuantity::Eta => copy(&metric.rounded_eta()),
            MetricQuantity::MeshU => copy(&metric.u),
        }
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_metric_mesh(
    metric: *const ricci_metric,
    mesh: *mut *mut ricci_mesh,
) -> ricci_status {
    guard::make(mesh, || {
        let MetricState { solution, lengths, .. } = &*shared(metric)?.0;
        Ok(ricci_mesh::intrinsic(solution.mesh().clone(), lengths.clone(), solution.metric().space))
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_metric_mirror(
    metric: *const ricci_metric,
    mirror: *mut u32,
    capacity: usize,
) -> ricci_status {
    guard::with(metric, |ricci_metric(state)| {
        let (mesh, double) = (state.solution.mesh(), state.solution.double());
        let images = mesh.vertices().map(|v| double.map_or(v, |double| double.mirror(v)).0);
        copy_each("mirror", mesh.n_vertices(), images, mirror, capacity)
    })
}

/// The report of the flow that led to a metric.
pub(crate) fn report_of(state: &MetricState) -> Outcome<&Report> {
    state.report.as_ref().ok_or_else(|| Failure::argument("no flow has led to this metric: it has no report"))
}
