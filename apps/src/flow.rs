//! `ricci flow`.

use crate::carry;
use crate::charts;
use crate::circles::circles;
use crate::csv;
use crate::failure::Failure;
use crate::figures::FlowResult;
use crate::flow_args::{FlowArgs, PinChoice, TargetChoice};
use crate::flow_summary;
use crate::input::{self, Input};
use crate::job::{self, Job, Outcome, default_space};
use crate::metric_file::MetricFile;
use crate::options::{FlipsChoice, MethodChoice, OnChoice, SchemeChoice};
use crate::output::{self, Outputs, check_extension, extension};
use crate::picture::{ColorChoice, FlowPictureArgs};
use crate::progress::Progress;
use crate::report::{Done, InputSummary, Report, Seconds, path_text};
use crate::show;
use crate::uv;
use ricci::Control;
use ricci::control::Stage;
use ricci::flow::{Gradient, Options};
use ricci::geometry::Space;
use ricci::mesh::{Mesh, VertexId};
use ricci::metric::{Scheme, Target};
use serde::Serialize;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Run the command and say what came out.
pub fn run(args: &FlowArgs, control: &Control) -> Result<u8, Failure> {
    let done = execute(args, control)?;
    if !args.common.quiet {
        flow_summary::say(&done);
    }
    Ok(done.exit_code)
}

/// Run the command; the exit code is 1 if a check fails or a file that was asked for has nothing to hold.
pub fn execute(args: &FlowArgs, control: &Control) -> Result<Done<Outcome>, Failure> {
    let start = Instant::now();
    check_request(args)?;
    let progress = Progress::watch(control, args.common.quiet);
    let input = input::read(&args.surface, control)?;
    // Placed cones exist in E² alone.
    let automatic = if matches!(args.target, Some(TargetChoice::Auto(_))) { Some(Space::E2) } else { None };
    let space = args.space.space().or(automatic).unwrap_or_else(|| default_space(input.mesh()));
    check_outputs(args, &input, space)?;
    let job = Job {
        space,
        scheme: args.solve.scheme.into(),
        target: args.target.as_ref().map(|t| target(t, &input, space, control)).transpose()?,
        options: Options {
            fixed_edges: match &args.keep_edges {
                Some(path) => csv::read_edges(path, input.mesh())?,
                None => Vec::new(),
            },
            pinned: args.pin.as_ref().map_or_else(Vec::new, |pin| pinned(pin, input.mesh())),
            ..options(args)
        },
        laid_out: args.charts
            || [&args.uv, &args.circles, &args.picture.base.picture, &args.common.report]
                .iter()
                .any(|path| path.is_some()),
    };
    let mut outcome = job::run(&input, job, control)?;
    if args.charts {
        let cut = charts::cut(&mut outcome, args.margin, control);
        outcome.failed.attempt("charts", cut)?;
    }
    let files = write(args, &input, &mut outcome, control, start)?;
    drop(progress);
    let checks = outcome.checks();
    let svg = args.picture.base.picture.as_ref().is_some_and(|p| show::is_svg(p));
    let missing = outcome.layout.is_err() && (args.uv.is_some() || args.circles.is_some() || svg);
    let exit_code = if missing || !outcome.failed.0.is_empty() { 1 } else { checks.exit_code() };
    Ok(Done { input, result: outcome, checks, files, seconds: start.elapsed().as_secs_f64(), exit_code })
}

fn options(args: &FlowArgs) -> Options {
    Options {
        gradient: Gradient { area_normalised: args.area_normalised, ..Gradient::default() },
        ..args.solve.options(args.common.threads())
    }
}

/// What can be refused before anything is read.
fn check_request(args: &FlowArgs) -> Result<(), Failure> {
    let usage = |message: &str| Err(Failure::Usage(message.into()));
    if args.charts && args.circles.is_some() {
        return usage("--circles: circles belong to the layout as a whole; leave --charts or --circles out");
    }
    if args.on == OnChoice::Input && (args.charts || args.homogeneous) {
        return usage(
            "--on input: charts and homogeneous coordinates belong to the refinement; leave --on, or them, out",
        );
    }
    if args.margin >= 1.0 {
        return usage("--margin: a share of the unit square's side, in [0, 1)");
    }
    if args.pin.is_some() && matches!(args.target, Some(TargetChoice::Auto(_))) {
        return usage("--target auto chooses every curvature, --pin leaves some free; leave one out");
    }
    if args.trace.is_some() && args.solve.method != MethodChoice::Gradient {
        return usage("--trace records the gradient flow; add --method gradient");
    }
    if args.area_normalised && args.solve.method != MethodChoice::Gradient {
        return usage("--area-normalised is a variant of the gradient flow; add --method gradient");
    }
    let written: &[&str] = if args.homogeneous { &["obj"] } else { &["obj", "glb"] };
    check_extension("--uv", args.uv.as_deref(), written)?;
    check_extension("--picture", args.picture.base.picture.as_deref(), &["png", "svg"])?;
    let table = match &args.target {
        Some(TargetChoice::Cones(path) | TargetChoice::File(path)) => Some(path.as_path()),
        _ => None,
    };
    let files =
        [&args.metric, &args.uv, &args.circles, &args.picture.base.picture, &args.trace, &args.common.report];
    output::check_outputs(
        &[Some(&args.surface.mesh), args.keep_edges.as_deref(), table],
        &files.map(|path| path.as_deref()),
    )
}

