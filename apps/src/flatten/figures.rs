//! The checks, the figures and the summary of `ricci flatten`.

use super::outcome::{PlaneOutcome, StrainedSheet};
use super::seamed::SeamedMap;
use crate::report::{Checks, Done, Figures};
use crate::runner::CommandRun;
use crate::say;
use ricci::flatten::{Distortion, FlattenReport, FlattenStop};
use serde_json::{Value, json};

/// Largest distance, over the diameter of the map, by which a corner was moved to make seams exact.
const MOVED: f64 = 1e-9;
/// The most by which pinned vertices and straight pieces may miss where they are to be, in the diameter of the map.
const MOST_MISFIT: f64 = 1e-11;

impl PlaneOutcome {
    pub fn checks(&self) -> Checks {
        let report = &self.flat.report;
        let mut checks = descent_checks(report, self.tolerance);
        if self.injective {
            checks.add("overlaps", f64::from(u8::from(!report.one_to_one)), 0.0);
        }
        if self.has_conditions {
            checks.add("misfit", report.misfit, MOST_MISFIT);
        }
        if let Some(sheet) = &self.sheet {
            let remedy = "allow more darts (--darts, --open), or a material that bears more";
            checks.add_with_remedy("strain_over_limit", sheet.taken[1], 1.0, remedy);
        }
        if let Some(seamed) = &self.seamed {
            checks.add("moved_corners", seamed.moved(), MOVED);
        }
        if let Some(&turned) = self.written_turned.get() {
            checks.add("turned_triangles_in_file", turned as f64, 0.0);
        }
        checks
    }

    pub fn figures(&self, run: &CommandRun<'_>) -> Figures {
        let report = &self.flat.report;
        let whole = self.origins.as_ref().map(|_| self.n_whole);
        descent_figures(Figures::default().if_some("whole_vertices", whole), report)
            .with("overlap", report.overlap)
            .with("one_to_one", report.one_to_one)
            .if_some("seams", self.seamed.as_ref().map(SeamedMap::figures))
            .if_some("sheet", self.sheet.as_ref().map(StrainedSheet::figures))
            .if_some("misfit", self.has_conditions.then_some(report.misfit))
            // The library gives no map in which exact arithmetic finds a turned triangle.
            .with("turned_triangles", 0)
            .if_some("turned_triangles_in_file", self.written_turned.get().copied())
            .failed(&run.failed)
            .with("left_out", run.outputs.left_out())
    }

    pub fn summary(&self, done: &Done) -> String {
        let report = &self.flat.report;
        let mut text = say::surface(&self.input);
        text += &descent_summary(report);
        if report.overlap > 0.0 {
            text +=
                &format!("overlap  {:.2} % of the map lies on other parts of it\n", 100.0 * report.overlap);
        }
        if let Some(seamed) = &self.seamed {
            text += &seamed.summary();
        }
        if let Some(sheet) = &self.sheet {
            text += &sheet.summary();
        }
        if self.injective && report.one_to_one {
            text += "overlap  none, by exact arithmetic on the numbers of the points\n";
        }
        if self.has_conditions {
            text += &format!(
                "misfit   {:.1e} of the map's diameter from pins and straight lines\n",
                report.misfit
            );
        }
        text + &reason(report) + &say::finish(done)
    }
}

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
