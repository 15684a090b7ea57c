//! The flat metric of a punctured sphere: the plane.
//!
//! Among the metrics that keep their bounds ([`super::star`]) the convex energy `∫ Σ K_j du_j` of the planar part has one lowest point
//! [Spr20]. There K = 0 inside; at the vertices that are held by their bound, the link of ∞, the gradient K_j is the turning of
//! the outline and is not negative. So the planar part is a convex polygon with a Delaunay triangulation, or, in the upper
//! half-space, an ideal convex polyhedron with one vertex at infinity.
//!
//! Newton's method with an active set: after each step, vertices that overstep their bound are put on it; those that
//! are held against their gradient are let go.

use super::star::{FLAT_POLYHEDRON, Punctured};
use crate::control::Control;
use crate::error::Result;
use crate::flow::{Flow, Options, Report, Seconds, StopReason};
use crate::geometry::twofold::two_sum;
use crate::geometry::worse;
use crate::mesh::{PerVertex, VertexId};

/// Vertices are let go once |K| inside is below this: before, turning says little.
const SETTLED: f64 = 0.5;
/// Most of its reflex angle that a vertex is let go by at once.
const WIDEST: f64 = 0.5;
/// Below this |K| a good step lowers it.
const NEAR: f64 = 1e-3;
/// Steps of u are not made shorter than this: squares of angles that are rounding.
const LEAST_STEP: f64 = 1e-24;
/// Angles of slivers below this change nothing around them: lengths move by their squares.
const NARROW: f64 = 1e-3;

/// How a flat metric was found.
#[derive(Debug, Clone, Copy)]
pub(super) struct Found {
    /// |K| inside is within the tolerance and the outline is convex, as far as was asked for.
    pub converged: bool,
    pub stop_reason: StopReason,
    /// Largest |K| inside.
    pub error: f64,
    /// Least turning of the outline.
    pub turning: f64,
}

/// What flows have cost.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Spent {
    /// Newton steps.
    pub iterations: usize,
    pub seconds: Seconds,
}

impl Spent {
    pub fn add(&mut self, report: &Report) {
        self.iterations += report.iterations;
        self.seconds += report.seconds;
    }
}

impl Punctured {
    /// Flow from the present u to the plane with an outline that turns by `−straight` at least, in `most` Newton steps at most, which are
    /// added to `spent`; no further where all vertices lie on a line ([`Punctured::is_flat`]).
    ///
    /// `slivers`: at the end angles far below 1e-4 count. Then edges of slivers are flipped by [`Punctured::restore`], and a step that
    /// raises the error, which is one over the edge of where slivers are triangles, is made again a quarter as long.
    pub fn flatten(
        &mut self,
        straight: f64,
        slivers: bool,
        most: usize,
        spent: &mut Spent,
        options: &Options,
        control: &Control,
    ) -> Result<Found> {
        let (mut rounds, mut longest) = (0, options.max_step);
        self.restore(slivers)?;
        loop {
            let before = slivers.then(|| self.clone());
            let report = self.step(longest, options, control)?;
            rounds += 1;
            spent.add(&report);
            let (error, stop_reason) = (report.max_curvature_error, report.stop_reason);
            let first = report.residuals.first().copied().unwrap_or(f64::INFINITY);
            longest = options.max_step;
            if let Some(before) = before.filter(|_| first < NEAR && first < error && rounds < most) {
                let moved = |v: VertexId| (self.metric.u[v] - before.metric.u[v]).abs();
                let moved = self.mesh.vertices().map(moved).fold(0.0, f64::max);
                if moved > LEAST_STEP {
                    (*self, longest) = (before, 0.25 * moved);
                    continue;
                }
            }
            let changed = self.restore(slivers)?;
            let turning = self.turning()?;
            let least = -turning.iter().map(|x| -x).fold(f64::NEG_INFINITY, worse);
            log::debug!(
                "punctured at {}, step {}: max |K| = {error:.1e}, {} arcs, least turning {least:.1e}",
                self.at,
                spent.iterations,
                turning.len()
            );
            let ended = stop_reason != StopReason::IterationLimit;
            let settled = error < SETTLED || ended;
            let go_on = changed || (settled && self.release(&turning, error.max(straight))?);
            if (!go_on && ended) || rounds >= most || self.is_flat(FLAT_POLYHEDRON)? {
                let converged = report.converged() && !go_on;
                let stop_reason = if go_on { StopReason::IterationLimit } else { stop_reason };
                return Ok(Found { converged, stop_reason, error, turning: least });
            }
        }
    }

    /// One Newton step with the star held.
    fn step(&mut self, max_step: f64, options: &Options, control: &Control) -> Result<Report> {
        let mut held: Vec<VertexId> = self.star().iter().map(|&arc| self.mesh.tip(arc)).collect();
        held.push(self.at);
        let options =
            Options { fixed_edges: self.rim(), max_iterations: 1, max_step, pinned: held, ..options.clone() };
        let followed = std::mem::take(&mut self.followed);
        let mut flow = Flow::from_metric(self.mesh.clone(), self.closed(), &options)?.following(followed);
        let report = flow.reach(&PerVertex::filled(self.mesh.n_vertices(), 0.0), control)?.clone();
        (self.mesh, self.metric, self.followed) = flow.into_parts();
        self.metric.u[self.at] = 0.0;
        self.flips += report.flips;
        Ok(report)
    }

    /// Let go of link vertices that turn by less than `−most`, no two next to each other; returns whether there were any.
    ///
    /// Flipped out, j lies on the side c of a triangle (a, b, c = a + b). Raising u_j by x makes a + b − c larger by x (a + b)/2, which
    /// is `φ² a b/(2 (a + b))` where the angle at j is `π − φ`. A narrow φ is all of what the outline turns in excess, as nothing else
    /// moves then; a wide one half of it. c is rounded: the difference is taken as it came out.
    ///
    /// A vertex j with m arcs has `K_j = Σ κ − 2π (m − 1) < 0`, since κ ≤ π: it is let go of all.
    fn release(&mut self, turning: &[f64], most: f64) -> Result<bool> {
        let mut near = PerVertex::filled(self.mesh.n_vertices(), false);
        let mut arcs = PerVertex::filled(self.mesh.n_vertices(), 0);
        let star = self.star();
        star.iter().for_each(|&arc| arcs[self.mesh.tip(arc)] += 1);
        let mut any = false;
        for (arc, turning) in star.into_iter().zip(turning) {
            let ([left, right], j) = ([self.link(arc), self.mesh.prev(arc.twin())], self.mesh.tip(arc));
            let ends = [j, self.mesh.tip(left), self.mesh.origin(right)];
            let [a, b] = [left, right].map(|h| self.length(h));
            let several = arcs[j] > 1;
            if (*turning >= -most && !several) || ends.iter().any(|&v| near[v]) {
                continue;
            }
            let rise = if several {
                WIDEST
            } else if self.flip(arc.edge()) {
                let angle = if -turning < NARROW { -turning } else { (-0.5 * turning).min(WIDEST) };
                angle * angle * (a / (a + b)) * (b / (a + b)) - 4.0 * self.slack(arc)? / (a + b)
            } else {
                continue;
            };
            (self.metric.u[j], self.metric.u_low[j]) = two_sum(self.metric.u[j], rise);
            ends.iter().for_each(|&v| near[v] = true);
            any = true;
        }
        if any {
            self.restore(false)?;
        }
        Ok(any)
    }
}
