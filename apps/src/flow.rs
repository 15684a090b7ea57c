//! `ricci flow`.

use crate::charts;
use crate::circles::circles;
use crate::csv;
use crate::delivery::Delivery;
use crate::failure::Failure;
use crate::figures;
use crate::flow_args::{FlowArgs, PinChoice, TargetChoice};
use crate::flow_summary;
use crate::input::{self, Input};
use crate::job::{self, Job, Outcome, default_space};
use crate::metric_file::MetricFile;
use crate::options::{MethodChoice, OnChoice};
use crate::output::{self, Outputs, check_extension};
use crate::picture::ColorChoice;
use crate::progress::{Progress, doing};
use crate::report::{Done, Figures, InputSummary, Report, timed};
use crate::show;
use crate::uv;
use ricci::Control;
use ricci::flow::{Gradient, Options, Solution};
use ricci::geometry::Space;
use ricci::mesh::{Mesh, PerVertex, VertexId};
use ricci::metric::{Measured, Scheme, Target};
use ricci::parallel::Pool;
use serde::Serialize;
use std::path::Path;
use std::time::Instant;

/// Run the command and say what came out.
pub fn run(args: &FlowArgs, control: &Control) -> Result<u8, Failure> {
    let done = execute(args, control)?;
    if !args.to.common.quiet {
        flow_summary::say(&done)?;
    }
    Ok(done.exit_code)
}

/// Run the command; the exit code is 1 if a check fails or a file that was asked for has nothing to hold.
pub fn execute(args: &FlowArgs, control: &Control) -> Result<Done<Outcome>, Failure> {
    let start = Instant::now();
    check_request(args)?;
    // All that is divided among threads is so in one pool, which starts once.
    Pool::new(args.to.common.threads)?.run(|| execute_in_pool(args, start, control))
}

fn execute_in_pool(args: &FlowArgs, start: Instant, control: &Control) -> Result<Done<Outcome>, Failure> {
    let progress = Progress::watch(control, args.to.common.quiet);
    let input = input::surface(&args.to.surface, control)?;
    // Placed cones exist in E² alone.
    let automatic = matches!(args.target, Some(TargetChoice::Auto(_))).then_some(Space::E2);
    let space = args.space.space().or(automatic).unwrap_or_else(|| default_space(input.mesh()));
    check_surface(args, &input, space)?;
    let write_metric = |solution: &Solution, measured: &Measured, target: &PerVertex<f64>| {
        let (mut outputs, mut seconds) = (Outputs::default(), 0.0);
        let write = |path| {
            let file = MetricFile::of(solution, measured, target)?;
            outputs.add(path, |out| file.write(out))
        };
        let written = timed(&mut seconds, || args.to.metric.as_deref().map_or(Ok(()), write));
        (outputs, written, seconds)
    };
    let job = job(args, &input, space)?;
    let (mut outcome, (outputs, written, seconds)) = job::run(&input, job, control, write_metric)?;
    outcome.solved.seconds.write += seconds;
    outcome.solved.failed.attempt("metric", written)?;
    if args.charts {
        let cut = doing("cutting", || charts::cut(&mut outcome, args.margin, control));
        outcome.solved.failed.attempt("charts", cut)?;
    }
    let delivery = Delivery::new(control, start)?.with(outputs);
    let (files, figures) = write(args, &input, &mut outcome, delivery)?;
    drop(progress);
    let checks = outcome.checks();
    let exit_code = if outcome.solved.failed.0.is_empty() { checks.exit_code() } else { 1 };
    let seconds = start.elapsed().as_secs_f64();
    Ok(Done { input, result: outcome, figures, checks, files, seconds, exit_code })
}

/// What is computed.
fn job(args: &FlowArgs, input: &Input, space: Space) -> Result<Job, Failure> {
    let fixed_edges = match &args.keep_edges {
        Some(path) => csv::read_edges(path, input.mesh())?,
        None => Vec::new(),
    };
    if args.pin == Some(PinChoice::Boundary) && input.mesh().is_closed() {
        return Err(Failure::Usage("--pin boundary: a closed surface has none; name vertices".into()));
    }
    let pinned = args.pin.as_ref().map_or_else(Vec::new, |pin| pinned(pin, input.mesh()));
    let of_layout = [&args.to.uv, &args.circles, &args.picture.base.picture, &args.to.common.report];
    Ok(Job {
        space,
        scheme: args.to.solve.scheme.into(),
        target: args.target.as_ref().map(|t| target(t, input, space)).transpose()?,
        target_name: args.target.as_ref().map(ToString::to_string),
        options: Options { fixed_edges, pinned, ..options(args) },
        laid_out: args.charts || of_layout.iter().any(|path| path.is_some()),
    })
}

