//! The flat metric of a punctured sphere: the plane.
//!
//! Among the metrics that keep their bounds ([`super::star`]) the convex energy `∫ Σ K_j du_j` of the planar part has one lowest point
//! [Spr20]. There K = 0 inside; at the link of ∞, whose vertices are on their bounds, the gradient K_j is the turning of the outline
//! and is not negative. So the planar part is a convex polygon with a Delaunay triangulation, or, in the upper half-space, an ideal
//! convex polyhedron with one vertex at infinity.
//!
//! It is found by an active-set method ([`ActiveSet`]): Newton steps with the link held; after each step vertices that violate their
//! bound enter the link, and those at which the outline turns the wrong way leave it.

use super::star::{FLAT_POLYHEDRON, PuncturedSurface};
use crate::control::Control;
use crate::error::Result;
use crate::flow::{ActiveSet, BorrowedMetric, Flow, FlowSeconds, Options, Report, StopReason};
use crate::geometry::double_double::two_sum;
use crate::geometry::worse;
use crate::mesh::{HalfedgeId, PerVertex};

/// Radians. Vertices may leave the link once the largest |K| inside is below this; before, the outline is far from its final shape.
const SETTLED: f64 = 0.5;
/// Radians. Largest angle of the triangle that is made where a vertex leaves the link: the metric around it is only known near the
/// present u.
const WIDEST_OPENING: f64 = 0.5;
/// Radians. Largest |K| below which Newton's method converges quadratically, so that a step that raises the error was too long.
const QUADRATIC: f64 = 1e-3;
/// Shortest step of u. An angle of 1e-12 is all rounding, and lengths change by the squares of angles.
const SHORTEST_STEP: f64 = 1e-24;
/// Radians. A triangle with a smaller angle changes the lengths around it by less than 1e-6, the square of the angle, and is made with
/// its full angle at once.
const NARROW: f64 = 1e-3;

/// The conditions that a plane is to fulfil.
#[derive(Debug, Clone, Copy)]
pub(super) struct PlaneGoal {
    /// Radians by which the outline may turn the wrong way at a vertex.
    pub straight: f64,
    /// True if angles far below 1e-4 count at the end. Then edges of slivers are flipped too, and near the end a step that
    /// raises the error, because a sliver breaks on its way, is made again a quarter as long.
    pub slivers: bool,
}

/// The report of a flow to a plane.
#[derive(Debug, Clone, Copy)]
pub(super) struct PlaneReport {
    /// True if |K| inside is within the tolerance and the outline is convex within that of the goal.
    pub converged: bool,
    pub stop_reason: StopReason,
    /// Largest |K| inside.
    pub error: f64,
    /// Least turning of the outline.
    pub turning: f64,
}

/// The solver that all flows of a call share, with its steps and times so far.
pub(super) struct PlaneSolver<'a> {
    flow: Flow,
    pub options: &'a Options,
    pub control: &'a Control,
    /// Newton steps so far.
    pub iterations: usize,
    pub seconds: FlowSeconds,
}

impl<'a> PlaneSolver<'a> {
    /// A solver for punctures of this surface.
    pub fn new(
        begin: &PuncturedSurface,
        options: &'a Options,
        control: &'a Control,
    ) -> Result<PlaneSolver<'a>> {
        let flow = Flow::within_bounds(begin.mesh.clone(), begin.metric.clone(), options)?;
        Ok(PlaneSolver { flow, options, control, iterations: 0, seconds: FlowSeconds::default() })
    }

    /// The number of Newton steps that remain until the limit of the options.
    pub fn left(&self) -> usize {
        self.options.iteration_limit().saturating_sub(self.iterations)
    }

    /// Count the steps and the time of a flow.
    pub fn add(&mut self, report: &Report) {
        self.iterations += report.iterations;
        self.seconds += report.seconds;
    }
}

