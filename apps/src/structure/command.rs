//! The command from beginning to end.

use super::args::{SourceChoice, StructureArgs};
use super::drawn;
use super::figures::{self, Found};
use super::file::AtlasFile;
use crate::delivery::Delivery;
use crate::failure::Failure;
use crate::input::{self, Input};
use crate::options::FlipsChoice;
use crate::output::{check_extension, check_outputs};
use crate::progress::{Progress, doing};
use crate::report::{Attempts, Done, Figures, InputSummary, Report, timed};
use ricci::Control;
use ricci::flow;
use ricci::mesh::VertexId;
use ricci::structure::{AtlasOptions, atlas};
use serde::Serialize;
use std::time::Instant;

/// Run the command and say what came out; the exit code is 1 if a check fails or a file that was asked for could not be made.
pub fn run(args: &StructureArgs, control: &Control) -> Result<u8, Failure> {
    let done = execute(args, control)?;
    if !args.common.quiet {
        figures::say(&done)?;
    }
    Ok(done.exit_code)
}

/// The command without its summary.
pub fn execute(args: &StructureArgs, control: &Control) -> Result<Done<Found>, Failure> {
    let start = Instant::now();
    check_request(args)?;
    let progress = Progress::watch(control, args.common.quiet);
    let mut input = input::surface(&args.surface, control)?;
    check_surface(args, &input)?;
    let mut seconds = input.seconds;
    let options = AtlasOptions {
        structure: args.kind.into(),
        charts: args.charts.into(),
        radius: args.radius,
        source: args.from.into(),
        singular: args.singular.map(VertexId),
        flow: flow::Options {
            threads: args.common.threads,
            flips: args.flips.into(),
            ..flow::Options::default()
        },
    };
    let found = timed(&mut seconds.solve, || doing("atlas", || atlas(&input.surface, &options, control)))?;
    input.seconds = seconds;
    let mut found = Found { atlas: found, failed: Attempts::default() };
    let (files, figures) = write(args, &mut input, &mut found, Delivery::new(control, start)?)?;
    drop(progress);
    let checks = found.checks();
    let exit_code = if found.failed.0.is_empty() { checks.exit_code() } else { 1 };
    let seconds = start.elapsed().as_secs_f64();
    Ok(Done { input, result: found, figures, checks, files, seconds, exit_code })
}

/// What can be refused before anything is read.
fn check_request(args: &StructureArgs) -> Result<(), Failure> {
    if matches!((args.from, args.flips), (SourceChoice::Form, FlipsChoice::Never)) {
        let why = "--flips is for the flow, and a structure from a 1-form has none: leave it out";
        return Err(Failure::Usage(why.into()));
    }
    let picture = args.picture.picture.as_deref();
    check_extension("--picture", picture, &["png"])?;
    let files = [args.atlas.as_deref(), picture, args.common.report.as_deref()];
    check_outputs(&[Some(&args.surface.file.mesh)], &files)
}

/// What can be refused once the surface is known.
fn check_surface(args: &StructureArgs, input: &Input) -> Result<(), Failure> {
    let n = input.mesh().n_vertices();
    if let Some(v) = args.singular.filter(|&v| v as usize >= n) {
        return Err(Failure::Usage(format!(
            "--singular {v}: there is no such vertex, they are 0 to {}",
            n - 1
        )));
    }
    if args.picture.picture.is_some() && input.positions().is_none() {
        return Err(Failure::Usage("--picture: an intrinsic metric has no positions in space".into()));
    }
    Ok(())
}

/// What was asked, defaults put in: a run with these options is this run.
#[derive(Serialize)]
struct Asked<'a> {
    input_geometry: &'static str,
    singular: Option<u32>,
    #[serde(flatten)]
    args: &'a StructureArgs,
}

/// Write every file that was asked for, the report last; returns their names and the figures. One that cannot be made keeps none of the
/// others back.
fn write(
    args: &StructureArgs,
    input: &mut Input,
    found: &mut Found,
    mut delivery: Delivery,
) -> Result<(Vec<String>, Figures), Failure> {
    if let Some(path) = &args.atlas {
        let written = delivery.outputs.add_json(path, &AtlasFile::new(&found.atlas));
        found.failed.attempt("atlas", written)?;
    }
    let control = delivery.control();
    let draw = || drawn::draw(input, &found.atlas, args, control);
    let drawn = delivery.picture(args.picture.picture.as_deref(), draw);
    found.failed.attempt("picture", drawn)?;
    delivery.close(&mut input.seconds);
    let figures = figures::of_structure(&found.atlas);
    let files = delivery.commit(args.common.report.as_deref(), || {
        let singular = || found.atlas.singular_vertices.first().map(|v| v.0);
        let has_one = args.singular.is_some() || found.atlas.singular_vertices.len() == 1;
        let asked = Asked {
            input_geometry: input.surface.geometry().name(),
            singular: has_one.then(singular).flatten(),
            args,
        };
        let report = Report::new("structure", InputSummary::of(input), asked, figures.clone());
        report.finished(found.checks(), input.seconds)
    })?;
    Ok((files, figures))
}
