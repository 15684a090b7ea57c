//! One flow from input to layout: what `ricci flow` and `ricci demo` run.

use crate::failure::{Failure, told};
use crate::input::Input;
use crate::laid::{self, Laid, is_carried_back};
use crate::report::{Checks, Seconds, timed};
use crate::solved::{Measures, Solved};
use ricci::Control;
use ricci::flow::{self, Solution, with_cones_placed};
use ricci::geometry::{Space, worse};
use ricci::mesh::{Mesh, PerVertex, VertexId};
use ricci::metric::target::check_vertices;
use ricci::metric::{Measured, Scheme};
use ricci::parallel::join;
use ricci::{Class, Flow, Target};

/// What to compute.
pub struct Job {
    pub space: Space,
    pub scheme: Scheme,
    /// `None`: the default of the surface's topology.
    pub target: Option<Target>,
    /// The name of the target in the summary, where that is not the name of its rule.
    pub target_name: Option<String>,
    pub options: flow::Options,
    /// Whether an output needs the layout.
    pub laid_out: bool,
}

/// The metric that a flow reached, with its layout where it has one.
pub struct Outcome {
    /// The rule that gave the target.
    pub rule: Target,
    /// What it is called in the summary.
    pub rule_name: String,
    /// Vertices whose conformal factor was held.
    pub pinned: Vec<VertexId>,
    pub report: flow::Report,
    pub solved: Solved,
    /// The layout, or why there is none.
    pub layout: Result<Laid, String>,
}

/// The space of a surface when none is asked for.
pub fn default_space(mesh: &Mesh) -> Space {
    if mesh.is_closed() && mesh.euler() < 0 { Space::H2 } else { Space::E2 }
}

/// Run a flow and lay its metric out. `beside`: what else is to be done with the metric; on one thread before it is laid out, so that its
/// memory is free again by then.
pub fn run<T: Send>(
    input: &Input,
    job: Job,
    control: &Control,
    beside: impl FnOnce(&Solution, &Measured, &PerVertex<f64>) -> T + Send,
) -> Result<(Outcome, T), Failure> {
    let class = Class::new(job.scheme, job.space);
    let (rule, rule_name) = rule(input, &job, control)?;
    let mut start = 0.0;
    let mut flow = timed(&mut start, || Flow::new(input.surface.clone(), class, &job.options, control))?;
    let solution = flow.solve(&rule, control)?;
    // Its factorisation is most of the memory of a run, and of no use to the layout.
    drop(flow);
    let (Some(report), Some(target)) = (solution.report().cloned(), solution.final_target()?) else {
        return Err(Failure::Failed("the flow has left no report".into()));
    };
    let mut seconds = Seconds::new(input, &report.seconds);
    seconds.flip += start;
    let lay_out = || match no_layout(&solution, job.laid_out) {
        Some(why) => Ok((Err(why), seconds)),
        None => {
            let mut seconds = seconds;
            told(laid::lay_out(input, &solution, &mut seconds, control)).map(|laid| (laid, seconds))
        }
    };
    let is_sound = report.broken_triangles == 0;
    let do_beside = |measured: &Measured| beside(&solution, measured, &target);
    let (measured, laid) = join(|| Measures::after(&solution, do_beside), || is_sound.then(&lay_out));
    let (done, measures) = measured?;
    let (layout, seconds) = match broken(&solution, &measures) {
        Some(why) => (Err(why), seconds),
        None => laid.unwrap_or_else(lay_out)?,
    };
    let mut solved = Solved::measured(solution, measures, target, seconds)?;
    solved.may_flip = job.options.flips != flow::Flips::Never;
    let rule_name = job.target_name.unwrap_or(rule_name);
    Ok((Outcome { rule, rule_name, pinned: job.options.pinned, report, solved, layout }, done))
}

/// Why a metric is not laid out, whatever its triangles; `needed`: by an output.
fn no_layout(solution: &Solution, needed: bool) -> Option<String> {
    if solution.metric().space == Space::S2 {
        Some("ricci uniformize lays spheres out".into())
    } else if !is_carried_back(solution, needed) {
        Some("edge flips led far away, and no output needs the way back to the given triangulation".into())
    } else {
        None
    }
}

/// Why a metric with broken triangles is not laid out.
fn broken(solution: &Solution, measures: &Measures) -> Option<String> {
    let broken = &measures.curvature.broken;
    let first = broken.first().filter(|_| solution.metric().space != Space::S2)?;
    let n = broken.len();
    Some(format!("{n} triangles break the triangle inequality (the first is face {first})"))
}

/// The target that was asked for, or the default of the surface, with its cones placed; and its name. A target that was asked for is
/// refused where the scheme cannot reach it on the given triangulation; a default is tried, and the flow then says why it cannot be
/// reached.
fn rule(input: &Input, job: &Job, control: &Control) -> Result<(Target, String), Failure> {
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
        _ => rule.name().into(),
    };
    let rule = with_cones_placed(&rule, &input.surface, job.space, control)?.into_owned();
    if job.target.is_none() {
        return Ok((rule, name));
    }
    let mut target = rule.values(&input.surface, job.space)?;
    let n = target.len();
    pinned.iter().filter(|v| v.index() < n).for_each(|&v| target[v] = 0.0);
    check_vertices(input.mesh(), job.scheme, &target)?;
    Ok((rule, name))
}

/// u at mirror images may differ by this: what rounding does where edges were flipped in another order.
const MIRROR: f64 = 1e-8;

impl Outcome {
    /// The curvature asked for, per given vertex; at pinned vertices what came out.
    pub fn target(&self, v: VertexId) -> f64 {
        self.solved.solution.target().map_or(0.0, |target| target[v])
    }

    /// Interior vertices that a list of cones names, with their curvature.
    pub fn named_cones(&self, input: &Input) -> Option<Vec<(VertexId, f64)>> {
        let Target::Cones(cones) = &self.rule else { return None };
        Some(cones.iter().filter(|c| !input.mesh().is_boundary_vertex(c.0)).copied().collect())
    }

    /// What the result is held against.
    pub fn checks(&self) -> Checks {
        let mut checks = self.solved.checks(self.report.allowed_error());
        let solution = &self.solved.solution;
        if let Some(double) = solution.double() {
            let u = &solution.metric().u;
            let differs = |v: VertexId| (u[v] - u[double.mirror(v)]).abs();
            checks.add("mirror_symmetry", solution.mesh().vertices().map(differs).fold(0.0, worse), MIRROR);
        }
        if let Ok(laid) = &self.layout {
            let limit = laid.layout.consistency_limit(self.solved.total_error());
            checks.add("layout_consistency", laid.layout.consistency(), limit);
            if let Some(packed) = &laid.packed {
                checks.add("overlapping_in_charts", packed.overlapping as f64, 0.0);
            }
            checks.add("flipped_triangles", laid.flipped().len() as f64, 0.0);
        }
        checks
    }
}
