//! The descent of a map, to the plane or the sphere, in checks, reports and summaries.

use crate::report::{Checks, Figures};
use crate::say;
use ricci::flatten::{Distortion, FlattenReport, FlattenStop};
use serde_json::{Value, json};

/// The checks of a descent that was asked for this Newton decrement.
pub fn descent_checks(report: &FlattenReport, tolerance: f64) -> Checks {
    let mut checks = Checks::default();
    if report.stop != FlattenStop::Rounding {
        checks.add("newton_decrement", report.decrement, tolerance);
    }
    checks.add("not_converged", f64::from(u8::from(!report.converged())), 0.0);
    checks
}

/// The figures of a descent, behind others.
pub fn descent_figures(before: Figures, report: &FlattenReport) -> Figures {
    before
        .with("start", report.start.name())
        .with("stop_reason", report.stop.name())
        .with("converged", report.converged())
        .with("iterations", report.iterations())
        .with("unclamped_steps", report.unclamped)
        .with("newton_decrement", report.decrement)
        .with("gradient", report.gradient)
        .with("energies", report.energies.clone())
        // Three figures of the map by themselves: its energy, its largest stretch, and the mean of |length / length - 1| over the edges.
        .with("energy", report.after.energy)
        .with("stretch_max", report.after.most_stretch)
        .with("distance_error", report.after.mean_length_error)
        .with("before", distortion(&report.before))
        .with("after", distortion(&report.after))
}

/// A descent in the lines of a summary.
pub fn descent_summary(report: &FlattenReport) -> String {
    let steps = say::count(report.iterations(), "step", "steps");
    let map = format!(
        "map      {} after {steps} from the {} map, {} by the Hessian itself, decrement {:.1e}\n",
        report.stop.name(),
        report.start.name(),
        report.unclamped,
        report.decrement
    );
    map + &line("before  ", &report.before) + &line("after   ", &report.after)
}

/// The line that says why a descent did not converge, with a remedy; empty where it did.
pub fn reason(report: &FlattenReport) -> String {
    why(report.stop).map_or_else(String::new, |why| format!("why      {why}\n"))
}

fn line(name: &str, of: &Distortion) -> String {
    format!(
        "{name} energy {:.6}, stretch {:.4} to {:.4}, lengths off by {:.2} % in the mean and {:.1} % at most, areas by {:.2} % and {:.1} %\n",
        of.energy,
        of.least_stretch,
        of.most_stretch,
        100.0 * of.mean_length_error,
        100.0 * of.max_length_error,
        100.0 * of.mean_area_error,
        100.0 * of.max_area_error
    )
}

/// The reason of a descent that did not converge, with a remedy.
fn why(stop: FlattenStop) -> Option<&'static str> {
    match stop {
        FlattenStop::Converged | FlattenStop::Rounding => None,
        FlattenStop::MaxIterations => {
            Some("the steps ran out: give more (--max-iterations), or ask for less (--tolerance)")
        }
        FlattenStop::Barrier => {
            Some("the energy falls on toward a triangle without area: --energy isometric does not")
        }
        FlattenStop::NoStep => {
            Some("no step lowers the energy: remesh thin triangles, or ask for less (--tolerance)")
        }
        FlattenStop::Unmet => Some(
            "no map was found that has pinned vertices and straight pieces where they are to be and turns no triangle over: see whether one exists, and start with fewer",
        ),
    }
}

/// The change of lengths and areas as reports have it.
pub fn distortion(of: &Distortion) -> Value {
    json!({
        "energy": of.energy,
        "least_stretch": of.least_stretch,
        "most_stretch": of.most_stretch,
        "mean_length_error": of.mean_length_error,
        "max_length_error": of.max_length_error,
        "mean_area_error": of.mean_area_error,
        "max_area_error": of.max_area_error,
        "mean_dilatation": of.mean_dilatation,
        "max_dilatation": of.max_dilatation,
        "area": of.area,
    })
}
