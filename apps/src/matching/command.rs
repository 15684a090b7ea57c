//! The command from beginning to end.

use super::args::{MatchArgs, ShowChoice};
use super::files::{write_carried, write_map, write_moved, write_overlay, write_places};
use super::found::{Found, say};
use super::marks;
use super::pictures::draw;
use crate::csv;
use crate::delivery::Delivery;
use crate::failure::Failure;
use crate::input::{self, Input};
use crate::options::MeshArgs;
use crate::output::{check_extension, check_outputs};
use crate::progress::{Progress, doing};
use crate::report::{Done, Figures, InputSummary, Report, timed};
use ricci::Control;
use ricci::flow;
use ricci::matching::{MatchOptions, match_surfaces};
use std::time::Instant;

/// Run the command and say what came out.
pub fn run(args: &MatchArgs, control: &Control) -> Result<u8, Failure> {
    let done = execute(args, control)?;
    if !args.common.quiet {
        crate::say::lines(&say(&done), &done.files)?;
    }
    Ok(done.exit_code)
}

/// The exit code is 1 if a check fails or a file that was asked for could not be made.
pub fn execute(args: &MatchArgs, control: &Control) -> Result<Done<Found>, Failure> {
    let start = Instant::now();
    check_request(args)?;
    let progress = Progress::watch(control, args.common.quiet);
    let input = input::read(&args.source, None, control)?;
    let target = input::read(&MeshArgs { mesh: args.target.clone(), weld: args.source.weld }, None, control)?;
    check_surfaces(args, [&input, &target])?;
    let counts = [input.mesh().n_vertices(), target.mesh().n_vertices()];
    let landmarks =
        args.landmarks.as_deref().map_or(Ok(Vec::new()), |path| csv::read_landmarks(path, counts))?;
    let meshes = [input.mesh(), target.mesh()];
    let options = MatchOptions {
        landmarks: landmarks.clone(),
        points: args.points.as_deref().map_or(Ok(Vec::new()), |path| marks::read_points(path, meshes))?,
        soft: args.soft.as_deref().map_or(Ok(Vec::new()), |path| marks::read_soft(path, meshes))?,
        curves: args.curves.as_deref().map_or(Ok(Vec::new()), |path| marks::read_curves(path, meshes))?,
        basis: args.basis.as_deref().map_or(Ok(Vec::new()), |path| marks::read_basis(path, meshes))?,
        loops: (!args.loops.is_empty()).then(|| args.loops.clone()),
        boundary: args.boundary.into(),
        loop_shape: args.loop_shape.into(),
        flow: flow::Options { threads: args.common.threads, ..flow::Options::default() },
    };
    let mut seconds = input.seconds;
    let matching = timed(&mut seconds.solve, || {
        doing("matching", || match_surfaces(&input.surface, &target.surface, &options, control))
    })?;
    let mut found = Found::new(&input, target, matching, (landmarks, args.same_numbering))?;
    if args.overlay.is_some() || args.overlay_places.is_some() {
        let overlay = timed(&mut seconds.solve, || {
            let threads = args.common.threads;
            doing("overlay", || found.matching.domain.overlay(threads, control).map_err(Failure::from))
        });
        if let Some(overlay) = found.failed.attempt("overlay", overlay)? {
            found.lay_over(&input, overlay)?;
        }
    }
    found.seconds = seconds;
    let (files, figures) = write(args, &input, &mut found, Delivery::new(control, start)?)?;
    drop(progress);
    let checks = found.checks();
    let exit_code = if found.failed.0.is_empty() { checks.exit_code() } else { 1 };
    let seconds = start.elapsed().as_secs_f64();
    Ok(Done { input, result: found, figures, checks, files, seconds, exit_code })
}

