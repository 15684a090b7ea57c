//! `ricci spline fit`.

use super::args::FitArgs;
use super::found::Found;
use super::planar::fit_planar;
use super::whole::fit_whole;
use crate::failure::Failure;
use crate::input::{self, Input};
use crate::options::MeshArgs;
use crate::output::{Outputs, check_extension, check_outputs};
use crate::progress::Progress;
use crate::report::{Checks, Figures, InputSummary, Report, Seconds, timed};
use crate::say::{self, count};
use ricci::Control;
use ricci::spline::Identities;
use serde::Serialize;
use serde_json::{Map, Value};
use std::io::Write;
use std::time::Instant;

/// Limits of the checks: identities of exact arithmetic, which doubles keep to this.
const UNITY: f64 = 1e-12;
const REPRODUCTION: f64 = 1e-10;
const CONTINUITY: f64 = 1e-8;

/// What was asked, defaults put in.
#[derive(Serialize)]
struct Asked<'a> {
    #[serde(flatten)]
    args: &'a FitArgs,
    #[serde(flatten)]
    defaults: &'a Map<String, Value>,
}

/// Fit a spline to a mesh. The exit code is 1 if a check fails.
pub fn fit(args: &FitArgs, control: &Control) -> Result<u8, Failure> {
    let start = Instant::now();
    check_extension("-o", Some(&args.out), &["json"])?;
    check_outputs(&[Some(&args.mesh)], &[Some(&*args.out), args.common.report.as_deref()])?;
    let progress = Progress::watch(control, args.common.quiet);
    let file = MeshArgs { mesh: args.mesh.clone(), weld: None };
    let input = input::read(&file, None, control)?;
    let mut seconds = Seconds { ..input.seconds };
    let mut found = timed(&mut seconds.solve, || match args.planar {
        true => fit_planar(args, &input, control),
        false => fit_whole(args, &input, control),
    })?;
    let identities = found.spline.identities(args.common.threads, control)?;
    check(&mut found.checks, &identities);
    let figures = figures(&found, &identities);
    let mut outputs = Outputs::default();
    timed(&mut seconds.write, || {
        outputs.add(&args.out, |out| out.write_all(found.spline.to_json().as_bytes()))
    })?;
    let text = text(args, &input, &found);
    if let Some(path) = &args.common.report {
        seconds.total = start.elapsed().as_secs_f64();
        let asked = Asked { args, defaults: &found.defaults };
        let report = Report::new("spline", InputSummary::of(&input), asked, figures);
        outputs.add_report(path, &report.finished(found.checks.clone(), seconds))?;
    }
    control.check()?;
    let files = outputs.commit()?;
    drop(progress);
    if !args.common.quiet {
        say::lines(&text, &files)?;
    }
    Ok(found.checks.exit_code())
}

fn figures(found: &Found, identities: &Identities) -> Figures {
    let space = found.spline.space();
    let figures = Figures::default()
        .with("degree", space.degree())
        .with("patches", space.patches().len())
        .with("control_points", space.n_control_points())
        // Fractions of the diagonal of the bounding box.
        .with("rms", found.rms)
        .with("max", found.max)
        .with("partition_of_unity", identities.partition_of_unity)
        .if_some("polynomial_reproduction", identities.polynomial_reproduction)
        .with("continuity", identities.continuity)
        // Sides between patches, at corners of the boundary, across which the spline is less smooth.
        .with("rough_sides", identities.rough_sides);
    figures.and(&found.figures)
}

fn check(checks: &mut Checks, identities: &Identities) {
    checks.add("partition_of_unity", identities.partition_of_unity, UNITY);
    if let Some(error) = identities.polynomial_reproduction {
        checks.add("polynomial_reproduction", error, REPRODUCTION);
    }
    checks.add("continuity", identities.continuity, CONTINUITY);
}

fn text(args: &FitArgs, input: &Input, found: &Found) -> String {
    let space = found.spline.space();
    let failed = found.checks.failed();
    let holes = found.spline.holes().len();
    let filled =
        if holes > 0 { format!(", {}", count(holes, "filled hole", "filled holes")) } else { String::new() };
    format!(
        "{}spline   degree {}, {}, {}{filled}\nfit      root mean square {:.2e}, largest {:.2e} of the diagonal of the bounding box\nchecks   {}\nwrote    {}\n",
        say::surface(input),
        args.degree,
        count(space.patches().len(), "patch", "patches"),
        count(space.n_control_points(), "control point", "control points"),
        found.rms,
        found.max,
        if failed.is_empty() { "all hold".into() } else { format!("FAILED: {}", failed.join(", ")) },
        args.out.display(),
    )
}
