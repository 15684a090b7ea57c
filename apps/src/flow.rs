//! `ricci flow` as a job: what it refuses, computes, writes and reports.

use crate::charts;
use crate::circle_file::CircleFile;
use crate::csv;
use crate::failure::{Failure, NO_POSITIONS};
use crate::flat::FlatLayout;
use crate::flow_args::{FlowArgs, PinChoice, StepsChoice, TargetChoice};
use crate::input::{self, Input};
use crate::job::{FlowJob, FlowOutcome, default_space, run_flow};
use crate::options::{MethodChoice, OnChoice};
use crate::output::{check_extension, check_outputs};
use crate::picture::ColorChoice;
use crate::progress::doing;
use crate::report::timed;
use crate::runner::{CommandRun, Job, JobHeader};
use crate::show;
use crate::surface_layout::{OwnFaces, SurfaceLayout};
use crate::uv;
use ricci::flow::{Gradient, Options, StepRule};
use ricci::geometry::Space;
use ricci::mesh::{Mesh, VertexId};
use ricci::metric::{Scheme, Target};
use serde::Serialize;

impl Job for FlowArgs {
    type Outcome = FlowOutcome;

    fn header(&self) -> JobHeader<'_> {
        JobHeader { name: "flow", common: &self.to.common, mesh: Some(&self.to.surface.file.mesh) }
    }

    fn check(&self) -> Result<(), Failure> {
        check_options(self)?;
        self.to.check_faces()?;
        let written: &[&str] = if self.homogeneous { &["obj"] } else { &["obj", "glb"] };
        let (to, picture) = (&self.to, &self.picture.base.picture);
        check_extension("--uv", to.uv.as_deref(), written)?;
        check_extension("--picture", picture.as_deref(), &["png", "svg"])?;
        to.flat.check()?;
        let table = match &self.target {
            Some(TargetChoice::Cones(path) | TargetChoice::File(path)) => Some(path.as_path()),
            _ => None,
        };
        let files = [
            &to.metric,
            &to.uv,
            &to.xref,
            &to.flat.flat,
            &self.circles,
            &self.trace,
            &to.common.report,
            picture,
        ];
        let inputs = [Some(to.surface.file.mesh.as_path()), self.keep_edges.as_deref(), table];
        check_outputs(&inputs, &files.map(|file| file.as_deref()))
    }

    fn compute(&self, run: &mut CommandRun<'_>) -> Result<FlowOutcome, Failure> {
        let input = input::surface(&self.to.surface, &mut run.seconds, run.control)?;
        let mut outcome = flow_of(self, input, run)?;
        if self.charts {
            let cut = || charts::cut(&mut outcome, self.margin, &mut run.seconds, run.control);
            let cut = doing("cutting", cut);
            run.failed.attempt("charts", cut)?;
        }
        Ok(outcome)
    }

    fn write(&self, outcome: &FlowOutcome, run: &mut CommandRun<'_>) -> Result<(), Failure> {
        let (input, solved, picture) = (&outcome.input, &outcome.solved, &self.picture.base);
        run.file("trace", self.trace.as_deref(), |outputs, path| {
            outputs.add(path, |out| csv::write_trace(out, &outcome.report.trace))
        })?;
        match &outcome.layout {
            Ok(laid) => {
                uv::write_asked(run, input, laid, &self.to, self.homogeneous)?;
                run.file("flat", self.to.flat.flat.as_deref(), |outputs, path| {
                    let flat = FlatLayout::new(input, laid, self.to.on)?.scaled(flat_scale(outcome, laid));
                    flat.write(outputs, path, &self.to.flat)
                })?;
                run.file("circles", self.circles.as_deref(), |outputs, path| {
                    let none = || Failure::Failed("the metric has no circles".into());
                    outputs.add_json(path, &CircleFile::new(solved, laid).ok_or_else(none)?)
                })?;
            }
            Err(why) => run.failed.refuse(
                why,
                &[
                    ("uv", self.to.uv.is_some()),
                    ("flat", self.to.flat.flat.is_some()),
                    ("xref", self.to.xref.is_some()),
                    ("circles", self.circles.is_some()),
                    ("charts", self.charts),
                    ("picture", picture.is_svg()),
                ],
            ),
        }
        let is_drawable = outcome.layout.is_ok() || !picture.is_svg();
        let path = picture.picture.as_deref().filter(|_| is_drawable);
        run.picture("picture", path, || show::draw(outcome, &self.picture, self.to.common.threads))
    }

    fn settings<'a>(&'a self, outcome: &'a FlowOutcome) -> impl Serialize + 'a {
        FlowSettings {
            space: outcome.solved.solution.metric().space.name(),
            input_geometry: outcome.input.surface.geometry().name(),
            target: self.target.as_ref().map_or_else(|| rule_text(&outcome.rule), ToString::to_string),
            pin: outcome.pinned.iter().map(|v| v.0).collect(),
            max_iterations: options(self).iteration_limit(),
            steps: (self.to.solve.method == MethodChoice::Gradient)
                .then(|| StepsChoice(options(self).gradient.step).to_string()),
            args: self,
        }
    }
}

