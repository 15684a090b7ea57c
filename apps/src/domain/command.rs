//! The command from beginning to end.

use super::args::CirclesArgs;
use super::figures::{of_domain, say};
use super::found::Found;
use super::picture;
use crate::carry::left_out;
use crate::delivery::Delivery;
use crate::failure::Failure;
use crate::input::{self, Input};
use crate::metric_file::MetricFile;
use crate::options::OnChoice;
use crate::output::{Outputs, check_extension, check_outputs};
use crate::picture::TextureChoice;
use crate::progress::Progress;
use crate::report::{Done, Figures, InputSummary, Report, timed};
use crate::uv;
use ricci::Control;
use ricci::canonical::{CircleDomainOptions, Normalisation, circle_domain};
use ricci::flow::Options;
use ricci::mesh::{PerVertex, VertexId};
use serde::Serialize;
use std::time::Instant;

/// Run the command and say what came out.
pub fn run(args: &CirclesArgs, control: &Control) -> Result<u8, Failure> {
    let done = execute(args, control)?;
    if !args.common.quiet {
        say(&done)?;
    }
    Ok(done.exit_code)
}

/// The exit code is 1 if a check fails or a file that was asked for has nothing to hold.
pub fn execute(args: &CirclesArgs, control: &Control) -> Result<Done<Found>, Failure> {
    let start = Instant::now();
    check_request(args)?;
    let progress = Progress::watch(control, args.common.quiet);
    let input = input::surface(&args.surface, control)?;
    check_surface(args, &input)?;
    let mut taken = 0.0;
    let domain = timed(&mut taken, || circle_domain(&input.surface, &options(args), control))?;
    let mut found = Found::new(&input, domain, taken)?;
    let (files, figures) = write(args, &input, &mut found, Delivery::new(control, start)?)?;
    drop(progress);
    let checks = found.checks(args.tolerance);
    let exit_code = if found.failed.0.is_empty() { checks.exit_code() } else { 1 };
    let seconds = start.elapsed().as_secs_f64();
    Ok(Done { input, result: found, figures, checks, files, seconds, exit_code })
}

/// What can be refused before anything is read.
fn check_request(args: &CirclesArgs) -> Result<(), Failure> {
    let picture = args.picture.picture.as_deref();
    check_extension("--uv", args.uv.as_deref(), &["obj", "glb"])?;
    check_extension("--picture", picture, &["png", "svg"])?;
    if args.picture.is_svg() && args.picture.is_turned() {
        let why = "--view, --up: an SVG shows the layout alone; use .png, or leave them out";
        return Err(Failure::Usage(why.into()));
    }
    let files = [
        args.metric.as_deref(),
        args.uv.as_deref(),
        args.xref.as_deref(),
        picture,
        args.common.report.as_deref(),
    ];
    check_outputs(&[Some(&args.surface.file.mesh)], &files)
}

/// What can be refused once the surface is known.
fn check_surface(args: &CirclesArgs, input: &Input) -> Result<(), Failure> {
    let mesh = input.mesh();
    if mesh.is_closed() {
        let path = input.path.display();
        return Err(Failure::Input(format!(
            "{path}: the surface is closed, it has no loops to make round; use ricci uniformize"
        )));
    }
    let (usage, n) = (|why: String| Err(Failure::Usage(why)), mesh.boundary_loops().len());
    if mesh.genus() > 0 {
        let of_disk = [
            ("--outer", args.outer.is_some()),
            ("--center", args.center.is_some()),
            ("--three", args.three.is_some()),
        ];
        if let Some((option, _)) = of_disk.iter().find(|(_, asked)| *asked) {
            let genus = mesh.genus();
            return usage(format!(
                "{option}: a surface of genus {genus} does not lie in the unit disk; leave it out"
            ));
        }
    }
    if let Some(k) = args.outer.filter(|&k| k >= n) {
        return usage(format!("--outer {k}: there is no such loop, they are 0 to {}", n - 1));
    }
    if args.uv.is_some() && input.positions().is_none() {
        return usage("--uv: an intrinsic metric has no positions in space".into());
    }
    Ok(())
}

