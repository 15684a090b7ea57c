//! The figures of a sphere for the reports of `ricci uniformize` and `ricci cover`, and its summary.

use super::sphere::{SphereSolution, SphereSurface};
use crate::input::Input;
use crate::report::Figures;
use crate::runner::CommandRun;
use crate::say;
use ricci::embed::Quality;

/// The figures of a sphere; `copies`: a cover was asked for.
pub fn of_sphere(input: &Input, s: &SphereSurface, copies: bool, run: &CommandRun<'_>) -> Figures {
    let (solved, start_flips) = (&s.solved, s.solved.solution.start_flips());
    let figures = Figures::of_metric(solved);
    let mut figures = match &s.method {
        SphereSolution::Flow(r, _) => figures.course(r, solved),
        SphereSolution::Puncture(r) => figures
            .with("converged", r.converged)
            .with("stop_reason", r.stop_reason.name())
            .with("iterations", r.iterations)
            .with("flips", start_flips + r.flips)
            .with("start_flips", start_flips),
    };
    figures = figures
        .with("max_curvature_error", solved.curvature_error())
        .with("tolerance", s.tolerance)
        .with("flipped_triangles", s.inward());
    let on_sphere = |r| Quality::on_sphere(r, input.mesh(), input.surface.lengths(), |f| s.piece(r, f)).ok();
    if let Some(q) = s.common_subdivision().ok().and_then(on_sphere) {
        figures = figures
            .with("qc_mean", q.qc_mean)
            .with("qc_max", q.qc_max)
            .with("area_ratio_min", q.area_ratio_min)
            .with("area_ratio_max", q.area_ratio_max)
            .with("degenerate_pieces", q.degenerate.len());
    }
    figures = figures
        // The reason why the common subdivision is missing, and with it `qc_mean` and the figures beside it.
        .if_some("no_refinement", s.subdivision.as_ref().and_then(|r| r.as_ref().err()).cloned())
        .with("area", solved.curvature.area)
        .with("smallest_edge", solved.lengths.iter().copied().fold(f64::INFINITY, f64::min))
        // The number of faces whose positions cannot be told from a point in floating-point numbers; the metric has them all the same.
        .with("degenerate_faces", s.points());
    if let SphereSolution::Puncture(r) = &s.method {
        figures = figures
            .with("puncture", r.puncture.0)
            .with("tried", r.tried)
            .with("planar_curvature_error", r.max_curvature_error)
            .with("u_range", r.u_range)
            .with("delaunay_violation", r.delaunay_violation)
            .with("link_turning", r.link_turning)
            .with("nonconvexity", r.nonconvexity)
            .with("centring", r.centring);
    }
    let none = Vec::<String>::new;
    // The universal cover of a sphere is the sphere.
    figures.with("word", none()).with("traces", none()).if_some("copies", copies.then_some(1)).missing(run)
}

/// The summary of a sphere.
pub fn text(s: &SphereSurface, copies: bool) -> String {
    let (stop, steps) = match &s.method {
        SphereSolution::Puncture(r) => (r.stop_reason, r.iterations),
        SphereSolution::Flow(r, _) => (r.stop_reason, r.iterations),
    };
    let mut text = format!(
        "metric   s2 {}: {stop} after {}, max |K| = {:.1e}{}, area {:.6}\n",
        s.solved.scheme,
        say::count(steps, "step", "steps"),
        s.solved.curvature_error(),
        say::tolerance(s.tolerance),
        s.solved.curvature.area,
    );
    if let SphereSolution::Puncture(r) = &s.method {
        text += &format!(
            "sphere   vertex {} at infinity, u over {:.2}, off the middle by {:.1e}, convex to {:.1e}\n",
            r.puncture, r.u_range, r.centring, r.nonconvexity
        );
    }
    let points = s.points();
    if points > 0 {
        text += &format!(
            "digits   {} too small for positions in doubles; the metric has all lengths\n",
            say::count(points, "face is", "faces are")
        );
    }
    if copies {
        text += "cover    1 copy: a sphere is its own universal cover\n";
    }
    text
}