impl PuncturedSurface {
    /// Flow from the present u to the plane in `most` Newton steps at most; no further where all vertices lie on a line
    /// ([`PuncturedSurface::is_flat`]).
    pub fn flatten(&mut self, goal: PlaneGoal, most: usize, solver: &mut PlaneSolver) -> Result<PlaneReport> {
        let (mut steps, mut longest) = (0, solver.options.max_step);
        self.enter(goal.slivers)?;
        loop {
            let before = goal.slivers.then(|| (self.metric.u.clone(), self.metric.u_low.clone()));
            let report = self.step(longest, solver)?;
            steps += 1;
            let (error, stop_reason) = (report.max_curvature_error, report.stop_reason);
            let was_near = report.residuals.first().is_some_and(|&first| first < QUADRATIC && first < error);
            longest = solver.options.max_step;
            if let Some((u, u_low)) = before.filter(|_| was_near && steps < most) {
                let moved = self.metric.u.iter().zip(u.iter()).map(|(a, b)| (a - b).abs()).fold(0.0, worse);
                if moved > SHORTEST_STEP {
                    (self.metric.u, self.metric.u_low) = (u, u_low);
                    self.enter(true)?;
                    longest = 0.25 * moved;
                    continue;
                }
            }
            let entered = self.enter(goal.slivers)?;
            let turning = self.turning()?;
            let least = -turning.iter().map(|x| -x).fold(f64::NEG_INFINITY, worse);
            log::debug!(
                "punctured at {}, step {}: max |K| = {error:.1e}, {} arcs, least turning {least:.1e}",
                self.at,
                solver.iterations,
                turning.len()
            );
            let ended = stop_reason != StopReason::IterationLimit;
            let settled = error < SETTLED || ended;
            let go_on = entered || (settled && self.leave(&turning, error.max(goal.straight))?);
            // If triangles are broken at the lowest point, angles are only as accurate as the goal for the outline.
            let is_broken = stop_reason == StopReason::BrokenTriangles;
            let within = if is_broken { FLAT_POLYHEDRON.max(goal.straight) } else { FLAT_POLYHEDRON };
            if (!go_on && ended) || steps >= most || self.is_flat(within)? {
                let converged = report.converged() && !go_on;
                let stop_reason = if go_on { StopReason::IterationLimit } else { stop_reason };
                return Ok(PlaneReport { converged, stop_reason, error, turning: least });
            }
        }
    }

    /// One Newton step with the puncture and its link held.
    fn step(&mut self, max_step: f64, solver: &mut PlaneSolver) -> Result<Report> {
        let link = self.star().into_iter().map(|arc| self.mesh.tip(arc));
        let active = ActiveSet { held: link.chain([self.at]).collect(), fixed_edges: self.rim() };
        // The solver measures the faces of the star too, so these must be triangles.
        (self.metric.u[self.at], self.metric.u_low[self.at]) = (self.closing_u(), 0.0);
        let lent =
            BorrowedMetric { mesh: &mut self.mesh, metric: &mut self.metric, followed: &mut self.followed };
        let report = solver.flow.step_within(lent, &active, max_step, solver.control);
        (self.metric.u[self.at], self.metric.u_low[self.at]) = (0.0, 0.0);
        let report = report?;
        self.flips += report.flips;
        solver.add(&report);
        Ok(report)
    }

    /// Vertices at which the outline turns by less than `−most` leave the link, no two next to each other; returns whether there
    /// were any. A vertex j with m > 1 arcs leaves all of them: angles inside are at most π, so `K_j = Σ κ − 2π (m − 1) < 0`.
    fn leave(&mut self, turning: &[f64], most: f64) -> Result<bool> {
        let mut is_near = PerVertex::filled(self.mesh.n_vertices(), false);
        let mut arcs = PerVertex::filled(self.mesh.n_vertices(), 0);
        let star = self.star();
        star.iter().for_each(|&arc| arcs[self.mesh.tip(arc)] += 1);
        let mut any = false;
        for (arc, &turning) in star.into_iter().zip(turning) {
            let [left, right] = self.link_at(arc);
            let j = self.mesh.tip(arc);
            let around = [j, self.mesh.tip(left), self.mesh.origin(right)];
            let has_several = arcs[j] > 1;
            if (turning >= -most && !has_several) || around.iter().any(|&v| is_near[v]) {
                continue;
            }
            let rise = if has_several { Some(WIDEST_OPENING) } else { self.opened(arc, -turning)? };
            let Some(rise) = rise else { continue };
            (self.metric.u[j], self.metric.u_low[j]) = two_sum(self.metric.u[j], rise);
            around.iter().for_each(|&v| is_near[v] = true);
            any = true;
        }
        if any {
            self.enter(false)?;
        }
        Ok(any)
    }

    /// Flip an arc to j out of the star, and return the rise of u_j after which the new triangle at j has the angle `π − φ`; none where
    /// the arc cannot be flipped. A narrow `excess` of the angle over π is φ, as nothing else moves; half of a wide one is.
    ///
    /// The new triangle has the sides a, b and c = a + b. Raising u_j by x makes a + b − c larger by x (a + b)/2, which is to be
    /// `φ² a b/(2 (a + b))`. c is rounded: the present a + b − c is taken as it came out.
    fn opened(&mut self, arc: HalfedgeId, excess: f64) -> Result<Option<f64>> {
        let [a, b] = self.link_at(arc).map(|h| self.length(h));
        if !self.flip(arc.edge()) {
            return Ok(None);
        }
        let phi = if excess < NARROW { excess } else { (0.5 * excess).min(WIDEST_OPENING) };
        Ok(Some(phi * phi * (a / (a + b)) * (b / (a + b)) - 4.0 * self.slack(arc)? / (a + b)))
    }

    /// The edges of the link at the tip of an arc: from there, and to there.
    fn link_at(&self, arc: HalfedgeId) -> [HalfedgeId; 2] {
        [self.link(arc), self.mesh.prev(arc.twin())]
    }
}
