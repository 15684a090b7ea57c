//! The figures of a circle domain, as its report has them, and what is said of it.

use super::found::Found;
use crate::failure::Failure;
use crate::metric_file::MIXED;
use crate::report::{Done, Figures};
use crate::say::{count, lines, modulus, surface};
use ricci::geometry::worse;
use serde_json::{Map, Value, json};

pub fn of_domain(found: &Found) -> Figures {
    let (domain, report) = (&found.domain, &found.domain.report);
    let circle = |c: &ricci::canonical::DomainCircle| json!({"loop": c.boundary_loop, "center": c.center, "radius": c.radius, "deviation": c.deviation, "vertices": c.vertices});
    let failed: Map<String, Value> =
        found.failed.0.iter().map(|(wish, why)| (wish.to_string(), why.as_str().into())).collect();
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
        // Vertices added to loops: before the flow, and where flips have crossed their edges.
        .with("halved_edges", report.halved_edges)
        .with("crossed_edges", report.crossed_edges)
        .if_some("puncture", report.puncture.map(|v| v.0))
        .if_some("modulus", domain.modulus)
        .if_some("modulus", domain.torus_modulus)
        .with("area", domain.layout.area)
        .with("flipped_triangles", found.laid.flipped().len())
        .distortion(Some(&found.laid))
        .if_some("failed", (!failed.is_empty()).then_some(failed))
}

/// What the command says on stdout.
pub fn say(done: &Done<Found>) -> Result<(), Failure> {
    let Done { result: found, checks, files, seconds, .. } = done;
    let (domain, report) = (&found.domain, &found.domain.report);
    let deviation = domain.circles.iter().map(|c| c.deviation).fold(0.0, worse);
    let mut text = surface(&done.input);
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
    let quality = &found.laid.quality;
    text += &format!(
        "layout   {}, {}, dilatation mean {:.4} max {:.3}{}\n",
        count(found.laid.flipped().len(), "triangle flipped", "triangles flipped"),
        count(found.laid.degenerate.len(), "piece without area", "pieces without area"),
        quality.qc_mean,
        quality.qc_max,
        modulus(domain.torus_modulus)
    );
    for (wishes, why) in found.failed.by_cause() {
        text += &format!("FAILED   --{}: {why}\n", wishes.join(", --"));
    }
    text += &checks.told(found.failed.0.is_empty());
    if !files.is_empty() {
        text += &format!("wrote    {}\n", files.join(", "));
    }
    lines(&(text + &format!("{seconds:.2} s\n")), files)
}
