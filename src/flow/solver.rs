//! A surface, a conformal class and a factorisation that serves many targets.

use super::evaluate::State;
use super::obstruction::{obstruction, obstruction_at_a_vertex};
use super::options::{Flips, Method, Options};
use super::report::{Report, StopReason, WORST, timed};
use super::system::System;
use crate::control::Control;
use crate::error::{Error, Result, check_size};
use crate::geometry::Space;
use crate::geometry::conformal::is_precise;
use crate::mesh::{Mesh, NormalCoordinates, PerVertex, VertexId};
use crate::metric::Metric;
use crate::metric::curvature::gauss_bonnet;
use crate::metric::target::settle_total;
use crate::parallel::Pool;

/// Solver for one surface. The symbolic analysis is kept between targets; each solve starts from the last metric that
/// reached its target (at first from the given one).
///
/// The solver owns its mesh because edge flips change it.
pub struct Solver {
    pub(super) mesh: Mesh,
    pub(super) metric: Metric,
    /// u of the last converged solve, or what was set.
    start: PerVertex<f64>,
    start_low: PerVertex<f64>,
    pub(super) options: Options,
    pub(super) pinned: Vec<bool>,
    pub(super) mirror: Option<Vec<u32>>,
    followed: Vec<NormalCoordinates>,
    pub(super) system: Option<System>,
    pub(super) pool: Pool,
}

/// What the methods share during one solve.
pub(super) struct Run<'a> {
    pub mesh: &'a mut Mesh,
    pub class: &'a mut Metric,
    /// u to start from.
    pub start: &'a PerVertex<f64>,
    pub start_low: &'a PerVertex<f64>,
    pub options: &'a Options,
    pub target: &'a [f64],
    pub pinned: &'a [bool],
    /// Per vertex its mirror image, where the metric is to stay symmetric.
    pub mirror: Option<&'a [u32]>,
    /// Told every flip.
    pub followed: &'a mut [NormalCoordinates],
    /// E² without pinned vertices: u is determined up to a constant, and Σ u = 0 is kept.
    pub free_scale: bool,
    /// Stop where the surface's double would flip a boundary edge; then `left` is set.
    pub one_copy: bool,
    pub left: bool,
    pub control: &'a Control,
}

impl Solver {
    /// A solver for `metric` on `mesh`. Errors: wrong sizes, variables outside the metric's domain, bad options.
    pub fn new(mesh: Mesh, metric: Metric, options: Options) -> Result<Solver> {
        options.check()?;
        if let Some(e) = options.fixed_edges.iter().find(|e| e.index() >= mesh.n_edges()) {
            let value = e.to_string();
            return Err(Error::Argument { what: "fixed edge", value, need: "an existing edge" });
        }
        let pool = Pool::new(options.threads)?;
        pool.run(|| metric.check_domain(&mesh))?;
        let pinned = vec![false; mesh.n_vertices()];
        let (start, start_low) = (metric.u.clone(), metric.u_low.clone());
        Ok(Solver {
            mesh,
            metric,
            start,
            start_low,
            options,
            pinned,
            mirror: None,
            followed: Vec::new(),
            system: None,
            pool,
        })
    }

    /// Hold u at these vertices (Dirichlet); replaces earlier pins. Their curvature is then free.
    pub fn pin(&mut self, vertices: &[VertexId]) -> Result<()> {
        let n = self.mesh.n_vertices();
        if let Some(v) = vertices.iter().find(|v| v.index() >= n) {
            let value = v.to_string();
            return Err(Error::Argument { what: "pinned vertex", value, need: "an existing vertex" });
        }
        self.pinned = vec![false; n];
        vertices.iter().for_each(|v| self.pinned[v.index()] = true);
        self.system = None;
        Ok(())
    }

    /// Keep u the same at every vertex v and its image `mirror[v]`, an involution: the metric on the double of a surface
    /// ([`crate::mesh::Double`]) stays symmetric, and its linear systems are half as large. Targets, start and pins must be
    /// symmetric. Errors: [`Error::Size`], [`Error::Argument`] where it is no involution or u is not symmetric.
    pub fn keep_symmetric(&mut self, mirror: &[VertexId]) -> Result<()> {
        check_size("mirror", mirror.len(), self.mesh.n_vertices())?;
        for (v, &image) in mirror.iter().enumerate() {
            let back = mirror.get(image.index()).is_some_and(|back| back.index() == v);
            if !back || self.start[image] != self.start[v.into()] {
                let value = format!("{v} → {image}");
                return Err(Error::Argument { what: "mirror", value, need: "an involution that keeps u" });
            }
        }
        self.mirror = Some(mirror.iter().map(|v| v.0).collect());
        self.system = None;
        Ok(())
    }

