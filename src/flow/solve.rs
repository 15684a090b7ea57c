//! One solve of a flow, from a target to a solution by the method of the options. A solve that fails leaves the flow as it was.

use super::Flow;
use super::cones::with_cones_placed;
use super::evaluate::FlowState;
use super::options::Method;
use super::report::{Report, StopReason, WORST};
use super::seconds::timed;
use super::solution::{ReachedTarget, Solution};
use super::system::{NewtonSystem, Precision};
use crate::control::Control;
use crate::error::{Error, Result, check_size};
use crate::geometry::Space;
use crate::geometry::conformal::is_precise;
use crate::mesh::{Mesh, PerVertex, VertexId};
use crate::metric::curvature::gauss_bonnet;
use crate::metric::delaunay::ClassFlips;
use crate::metric::target::{check_total, check_upper, settle_total};
use crate::metric::{Metric, Target};
use std::sync::Arc;

/// The last state of a method.
pub(super) struct MethodEnd {
    pub state: FlowState,
    /// True if the flow has left the one copy of a surface with boundary, whose double would flip a boundary edge.
    pub left: bool,
}

impl Flow {
    /// Flow to a target, which is ignored at pinned vertices. Not reaching it is reported and no error. With pinned vertices
    /// [`Target::Outer`] is 0 at all others: these vertices are held in the place of the outer loop.
    ///
    /// # Errors
    /// Those of [`with_cones_placed`] and [`Target::values`]; without pins a total that no metric can have ([`check_total`]); curvature
    /// that no angle can have ([`check_upper`]); [`Error::Cancelled`], [`Error::Factorisation`]: the flow is then where it was before.
    pub fn solve(&mut self, target: &Target, control: &Control) -> Result<Solution> {
        if self.holds_outer {
            self.holds_outer = false;
            self.pin(&self.options.pinned.clone(), control)?;
        }
        let target = match target {
            Target::Outer(outer) if self.options.pinned.is_empty() => {
                return self.solve_outer(*outer, control);
            }
            Target::Outer(_) => &Target::Cones(Vec::new()),
            target => target,
        };
        let (space, given) = (self.metric.space, self.given().clone());
        let was_placed = matches!(target, Target::Auto(_));
        let target = with_cones_placed(target, self.surface(), space, &control.part(0.0, 0.5))?;
        let mut values = target.values(self.surface(), space)?;
        given.vertices().filter(|v| self.pinned[v.index()]).for_each(|v| values[v] = 0.0);
        check_upper(&given, &values)?;
        if !self.has_pins() {
            check_total(&given, space, &values)?;
            settle_total(&given, space, &mut values);
        }
        self.reach(&values, &control.part(if was_placed { 0.5 } else { 0.0 }, 1.0))?;
        let (named, tolerance) = (target.named(), self.options.tolerance);
        if let Some(reached) = &mut self.now.reached {
            let is_cone = |v: &VertexId| named.contains(v) || reached.target[*v].abs() > tolerance;
            let inside = given.vertices().filter(|&v| !given.is_boundary_vertex(v));
            reached.cones = inside.filter(is_cone).collect();
        }
        Ok(self.solution())
    }

    /// [`Flow::solve`] for the curvature of every given vertex, without the checks of admissibility: only values that are not finite are
    /// refused. The report says how far the flow came.
    ///
    /// # Errors
    /// [`Error::Size`], [`Error::Argument`]; those of [`Flow::solve`].
    pub(crate) fn reach(&mut self, target: &PerVertex<f64>, control: &Control) -> Result<&Report> {
        let given = self.given();
        check_size("target", target.len(), given.n_vertices())?;
        if let Some(v) = given.vertices().find(|&v| !target[v].is_finite()) {
            let value = format!("{} at vertex {v}", target[v]);
            return Err(Error::Argument { what: "target curvature", value, need: "finite everywhere" });
        }
        let mut report = self.advance(target, control)?;
        if let Some(double) = self.double() {
            report.on_surface(double);
        }
        let mut target = target.clone();
        if self.has_pins() {
            let curvature = self.curvature()?.at;
            let pinned = |v: &VertexId| self.pinned[v.index()];
            self.given().vertices().filter(pinned).for_each(|v| target[v] = curvature[v]);
        }
        let reached =
            self.now.reached.insert(ReachedTarget { report, target, cones: Vec::new(), is_one_piece: false });
        Ok(&reached.report)
    }

    /// True if a flow to this target ends with [`Flow::flatten`], because layouts in H² magnify remaining curvature by e^distance.
    fn is_to_be_flattened(&self, target: &PerVertex<f64>) -> bool {
        self.metric.space == Space::H2 && target.iter().all(|&k| k == 0.0)
    }

