//! The figures of a flow for the report of `ricci flow`, and those that other commands share with it.

use crate::job::FlowOutcome;
use crate::report::Figures;
use crate::runner::CommandRun;
use crate::solved::SolvedMetric;
use crate::surface_layout::SurfaceLayout;
use ricci::embed::{Layout, RepairedInput, Seam};
use ricci::flow::{Obstruction, Report};
use ricci::geometry::{PlaneIsometry, Space};
use ricci::mesh::{HalfedgeId, VertexId};
use serde_json::{Value, json};

impl Figures {
    /// The space and the scheme of a metric.
    pub fn of_metric(solved: &SolvedMetric) -> Figures {
        Figures::default()
            .with("space", solved.solution.metric().space.name())
            .with("scheme", solved.scheme.name())
            .if_some("scheme_distance", scheme_distance(solved))
    }

    /// The course of a flow. `flips` counts the isometric flips to the Delaunay triangulation too, `start_flips` only these.
    pub fn course(self, report: &Report, solved: &SolvedMetric) -> Figures {
        let start_flips = solved.solution.start_flips();
        self.with("converged", report.converged())
            .with("stop_reason", report.stop_reason.name())
            .with("iterations", report.iterations)
            .with("flips", start_flips + report.flips)
            .with("start_flips", start_flips)
    }

    /// The precision of a flow: the tolerance asked for and, where the flow stalled, the most that rounding changes the curvature there.
    pub fn precision(self, report: &Report) -> Figures {
        self.with("tolerance", report.tolerance)
            .with("rounding_floor", report.rounding_floor)
            .with("double_double", report.double_double)
    }

    /// The distortion of the surface by a layout; null where there is none. The figures are those of the faces that are written: the
    /// input's own with `--on input`, where edges were split with `--repair`; `flipped_input_faces` counts the input's own in any case.
    ///
    /// Faces without area in the input or the layout are `degenerate_pieces`, which the qc figures leave out; with charts also faces that
    /// are smaller than the coordinates of the unit square resolve. `crossings` counts the vertices of the subdivision beyond the input's,
    /// but for those of `straightened_edges`: in H² edges of pieces that straight sides in the Poincaré disk would turn over, and
    /// `turned_by_straight_sides` counts the pieces for which that did not suffice.
    pub fn distortion(self, laid: Option<&SurfaceLayout>) -> Figures {
        let written = laid.map(SurfaceLayout::written);
        let quality = written.as_ref().map(|written| written.quality);
        let repaired = laid.and_then(SurfaceLayout::repaired);
        self.if_some(
            "flipped_input_faces",
            laid.filter(|l| l.on_input.is_some()).map(|l| l.folded_input_faces()),
        )
        .if_some("figures_of", laid.filter(|l| l.own_faces.is_some()).map(|_| "input"))
        .if_some("split_edges", repaired.map(|r| r.split_edges.len()))
        .if_some("added_vertices", repaired.map(RepairedInput::n_added))
        .with("qc_mean", quality.map(|q| q.qc_mean))
        .with("qc_max", quality.map(|q| q.qc_max))
        .with("area_ratio_min", quality.map(|q| q.area_ratio_min))
        .with("area_ratio_max", quality.map(|q| q.area_ratio_max))
        .with("degenerate_pieces", written.as_ref().map(|written| written.degenerate.len()))
        .with("crossings", laid.and_then(SurfaceLayout::common_subdivision).map(|r| r.crossings.len()))
        .if_some("straightened_edges", laid.map(SurfaceLayout::n_straightened).filter(|&n| n > 0))
        .if_some(
            "turned_by_straight_sides",
            laid.map(SurfaceLayout::n_turned_by_straight_sides).filter(|&n| n > 0),
        )
    }

    /// The options that failed, with the reasons, and what the input's file holds and the file with the layout has no place for.
    pub fn missing(self, run: &CommandRun<'_>) -> Figures {
        self.failed(&run.failed).with("left_out", run.outputs.left_out())
    }
}