    /// Record every flip from now on in `normal`, which follows the edges of an earlier triangulation, beside those that are told
    /// already.
    pub fn follow(&mut self, normal: NormalCoordinates) -> Result<()> {
        normal.check(&self.mesh)?;
        self.followed.push(normal);
        Ok(())
    }

    /// What each [`Solver::follow`] has recorded.
    pub fn followed(&self) -> &[NormalCoordinates] {
        &self.followed
    }

    /// The triangulation, the metric and what [`Solver::follow`] has recorded.
    pub fn into_parts(self) -> (Mesh, Metric, Vec<NormalCoordinates>) {
        (self.mesh, self.metric, self.followed)
    }

    /// Do other work on this solver's threads.
    pub fn run<R: Send>(&self, work: impl FnOnce() -> R + Send) -> R {
        self.pool.run(work)
    }

    /// Where the next solve starts: u and what its doubles lose.
    pub(super) fn start(&self) -> [&PerVertex<f64>; 2] {
        [&self.start, &self.start_low]
    }

    /// Let the next solve start there, where a solve once ended.
    pub(super) fn start_from(&mut self, u: PerVertex<f64>, low: PerVertex<f64>) {
        (self.start, self.start_low) = (u, low);
    }

    /// Set u (V entries): the start of the next solves, and the values held at pinned vertices.
    pub fn set_u(&mut self, u: PerVertex<f64>) -> Result<()> {
        let u_low = PerVertex::filled(u.len(), 0.0);
        let metric = Metric { u, u_low, ..self.metric.clone() };
        self.pool.run(|| metric.check_domain(&self.mesh))?;
        (self.start, self.start_low) = (metric.u.clone(), metric.u_low.clone());
        self.metric = metric;
        Ok(())
    }

    /// The surface's connectivity.
    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// The current metric: the start, or where the last solve ended, converged or not.
    pub fn metric(&self) -> &Metric {
        &self.metric
    }

    /// Flow to curvature `target` (V entries, radians; ignored at pinned vertices).
    ///
    /// Not reaching it is reported, not an error. Errors: wrong size, a target that is not finite, cancelled, out
    /// of memory; the metric is then unchanged.
    pub fn solve(&mut self, target: &PerVertex<f64>, control: &Control) -> Result<Report> {
        self.solve_on(target, false, control).map(|(report, _)| report)
    }

    /// [`Solver::solve`], which on `one_copy` of a symmetric surface stops where its double would flip an edge of the axis: then the
    /// other value is true.
    pub(super) fn solve_on(
        &mut self,
        target: &PerVertex<f64>,
        one_copy: bool,
        control: &Control,
    ) -> Result<(Report, bool)> {
        check_size("target", target.len(), self.mesh.n_vertices())?;
        if let Some(v) = self.mesh.vertices().find(|&v| !target[v].is_finite()) {
            let value = format!("{} at vertex {v}", target[v]);
            return Err(Error::Argument { what: "target curvature", value, need: "finite everywhere" });
        }
        let mut target = target.clone();
        if !self.pinned.contains(&true) {
            settle_total(&self.mesh, self.metric.space, &mut target);
        }
        let mut report = Report::new(self.options.tolerance);
        let precise = self.metric.epsilon.iter().all(|&e| is_precise(self.metric.space, e));
        report.double_double = precise && self.options.method == Method::Newton;
        let mut seconds = 0.0;
        let free_scale = self.metric.space == Space::E2 && !self.pinned.contains(&true);
        let before = (self.options.flips == Flips::Auto)
            .then(|| (self.mesh.clone(), self.metric.eta.clone(), self.followed.clone()));
        let mut run = Run {
            mesh: &mut self.mesh,
            class: &mut self.metric,
            start: &self.start,
            start_low: &self.start_low,
            options: &self.options,
            target: &target,
            pinned: &self.pinned,
            mirror: self.mirror.as_deref(),
            followed: &mut self.followed,
            free_scale,
            one_copy,
            left: false,
            control,
        };
        let system = &mut self.system;
        let state = timed(&mut seconds, || self.pool.run(|| run.solve(system, &mut report)));
        let left = run.left;
        if run.mirror.is_some() != self.mirror.is_some() {
            *system = None;
        }
        let mut state = match (state, before) {
            (Err(error), Some((mesh, eta, followed))) => {
                // Nothing happened: the old triangulation, whose system is to be made anew.
                (self.mesh, self.metric.eta, self.followed, self.system) = (mesh, eta, followed, None);
                return Err(error);
            }
            (state, _) => state?,
        };
        report.seconds.total = seconds;
        if one_copy && free_scale {
            // The scale of the double, where a vertex inside counts twice.
            let copies = |v| if self.mesh.is_boundary_vertex(v) { 1.0 } else { 2.0 };
            let (sum, n) = self
                .mesh
                .vertices()
                .fold((0.0, 0.0), |(sum, n), v| (sum + copies(v) * state.u[v], n + copies(v)));
            state.shift(-sum / n);
        }
        if report.converged {
            (self.start, self.start_low) = (state.u.clone(), state.low.clone());
        }
        (self.metric.u, self.metric.u_low) = (state.u, state.low);
        Ok((report, left))
    }
}

