//! The checks, the figures and the summary of `ricci circles`.

use super::outcome::CirclesOutcome;
use crate::metric_file::MIXED;
use crate::report::{Checks, Done, Figures, InputSummary};
use crate::runner::{CommandRun, JobOutcome};
use crate::say::{count, finish, modulus, surface};
use crate::solved::GAUSS_BONNET;
use ricci::canonical::circle_domain::ROUND;
use ricci::canonical::{CircleDomain, DomainFrame};
use ricci::metric::Scheme;
use serde_json::json;
use std::f64::consts::FRAC_2_PI;

/// A remedy for triangles that are turned over: of sheets 200 times as long as wide, those with two rows of quadrilaterals fold five
/// triangles, and none once each triangle is cut into four.
const FINER: &str = "cut each triangle into four, `ricci refine --levels 1`";

impl JobOutcome for CirclesOutcome {
    type Figures = Figures;

    fn checks(&self) -> Checks {
        let (domain, layout) = (&self.domain, &self.laid.layout);
        let mut checks = Checks::default();
        checks.add("gauss_bonnet", self.gauss_bonnet, GAUSS_BONNET);
        checks.add("max_curvature_error", domain.report.domain_curvature_error, self.tolerance);
        checks.add("roundness", domain.report.deviation, ROUND);
        checks.add("overlapping_circles", domain.overlapping().len() as f64, 0.0);
        let errors = domain.report.domain_curvature_error * domain.metric.mesh().n_vertices() as f64;
        checks.add("layout_consistency", layout.consistency(), layout.consistency_limit(errors));
        let finer = Some(FINER).filter(|_| domain.span_beyond_range().is_none());
        checks.add_none("flipped_triangles", ["face", "faces"], self.laid.flipped(), finer);
        checks.add("unconverged", f64::from(u8::from(!domain.report.converged)), 0.0);
        checks
    }

    fn input(&self) -> Option<InputSummary> {
        Some(InputSummary::of(&self.input))
    }

    fn figures(&self, run: &CommandRun<'_>) -> Figures {
        let CirclesOutcome { domain, laid, .. } = self;
        let report = &domain.report;
        let circle = |c: &ricci::canonical::DomainCircle| json!({"loop": c.boundary_loop, "center": c.centre, "radius": c.radius, "log_radius": c.log_radius, "deviation": c.deviation, "vertices": c.vertices});
        let figures = Figures::default()
            .with("space", domain.layout.space.name())
            .with("scheme", if domain.frame == DomainFrame::Strip { Scheme::Yamabe.name() } else { MIXED })
            .if_some("frame", frame_name(domain.frame))
            .with("converged", report.converged)
            .with("stop_reason", report.stop_reason.name())
            .with("iterations", report.iterations)
            .with("flips", report.flips)
            .with("max_curvature_error", report.domain_curvature_error)
            .if_some("worst_vertex", report.worst_vertex.map(|v| v.0))
            .if_some("outer", domain.outer)
            .if_some("centred_on", report.centred_on)
            .with("roundness", report.deviation)
            .with("circles", domain.circles.iter().map(circle).collect::<Vec<_>>())
            // The vertices that were added to loops: before the flow, and where flips have crossed their edges.
            .with("halved_edges", report.halved_edges)
            .with("crossed_edges", report.crossed_edges)
            .if_some("puncture", report.puncture.map(|v| v.0))
            .if_some("modulus", domain.modulus);
        crate::modulus::add_figures(figures, self.modulus.as_ref())
            .if_some("modulus", domain.torus_modulus)
            .with("area", domain.layout.area)
            .with("flipped_triangles", laid.flipped().len())
            .distortion(Some(laid))
            .failed(&run.failed)
            .with("left_out", run.outputs.left_out())
    }