    /// A solve, which goes on on the double if an edge has to be flipped across the boundary. On an error the flow is as before.
    fn advance(&mut self, target: &PerVertex<f64>, control: &Control) -> Result<Report> {
        // Flattening and the solve on the double can fail after `run` has changed u and the start, so copies of these are kept.
        let goes_on = self.one_copy || self.is_to_be_flattened(target);
        let Metric { u, u_low, .. } = &self.metric;
        let before = goes_on.then(|| [u, u_low, &self.start, &self.start_low].map(PerVertex::clone));
        let flips = self.flips;
        let outcome = self.run(target, control).and_then(|(report, left)| match &before {
            Some([_, _, start, start_low]) if left => {
                self.run_doubled(report, target, [start, start_low], control)
            }
            _ => Ok((report, None)),
        });
        match outcome {
            Ok((report, doubled)) => {
                if let Some(doubled) = doubled {
                    *self = doubled;
                }
                Ok(report)
            }
            Err(error) => {
                // Back to the triangulation from before; the system of another one is dropped.
                self.system = None;
                let Flow { now, log, start, start_low, .. } = self;
                let eta = Arc::make_mut(&mut now.metric.eta);
                log.undo(Arc::make_mut(&mut now.mesh), eta, &mut now.followed)?;
                now.share_given();
                now.flips = flips;
                if let Some(before) = before {
                    [now.metric.u, now.metric.u_low, *start, *start_low] = before;
                }
                Err(error)
            }
        }
    }

    /// The rest of a solve on the double of the surface, after a first part on one copy, which ended with this report because an edge has to
    /// be flipped across the boundary. Returns the report of both parts and the flow on the double.
    ///
    /// `start` is the u that the solve started from (high parts, low parts). If the target is not reached, the next solve starts from it
    /// again.
    fn run_doubled(
        &self,
        mut report: Report,
        target: &PerVertex<f64>,
        start: [&PerVertex<f64>; 2],
        control: &Control,
    ) -> Result<(Report, Option<Flow>)> {
        let mut took = 0.0;
        let mut doubled = timed(&mut took, || self.doubled(control))?;
        report.seconds.flip += took;
        report.seconds.total += took;
        let limit = self.options.max_iterations;
        doubled.options.max_iterations = self.options.iteration_limit() - report.iterations;
        let rest = doubled.run(target, control)?.0;
        doubled.options.max_iterations = limit;
        if let (false, Some(double)) = (rest.is_reached(), doubled.now.double()) {
            let spread = |x: &[f64]| double.spread_vertices(x).map(PerVertex::from);
            (doubled.start, doubled.start_low) = (spread(start[0])?, spread(start[1])?);
        }
        Ok((report.then(rest), Some(doubled)))
    }

    /// One solve on the present copy or double. Returns the report, and true if the copy was left because its double would flip a boundary
    /// edge.
    fn run(&mut self, target: &PerVertex<f64>, control: &Control) -> Result<(Report, bool)> {
        self.target = self.spread_target(target)?;
        if !self.has_pins() {
            settle_total(&self.now.mesh, self.now.metric.space, &mut self.target);
        }
        let mut report = Report::new(self.options.tolerance);
        let precise = self.metric.epsilon.iter().all(|&e| is_precise(self.metric.space, e));
        report.double_double = precise && self.options.method == Method::Newton;
        let mut seconds = 0.0;
        self.log.clear();
        let single_serves = self.single_serves;
        let mirror = self.mirror.clone();
        let pool = self.pool.clone();
        let end = timed(&mut seconds, || pool.run(|| self.flow(&mut report, control)));
        // A system that no step has factorised is not kept for the next solve.
        self.system = self.system.take().filter(NewtonSystem::has_factor);
        self.single_serves = single_serves;
        if self.mirror.is_some() != mirror.is_some() {
            (self.mirror, self.system) = (mirror, None);
        }
        let MethodEnd { mut state, left } = end?;
        report.seconds.total += seconds;
        self.now.flips += report.flips;
        self.now.share_given();
        if self.one_copy && self.free_scale() {
            // The mean of u on the double is set to 0, where each interior vertex counts twice.
            let copies = |v| if self.mesh.is_boundary_vertex(v) { 1.0 } else { 2.0 };
            let (sum, n) = self
                .mesh
                .vertices()
                .fold((0.0, 0.0), |(sum, n), v| (sum + copies(v) * state.u[v], n + copies(v)));
            state.shift(-sum / n);
        }
        if report.is_reached() {
            self.start.copy_from_slice(&state.u);
            self.start_low.copy_from_slice(&state.low);
        }
        self.now.metric.u.copy_from_slice(&state.u);
        self.now.metric.u_low.copy_from_slice(&state.low);
        if report.is_reached() && self.is_to_be_flattened(target) {
            report.angle_defect = Some(self.flatten_at(state, control)?);
        } else {
            self.memory.take_back(state);
        }
        Ok((report, left))
    }

