//! One flow from input to layout: what `ricci flow` and `ricci demo` run.

use crate::failure::Failure;
use crate::input::Input;
use crate::laid::{self, Laid};
use crate::report::{Attempts, Checks, Seconds, timed};
use ricci::Control;
use ricci::flow::{self, SurfaceFlow};
use ricci::geometry::{Space, worse};
use ricci::mesh::{Mesh, PerEdge, PerVertex, VertexId};
use ricci::metric::target::{check_total, check_vertices, settle_total};
use ricci::metric::{Curvature, Initial, Metric, Scheme, Target};

/// What to compute.
pub struct Job {
    pub space: Space,
    pub scheme: Scheme,
    /// `None`: the default of the surface's topology.
    pub target: Option<Target>,
    pub options: flow::Options,
    /// Vertices whose conformal factor is held at 0; their curvature is free.
    pub pinned: Vec<VertexId>,
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
    let space = job.space;
    let (rule, mut target) = target(&input.mesh, &input.lengths, &job)?;
    let mut start = 0.0;
    let mut flow = timed(&mut start, || {
        let Input { mesh, lengths, geometry, .. } = input;
        SurfaceFlow::new(mesh, lengths, *geometry, job.scheme, space, &job.pinned, &job.options, control)
    })?;
    let report = flow.solve(&target, control)?;
    // Layouts in H² magnify what is left of the curvature by e^distance.
    if report.converged && space == Space::H2 && flow.mesh().is_closed() && target.iter().all(|&k| k == 0.0) {
        flow.flatten(control)?;
    }
    let (mesh, metric) = (flow.mesh().clone(), flow.metric().clone());

    // What goes wrong from here on is no fault of the input.
    let failed = |error: ricci::Error| Failure::Failed(error.to_string());
    let lengths = metric.lengths(&mesh).map_err(failed)?;
    let curvature = metric.curvature(&mesh).map_err(failed)?;
    job.pinned.iter().for_each(|&v| target[v] = curvature.at[v]);
    let mut seconds = Seconds::new(input, &report.seconds);
    seconds.flip += start;
    let layout = laid::lay_out(input, &flow, &curvature, &target, job.laid_out, &mut seconds, control)?;
    Ok(Outcome {
        scheme: job.scheme,
        rule,
        final_target: flow.target(&target).map_err(failed)?,
        target,
        pinned: job.pinned,
        initial: flow.initial().clone(),
        start_flips: flow.start_flips(),
        mirror: flow.double().map(|double| mesh.vertices().map(|v| double.mirror(v).0).collect()),
        mesh,
        metric,
        lengths,
        curvature,
        report,
        layout,
        failed: Attempts::default(),
        left_out: Vec::new(),
        seconds,
    })
}

/// The target by rule and by value, admissible.
fn target(mesh: &Mesh, lengths: &PerEdge<f64>, job: &Job) -> Result<(Target, PerVertex<f64>), Failure> {
    let free = !job.pinned.is_empty();
    let rule = match &job.target {
        Some(rule) => rule.clone(),
        None if free => Target::Cones(Vec::new()),
        None => Target::default_for(mesh, lengths, job.space)?,
    };
    let mut target = rule.values(mesh, lengths, job.space)?;
    job.pinned.iter().filter(|v| v.index() < mesh.n_vertices()).for_each(|&v| target[v] = 0.0);
    match check_vertices(mesh, job.scheme, &target) {
        // A default that is too low for the scheme on this triangulation is no fault of the input: the flow says why it
        // cannot be reached.
        Err(ricci::Error::TargetBelow { .. }) if job.target.is_none() => {}
        possible => possible?,
    }
    if !free {
        check_total(mesh, job.space, &target)?;
        settle_total(mesh, job.space, &mut target);
    }
    Ok((rule, target))
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
        checks.add("max_curvature_error", self.curvature_error(), self.report.tolerance);
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