    fn summary(&self, done: &Done) -> String {
        let CirclesOutcome { input, domain, laid, .. } = self;
        let report = &domain.report;
        let mut text = surface(input);
        text += &format!(
            "metric   {}: {} after {}, max |K| = {:.1e}\n",
            domain.layout.space,
            report.stop_reason,
            count(report.iterations, "step", "steps"),
            report.domain_curvature_error
        );
        text += &format!(
            "circles  {}, off by {:.1e} of the radius at most{}{}{}{}\n",
            count(domain.circles.len(), "circle", "circles"),
            report.deviation,
            domain.outer.map_or_else(String::new, |k| format!(", loop {k} outside")),
            report.centred_on.map_or_else(String::new, |k| format!(", loop {k} about the centre")),
            if domain.frame == DomainFrame::Strip { ", as lines of a strip (log coordinates)" } else { "" },
            domain.modulus.map_or_else(String::new, |m| format!(", modulus {m:.6}"))
        );
        text += &crate::modulus::line(self.modulus.as_ref());
        text += &why(self);
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

/// The name of the shape of a surface of genus 0.
fn frame_name(frame: DomainFrame) -> Option<&'static str> {
    match frame {
        DomainFrame::Auto => None,
        DomainFrame::Disk => Some("disk"),
        DomainFrame::Strip => Some("strip"),
    }
}

/// Where the domain is not as exact as asked for, and what to change; empty if it is.
fn why(outcome: &CirclesOutcome) -> String {
    let (domain, report) = (&outcome.domain, &outcome.domain.report);
    if report.converged {
        return String::new();
    }
    if let Some(span) = domain.span_beyond_range() {
        return format!(
            "why      some lengths are e^{span:.0} times smaller than others: a part of the surface is about {:.0} times as long as wide, or more, too long \
             for doubles in one disk. ricci flow lays such a sheet out with the lengths of its outline; cut across, its parts become disks\n",
            span * FRAC_2_PI
        );
    }
    let mut text = String::new();
    if let Some(k) = report.worst_loop.filter(|_| report.deviation > ROUND) {
        let c = &domain.circles[k];
        let [x, y] = c.centre;
        text += &format!(
            "why      loop {k} is off its circle by {:.1e} of the radius {:.1e} about ({x:.6}, {y:.6}): {}\n",
            c.deviation,
            c.radius,
            remedy(outcome)
        );
    }
    if let Some(v) = report.worst_vertex.filter(|_| report.domain_curvature_error > outcome.tolerance) {
        let n = outcome.halved.mesh().n_vertices();
        let place = match v.index().checked_sub(n).filter(|_| domain.frame != DomainFrame::Strip) {
            Some(k) => format!("the centre of loop {k}"),
            None => format!("vertex {v}"),
        };
        text += &format!(
            "why      max |K| = {:.1e} at {place}, limit {:.1e}: {}, or ask for less (--tolerance)\n",
            report.domain_curvature_error,
            outcome.tolerance,
            if is_annulus_in_disk(domain) { STRIP } else { "remesh thin triangles there" }
        );
    }
    if text.is_empty() && outcome.laid.flipped().is_empty() {
        text += &format!("why      triangles break or circles overlap: {FINER}\n");
    }
    text
}

/// The way out for an annulus whose inner circle is too small for the disk.
const STRIP: &str = "doubles hold no more digits of so small a circle in the disk; --frame strip does";

fn is_annulus_in_disk(domain: &CircleDomain) -> bool {
    domain.frame == DomainFrame::Disk && domain.circles.len() == 2
}

/// The way to a rounder loop.
fn remedy(outcome: &CirclesOutcome) -> String {
    let domain = &outcome.domain;
    if domain.frame != DomainFrame::Disk {
        return "remesh thin triangles near it, or give it more edges (--least-loop)".into();
    }
    if domain.circles.len() == 1 {
        return FINER.into();
    }
    if is_annulus_in_disk(domain) {
        return STRIP.into();
    }
    "doubles do not hold this loop beside the others in one disk; try another outer loop (--outer), or cut the surface along its \
     long tubes and treat the parts"
        .into()
}