    /// The flow by the method of the options, from the start to the end that the report describes.
    pub(super) fn flow(&mut self, report: &mut Report, control: &Control) -> Result<MethodEnd> {
        let mut state = self.memory.state(&self.start, &self.start_low);
        let keeps_area = self.options.method == Method::Gradient && self.options.gradient.area_normalised;
        if self.free_scale() && !keeps_area {
            state.centre();
        }
        if !self.evaluate(&mut state, report, control)? {
            return Err(Error::Argument { what: "u", value: "start".into(), need: "in the metric's domain" });
        }
        // A target that is infeasible on one triangulation can be feasible after flips, so obstructions are only searched where flips
        // are off. One that a single vertex rules out needs no flow.
        if !self.flips_allowed {
            report.obstruction = self.obstruction_at_a_vertex();
        }
        let stopped = |state| MethodEnd { state, left: false };
        let end = match (self.options.method, self.metric.space) {
            _ if report.obstruction.is_some() => {
                let mut residual = vec![0.0; self.target.len()];
                report.max_curvature_error = state.residual(&self.target, &self.pinned, &mut residual);
                report.residuals.push(report.max_curvature_error);
                report.stop_reason = StopReason::Infeasible;
                stopped(state)
            }
            (Method::Gradient, _) => stopped(self.run_gradient_flow(state, report, control)?),
            (Method::Newton, Space::S2) => stopped(self.spherical(state, report, control)?),
            (Method::Newton, _) => self.newton(state, report, control)?,
        };
        self.judge(&end.state, report);
        Ok(end)
    }

    /// Complete the report by what is measured at the last state.
    fn judge(&self, state: &FlowState, report: &mut Report) {
        report.broken_triangles = state.broken();
        // In E² the area does not enter Gauss–Bonnet.
        let area = if self.metric.space == Space::E2 { 0.0 } else { state.area(&self.mesh, &self.metric) };
        report.gauss_bonnet = gauss_bonnet(&self.mesh, self.metric.space, &state.curvature, area);
        report.worst = self.worst(state);
        if report.is_reached() && report.broken_triangles > 0 {
            report.stop_reason = StopReason::BrokenTriangles;
        }
        let open = matches!(
            report.stop_reason,
            StopReason::Stalled
                | StopReason::Diverged
                | StopReason::OutOfReach { .. }
                | StopReason::IterationLimit
        );
        if !self.flips_allowed && open {
            report.obstruction = self.obstruction(state);
            if report.obstruction.is_some() {
                report.stop_reason = StopReason::Infeasible;
            }
        }
    }

    /// The vertices that are farthest from their target.
    fn worst(&self, state: &FlowState) -> Vec<(VertexId, f64)> {
        let mut worst: Vec<(VertexId, f64)> = Vec::with_capacity(WORST + 1);
        let first = |v: &VertexId| self.mirror.as_ref().is_none_or(|mirror| mirror[v.index()] >= v.0);
        for v in self.mesh.vertices().filter(|v| !self.pinned[v.index()]).filter(first) {
            let error = state.curvature[v] - self.target[v];
            let rank = worst.partition_point(|(_, other)| other.abs() >= error.abs());
            if rank < WORST && error != 0.0 {
                worst.insert(rank, (v, error));
                worst.truncate(WORST);
            }
        }
        worst
    }

    pub(super) fn has_pins(&self) -> bool {
        self.pinned.contains(&true)
    }

    /// True in E² without pinned vertices: u is determined up to a constant, and Σ u = 0 is kept.
    pub(super) fn free_scale(&self) -> bool {
        self.metric.space == Space::E2 && !self.has_pins()
    }

    /// Curvature error that a linear solution may leave, a small share of the tolerance.
    pub(super) fn enough(&self) -> f64 {
        0.01 * self.options.tolerance
    }

