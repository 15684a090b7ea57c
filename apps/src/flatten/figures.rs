//! The checks, the figures and the summary of `ricci flatten`.

use super::descent::{descent_checks, descent_figures, descent_summary, reason};
use super::outcome::{PlaneOutcome, StrainedSheet};
use super::seamed::SeamedMap;
use crate::report::{Checks, Done, Figures};
use crate::runner::CommandRun;
use crate::say;

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