fn options(args: &FlowArgs) -> Options {
    let gradient = Gradient { area_normalised: args.area_normalised, ..Gradient::default() };
    Options { gradient, ..args.to.options() }
}

/// What can be refused before anything is read.
fn check_request(args: &FlowArgs) -> Result<(), Failure> {
    let newton = args.to.solve.method != MethodChoice::Gradient;
    let on_input = args.to.on == OnChoice::Input;
    let placed = matches!(args.target, Some(TargetChoice::Auto(_)));
    let refused = [
        (
            args.charts && args.circles.is_some(),
            "--circles: circles belong to the layout as a whole; leave --charts or --circles out",
        ),
        (
            on_input && (args.charts || args.homogeneous),
            "--on input: charts and homogeneous coordinates belong to the refinement; leave --on, or them, out",
        ),
        (
            args.picture.base.is_svg() && args.picture.base.is_turned(),
            "--view, --up: an SVG shows the layout alone; use .png, or leave them out",
        ),
        (args.margin >= 1.0, "--margin: a share of the unit square's side, in [0, 1)"),
        (
            args.pin.is_some() && placed,
            "--target auto chooses every curvature, --pin leaves some free; leave one out",
        ),
        (args.trace.is_some() && newton, "--trace records the gradient flow; add --method gradient"),
        (
            args.area_normalised && newton,
            "--area-normalised is a variant of the gradient flow; add --method gradient",
        ),
    ];
    if let Some((_, why)) = refused.into_iter().find(|(refused, _)| *refused) {
        return Err(Failure::Usage(why.into()));
    }
    let written: &[&str] = if args.homogeneous { &["obj"] } else { &["obj", "glb"] };
    let (to, picture) = (&args.to, args.picture.base.picture.as_deref());
    check_extension("--uv", to.uv.as_deref(), written)?;
    check_extension("--picture", picture, &["png", "svg"])?;
    let table = match &args.target {
        Some(TargetChoice::Cones(path) | TargetChoice::File(path)) => Some(path.as_path()),
        _ => None,
    };
    let files = [&to.metric, &to.uv, &to.xref, &args.circles, &args.trace, &to.common.report];
    let files: Vec<Option<&Path>> = files.map(|path| path.as_deref()).into_iter().chain([picture]).collect();
    output::check_outputs(&[Some(&to.surface.file.mesh), args.keep_edges.as_deref(), table], &files)
}

/// What can be refused once the surface is known.
fn check_surface(args: &FlowArgs, input: &Input, space: Space) -> Result<(), Failure> {
    let refuse = |why: String| Err(Failure::Usage(why));
    let scheme: Scheme = args.to.solve.scheme.into();
    let (on_sphere, in_space) = (space == Space::S2, input.positions().is_some());
    let picture = args.picture.base.picture.is_some();
    let color = args.picture.color().and_then(ColorChoice::of_layout).map(|name| format!("--color {name}"));
    let of_layout = [
        (args.to.uv.is_some(), "--uv"),
        (args.picture.zoom.is_some(), "--zoom"),
        (color.is_some(), color.as_deref().unwrap_or_default()),
        (picture && args.picture.base.is_svg(), "--picture: an SVG shows the layout alone"),
        (picture && !in_space, "--picture: an intrinsic metric has no positions in space"),
    ];
    if let Some((_, option)) = of_layout.into_iter().find(|(wanted, _)| *wanted && on_sphere) {
        return refuse(format!("{option}: ricci uniformize lays spheres out; use it, or --space e2"));
    }
    let in_plane = [
        (args.circles.is_some(), "--circles"),
        (args.charts, "--charts"),
        (args.homogeneous, "--homogeneous"),
    ];
    if let Some((_, option)) = in_plane.into_iter().find(|(wanted, _)| *wanted && space != Space::E2) {
        return refuse(format!(
            "{option}: layouts in {space} have none; use --space e2 (with --target single:V or cones:FILE.csv where \
             the surface needs cones)"
        ));
    }
    if args.circles.is_some() && scheme.epsilon() == 0 {
        return refuse(format!(
            "--circles: scheme {scheme} has no circles; use inversive, thurston, tangential or virtual"
        ));
    }
    if args.to.uv.is_some() && !in_space {
        return refuse("--uv: an intrinsic metric has no positions in space".into());
    }
    let n = input.mesh().n_vertices();
    match args.picture.zoom {
        Some(zoom) if zoom.vertex as usize >= n => {
            refuse(format!("--zoom: there is no vertex {}, they are 0 to {}", zoom.vertex, n - 1))
        }
        _ => Ok(()),
    }
}

