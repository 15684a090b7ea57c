//! The checks and the summary of `ricci flow`.

use crate::figures::of_flow;
use crate::job::FlowOutcome;
use crate::listed::named;
use crate::report::{Checks, Done, Figures, InputSummary};
use crate::runner::{CommandRun, JobOutcome};
use crate::say::{count, ending, modulus, surface, tolerance};
use crate::surface_layout::SurfaceLayout;
use ricci::Target;
use ricci::flow::StopReason;
use ricci::geometry::worse;
use ricci::mesh::VertexId;

/// Largest difference of u at mirror images: rounding differs where edges of the two halves were flipped in another order.
const MIRROR: f64 = 1e-8;

impl JobOutcome for FlowOutcome {
    type Figures = Figures;

    fn checks(&self) -> Checks {
        let mut checks = self.solved.checks(self.report.allowed_error());
        let solution = &self.solved.solution;
        if let Some(double) = solution.double() {
            let u = &solution.metric().u;
            let differs = |v: VertexId| (u[v] - u[double.mirror(v)]).abs();
            checks.add("mirror_symmetry", solution.mesh().vertices().map(differs).fold(0.0, worse), MIRROR);
        }
        if let (Target::Outer(_), false) = (&self.rule, solution.is_one_piece()) {
            let holes = self.input.mesh().boundary_loops().len() - 1;
            checks.add("unclosed_holes", holes as f64, 0.0);
        }
        if let Ok(laid) = &self.layout {
            let limit = laid.layout.consistency_limit(self.solved.total_error());
            checks.add("layout_consistency", laid.layout.consistency(), limit);
            if let Some(packed) = &laid.packed {
                checks.add("overlapping_in_charts", packed.overlapping as f64, 0.0);
            }
            laid.check_flipped(&mut checks);
        }
        checks
    }

    fn input(&self) -> Option<InputSummary> {
        Some(InputSummary::of(&self.input))
    }

    fn figures(&self, run: &CommandRun<'_>) -> Figures {
        of_flow(self, run)
    }

    fn summary(&self, done: &Done) -> String {
        let report = &self.report;
        let mut text = surface(&self.input);
        text += &format!(
            "metric   {} {}, target {}: {} after {}, max |K − K̄| = {:.1e}{}{}\n",
            self.solved.solution.metric().space,
            self.solved.scheme,
            self.rule_name,
            report.stop_reason,
            count(report.iterations, "step", "steps"),
            report.max_curvature_error,
            tolerance(report.tolerance),
            match report.broken_triangles {
                0 => String::new(),
                n => format!(", {}", count(n, "broken triangle", "broken triangles")),
            }
        );
        text += &self.solved.scheme_line();
        if !report.converged() {
            text += &format!("why      {}\n", why(self));
        }
        text += &match &self.layout {
            Ok(laid) => format!("layout   {}\n{}", layout(laid), overlap(laid)),
            Err(why) => format!("layout   none: {why}\n"),
        };
        text + &ending(&self.input, done, self.solved.may_flip)
    }
}

/// The quality of a layout.
pub fn layout(laid: &SurfaceLayout) -> String {
    let written = laid.written();
    let q = written.quality;
    let mut text = format!(
        "{}{}, dilatation mean {:.4} max {:.3}, area ratio {:.2e} to {:.2e}",
        written.name,
        count(written.flipped.len(), "triangle flipped", "triangles flipped"),
        q.qc_mean,
        q.qc_max,
        q.area_ratio_min,
        q.area_ratio_max
    );
    if !written.degenerate.is_empty() {
        text += &format!(", {} without area", count(written.degenerate.len(), "triangle", "triangles"));
    }
    if let n @ 1.. = laid.n_turned_by_straight_sides() {
        text += &format!(
            "\nsides    {} upright in the hyperbolic plane, but turned over where a viewer draws straight sides for arcs",
            count(n, "triangle is", "triangles are"),
        );
    }
    if let Some(repaired) = laid.repaired() {
        text += &format!(
            "\nrepaired {} that folded: {} of the input split at {}",
            count(laid.folded_input_faces(), "face", "faces"),
            count(repaired.split_edges.len(), "edge", "edges"),
            count(repaired.n_added(), "point", "points"),
        );
    }
    if let Some(packed) = &laid.packed {
        let charts = &packed.charts;
        text += &format!(
            "\ncharts   {}, {:.0} % of the unit square",
            count(charts.count(), "chart", "charts"),
            100.0 * charts.efficiency
        );
    }
    text + &modulus(laid.modulus)
}

/// The line about a layout that overlaps itself.
fn overlap(laid: &SurfaceLayout) -> String {
    laid.overlap().map_or_else(String::new, |share| {
        format!(
            "overlap  {:.2} % of the layout's area lies on other parts of it: --charts cuts it into pieces that do not overlap\n",
            100.0 * share
        )
    })
}

/// The reason why a flow did not converge, as far as it is known.
fn why(outcome: &FlowOutcome) -> String {
    let report = &outcome.report;
    if let (StopReason::BrokenTriangles, Target::Outer(_)) = (report.stop_reason, &outcome.rule) {
        return "with the lengths of the outer loop kept, a triangle breaks that no flip may mend, since edges are kept or the geometry of \
                the input is not Euclidean: allow flips, or bend the loops instead (--target boundary)"
            .into();
    }
    if report.stop_reason == StopReason::BrokenTriangles {
        return format!(
            "no metric of the scheme on this triangulation: its energy is least with broken {}",
            named("face", "faces", &outcome.solved.curvature.broken)
        );
    }
    if let Some(o) = &report.obstruction {
        return format!(
            "the target adds up to {:.6} at {}; every metric of the scheme on this triangulation has more than {:.6} there",
            o.curvature,
            named("vertex", "vertices", &o.vertices),
            o.least
        );
    }
    if let StopReason::OutOfReach { step } = report.stop_reason {
        return format!(
            "lengths would differ by a factor of about e^{step:.0}: too much curvature at too few vertices; spread it over cones \
             (--target auto:N), or make the boundary geodesic where χ < 0 (ricci uniformize)"
        );
    }
    let worst: Vec<VertexId> = report.worst.iter().map(|&(v, _)| v).collect();
    format!("the error is largest at {}", named("vertex", "vertices", &worst))
}
