//! The command from beginning to end.

use super::args::{HarmonicArgs, Target};
use super::files::{draw_sphere, write_sphere};
use super::found::{Found, Map};
use crate::delivery::Delivery;
use crate::failure::Failure;
use crate::input::{self, Input};
use crate::output::{check_extension, check_outputs};
use crate::progress::Progress;
use crate::report::{Done, Figures, InputSummary, Report};
use crate::say;
use ricci::Control;
use serde::Serialize;
use std::time::Instant;

/// Run the command and say what came out.
pub fn run(args: &HarmonicArgs, control: &Control) -> Result<u8, Failure> {
    let done = execute(args, control)?;
    if !args.common.quiet {
        let text = say::surface(&done.input) + &done.result.text() + &say::finish(&done, &done.result.failed);
        say::lines(&text, &done.files)?;
    }
    Ok(done.exit_code)
}

/// The exit code is 1 if a check fails or a file that was asked for has nothing to hold.
pub fn execute(args: &HarmonicArgs, control: &Control) -> Result<Done<Found>, Failure> {
    let start = Instant::now();
    check_request(args)?;
    let progress = Progress::watch(control, args.common.quiet);
    let input = input::surface(&args.surface, control)?;
    let usual = if input.mesh().is_closed() { Target::Sphere } else { Target::Disk };
    let to = args.to.clone().unwrap_or(usual);
    check_surface(args, &input, &to)?;
    let mut found = Found::new(&input, args, &to, control)?;
    let (files, figures) = write(args, (&input, &to), &mut found, Delivery::new(control, start)?)?;
    drop(progress);
    let checks = found.checks();
    let exit_code = if found.failed.0.is_empty() { checks.exit_code() } else { 1 };
    let seconds = start.elapsed().as_secs_f64();
    Ok(Done { input, result: found, figures, checks, files, seconds, exit_code })
}

/// What can be refused before anything is read.
fn check_request(args: &HarmonicArgs) -> Result<(), Failure> {
    check_extension("--uv", args.uv.as_deref(), &["obj", "glb"])?;
    check_extension("--sphere", args.sphere.as_deref(), &["obj", "glb"])?;
    check_extension("--picture", args.picture.picture.as_deref(), &["png", "svg"])?;
    let corners = args.corners.len();
    let refused = match &args.to {
        Some(Target::Polygon(None)) if corners < 3 => Some(
            "--to polygon: say how many corners it has, --to polygon:N, or which they are, --corners V,V,V,…"
                .into(),
        ),
        Some(Target::Polygon(Some(n))) if corners > 0 && corners != *n as usize => {
            Some(format!("--corners: {corners} boundary vertices for a polygon with {n} corners"))
        }
        Some(Target::Polygon(_)) => None,
        Some(Target::Rectangle) if corners == 0 || corners == 4 => None,
        Some(Target::Rectangle) => Some("--corners: four boundary vertices for --to rectangle".into()),
        _ if corners > 0 => Some("--corners: for --to polygon or --to rectangle".into()),
        _ => None,
    };
    if let Some(why) = refused {
        return Err(Failure::Usage(why));
    }
    let values = match &args.to {
        Some(Target::File(path)) => Some(&**path),
        _ => None,
    };
    let files = [
        args.uv.as_deref(),
        args.sphere.as_deref(),
        args.picture.picture.as_deref(),
        args.common.report.as_deref(),
    ];
    check_outputs(&[Some(&args.surface.file.mesh), values], &files)
}

/// What can be refused once the surface is known.
fn check_surface(args: &HarmonicArgs, input: &Input, to: &Target) -> Result<(), Failure> {
    let is_sphere = *to == Target::Sphere;
    let n = input.mesh().n_vertices();
    if let Some(v) = args.corners.iter().find(|v| **v as usize >= n) {
        return Err(Failure::Usage(format!("--corners: there is no vertex {v}, they are 0 to {}", n - 1)));
    }
    let mesh = input.mesh();
    let (loops, genus) = (mesh.boundary_loops().len(), mesh.genus());
    let needed = match to {
        Target::Sphere if loops > 0 || genus > 0 => Some("a closed surface of genus 0"),
        Target::Disk | Target::Polygon(_) | Target::Rectangle if loops != 1 || genus > 0 => {
            Some("a disk, of genus 0 with one boundary loop")
        }
        _ => None,
    };
    if let Some(needed) = needed {
        let path = input.path.display();
        let why = format!("the surface has genus {genus} and {loops} boundary loops; {needed} is needed");
        return Err(Failure::Input(format!("{path}: {why}")));
    }
    let in_space = input.positions().is_some();
    let drawn = args.picture.picture.is_some();
    let refused = [
        (is_sphere && args.uv.is_some(), "--uv: a sphere lies in no plane; use --sphere S.obj"),
        (!is_sphere && args.sphere.is_some(), "--sphere: the map is to the plane; use --uv, or --to sphere"),
        (is_sphere && args.picture.is_svg(), "--picture: an SVG shows no surface in space; use .png"),
        (args.uv.is_some() && !in_space, "--uv: an intrinsic metric has no positions in space"),
        (
            drawn && !in_space && !args.picture.is_svg() && !is_sphere,
            "--picture: an intrinsic metric has no positions in space; use .svg",
        ),
    ];
    match refused.into_iter().find(|(refused, _)| *refused) {
        Some((_, why)) => Err(Failure::Usage(why.into())),
        None => Ok(()),
    }
}

/// What was asked, defaults put in: a run with these options is this run.
#[derive(Serialize)]
struct Asked<'a> {
    input_geometry: &'static str,
    #[serde(flatten)]
    args: &'a HarmonicArgs,
    to: &'a Target,
}

/// Write every file that was asked for, the report last; returns their names and the figures. One that cannot be made keeps none of the
/// others back.
fn write(
    args: &HarmonicArgs,
    (input, to): (&Input, &Target),
    found: &mut Found,
    mut delivery: Delivery,
) -> Result<(Vec<String>, Figures), Failure> {
    let (mesh, sphere) = (args.uv.as_deref(), args.sphere.as_deref());
    let picture = args.picture.picture.as_deref();
    let outputs = &mut delivery.outputs;
    let (wish, written, drawn) = match &found.map {
        Map::Plane(plane) => {
            let input = found.input.as_ref().unwrap_or(input);
            let written = mesh.map_or(Ok(()), |path| plane.write(outputs, path, input));
            ("uv", written, delivery.picture(picture, || plane.draw(input, args)))
        }
        Map::Sphere(map) => {
            let written = sphere.map_or(Ok(()), |path| write_sphere(outputs, path, found, map));
            ("sphere", written, delivery.picture(picture, || draw_sphere(found, map, args)))
        }
    };
    found.failed.attempt(wish, written)?;
    found.failed.attempt("picture", drawn)?;
    delivery.close(&mut found.seconds);
    let figures = found.figures();
    let files = delivery.commit(args.common.report.as_deref(), || {
        let asked = Asked { input_geometry: input.surface.geometry().name(), args, to };
        let report = Report::new("harmonic", InputSummary::of(input), asked, figures.clone());
        report.finished(found.checks(), found.seconds)
    })?;
    Ok((files, figures))
}