/// What can be refused before anything is read.
fn check_request(args: &MatchArgs) -> Result<(), Failure> {
    check_extension("--output", args.output.as_deref(), &["obj", "glb"])?;
    check_extension("--carried", args.carried.as_deref(), &["obj", "glb"])?;
    check_extension("--overlay", args.overlay.as_deref(), &["obj", "glb"])?;
    check_extension("--domains", args.domains.as_deref(), &["png"])?;
    check_extension("--heat", args.heat.as_deref(), &["png"])?;
    check_extension("--picture", args.picture.picture.as_deref(), &["png"])?;
    let files = [
        args.map.as_deref(),
        args.back.as_deref(),
        args.output.as_deref(),
        args.carried.as_deref(),
        args.overlay.as_deref(),
        args.overlay_places.as_deref(),
        args.domains.as_deref(),
        args.heat.as_deref(),
        args.picture.picture.as_deref(),
        args.common.report.as_deref(),
    ];
    let inputs = [
        Some(args.source.mesh.as_path()),
        Some(args.target.as_path()),
        args.landmarks.as_deref(),
        args.points.as_deref(),
        args.soft.as_deref(),
        args.curves.as_deref(),
        args.basis.as_deref(),
    ];
    check_outputs(&inputs, &files)
}

/// What can be refused once the surfaces are known.
fn check_surfaces(args: &MatchArgs, surfaces: [&Input; 2]) -> Result<(), Failure> {
    if let Some(input) = surfaces.iter().find(|input| input.positions().is_none()) {
        let path = input.path.display();
        return Err(Failure::Input(format!(
            "{path}: an intrinsic metric has no positions to measure the map by"
        )));
    }
    let [n, m] = surfaces.map(|input| input.mesh().n_vertices());
    if args.same_numbering && n != m {
        return Err(Failure::Usage(format!("--same-numbering: the source has {n} vertices, the target {m}")));
    }
    Ok(())
}

/// Write every file that was asked for, the report last; returns their names and the figures. One that cannot be made keeps none of the
/// others back.
fn write(
    args: &MatchArgs,
    input: &Input,
    found: &mut Found,
    mut delivery: Delivery,
) -> Result<(Vec<String>, Figures), Failure> {
    let outputs = &mut delivery.outputs;
    if let Some(path) = &args.map {
        let written = write_map(outputs, path, &found.matching.forward);
        found.failed.attempt("map", written)?;
    }
    if let Some(path) = &args.back {
        let written = write_map(outputs, path, &found.matching.backward);
        found.failed.attempt("back", written)?;
    }
    if let Some(path) = &args.output {
        let written = write_moved(outputs, path, input, found);
        found.failed.attempt("output", written)?;
    }
    if let Some(path) = &args.carried {
        let written = write_carried(outputs, path, input, found);
        found.failed.attempt("carried", written)?;
    }
    if let Some(overlay) = &found.overlay {
        if let Some(path) = &args.overlay {
            let written = write_overlay(outputs, path, input, (found, overlay));
            found.failed.attempt("overlay", written)?;
        }
        if let Some(path) = &args.overlay_places {
            let written = write_places(outputs, path, overlay);
            found.failed.attempt("overlay_places", written)?;
        }
    }
    let pictures = [
        ("picture", args.picture.picture.as_deref(), args.show.unwrap_or(ShowChoice::Carried)),
        ("domains", args.domains.as_deref(), ShowChoice::Domains),
        ("heat", args.heat.as_deref(), ShowChoice::Heat),
    ];
    for (name, path, show) in pictures {
        let drawn = delivery.picture(path, || draw(show, input, found, args));
        found.failed.attempt(name, drawn)?;
    }
    delivery.close(&mut found.seconds);
    let figures = found.figures();
    let files = delivery.commit(args.common.report.as_deref(), || {
        let surfaces = InputSummary::of(input).with_target(InputSummary::of(&found.target));
        let report = Report::new("match", surfaces, args, figures.clone());
        report.finished(found.checks(), found.seconds)
    })?;
    Ok((files, figures))
}