/// The options of a run as its report has them.
#[derive(Serialize)]
struct FlowSettings<'a> {
    space: &'static str,
    input_geometry: &'static str,
    target: String,
    pin: Vec<u32>,
    max_iterations: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    steps: Option<String>,
    #[serde(flatten)]
    args: &'a FlowArgs,
}

/// The flow of one surface, with its layout on the faces that are written.
pub fn flow_of(args: &FlowArgs, input: Input, run: &mut CommandRun<'_>) -> Result<FlowOutcome, Failure> {
    // Cones are placed in E² alone.
    let automatic = matches!(args.target, Some(TargetChoice::Auto(_))).then_some(Space::E2);
    let space = args.space.space().or(automatic).unwrap_or_else(|| default_space(input.mesh()));
    check_surface(args, &input, space)?;
    let job = flow_job(args, &input, space)?;
    let mut outcome = run_flow(input, job, run)?;
    if let (Ok(laid), OnChoice::Input) = (&mut outcome.layout, args.to.on) {
        let faces = || OwnFaces::new(&laid.layout, &outcome.input, args.to.repair, run.control);
        laid.own_faces = timed(&mut run.seconds.layout, faces)?;
    }
    Ok(outcome)
}

/// The flow that the arguments ask for.
fn flow_job<'a>(args: &'a FlowArgs, input: &Input, space: Space) -> Result<FlowJob<'a>, Failure> {
    let fixed_edges = match &args.keep_edges {
        Some(path) => csv::read_edges(path, input.mesh())?,
        None => Vec::new(),
    };
    if args.pin == Some(PinChoice::Boundary) && input.mesh().is_closed() {
        return Err(Failure::Usage("--pin boundary: a closed surface has none; name vertices".into()));
    }
    let pinned = args.pin.as_ref().map_or_else(Vec::new, |pin| pinned(pin, input.mesh()));
    let to = &args.to;
    let of_layout = [&to.uv, &to.flat.flat, &args.circles, &args.picture.base.picture, &to.common.report];
    Ok(FlowJob {
        space,
        scheme: args.to.solve.scheme.into(),
        target: match args.outer {
            Some(_) => Some(Target::Outer(args.outer)),
            None => args.target.as_ref().map(|t| target(t, input, space)).transpose()?,
        },
        target_name: args.target.as_ref().map(ToString::to_string).filter(|name| name != "outer"),
        options: Options { fixed_edges, pinned, ..options(args) },
        needs_layout: args.charts || of_layout.iter().any(|path| path.is_some()),
        metric: args.to.metric.as_deref(),
    })
}

fn options(args: &FlowArgs) -> Options {
    let step = args.steps.map_or_else(StepRule::default, |steps| steps.0);
    let gradient = Gradient { step, area_normalised: args.area_normalised };
    Options { gradient, ..args.to.options() }
}