fn options(args: &CirclesArgs) -> CircleDomainOptions {
    let normalisation = match (&args.three, args.center) {
        (Some(three), _) => {
            Normalisation::Three(three.vertices.map(VertexId), three.degrees.map(f64::to_radians))
        }
        (None, Some(v)) => Normalisation::Vertex(VertexId(v)),
        (None, None) => Normalisation::Centred,
    };
    let flow = Options {
        tolerance: args.tolerance,
        max_iterations: args.max_iterations as usize,
        threads: args.common.threads,
        ..Options::default()
    };
    CircleDomainOptions { outer: args.outer, normalisation, least_loop: args.least_loop, flow }
}

/// Write every file that was asked for, the report last; returns their names and the figures. One that cannot be made keeps none of the
/// others back.
fn write(
    args: &CirclesArgs,
    input: &Input,
    found: &mut Found,
    mut delivery: Delivery,
) -> Result<(Vec<String>, Figures), Failure> {
    let outputs = &mut delivery.outputs;
    if let Some(path) = &args.metric {
        let written = write_metric(outputs, path, found);
        found.failed.attempt("metric", written)?;
    }
    if let Some(path) = &args.uv {
        let faces = (OnChoice::Refined, false);
        let written = uv::write(outputs, path, &found.halved, &found.laid, faces);
        if let Some([vertices, faces]) = found.failed.attempt("uv", written)? {
            let [v, f] = [found.halved.mesh().n_vertices(), found.halved.mesh().n_faces()];
            found.added = [vertices + v - input.mesh().n_vertices(), faces + f - input.mesh().n_faces()];
        }
    }
    if let Some(path) = &args.xref {
        let (halved, laid) = (&found.halved, &found.laid);
        let written = outputs.add(path, |out| uv::write_origins(out, halved, laid, OnChoice::Refined));
        found.failed.attempt("xref", written)?;
    }
    let style = args.picture.style(args.texture.unwrap_or(TextureChoice::Circles), args.common.threads);
    let draw = || picture::draw(found, &style, args.picture.is_svg());
    let drawn = delivery.picture(args.picture.picture.as_deref(), draw);
    found.failed.attempt("picture", drawn)?;
    delivery.close(&mut found.seconds);
    let figures = of_domain(found).with("left_out", left_out(input));
    let files = delivery.commit(args.common.report.as_deref(), || {
        let asked = Asked::new(args, input, found);
        let report = Report::new("circles", InputSummary::of(input), asked, figures.clone());
        report.finished(found.checks(args.tolerance), found.seconds)
    })?;
    Ok((files, figures))
}

/// The metric of the surface with its disks; in the unit disk without the hub of the outer loop, whose disk lies outside.
fn write_metric(outputs: &mut Outputs, path: &std::path::Path, found: &Found) -> Result<(), Failure> {
    let domain = &found.domain;
    let target = PerVertex::filled(domain.metric.mesh().n_vertices(), 0.0);
    let file = MetricFile::new(&domain.metric, &target)?;
    let Some(outer) = domain.outer else { return outputs.add(path, |out| file.write(out)) };
    let file = file.without(domain.filled.hub(outer).index());
    let curvature = file.curvature();
    let file = file.free_on_boundary(&curvature);
    outputs.add(path, |out| file.write(out))
}

/// What was asked, defaults put in: a run with these options is this run.
#[derive(Serialize)]
struct Asked<'a> {
    input_geometry: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    outer: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    texture: Option<TextureChoice>,
    #[serde(flatten)]
    args: &'a CirclesArgs,
}

impl Asked<'_> {
    fn new<'a>(args: &'a CirclesArgs, input: &Input, found: &Found) -> Asked<'a> {
        let drawn = args.picture.picture.is_some();
        Asked {
            input_geometry: input.surface.geometry().name(),
            outer: found.domain.outer,
            texture: args.texture.or(drawn.then_some(TextureChoice::Circles)),
            args,
        }
    }
}