/// What can be refused once the surface is known.
fn check_outputs(args: &FlowArgs, input: &Input, space: Space) -> Result<(), Failure> {
    let laid_out = space != Space::S2;
    let missing = |option: &str| {
        let why = "ricci uniformize lays spheres out; use it, or --space e2";
        Err(Failure::Usage(format!("{option}: {why}")))
    };
    for (option, wanted) in [("--uv", args.uv.is_some()), ("--zoom", args.picture.zoom.is_some())] {
        if wanted && !laid_out {
            return missing(option);
        }
    }
    let in_plane = [
        ("--circles", args.circles.is_some()),
        ("--charts", args.charts),
        ("--homogeneous", args.homogeneous),
    ];
    for (option, wanted) in in_plane {
        if wanted && space != Space::E2 {
            return Err(Failure::Usage(format!(
                "{option}: layouts in {space} have none; use --space e2 (with --target single:V or cones:FILE.csv \
                 where the surface needs cones)"
            )));
        }
    }
    let scheme: Scheme = args.solve.scheme.into();
    if args.circles.is_some() && scheme.epsilon() == 0 {
        return Err(Failure::Usage(format!(
            "--circles: scheme {scheme} has no circles; use inversive, thurston, tangential or virtual"
        )));
    }
    if args.uv.is_some() && input.positions().is_none() {
        return Err(Failure::Usage("--uv: an intrinsic metric has no positions in space".into()));
    }
    if let Some(name) = args.picture.color().filter(|_| !laid_out).and_then(ColorChoice::of_layout) {
        return missing(&format!("--color {name}"));
    }
    if let Some(zoom) = args.picture.zoom {
        let n = input.mesh().n_vertices();
        if zoom.vertex as usize >= n {
            return Err(Failure::Usage(format!(
                "--zoom: there is no vertex {}, they are 0 to {}",
                zoom.vertex,
                n - 1
            )));
        }
    }
    if let Some(path) = args.picture.base.picture.as_ref().filter(|_| !laid_out) {
        let nothing = if extension(path) == "svg" {
            "an SVG shows the layout alone"
        } else if input.positions().is_none() {
            "an intrinsic metric has no positions in space"
        } else {
            return Ok(());
        };
        return missing(&format!("--picture: {nothing}"));
    }
    Ok(())
}

fn target(choice: &TargetChoice, input: &Input, space: Space, control: &Control) -> Result<Target, Failure> {
    let n = input.mesh().n_vertices();
    Ok(match choice {
        TargetChoice::Uniform => Target::Uniform,
        TargetChoice::Boundary => Target::Boundary,
        TargetChoice::Single(v) => Target::Single(VertexId(*v)),
        TargetChoice::Auto(n) => charts::auto_target(*n, input, space, control)?,
        TargetChoice::Cones(path) => Target::Cones(csv::read_curvatures(path, n)?),
        TargetChoice::File(path) => Target::All(csv::read_all_curvatures(path, n)?),
    })
}

fn pinned(choice: &PinChoice, mesh: &Mesh) -> Vec<VertexId> {
    match choice {
        PinChoice::Boundary => mesh.vertices().filter(|&v| mesh.is_boundary_vertex(v)).collect(),
        PinChoice::Vertices(list) => list.iter().map(|&v| VertexId(v)).collect(),
    }
}