/// The factor from a layout, which has the area of the input, to lengths in the input's unit: where vertices are pinned, or a target holds
/// the outer loop, those of the metric, whose conformal factor is 0 there.
fn flat_scale(outcome: &FlowOutcome, laid: &SurfaceLayout) -> f64 {
    let of_charts = laid.packed.as_ref().map_or(1.0, |packed| packed.charts.scale);
    let holds_lengths = !outcome.pinned.is_empty() || matches!(outcome.rule, Target::Outer(_));
    let of_layout = if holds_lengths { laid.layout.scale } else { 1.0 };
    1.0 / (of_charts * of_layout)
}

/// Refuse options that do not go together.
pub fn check_options(args: &FlowArgs) -> Result<(), Failure> {
    let newton = args.to.solve.method != MethodChoice::Gradient;
    let on_input = args.to.on == OnChoice::Input;
    let placed = matches!(args.target, Some(TargetChoice::Auto(_)));
    let holds_outer = args.outer.is_some() || args.target == Some(TargetChoice::Outer);
    let other = args.target.is_some() && args.target != Some(TargetChoice::Outer);
    let refused = [
        (
            args.charts && args.circles.is_some(),
            "--circles: circles belong to the layout as a whole; leave --charts or --circles out",
        ),
        (
            on_input && (args.charts || args.homogeneous),
            "--on input: charts and homogeneous coordinates belong to the subdivision; leave --on, or them, out",
        ),
        (
            args.picture.base.is_svg() && args.picture.base.is_turned(),
            "--view, --up: an SVG shows the layout alone; use .png, or leave them out",
        ),
        (
            args.picture.color == Some(ColorChoice::Charts) && !args.charts,
            "--color charts: the layout is not cut into charts; add --charts",
        ),
        (args.margin >= 1.0, "--margin: a share of the unit square's side, in [0, 1)"),
        (
            args.pin.is_some() && placed,
            "--target auto chooses every curvature, --pin leaves some free; leave one out",
        ),
        (
            args.outer.is_some() && other,
            "--outer names the loop that --target outer holds; leave --outer or --target out",
        ),
        (
            args.pin.is_some() && holds_outer,
            "--target outer holds the outer loop itself; leave --pin, or --target and --outer, out",
        ),
        (args.trace.is_some() && newton, "--trace records the gradient flow; add --method gradient"),
        (args.steps.is_some() && newton, "--steps is a rule of the gradient flow; add --method gradient"),
        (
            args.area_normalised && newton,
            "--area-normalised is a variant of the gradient flow; add --method gradient",
        ),
    ];
    match refused.into_iter().find(|(refused, _)| *refused) {
        Some((_, why)) => Err(Failure::Usage(why.into())),
        None => Ok(()),
    }
}

/// Refuse what can be refused once the surface is known.
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
        (args.to.flat.flat.is_some(), "--flat"),
    ];
    if let Some((_, option)) = in_plane.into_iter().find(|(wanted, _)| *wanted && space != Space::E2) {
        let why = if option == "--flat" { "are not flat" } else { "have none" };
        return refuse(format!(
            "{option}: layouts in {space} {why}; use --space e2 (with --target auto:N, single:V or cones:FILE.csv \
             where the surface needs cones)"
        ));
    }
    if args.circles.is_some() && scheme.epsilon() == 0 {
        return refuse(format!(
            "--circles: scheme {scheme} has no circles; use inversive, thurston, tangential or virtual"
        ));
    }
    if args.to.uv.is_some() && !in_space {
        return refuse(format!("--uv: {NO_POSITIONS}; --flat OUT.obj writes the layout as a flat mesh"));
    }
    args.to.flat.check_surface(input)?;
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
        TargetChoice::Outer => Target::Outer(None),
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

/// The text of a default target: the name of its rule, or the cones that were chosen.
fn rule_text(rule: &Target) -> String {
    match rule {
        Target::Cones(cones) if !cones.is_empty() => {
            let named = cones.iter().map(|(v, k)| format!("{v},{k}"));
            format!("cones:{}", named.collect::<Vec<_>>().join(";"))
        }
        rule => rule.name().into(),
    }
}