    /// Compute a state at its u, on the Delaunay triangulation there if edges may be flipped; false outside the domain.
    pub(super) fn evaluate(
        &mut self,
        state: &mut FlowState,
        report: &mut Report,
        control: &Control,
    ) -> Result<bool> {
        timed(&mut report.seconds.assemble, || state.measure(&self.mesh, &self.metric));
        if !self.flips_allowed {
            return Ok(timed(&mut report.seconds.assemble, || state.finish(&self.mesh)));
        }
        let Flow { now: Solution { mesh, metric, followed, .. }, log, fixed, .. } = self;
        let mut record = |mesh: &Mesh, flip| log.record(mesh, flip, followed);
        let surface = ClassFlips { mesh: Arc::make_mut(mesh), metric, record: &mut record };
        let (real, flips) = state.flip_to_delaunay(surface, fixed, &mut report.seconds, control)?;
        report.flips += flips;
        self.unseen_flips += flips;
        Ok(real)
    }

    /// Take the system for the present unknowns and triangulation out of the flow, new or kept; a kept one may have the factor of another
    /// triangulation ([`Flow::analysed`]). The caller puts it back.
    pub(super) fn take_system(&mut self, report: &mut Report) -> Result<NewtonSystem> {
        let flips = std::mem::take(&mut self.unseen_flips);
        let system = match self.system.take() {
            Some(kept) if flips == 0 => kept,
            Some(kept) => timed(&mut report.seconds.analyse, || {
                kept.flipped(&self.mesh, &self.held_by_system(), self.mirror.as_deref(), flips)
            })?,
            None => timed(&mut report.seconds.analyse, || self.new_system())?,
        };
        report.unknowns = system.unknowns();
        report.factor_entries = system.factor_entries();
        Ok(system)
    }

    /// An analysed system of the present unknowns and triangulation.
    fn new_system(&self) -> Result<NewtonSystem> {
        NewtonSystem::new(&self.mesh, &self.held_by_system(), self.mirror.as_deref())
    }

    /// The vertices at which the system has no unknown.
    fn held_by_system(&self) -> Vec<bool> {
        let mut held = if self.is_bounded { vec![false; self.pinned.len()] } else { self.pinned.clone() };
        held[0] |= self.free_scale();
        held
    }

    /// A system that can be factorised in this precision.
    pub(super) fn analysed(
        &self,
        system: NewtonSystem,
        precision: Precision,
        report: &mut Report,
    ) -> Result<NewtonSystem> {
        if system.is_ready(precision) {
            return Ok(system);
        }
        let system = timed(&mut report.seconds.analyse, || system.analysed(&self.mesh, precision))?;
        report.factor_entries = system.factor_entries();
        Ok(system)
    }

    /// Fill the matrix at a state.
    pub(super) fn assemble(&self, system: &mut NewtonSystem, state: &FlowState, report: &mut Report) {
        timed(&mut report.seconds.assemble, || {
            system.jacobian.assemble(&self.mesh, &self.metric, state);
            if self.is_bounded {
                system.jacobian.hold(&self.mesh, &self.pinned);
            }
        });
    }
}

/// Subtract the mean.
pub(super) fn centre(x: &mut [f64]) {
    let mean = x.iter().sum::<f64>() / x.len() as f64;
    x.iter_mut().for_each(|x| *x -= mean);
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::flow::Options;
    use crate::mesh::EdgeId;
    use crate::mesh::shapes::{self, SplitMix64};
    use crate::metric::{Class, Surface};
    use std::f64::consts::TAU;

    #[test]
    fn a_solve_that_cannot_go_on_in_the_double_leaves_the_flow_as_it_was() {
        let disk = Surface::from_soup(&shapes::disk(6).unwrap()).unwrap();
        let (n, control, mut random) = (disk.mesh().n_vertices(), Control::new(), SplitMix64::new(4));
        let mut target = PerVertex::from_fn(n, |_: VertexId| 4.0 * (random.unit() - 0.5));
        let miss = (TAU - target.iter().sum::<f64>()) / n as f64;
        target.iter_mut().for_each(|k| *k += miss);
        for class in [Class::yamabe(Space::E2), Class::inversive(Space::E2)] {
            let start = || Flow::new(disk.clone(), class, &Options::default(), &control).unwrap();
            let (report, left) = start().run(&target, &control).unwrap();
            assert!(left && report.flips > 0);
            let mut flow = start();
            let before = (flow.solution(), flow.start.clone(), flow.start_low.clone());
            // With these options the double cannot be made.
            flow.options.fixed_edges = vec![EdgeId(u32::MAX)];
            assert!(flow.reach(&target, &control).is_err());
            let (Solution { mesh, metric, followed, flips, .. }, u, u_low) = before;
            assert!(flow.mesh == mesh && flow.metric == metric && flow.followed == followed);
            assert!(flow.flips == flips && flow.start == u && flow.start_low == u_low);
            assert!(flow.report().is_none());
        }
    }
}