/// Write every file that was asked for, the report last; returns their names. One that cannot be made keeps none of the others back.
fn write(
    args: &FlowArgs,
    input: &Input,
    outcome: &mut Outcome,
    control: &Control,
    start: Instant,
) -> Result<Vec<String>, Failure> {
    control.step(Stage::Write, 0.0)?;
    let mut outputs = Outputs::default();
    let begin = Instant::now();
    if let Some(path) = &args.metric {
        let written = write_metric(&mut outputs, path, outcome);
        outcome.failed.attempt("metric", written)?;
    }
    if let Some(path) = &args.trace {
        let written = outputs.add(path, |out| csv::write_trace(out, &outcome.report.trace));
        outcome.failed.attempt("trace", written)?;
    }
    control.check()?;
    if let (Some(path), Ok(laid)) = (&args.uv, &outcome.layout) {
        let written = uv::write(&mut outputs, path, input, laid, (args.on, args.homogeneous));
        if outcome.failed.attempt("uv", written)?.is_some() {
            outcome.left_out = carry::left_out(input);
        }
    }
    control.check()?;
    let drawable = |path: &&PathBuf| outcome.layout.is_ok() || !show::is_svg(path);
    if let Some(path) = args.picture.base.picture.as_ref().filter(drawable) {
        let threads = args.common.threads();
        let written = outputs.add(path, |out| show::draw(out, path, input, outcome, &args.picture, threads));
        outcome.failed.attempt("picture", written)?;
    }
    let Outcome { mesh, metric, scheme, .. } = &*outcome;
    let all = outcome.layout.as_ref().ok().and_then(|laid| circles(mesh, metric, scheme.name(), laid));
    if let (Some(path), Some(all)) = (&args.circles, all) {
        let written = outputs.add_json(path, &all);
        outcome.failed.attempt("circles", written)?;
    }
    outcome.seconds.write += begin.elapsed().as_secs_f64();
    control.step(Stage::Write, 0.5)?;
    let mut report_failed = Ok(());
    if let Some(path) = &args.common.report {
        let seconds = Seconds { total: start.elapsed().as_secs_f64(), ..outcome.seconds };
        let asked = Asked::new(args, input, outcome);
        report_failed = outputs.add_report(path, &report(input, outcome, asked, seconds));
    }
    control.check()?;
    let files = outputs.commit()?.iter().map(|p| path_text(p)).collect();
    report_failed.map(|()| files)
}

fn write_metric(outputs: &mut Outputs, path: &Path, outcome: &Outcome) -> Result<(), Failure> {
    let Outcome { mesh, scheme, metric, lengths, final_target, mirror, .. } = outcome;
    let factor = outcome.initial.conformal_factor(metric)?;
    let lost = metric.length_remainders(mesh)?;
    let file =
        MetricFile::new(mesh, *scheme, metric, [lengths, &lost], &factor, final_target, mirror.as_deref());
    outputs.add_json(path, &file)
}

/// What was asked, defaults put in: a run with these options is this run.
#[derive(Serialize)]
pub struct Asked {
    weld: Option<f64>,
    space: &'static str,
    scheme: SchemeChoice,
    target: String,
    method: MethodChoice,
    area_normalised: bool,
    pin: Vec<u32>,
    flips: FlipsChoice,
    keep_edges: Option<String>,
    tolerance: f64,
    max_iterations: usize,
    input_geometry: &'static str,
    threads: usize,
    metric: Option<String>,
    uv: Option<String>,
    on: OnChoice,
    circles: Option<String>,
    #[serde(flatten)]
    picture: FlowPictureArgs,
    homogeneous: bool,
    charts: bool,
    margin: f64,
    trace: Option<String>,
}

impl Asked {
    fn new(args: &FlowArgs, input: &Input, outcome: &Outcome) -> Self {
        let text = |path: &Option<PathBuf>| path.as_deref().map(path_text);
        Asked {
            weld: args.surface.weld,
            space: outcome.metric.space.name(),
            scheme: args.solve.scheme,
            target: args.target.as_ref().map_or_else(|| rule_text(&outcome.rule), ToString::to_string),
            method: args.solve.method,
            area_normalised: args.area_normalised,
            pin: outcome.pinned.iter().map(|v| v.0).collect(),
            flips: args.solve.flips,
            keep_edges: text(&args.keep_edges),
            tolerance: args.solve.tolerance,
            max_iterations: options(args).iteration_limit(),
            input_geometry: input.surface.geometry().name(),
            threads: args.common.threads(),
            metric: text(&args.metric),
            uv: text(&args.uv),
            on: args.on,
            circles: text(&args.circles),
            picture: args.picture.clone(),
            homogeneous: args.homogeneous,
            charts: args.charts,
            margin: args.margin,
            trace: text(&args.trace),
        }
    }
}

/// A default target: its rule, with the cones that were chosen.
fn rule_text(rule: &Target) -> String {
    match rule {
        Target::Cones(cones) if !cones.is_empty() => {
            let named = cones.iter().map(|(v, k)| format!("{v},{k}"));
            format!("cones:{}", named.collect::<Vec<_>>().join(";"))
        }
        rule => rule.name().into(),
    }
}

/// The report of a flow.
pub fn report<O: Serialize>(
    input: &Input,
    outcome: &Outcome,
    asked: O,
    seconds: Seconds,
) -> Report<O, FlowResult> {
    Report::new("flow", InputSummary::of(input), asked, FlowResult::new(input, outcome))
        .finished(outcome.checks(), seconds)
}
