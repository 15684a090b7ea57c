//! The figures of a flow, as its report has them.

use crate::charts;
use crate::input::Input;
use crate::job::Outcome;
use crate::laid::Laid;
use ricci::embed::{Layout, Seam};
use ricci::flow::{Obstruction, Report};
use ricci::geometry::{PlaneIsometry, Space};
use ricci::mesh::{HalfedgeId, VertexId};
use serde::Serialize;
use std::collections::BTreeMap;

/// How a flow went.
#[derive(Serialize)]
pub struct Course {
    pub converged: bool,
    pub stop_reason: &'static str,
    pub iterations: usize,
    /// Edge flips, `start_flips` included.
    pub flips: usize,
    /// Isometric flips to the Delaunay triangulation before the flow.
    pub start_flips: usize,
}

impl Course {
    pub fn new(report: &Report, start_flips: usize) -> Course {
        let Report { stop_reason, iterations, flips, .. } = *report;
        let converged = report.converged();
        let (stop_reason, flips) = (stop_reason.name(), start_flips + flips);
        Course { converged, stop_reason, iterations, flips, start_flips }
    }
}

/// How a layout distorts the surface; null where there is none.
#[derive(Serialize)]
pub struct Distortion {
    qc_mean: Option<f64>,
    qc_max: Option<f64>,
    area_ratio_min: Option<f64>,
    area_ratio_max: Option<f64>,
    /// Faces without area in the input or the layout; the qc figures leave them out. With charts also those that are smaller than
    /// the coordinates of the unit square resolve, which the check for overlaps leaves out.
    degenerate_pieces: Option<usize>,
    /// Vertices of the common refinement that are none of the input's; null where the layout is of the given triangulation.
    crossings: Option<usize>,
}

impl Distortion {
    pub fn of(laid: Option<&Laid>) -> Distortion {
        let quality = laid.map(|laid| &laid.quality);
        Distortion {
            qc_mean: quality.map(|q| q.qc_mean),
            qc_max: quality.map(|q| q.qc_max),
            area_ratio_min: quality.map(|q| q.area_ratio_min),
            area_ratio_max: quality.map(|q| q.area_ratio_max),
            degenerate_pieces: laid.map(|laid| laid.degenerate.len()),
            crossings: laid.and_then(Laid::refinement).map(|r| r.crossings.len()),
        }
    }
}

/// The figures of a flow. Those of the layout are null where there is none.
#[derive(Serialize)]
pub struct FlowResult {
    space: &'static str,
    scheme: &'static str,
    target: &'static str,
    #[serde(flatten)]
    course: Course,
    max_curvature_error: f64,
    /// What the error is held against: the tolerance, or the rounding floor of the mesh.
    tolerance: f64,
    /// Where a flow stalled: what rounding can do to the curvature there.
    rounding_floor: Option<f64>,
    /// Whether u, lengths and curvature were carried to twice the digits of a double.
    double_double: bool,
    broken_triangles: usize,
    /// Faces that break the triangle inequality.
    broken_faces: Vec<usize>,
    /// Where |K − K̄| is largest.
    worst_vertices: Vec<VertexFigures>,
    /// A set of vertices that proves that the target cannot be reached in this scheme on this triangulation.
    obstruction: Option<ObstructionFigures>,
    /// Newton matrices that had to be shifted to be positive definite.
    shifted: usize,
    /// Edges whose weight had to be moved into the scheme's range, and the largest relative change of length by that.
    clamped_edges: usize,
    max_length_change: f64,
    area: f64,
    flipped_triangles: Option<usize>,
    /// Faces of the input that fold where the map is made linear on them.
    flipped_input_faces: Option<usize>,
    #[serde(flatten)]
    distortion: Distortion,
    /// Number of charts, and the share of the unit square that they cover.
    #[serde(skip_serializing_if = "Option::is_none")]
    charts: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    packing: Option<f64>,
    /// Cones that were given or placed, `[vertex, curvature]`.
    #[serde(skip_serializing_if = "Option::is_none")]
    cones: Option<Vec<(u32, f64)>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    modulus: Option<[f64; 2]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    seams: Option<Vec<SeamFigures>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    no_layout: Option<String>,
    /// What was asked for and could not be done, by option, with the reason.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    failed: BTreeMap<&'static str, String>,
    /// What the input's file holds and the one with the layout does not.
    left_out: Vec<&'static str>,
    residuals: Vec<f64>,
}

/// The plane isometry `z ↦ e^{iθ} z + t` from the left side of a seam to its right side, in the layout's coordinates.
#[derive(Serialize)]
struct SeamFigures {
    rotation: f64,
    translation: [f64; 2],
    /// Relative to the diameter of the layout.
    residual: f64,
    edges: usize,
}

#[derive(Serialize)]
struct VertexFigures {
    vertex: usize,
    /// K − K̄, radians.
    curvature_error: f64,
}

/// Every metric of the scheme on this triangulation has a total curvature of more than `above` at the vertices; the target
/// asks for `target`.
#[derive(Serialize)]
struct ObstructionFigures {
    vertices: Vec<usize>,
    target: f64,
    above: f64,
}

impl FlowResult {
    pub fn new(input: &Input, outcome: &Outcome) -> Self {
        let Outcome { report, initial, layout, .. } = outcome;
        let laid = layout.as_ref().ok();
        let packed = laid.and_then(|l| l.packed.as_ref());
        let cones = charts::interior_cones(input, outcome);
        let seam = |(s, segment): (&Seam, &Vec<HalfedgeId>)| {
            let PlaneIsometry { rotation, translation } = s.isometry();
            SeamFigures { rotation, translation, residual: s.residual, edges: segment.len() }
        };
        let seams = |layout: &Layout| layout.seams.iter().zip(&layout.cut.segments).map(seam).collect();
        let worst =
            |&(v, curvature_error): &(VertexId, f64)| VertexFigures { vertex: v.index(), curvature_error };
        let obstruction = |o: &Obstruction| ObstructionFigures {
            vertices: o.vertices.iter().map(|v| v.index()).collect(),
            target: o.curvature,
            above: o.least,
        };
        FlowResult {
            space: outcome.metric.space.name(),
            scheme: outcome.scheme.name(),
            target: outcome.rule.name(),
            course: Course::new(report, outcome.start_flips),
            max_curvature_error: report.max_curvature_error,
            tolerance: report.tolerance,
            rounding_floor: report.rounding_floor,
            double_double: report.double_double,
            broken_triangles: report.broken_triangles,
            broken_faces: outcome.curvature.broken.iter().map(|f| f.index()).collect(),
            worst_vertices: report.worst.iter().map(worst).collect(),
            obstruction: report.obstruction.as_ref().map(obstruction),
            shifted: report.shifted,
            clamped_edges: initial.clamped_edges,
            max_length_change: initial.max_length_change,
            area: outcome.curvature.area,
            flipped_triangles: laid.map(|l| l.flipped().len()),
            flipped_input_faces: laid.and_then(|l| l.on_input.as_ref()).map(|o| o.flipped.len()),
            distortion: Distortion::of(laid),
            charts: packed.map(|p| p.charts.count()),
            packing: packed.map(|p| p.charts.efficiency),
            cones: cones.map(|cones| cones.into_iter().map(|(v, k)| (v.0, k)).collect()),
            modulus: laid.and_then(|l| l.modulus),
            seams: laid.map(|l| &l.layout).filter(|layout| layout.space == Space::E2).map(seams),
            no_layout: layout.as_ref().err().cloned(),
            failed: outcome.failed.0.clone(),
            left_out: outcome.left_out.clone(),
            residuals: report.residuals.clone(),
        }
    }
}
