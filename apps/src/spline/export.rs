//! `ricci spline export` as a job: bicubic patches near a spline, for CAD.

use super::args::ExportArgs;
use crate::failure::Failure;
use crate::output::{check_extension, check_outputs, extension};
use crate::report::{Checks, Done, Figures, timed};
use crate::runner::{CommandRun, Job, JobHeader, JobOutcome};
use crate::say::count;
use ricci::spline::{BicubicFit, BicubicOptions, Spline, StepOptions};

/// Largest angle, in degrees, between the normals of neighbouring patches: larger angles are seen in reflections.
const NORMAL_JUMP: f64 = 1.0;

/// A spline, with bicubic patches near it.
pub struct ExportOutcome {
    spline: Spline,
    bicubic: BicubicFit,
    /// The patches of the spline that fold.
    folds: Vec<usize>,
    /// The limit of the distance from the spline.
    tolerance: f64,
}

impl Job for ExportArgs {
    type Outcome = ExportOutcome;

    fn header(&self) -> JobHeader<'_> {
        JobHeader { name: "spline", common: &self.common, mesh: None }
    }

    fn check(&self) -> Result<(), Failure> {
        check_extension("-o", Some(&self.out), &["step", "stp", "json"])?;
        check_outputs(&[Some(&self.spline)], &[Some(&*self.out), self.common.report.as_deref()])
    }

    fn compute(&self, run: &mut CommandRun<'_>) -> Result<ExportOutcome, Failure> {
        let spline = timed(&mut run.seconds.read, || Spline::read(&self.spline))?;
        let options = BicubicOptions {
            tolerance: self.tolerance,
            control_points: self.control_points.map(|n| n as usize),
            folds: self.allow_folds,
            threads: self.common.threads,
            ..BicubicOptions::default()
        };
        let bicubic = timed(&mut run.seconds.solve, || spline.to_bicubic(&options, run.control))?;
        let folds = if self.allow_folds {
            timed(&mut run.seconds.solve, || spline.folds(self.common.threads, run.control))?
        } else {
            Vec::new()
        };
        Ok(ExportOutcome { spline, bicubic, folds, tolerance: self.tolerance })
    }

    fn write(&self, outcome: &ExportOutcome, run: &mut CommandRun<'_>) -> Result<(), Failure> {
        let (surface, mut bytes) = (&outcome.bicubic.surface, Vec::new());
        if extension(&self.out) == "json" {
            surface.write_json(&mut bytes).map_err(|why| Failure::Input(why.to_string()))?;
        } else {
            surface.write_step(&step_options(self), &mut bytes)?;
        }
        run.outputs.add_bytes(&self.out, &bytes)
    }
}

impl JobOutcome for ExportOutcome {
    type Figures = Figures;

    fn checks(&self) -> Checks {
        let bicubic = &self.bicubic;
        let mut checks = Checks::default();
        checks.add("distance", bicubic.distance, self.tolerance);
        checks.add("normal_jump", bicubic.angles.largest.to_degrees(), NORMAL_JUMP);
        let remedy = "the surface turns back on itself there: fit it again, with more --fairness, or more patches by a smaller --tolerance";
        checks.add_none("folded_patches", ["patch", "patches"], &self.folds, Some(remedy));
        checks.add("open_sides", bicubic.surface.open_sides() as f64, 0.0);
        checks
    }

    fn figures(&self, _: &CommandRun<'_>) -> Figures {
        let ExportOutcome { spline, bicubic, .. } = self;
        let surface = &bicubic.surface;
        Figures::default()
            .with("degree", spline.space().degree())
            .with("patches", spline.space().patches().len())
            .with("bicubic_patches", surface.patches.len())
            .with("curves", surface.curves.len())
            .with("control_points", surface.n_control_points())
            .with("spans_min", bicubic.spans[0])
            .with("spans_max", bicubic.spans[1])
            .with("rounds", bicubic.rounds)
            .with("folded_patches", &self.folds[..])
            .with("closed", surface.is_closed())
            .with("diagonal", bicubic.diagonal)
            // A fraction of the diagonal of the bounding box.
            .with("distance", bicubic.distance)
            // Degrees.
            .with("normal_jump_max", bicubic.angles.largest.to_degrees())
            .with("normal_jump_mean", bicubic.angles.mean.to_degrees())
            .with("normal_jump_of_spline", bicubic.angles.of_spline.to_degrees())
    }

    fn summary(&self, done: &Done) -> String {
        let bicubic = &self.bicubic;
        let [least, most] = bicubic.spans;
        format!(
            "patches  {}, {least} to {most} spans a side, {}\ndistance {:.2e} of the diagonal of the bounding box\nnormals  turn at common sides by {:.3} degrees at most, {:.4} in the mean; the spline's own by {:.3}\n{}wrote    {}\n",
            count(bicubic.surface.patches.len(), "bicubic patch", "bicubic patches"),
            if bicubic.surface.is_closed() { "closed" } else { "open" },
            bicubic.distance,
            bicubic.angles.largest.to_degrees(),
            bicubic.angles.mean.to_degrees(),
            bicubic.angles.of_spline.to_degrees(),
            done.checks.told(true),
            done.files[0],
        )
    }
}

fn step_options(args: &ExportArgs) -> StepOptions {
    let name = args.spline.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    StepOptions { name, unit: args.unit.length_unit(), colours: args.colours }
}
