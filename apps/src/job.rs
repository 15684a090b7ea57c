//! One flow from the input to the layout of its metric.

use crate::failure::{Failure, or_reason};
use crate::input::Input;
use crate::metric_file::MetricFile;
use crate::output::Outputs;
use crate::report::{PhaseSeconds, timed};
use crate::runner::CommandRun;
use crate::solved::{MetricMeasures, SolvedMetric};
use crate::surface_layout::{self, SurfaceLayout, is_carried_back};
use ricci::Control;
use ricci::flow::{self, Solution, with_cones_placed};
use ricci::geometry::Space;
use ricci::mesh::{Mesh, VertexId};
use ricci::metric::target::check_vertices;
use ricci::metric::{Measured, Scheme};
use ricci::parallel::join;
use ricci::{Class, Flow, Target};
use std::path::Path;

/// The options of one flow.
pub struct FlowJob<'a> {
    pub space: Space,
    pub scheme: Scheme,
    /// `None`: the default of the surface's topology.
    pub target: Option<Target>,
    /// The name of the target in the summary, where that is not the name of its rule.
    pub target_name: Option<String>,
    pub options: flow::Options,
    /// True if an output needs the layout.
    pub needs_layout: bool,
    /// The name of the metric's file.
    pub metric: Option<&'a Path>,
}

/// The metric that a flow reached, with its layout where it has one.
pub struct FlowOutcome {
    pub input: Input,
    /// The rule that gave the target.
    pub rule: Target,
    /// The name of the target in the summary.
    pub rule_name: String,
    /// The vertices whose conformal factor was held.
    pub pinned: Vec<VertexId>,
    pub report: flow::Report,
    pub solved: SolvedMetric,
    /// The layout, or the reason why there is none.
    pub layout: Result<SurfaceLayout, String>,
}

/// The space of a surface when none is asked for.
pub fn default_space(mesh: &Mesh) -> Space {
    if mesh.is_closed() && mesh.euler() < 0 { Space::H2 } else { Space::E2 }
}

/// Run a flow, write its metric if that is asked for, and lay it out. With two threads the metric is measured and written while it is laid
/// out; with one it is written first, so that the memory of that is free again.
pub fn run_flow(input: Input, job: FlowJob<'_>, run: &mut CommandRun<'_>) -> Result<FlowOutcome, Failure> {
    let (class, control) = (Class::new(job.scheme, job.space), run.control);
    let (rule, rule_name) = rule(&input, &job, &control.part(0.05, 0.2))?;
    let new_flow =
        || Flow::toward(&rule, input.surface.clone(), class, &job.options, &control.part(0.2, 0.25));
    let mut flow = timed(&mut run.seconds.flip, new_flow)?;
    let solution = flow.solve(&rule, &control.part(0.25, 0.7))?;
    // The factorisation is most of the memory of a run, and the layout has no use for it.
    drop(flow);
    let (Some(report), Some(target)) = (solution.report().cloned(), solution.final_target()?) else {
        return Err(Failure::Failed("the flow has left no report".into()));
    };
    run.seconds.add_flow(&report.seconds);
    let lay_out = || -> Result<_, Failure> {
        let mut seconds = PhaseSeconds::default();
        let layout = match no_layout(&solution, job.needs_layout) {
            Some(why) => Err(why),
            None => {
                or_reason(surface_layout::lay_out(&input, &solution, &mut seconds, &control.part(0.7, 1.0)))?
            }
        };
        Ok((layout, seconds))
    };
    let (mut outputs, mut writing) = (Outputs::default(), 0.0);
    let write_metric = |measured: &Measured| -> Result<(), Failure> {
        let Some(path) = job.metric else { return Ok(()) };
        let file = MetricFile::of(&solution, measured, &target)?;
        timed(&mut writing, || outputs.add(path, |out| file.write(out)))
    };
    let is_sound = report.broken_triangles == 0;
    let measure = || MetricMeasures::after(&solution, write_metric);
    let (measured, laid) = join(measure, || is_sound.then(&lay_out));
    let (written, measures) = measured?;
    let layout = match broken(&solution, &measures) {
        Some(why) => Err(why),
        None => {
            let (layout, seconds) = laid.unwrap_or_else(lay_out)?;
            run.seconds.refine += seconds.refine;
            run.seconds.layout += seconds.layout;
            layout
        }
    };
    run.outputs.append(outputs);
    run.seconds.write += writing;
    run.failed.attempt("metric", written)?;
    let mut solved = SolvedMetric::measured(solution, measures, target)?;
    solved.may_flip = job.options.flips != flow::Flips::Never;
    let rule_name = job.target_name.unwrap_or(rule_name);
    Ok(FlowOutcome { input, rule, rule_name, pinned: job.options.pinned, report, solved, layout })
}

