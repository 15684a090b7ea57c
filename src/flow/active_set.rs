//! Newton steps under bounds on u, by an active-set method.
//!
//! Among the u with `u_j ≥ b_j` for some vertices j, the lowest point of the convex energy `∫ Σ (K_j − K̄_j) du_j` has K_j = K̄_j
//! where u_j is above its bound, and `K_j − K̄_j ≥ 0`, which is the multiplier of the bound, where u_j is on it. The bounds that u is
//! held on are the *active set*. The caller takes Newton steps with it ([`Flow::step_within`]) and changes it in between: bounds that
//! are violated enter, those with a negative multiplier leave.
//!
//! Held vertices keep their rows and columns in the Newton matrix, as those of the identity. The pattern of the matrix is then that of
//! the triangulation, whichever vertices are held, so one analysis serves all steps, also those on other surfaces of that pattern.

use super::seconds::timed;
use super::system::NewtonSystem;
use super::{Flow, Options, Report};
use crate::control::Control;
use crate::error::{Error, Result};
use crate::mesh::{EdgeId, FixedEdges, Mesh, NormalCoordinates, VertexId};
use crate::metric::Metric;
use std::sync::Arc;

/// The vertices and edges that a Newton step leaves as they are.
pub(crate) struct ActiveSet {
    /// Vertices on their bound.
    pub held: Vec<VertexId>,
    /// Edges whose flips would change the bounds.
    pub fixed_edges: Vec<EdgeId>,
}

/// A metric that a flow borrows for one step.
pub(crate) struct BorrowedMetric<'a> {
    pub mesh: &'a mut Mesh,
    pub metric: &'a mut Metric,
    /// Every flip is recorded in these.
    pub followed: &'a mut Vec<NormalCoordinates>,
}

impl BorrowedMetric<'_> {
    fn exchange(&mut self, flow: &mut Flow) {
        std::mem::swap(self.mesh, Arc::make_mut(&mut flow.now.mesh));
        std::mem::swap(self.metric, &mut flow.now.metric);
        std::mem::swap(self.followed, &mut flow.now.followed);
    }
}

impl Flow {
    /// A solver for [`Flow::step_within`] on metrics with as many vertices and edges as this one, with K̄ = 0. It keeps its
    /// memory and the analysis of its matrix from step to step.
    ///
    /// # Errors
    /// Those of [`Flow::from_metric`].
    pub(crate) fn within_bounds(mesh: Mesh, metric: Metric, options: &Options) -> Result<Flow> {
        let options = Options { max_iterations: 1, ..options.clone() };
        // The active set changes by the signs of the multipliers that a step leads to, so steps are solved in f64 from the first.
        let flow = Flow::from_metric(mesh, metric, &options)?;
        Ok(Flow { is_bounded: true, single_serves: false, ..flow })
    }

    /// One Newton step of a metric, with flips, on the threads of the caller's pool; no u moves by more than `max_step`.
    ///
    /// # Errors
    /// [`Error::Argument`] for lengths that are not real, and where no vertex is held that fixes the scale;
    /// [`Error::Factorisation`], [`Error::Cancelled`]. The metric is then its start, and may have been flipped.
    pub(crate) fn step_within(
        &mut self,
        mut lent: BorrowedMetric<'_>,
        active: &ActiveSet,
        max_step: f64,
        control: &Control,
    ) -> Result<Report> {
        lent.exchange(self);
        let report = self.step_now(active, max_step, control);
        lent.exchange(self);
        report
    }

    fn step_now(&mut self, active: &ActiveSet, max_step: f64, control: &Control) -> Result<Report> {
        self.pinned.fill(false);
        active.held.iter().for_each(|v| self.pinned[v.index()] = true);
        if self.free_scale() {
            let (value, need) = ("empty".into(), "a vertex at least, which fixes the scale");
            return Err(Error::Argument { what: "active set", value, need });
        }
        self.fixed = FixedEdges::new(&self.mesh, &active.fixed_edges)?;
        self.log.clear();
        self.options.max_step = max_step;
        // Only with several threads is a system made that no step needs. It is dropped, so that steps are the same for any number.
        self.system = self.system.take().filter(NewtonSystem::has_factor);
        // The pattern of the system may be out of date, since edges were flipped outside this flow.
        self.unseen_flips =
            self.system.as_ref().map_or(0, |system| system.jacobian.changed_edges(&self.mesh));
        (self.start, self.start_low) = (self.metric.u.clone(), self.metric.u_low.clone());
        let mut report = Report::new(self.options.tolerance);
        let mut seconds = 0.0;
        let end = timed(&mut seconds, || self.flow(&mut report, control))?;
        report.seconds.total = seconds;
        (self.now.metric.u, self.now.metric.u_low) = (end.state.u, end.state.low);
        Ok(report)
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::geometry::Space;
    use crate::mesh::{PerVertex, shapes};
    use crate::metric::{Class, Surface};

    #[test]
    fn held_vertices_are_pinned_ones_and_need_no_analysis_of_their_own() {
        let surface = Surface::from_soup(&shapes::icosphere(6).unwrap()).unwrap();
        let start = surface.initial(Class::yamabe(Space::E2)).unwrap().metric;
        let (mesh, control) = (Mesh::clone(surface.mesh()), Control::new());
        let mut bounded = Flow::within_bounds(mesh.clone(), start.clone(), &Options::default()).unwrap();
        for held in [vec![0, 5, 9], vec![7], vec![0, 1, 2, 3, 4, 30]] {
            let held: Vec<VertexId> = held.into_iter().map(VertexId).collect();
            let options = Options { pinned: held.clone(), max_iterations: 1, ..Options::default() };
            let mut pinned = Flow::from_metric(mesh.clone(), start.clone(), &options).unwrap();
            pinned.single_serves = false;
            let expected =
                pinned.reach(&PerVertex::filled(mesh.n_vertices(), 0.0), &control).unwrap().clone();
            let (mut moved_mesh, mut metric, mut followed) = (mesh.clone(), start.clone(), Vec::new());
            let lent = BorrowedMetric { mesh: &mut moved_mesh, metric: &mut metric, followed: &mut followed };
            let active = ActiveSet { held: held.clone(), fixed_edges: Vec::new() };
            let report = bounded.step_within(lent, &active, 3.0, &control).unwrap();
            assert_eq!((report.iterations, report.flips), (expected.iterations, expected.flips));
            assert!((report.max_curvature_error - expected.max_curvature_error).abs() < 1e-11);
            assert_eq!(moved_mesh, **pinned.mesh());
            for v in mesh.vertices() {
                assert!((metric.u[v] - pinned.metric().u[v]).abs() < 1e-11, "{v}");
            }
            assert!(held.iter().all(|&v| metric.u[v] == start.u[v]));
            let is_first = held.len() == 3;
            assert_eq!(report.seconds.analyse > 0.0, is_first, "{held:?}");
        }
    }
}
