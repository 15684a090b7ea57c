//! One flow from input to layout: what `ricci flow` and `ricci demo` run.

use crate::failure::Failure;
use crate::input::Input;
use crate::laid::{self, Laid};
use crate::report::{Attempts, Checks, Seconds, timed};
use ricci::Control;
use ricci::flow;
use ricci::geometry::{Space, worse};
use ricci::mesh::{Mesh, PerEdge, PerVertex, VertexId};
use ricci::metric::target::check_vertices;
use ricci::metric::{Curvature, Initial, Metric, Scheme};
use ricci::{Class, Flow, Target};

/// What to compute.
pub struct Job {
    pub space: Space,
    pub scheme: Scheme,
    /// `None`: the default of the surface's topology.
    pub target: Option<Target>,
    pub options: flow::Options,
    /// Whether an output needs the layout.
    pub laid_out: bool,
}

/// The metric that a flow reached, with its layout where it has one.
pub struct Outcome {
    pub scheme: Scheme,
    /// The rule that gave the target.
    pub rule: Target,
    /// The curvature asked for, per given vertex; at pinned vertices what came out.
    pub target: PerVertex<f64>,
    /// The same per vertex of `mesh`.
    pub final_target: PerVertex<f64>,
    /// Vertices whose conformal factor was held.
    pub pinned: Vec<VertexId>,
    /// Where the flow started, on the Delaunay triangulation if edges were flipped.
    pub initial: Initial,
    /// Isometric flips before the flow.
    pub start_flips: usize,
    /// Per vertex of `mesh` its mirror image, if that is the double of the given surface.
    pub mirror: Option<Vec<u32>>,
    /// The final triangulation, of the given surface or of its double.
    pub mesh: Mesh,
    pub metric: Metric,
    pub lengths: PerEdge<f64>,
    pub curvature: Curvature,
    pub report: flow::Report,
    /// The layout, or why there is none.
    pub layout: Result<Laid, String>,
    /// Wishes that the flow was no obstacle to but something else was.
    pub failed: Attempts,
    /// What the input's file holds and the layout's file does not.
    pub left_out: Vec<&'static str>,
    pub seconds: Seconds,
}

/// The space of a surface when none is asked for.
pub fn default_space(mesh: &Mesh) -> Space {
    if mesh.is_closed() && mesh.euler() < 0 { Space::H2 } else { Space::E2 }
}

pub fn run(input: &Input, job: Job, control: &Control) -> Result<Outcome, Failure> {
    let class = Class::new(job.scheme, job.space);
    let rule = rule(input, &job)?;
    let mut start = 0.0;
    let mut flow = timed(&mut start, || Flow::new(input.surface.clone(), class, &job.options, control))?;
    let solution = flow.solve(&rule, control)?;

    // What goes wrong from here on is no fault of the input.
    let failed = |error: ricci::Error| Failure::Failed(error.to_string());
    let (mesh, metric) = (solution.mesh(), solution.metric());
    let lengths = metric.lengths(mesh).map_err(failed)?;
    let curvature = metric.curvature(mesh).map_err(failed)?;
    let (Some(report), Some(target), Some(final_target)) =
        (solution.report().cloned(), solution.target().cloned(), solution.final_target()?)
    else {
        return Err(Failure::Failed("the flow has left no report".into()));
    };
    let mut seconds = Seconds::new(input, &report.seconds);
    seconds.flip += start;
    let layout = laid::lay_out(input, &solution, &curvature, job.laid_out, &mut seconds, control)?;
    Ok(Outcome {
        scheme: job.scheme,
        rule,
        final_target,
        target,
        pinned: job.options.pinned,
        initial: solution.initial().clone(),
        start_flips: solution.start_flips(),
        mirror: solution.double().map(|double| mesh.vertices().map(|v| double.mirror(v).0).collect()),
        mesh: Mesh::clone(mesh),
        metric: metric.clone(),
        lengths,
        curvature,
        report,
        layout,
        failed: Attempts::default(),
        left_out: Vec::new(),
        seconds,
    })
}

/// The target that was asked for or is the default of the surface. What is asked for must be possible on the given triangulation; a
/// default that is too low for the scheme there is no fault of the input, and the flow says why it cannot be reached.
fn rule(input: &Input, job: &Job) -> Result<Target, Failure> {
    let pinned = &job.options.pinned;
    let Some(rule) = &job.target else {
        return Ok(match pinned.is_empty() {
            true => Target::default_for(&input.surface, job.space)?,
            false => Target::Cones(Vec::new()),
        });
    };
    let mut target = rule.values(&input.surface, job.space)?;
    let n = target.len();
    pinned.iter().filter(|v| v.index() < n).for_each(|&v| target[v] = 0.0);
    check_vertices(input.mesh(), job.scheme, &target)?;
    Ok(rule.clone())
}

/// Gauss–Bonnet must hold to this. Each of the 3F angles is off by a few ulp, which add up like a random walk: 1e-12 for a
/// million faces.
pub const GAUSS_BONNET: f64 = 1e-10;

/// u at mirror images may differ by this: what rounding does where edges were flipped in another order.
const MIRROR: f64 = 1e-8;

impl Outcome {
    /// max |K − K̄| of the metric as it is written.
    pub fn curvature_error(&self) -> f64 {
        self.curvature.at.iter().zip(&self.final_target).fold(0.0, |m, (k, t)| worse(m, (k - t).abs()))
    }

    /// What the result is held against.
    pub fn checks(&self) -> Checks {
        let mut checks = Checks::default();
        checks.add("gauss_bonnet", self.curvature.gauss_bonnet, GAUSS_BONNET);
        checks.add("max_curvature_error", self.curvature_error(), self.report.allowed_error());
        if let Some(mirror) = &self.mirror {
            let u = &self.metric.u;
            let differs = |(v, &image): (VertexId, &u32)| (u[v] - u[VertexId(image)]).abs();
            let most = self.mesh.vertices().zip(mirror).map(differs).fold(0.0, worse);
            checks.add("mirror_symmetry", most, MIRROR);
        }
        checks.add("broken_triangles", self.curvature.broken.len() as f64, 0.0);
        if let Ok(laid) = &self.layout {
            checks.add("layout_consistency", laid.consistency(), laid.consistency_limit);
            if let Some(packed) = &laid.packed {
                checks.add("overlapping_in_charts", packed.overlapping as f64, 0.0);
            }
            checks.add("flipped_triangles", laid.flipped().len() as f64, 0.0);
        }
        checks
    }
}