fn target(choice: &TargetChoice, input: &Input, space: Space) -> Result<Target, Failure> {
    let n = input.mesh().n_vertices();
    Ok(match choice {
        TargetChoice::Auto(_) if [space, input.surface.geometry()] != [Space::E2; 2] => {
            return Err(Failure::Usage("--target auto: cones are placed in e2 only".into()));
        }
        TargetChoice::Uniform => Target::Uniform,
        TargetChoice::Boundary => Target::Boundary,
        TargetChoice::Single(v) => Target::Single(VertexId(*v)),
        TargetChoice::Auto(n) => Target::Auto(*n),
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

/// Write every file that was asked for but the metric, the report last; returns their names and the figures. One that cannot be made keeps
/// none of the others back.
fn write(
    args: &FlowArgs,
    input: &Input,
    outcome: &mut Outcome,
    mut delivery: Delivery,
) -> Result<(Vec<String>, Figures), Failure> {
    let outputs = &mut delivery.outputs;
    if let Some(path) = &args.trace {
        let written = outputs.add(path, |out| csv::write_trace(out, &outcome.report.trace));
        outcome.solved.failed.attempt("trace", written)?;
    }
    match &outcome.layout {
        Ok(laid) => {
            let solved = &mut outcome.solved;
            uv::write_asked(outputs, input, laid, (&args.to, args.homogeneous), solved)?;
            if let Some(path) = &args.circles {
                let all = circles(solved, laid).ok_or(Failure::Failed("the metric has no circles".into()));
                let written = all.and_then(|all| outputs.add_json(path, &all));
                solved.failed.attempt("circles", written)?;
            }
        }
        Err(why) => {
            let of_layout = [
                ("uv", args.to.uv.is_some()),
                ("xref", args.to.xref.is_some()),
                ("circles", args.circles.is_some()),
                ("charts", args.charts),
                ("picture", args.picture.base.is_svg()),
            ];
            let missing = of_layout.into_iter().filter(|(_, asked)| *asked);
            outcome.solved.failed.0.extend(missing.map(|(wish, _)| (wish, why.clone())));
        }
    }
    let drawable = outcome.layout.is_ok() || !args.picture.base.is_svg();
    let picture = args.picture.base.picture.as_deref().filter(|_| drawable);
    let drawn =
        delivery.picture(picture, || show::draw(input, outcome, &args.picture, args.to.common.threads));
    outcome.solved.failed.attempt("picture", drawn)?;
    delivery.close(&mut outcome.solved.seconds);
    let figures = figures::of_flow(input, outcome);
    let files = delivery.commit(args.to.common.report.as_deref(), || {
        let asked = Asked::new(args, input, outcome);
        let report = Report::new("flow", InputSummary::of(input), asked, figures.clone());
        report.finished(outcome.checks(), outcome.solved.seconds)
    })?;
    Ok((files, figures))
}

/// What was asked, defaults put in: a run with these options is this run.
#[derive(Serialize)]
struct Asked<'a> {
    space: &'static str,
    input_geometry: &'static str,
    target: String,
    pin: Vec<u32>,
    max_iterations: usize,
    #[serde(flatten)]
    args: &'a FlowArgs,
}

impl Asked<'_> {
    fn new<'a>(args: &'a FlowArgs, input: &Input, outcome: &Outcome) -> Asked<'a> {
        Asked {
            space: outcome.solved.solution.metric().space.name(),
            input_geometry: input.surface.geometry().name(),
            target: args.target.as_ref().map_or_else(|| rule_text(&outcome.rule), ToString::to_string),
            pin: outcome.pinned.iter().map(|v| v.0).collect(),
            max_iterations: options(args).iteration_limit(),
            args,
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
