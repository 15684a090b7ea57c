//! `ricci spline export`.

use super::args::{ExportArgs, Unit};
use crate::failure::Failure;
use crate::output::{Outputs, check_extension, check_outputs, extension};
use crate::progress::Progress;
use crate::report::{Checks, Figures, Report, Seconds, timed};
use crate::say::{self, count};
use ricci::Control;
use ricci::spline::{Bicubic, BicubicOptions, LengthUnit, Spline, StepOptions};
use std::time::Instant;

/// Largest angle, in degrees, between the normals of neighbouring patches: a designer sees more in reflections.
const NORMAL_JUMP: f64 = 1.0;

/// Write bicubic patches near a spline. The exit code is 1 if a check fails.
pub fn export(args: &ExportArgs, control: &Control) -> Result<u8, Failure> {
    let start = Instant::now();
    check_extension("-o", Some(&args.out), &["step", "stp", "json"])?;
    check_outputs(&[Some(&args.spline)], &[Some(&*args.out), args.common.report.as_deref()])?;
    let progress = Progress::watch(control, args.common.quiet);
    let mut seconds = Seconds::default();
    let spline = timed(&mut seconds.read, || Spline::read(&args.spline))?;
    let options = BicubicOptions {
        tolerance: args.tolerance,
        threads: args.common.threads,
        ..BicubicOptions::default()
    };
    let found = timed(&mut seconds.solve, || spline.to_bicubic(&options, control))?;
    let checks = checks(args, &found);
    let mut outputs = Outputs::default();
    timed(&mut seconds.write, || -> Result<(), Failure> {
        let mut bytes = Vec::new();
        if extension(&args.out) == "json" {
            found.surface.write_json(&mut bytes).map_err(|why| Failure::Input(why.to_string()))?;
        } else {
            found.surface.write_step(&step_options(args), &mut bytes)?;
        }
        outputs.add_bytes(&args.out, &bytes)
    })?;
    if let Some(path) = &args.common.report {
        seconds.total = start.elapsed().as_secs_f64();
        let report = Report::new("spline", None, args, figures(&spline, &found));
        outputs.add_report(path, &report.finished(checks.clone(), seconds))?;
    }
    control.check()?;
    let files = outputs.commit()?;
    drop(progress);
    if !args.common.quiet {
        say::lines(&text(args, &found, &checks), &files)?;
    }
    Ok(checks.exit_code())
}

fn step_options(args: &ExportArgs) -> StepOptions {
    let unit = match args.unit {
        Unit::Mm => LengthUnit::Millimetre,
        Unit::M => LengthUnit::Metre,
    };
    let name = args.spline.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    StepOptions { name, unit }
}

fn checks(args: &ExportArgs, found: &Bicubic) -> Checks {
    let mut checks = Checks::default();
    checks.add("distance", found.distance, args.tolerance);
    checks.add("normal_jump", found.angles.largest.to_degrees(), NORMAL_JUMP);
    checks.add("open_sides", found.surface.open_sides() as f64, 0.0);
    checks
}

fn figures(spline: &Spline, found: &Bicubic) -> Figures {
    let surface = &found.surface;
    Figures::default()
        .with("degree", spline.space().degree())
        .with("patches", spline.space().patches().len())
        .with("bicubic_patches", surface.patches.len())
        .with("curves", surface.curves.len())
        .with("control_points", surface.n_control_points())
        .with("spans_min", found.spans[0])
        .with("spans_max", found.spans[1])
        .with("rounds", found.rounds)
        .with("closed", surface.is_closed())
        .with("diagonal", found.diagonal)
        // A fraction of the diagonal of the bounding box.
        .with("distance", found.distance)
        // Degrees.
        .with("normal_jump_max", found.angles.largest.to_degrees())
        .with("normal_jump_mean", found.angles.mean.to_degrees())
        .with("normal_jump_of_spline", found.angles.of_spline.to_degrees())
}

fn text(args: &ExportArgs, found: &Bicubic, checks: &Checks) -> String {
    let failed = checks.failed();
    let [least, most] = found.spans;
    format!(
        "patches  {}, {least} to {most} spans a side, {}\ndistance {:.2e} of the diagonal of the bounding box\nnormals  turn at common sides by {:.3} degrees at most, {:.4} in the mean; the spline's own by {:.3}\nchecks   {}\nwrote    {}\n",
        count(found.surface.patches.len(), "bicubic patch", "bicubic patches"),
        if found.surface.is_closed() { "closed" } else { "open" },
        found.distance,
        found.angles.largest.to_degrees(),
        found.angles.mean.to_degrees(),
        found.angles.of_spline.to_degrees(),
        if failed.is_empty() { "all hold".into() } else { format!("FAILED: {}", failed.join(", ")) },
        args.out.display(),
    )
}