impl Run<'_> {
    fn solve(&mut self, system: &mut Option<System>, report: &mut Report) -> Result<State> {
        let mut state = State::new(self.mesh, self.start, self.start_low);
        let keeps_area = self.options.method == Method::Gradient && self.options.gradient.area_normalised;
        if self.free_scale && !keeps_area {
            state.center();
        }
        if !self.evaluate(&mut state, report)? {
            return Err(Error::Argument { what: "u", value: "start".into(), need: "in the metric's domain" });
        }
        // A target that a single vertex rules out needs no flow.
        // What rules a target out on one triangulation says nothing of the others.
        let rigid = !self.flips();
        if rigid {
            report.obstruction =
                obstruction_at_a_vertex(self.mesh, self.class, self.target, self.pinned, report.tolerance);
        }
        let state = match (self.options.method, self.class.space) {
            _ if report.obstruction.is_some() => {
                let mut residual = vec![0.0; self.target.len()];
                report.max_curvature_error = state.residual(self.target, self.pinned, &mut residual);
                report.residuals.push(report.max_curvature_error);
                report.stop_reason = StopReason::Infeasible;
                state
            }
            (Method::Gradient, _) => self.gradient(state, report)?,
            (Method::Newton, Space::S2) => self.spherical(system, state, report)?,
            (Method::Newton, _) => self.newton(system, state, report)?,
        };
        report.broken_triangles = state.broken();
        let area = state.area(self.mesh, self.class);
        report.gauss_bonnet = gauss_bonnet(self.mesh, self.class.space, &state.curvature, area);
        let reached = matches!(report.stop_reason, StopReason::Converged | StopReason::RoundingFloor);
        if reached && report.broken_triangles > 0 {
            report.stop_reason = StopReason::BrokenTriangles;
        }
        report.worst = self.worst(&state);
        let known = report.obstruction.is_some();
        if rigid
            && !known
            && !matches!(report.stop_reason, StopReason::Converged | StopReason::BrokenTriangles)
        {
            report.obstruction = obstruction(self.mesh, self.class, &state, self.target, self.pinned);
            if report.obstruction.is_some() {
                report.stop_reason = StopReason::Infeasible;
            }
        }
        report.converged = matches!(report.stop_reason, StopReason::Converged | StopReason::RoundingFloor);
        Ok(state)
    }

    /// Whether edges may be flipped.
    pub(super) fn flips(&self) -> bool {
        let options = self.options;
        options.flips == Flips::Auto && options.method == Method::Newton && self.class.space != Space::S2
    }

    /// Curvature error that a linear solution may leave: it is added to what the tolerance allows.
    pub(super) fn enough(&self) -> f64 {
        0.01 * self.options.tolerance
    }

    /// The vertices that are farthest from their target.
    fn worst(&self, state: &State) -> Vec<(VertexId, f64)> {
        let mut worst: Vec<(VertexId, f64)> = Vec::with_capacity(WORST + 1);
        let first = |v: &VertexId| self.mirror.is_none_or(|mirror| mirror[v.index()] >= v.0);
        for v in self.mesh.vertices().filter(|v| !self.pinned[v.index()]).filter(first) {
            let error = state.curvature[v] - self.target[v.index()];
            let rank = worst.partition_point(|(_, other)| other.abs() >= error.abs());
            if rank < WORST && error != 0.0 {
                worst.insert(rank, (v, error));
                worst.truncate(WORST);
            }
        }
        worst
    }

    /// The system for this run's unknowns: analysed now, or kept from before the last `flips` flips.
    pub(super) fn prepare<'s>(
        &self,
        system: &'s mut Option<System>,
        flips: usize,
        report: &mut Report,
    ) -> Result<&'s mut System> {
        let fixed = || {
            let mut fixed = self.pinned.to_vec();
            fixed[0] |= self.free_scale;
            fixed
        };
        let kept = match system.take() {
            Some(kept) if flips == 0 => kept,
            Some(kept) => {
                timed(&mut report.seconds.analyse, || kept.flipped(self.mesh, &fixed(), self.mirror, flips))?
            }
            None => timed(&mut report.seconds.analyse, || System::new(self.mesh, &fixed(), self.mirror))?,
        };
        let system = system.insert(kept);
        report.unknowns = system.unknowns();
        report.factor_entries = system.factor_entries();
        Ok(system)
    }
}

/// Subtract the mean.
pub(super) fn center(x: &mut [f64]) {
    let mean = x.iter().sum::<f64>() / x.len() as f64;
    x.iter_mut().for_each(|x| *x -= mean);
}