/// The reason why a metric is not laid out even where no triangle is broken; `needed`: an output needs the layout.
fn no_layout(solution: &Solution, needed: bool) -> Option<String> {
    if solution.metric().space == Space::S2 {
        Some("ricci uniformize lays spheres out".into())
    } else if !is_carried_back(solution, needed) {
        Some("edge flips led far away, and no output needs the way back to the given triangulation".into())
    } else {
        None
    }
}

/// The reason why a metric with broken triangles is not laid out.
fn broken(solution: &Solution, measures: &MetricMeasures) -> Option<String> {
    let broken = &measures.curvature.broken;
    let first = broken.first().filter(|_| solution.metric().space != Space::S2)?;
    let n = broken.len();
    Some(format!("{n} triangles break the triangle inequality (the first is face {first})"))
}

/// The target that was asked for, or the default of the surface, with its cones placed; and its name. A target that was asked for is
/// refused where the scheme cannot reach it on the given triangulation; a default is tried, and the flow then says why it cannot be
/// reached.
fn rule(input: &Input, job: &FlowJob<'_>, control: &Control) -> Result<(Target, String), Failure> {
    let pinned = &job.options.pinned;
    let rule = match &job.target {
        Some(rule) => rule.clone(),
        None if pinned.is_empty() => Target::default_for(&input.surface, job.space)?,
        None => Target::Cones(Vec::new()),
    };
    let name = match rule {
        Target::Auto(n) => format!(
            "auto:{n} (the default of open surfaces with handles; --target boundary bends the boundary alone)"
        ),
        Target::Outer(outer) => outer_name(outer),
        _ => rule.name().into(),
    };
    let rule = with_cones_placed(&rule, &input.surface, job.space, control)?.into_owned();
    if job.target.is_none() {
        return Ok((rule, name));
    }
    if let Target::Outer(_) = rule {
        rule.check(&input.surface, Class::new(job.scheme, job.space))?;
        return Ok((rule, name));
    }
    let mut target = rule.values(&input.surface, job.space)?;
    let n = target.len();
    pinned.iter().filter(|v| v.index() < n).for_each(|&v| target[v] = 0.0);
    check_vertices(input.mesh(), job.scheme, &target)?;
    Ok((rule, name))
}

/// The name of a target that holds the outer loop.
fn outer_name(outer: Option<usize>) -> String {
    let which = outer.map_or_else(|| "the longest loop".into(), |k| format!("loop {k}"));
    format!(
        "outer ({which} keeps its lengths, others are filled; --target boundary bends all loops by their length)"
    )
}

impl FlowOutcome {
    /// The curvature asked for at a vertex of the input; at a pinned vertex the one that came out.
    pub fn target(&self, v: VertexId) -> f64 {
        self.solved.solution.target().map_or(0.0, |target| target[v])
    }

    /// The interior vertices that a list of cones names, with their curvature.
    pub fn named_cones(&self) -> Option<Vec<(VertexId, f64)>> {
        let Target::Cones(cones) = &self.rule else { return None };
        Some(cones.iter().filter(|c| !self.input.mesh().is_boundary_vertex(c.0)).copied().collect())
    }
}
