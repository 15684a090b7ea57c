//! The checks, the figures and the summary of `ricci circles`.

use super::outcome::CirclesOutcome;
use crate::carry::left_out;
use crate::metric_file::MIXED;
use crate::report::{Checks, Done, Figures, InputSummary};
use crate::runner::{CommandRun, JobOutcome};
use crate::say::{count, finish, modulus, surface};
use crate::solved::GAUSS_BONNET;
use ricci::geometry::worse;
use serde_json::json;

/// Largest distance of a loop from its circle, as a share of the radius.
const ROUND: f64 = 1e-9;

impl JobOutcome for CirclesOutcome {
    type Figures = Figures;

    fn checks(&self) -> Checks {
        let (domain, layout) = (&self.domain, &self.laid.layout);
        let mut checks = Checks::default();
        checks.add("gauss_bonnet", self.gauss_bonnet, GAUSS_BONNET);
        checks.add("max_curvature_error", domain.report.domain_curvature_error, self.tolerance);
        checks.add("roundness", domain.circles.iter().map(|c| c.deviation).fold(0.0, worse), ROUND);
        checks.add("overlapping_circles", domain.overlapping().len() as f64, 0.0);
        let errors = domain.report.domain_curvature_error * domain.metric.mesh().n_vertices() as f64;
        checks.add("layout_consistency", layout.consistency(), layout.consistency_limit(errors));
        checks.add("flipped_triangles", layout.flipped.len() as f64, 0.0);
        checks.add("unconverged", f64::from(u8::from(!domain.report.converged)), 0.0);
        checks
    }

    fn input(&self) -> Option<InputSummary> {
        Some(InputSummary::of(&self.input))
    }

    fn figures(&self, run: &CommandRun<'_>) -> Figures {
        let CirclesOutcome { input, domain, laid, .. } = self;
        let report = &domain.report;
        let circle = |c: &ricci::canonical::DomainCircle| json!({"loop": c.boundary_loop, "center": c.center, "radius": c.radius, "deviation": c.deviation, "vertices": c.vertices});
        Figures::default()
            .with("space", domain.layout.space.name())
            .with("scheme", MIXED)
            .with("converged", report.converged)
            .with("stop_reason", report.stop_reason.name())
            .with("iterations", report.iterations)
            .with("flips", report.flips)
            .with("max_curvature_error", report.domain_curvature_error)
            .if_some("outer", domain.outer)
            .with("circles", domain.circles.iter().map(circle).collect::<Vec<_>>())
            // The vertices that were added to loops: before the flow, and where flips have crossed their edges.
            .with("halved_edges", report.halved_edges)
            .with("crossed_edges", report.crossed_edges)
            .if_some("puncture", report.puncture.map(|v| v.0))
            .if_some("modulus", domain.modulus)
            .if_some("modulus", domain.torus_modulus)
            .with("area", domain.layout.area)
            .with("flipped_triangles", laid.flipped().len())
            .distortion(Some(laid))
            .failed(&run.failed)
            .with("left_out", left_out(input))
    }

    fn summary(&self, done: &Done) -> String {
        let CirclesOutcome { input, domain, laid, .. } = self;
        let report = &domain.report;
        let deviation = domain.circles.iter().map(|c| c.deviation).fold(0.0, worse);
        let mut text = surface(input);
        text += &format!(
            "metric   {}: {} after {}, max |K| = {:.1e}\n",
            domain.layout.space,
            report.stop_reason,
            count(report.iterations, "step", "steps"),
            report.domain_curvature_error
        );
        text += &format!(
            "circles  {}, off by {deviation:.1e} of the radius at most{}{}\n",
            count(domain.circles.len(), "circle", "circles"),
            domain.outer.map_or_else(String::new, |k| format!(", loop {k} outside")),
            domain.modulus.map_or_else(String::new, |m| format!(", modulus {m:.6}"))
        );
        if report.halved_edges + report.crossed_edges > 0 {
            text += &format!(
                "loops    {} added: {} where edges were halved, {} where flips crossed them\n",
                count(report.halved_edges + report.crossed_edges, "vertex", "vertices"),
                report.halved_edges,
                report.crossed_edges
            );
        }
        text += &format!(
            "layout   {}, {}, dilatation mean {:.4} max {:.3}{}\n",
            count(laid.flipped().len(), "triangle flipped", "triangles flipped"),
            count(laid.degenerate.len(), "piece without area", "pieces without area"),
            laid.quality.qc_mean,
            laid.quality.qc_max,
            modulus(domain.torus_modulus)
        );
        text + &finish(done)
    }
}
