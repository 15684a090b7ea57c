//! The command from beginning to end.

use super::args::FormsArgs;
use super::drawn;
use super::figures;
use super::file::FormsFile;
use super::found::Found;
use crate::delivery::Delivery;
use crate::failure::Failure;
use crate::input::{self, Input};
use crate::output::{check_extension, check_outputs};
use crate::progress::Progress;
use crate::report::{Done, Figures, InputSummary, Report};
use ricci::Control;
use serde::Serialize;
use std::time::Instant;

/// Run the command and say what came out.
pub fn run(args: &FormsArgs, control: &Control) -> Result<u8, Failure> {
    let done = execute(args, control)?;
    if !args.common.quiet {
        figures::say(&done)?;
    }
    Ok(done.exit_code)
}

/// The exit code is 1 if a check fails or a file that was asked for has nothing to hold.
pub fn execute(args: &FormsArgs, control: &Control) -> Result<Done<Found>, Failure> {
    let start = Instant::now();
    check_request(args)?;
    let progress = Progress::watch(control, args.common.quiet);
    let input = input::surface(&args.surface, control)?;
    check_surface(args, &input)?;
    let mut found = Found::new(&input, args, control)?;
    let (files, figures) = write(args, &input, &mut found, Delivery::new(control, start)?)?;
    drop(progress);
    let checks = found.checks();
    let exit_code = if found.failed.0.is_empty() { checks.exit_code() } else { 1 };
    let seconds = start.elapsed().as_secs_f64();
    Ok(Done { input, result: found, figures, checks, files, seconds, exit_code })
}

/// What can be refused before anything is read.
fn check_request(args: &FormsArgs) -> Result<(), Failure> {
    let picture = args.picture.picture.as_deref();
    check_extension("--uv", args.uv.as_deref(), &["obj", "glb"])?;
    check_extension("--picture", picture, &["png", "svg"])?;
    if !args.combination.is_empty() && args.combination.iter().all(|&x| x == 0.0) {
        let why =
            "--combination: the form 0 has no zeros and no trajectories; give a coefficient that is not 0";
        return Err(Failure::Usage(why.into()));
    }
    let in_space = args.show.is_some() || args.zoom.is_some() || args.picture.is_turned();
    if args.picture.is_svg() && in_space {
        let why = "--show, --zoom, --view, --up: an SVG shows the integral of the form alone; use .png, or leave them out";
        return Err(Failure::Usage(why.into()));
    }
    let files = [args.forms.as_deref(), args.uv.as_deref(), picture, args.common.report.as_deref()];
    check_outputs(&[Some(&args.surface.file.mesh)], &files)
}

/// What can be refused once the surface is known.
fn check_surface(args: &FormsArgs, input: &Input) -> Result<(), Failure> {
    let (mesh, in_space) = (input.mesh(), input.positions().is_some());
    let n = mesh.n_vertices();
    for (option, v) in [("--base", args.base), ("--zoom", args.zoom.map(|zoom| zoom.vertex))] {
        if let Some(v) = v.filter(|&v| v as usize >= n) {
            let why = format!("{option} {v}: there is no such vertex, they are 0 to {}", n - 1);
            return Err(Failure::Usage(why));
        }
    }
    let drawn = [
        (args.uv.is_some(), "--uv"),
        (args.picture.picture.is_some() && !args.picture.is_svg(), "--picture: as .png"),
    ];
    match drawn.into_iter().find(|(wanted, _)| *wanted && !in_space) {
        Some((_, option)) => {
            Err(Failure::Usage(format!("{option}: an intrinsic metric has no positions in space")))
        }
        None => Ok(()),
    }
}

/// What was asked, defaults put in: a run with these options is this run.
#[derive(Serialize)]
struct Asked<'a> {
    input_geometry: &'static str,
    base: u32,
    combination: &'a [f64],
    #[serde(flatten)]
    args: &'a FormsArgs,
}

/// Write every file that was asked for, the report last; returns their names and the figures. One that cannot be made keeps none of the
/// others back.
fn write(
    args: &FormsArgs,
    input: &Input,
    found: &mut Found,
    mut delivery: Delivery,
) -> Result<(Vec<String>, Figures), Failure> {
    if let Some(path) = &args.forms {
        let written = delivery.outputs.add_json(path, &FormsFile::new(found));
        found.failed.attempt("forms", written)?;
    }
    let none = || Failure::Failed("the surface has no harmonic form but 0".into());
    if let Some(path) = &args.uv {
        let chosen = found.chosen.as_ref().ok_or_else(none);
        let outputs = &mut delivery.outputs;
        let written = chosen.and_then(|chosen| drawn::write_uv(outputs, path, input, &chosen.layout));
        found.failed.attempt("uv", written)?;
    }
    let chosen = found.chosen.as_ref().ok_or_else(none);
    let control = delivery.control();
    let draw = || chosen.and_then(|chosen| drawn::draw(input, chosen, args, control));
    let drawn = delivery.picture(args.picture.picture.as_deref(), draw);
    found.failed.attempt("picture", drawn)?;
    delivery.close(&mut found.seconds);
    let figures = figures::of_forms(found);
    let files = delivery.commit(args.common.report.as_deref(), || {
        let asked = Asked {
            input_geometry: input.surface.geometry().name(),
            base: found.forms.basis.base.0,
            combination: found.chosen.as_ref().map_or(&[], |chosen| &chosen.coefficients),
            args,
        };
        let report = Report::new("forms", InputSummary::of(input), asked, figures.clone());
        report.finished(found.checks(), found.seconds)
    })?;
    Ok((files, figures))
}