/// The figures of a flow. Those of the layout are null where there is none.
pub fn of_flow(outcome: &FlowOutcome, run: &CommandRun<'_>) -> Figures {
    let FlowOutcome { report, solved, layout, .. } = outcome;
    let laid = layout.as_ref().ok();
    let packed = laid.and_then(|l| l.packed.as_ref());
    let initial = solved.solution.initial();
    let cones: Option<Vec<_>> =
        outcome.named_cones().map(|cones| cones.into_iter().map(|(v, k)| json!([v.0, k])).collect());
    let worst = |&(v, error): &(VertexId, f64)| json!({"vertex": v.0, "curvature_error": error});
    Figures::of_metric(solved)
        .with("target", outcome.rule.name())
        .course(report, solved)
        .with("max_curvature_error", report.max_curvature_error)
        .precision(report)
        .with("broken_triangles", report.broken_triangles)
        .with("broken_faces", solved.curvature.broken.iter().map(|f| f.0).collect::<Vec<_>>())
        .with("worst_vertices", report.worst.iter().map(worst).collect::<Vec<_>>())
        .with("obstruction", report.obstruction.as_ref().map(obstruction))
        // The number of Newton matrices that had to be shifted to be positive definite.
        .with("shifted", report.shifted)
        // The number of edges whose weight was moved into the range of the scheme, and the largest relative change of length by that.
        .with("clamped_edges", initial.clamped_edges)
        .with("max_length_change", initial.max_length_change)
        .with("area", solved.curvature.area)
        .with("flipped_triangles", laid.map(|l| l.flipped().len()))
        .distortion(laid)
        .if_some("overlap", laid.filter(|l| l.packed.is_none()).and_then(|l| l.layout.overlap()))
        .if_some("charts", packed.map(|p| p.charts.count()))
        .if_some("packing", packed.map(|p| p.charts.efficiency))
        .if_some("cones", cones)
        .if_some("modulus", laid.and_then(|l| l.modulus))
        .if_some("seams", laid.map(|l| &l.layout).filter(|l| l.space == Space::E2).map(seams))
        .if_some("no_layout", layout.as_ref().err().cloned())
        .missing(run)
        .with("residuals", report.residuals.clone())
}

/// The distance of the metric that a circle packing starts from, from that of the surface; none for schemes that represent every metric.
fn scheme_distance(solved: &SolvedMetric) -> Option<Value> {
    let d = &solved.solution.initial().distance;
    solved.scheme.is_packing().then(|| {
        json!({
            "max_log_length": d.max_log_length,
            "mean_log_length": d.mean_log_length,
            "edge": d.edge.map(|e| e.0),
            "max_dilatation": d.max_dilatation,
            "mean_dilatation": d.mean_dilatation,
            "face": d.face.map(|f| f.0),
            "far": d.is_far(),
        })
    })
}

/// Vertices at which every metric of the scheme on this triangulation has a total curvature of more than `above`, while the target asks
/// for `target`.
fn obstruction(o: &Obstruction) -> Value {
    let vertices: Vec<u32> = o.vertices.iter().map(|v| v.0).collect();
    json!({"vertices": vertices, "target": o.curvature, "above": o.least})
}

/// Per seam the plane isometry `z ↦ e^{iθ} z + t` from its left side to its right side, in the layout's coordinates; the residual is
/// relative to the layout's diameter.
fn seams(layout: &Layout) -> Vec<Value> {
    let figures = |(s, segment): (&Seam, &Vec<HalfedgeId>)| {
        let PlaneIsometry { rotation, translation } = s.isometry();
        json!({"rotation": rotation, "translation": translation, "residual": s.residual, "edges": segment.len()})
    };
    layout.seams.iter().zip(&layout.cut.segments).map(figures).collect()
}
