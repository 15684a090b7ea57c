//! The verdict on a circle domain as it is returned: whether it is converged, and why not.

use super::super::lift::span_beyond_range;
use super::domain::{CircleDomain, CircleReport, DomainCircle};
use super::options::ROUND;
use crate::flow::StopReason;
use crate::geometry::worse;
use crate::mesh::{PerVertex, VertexId};

/// The largest |K| of some vertices, and where it is.
pub(super) fn largest_curvature(
    curvature: &PerVertex<f64>,
    counts: impl Fn(VertexId) -> bool,
) -> (f64, Option<VertexId>) {
    let of = (0..curvature.len()).map(VertexId::from).filter(|&v| counts(v));
    let worst = of.max_by(|&a, &b| curvature[a].abs().total_cmp(&curvature[b].abs()).then(b.cmp(&a)));
    (worst.map_or(0.0, |v| curvature[v].abs()), worst)
}

/// The largest deviation of a loop from its circle, and the loop.
pub(super) fn largest_deviation(circles: &[DomainCircle]) -> (f64, Option<usize>) {
    let worst = circles.iter().max_by(|a, b| a.deviation.total_cmp(&b.deviation));
    (circles.iter().map(|c| c.deviation).fold(0.0, worse), worst.map(|c| c.boundary_loop))
}

impl CircleDomain {
    /// True if nothing is wrong with the domain as it is, or if more edges on its loops will mend what is.
    pub(super) fn is_exact(&self) -> bool {
        self.report.converged || (self.report.least_gap <= 0.0 && self.report.deviation <= ROUND)
    }

    /// The span of the metric's u, if it is so large that f64s hardly hold the squares of all lengths: then a part of the surface is about 2/π
    /// times that span as long as wide.
    pub fn span_beyond_range(&self) -> Option<f64> {
        span_beyond_range(self.metric.metric().u.iter().copied())
    }

    /// The domain with the verdict on it as it is. `report` holds the stop reason of the flow.
    pub(super) fn judged(mut self, tolerance: f64) -> CircleDomain {
        let (deviation, worst_loop) = largest_deviation(&self.circles);
        let fits = self.layout.flipped.is_empty() && self.report.least_gap > 0.0;
        let report = &mut self.report;
        (report.deviation, report.worst_loop) = (deviation, worst_loop);
        report.stop_reason = report.stop_reason_of_domain(tolerance, fits);
        report.converged = report.stop_reason == StopReason::Converged;
        self
    }
}

impl CircleReport {
    /// The stop reason of the flow, unless it converged and the domain is not that exact, or does not fit: triangles of it are flipped, or
    /// circles overlap.
    fn stop_reason_of_domain(&self, tolerance: f64, fits: bool) -> StopReason {
        let is_exact = self.domain_curvature_error <= tolerance && self.deviation <= ROUND;
        match self.stop_reason {
            StopReason::Converged if !is_exact => {
                StopReason::RoundingFloor { size: worse(self.domain_curvature_error, self.deviation) }
            }
            StopReason::Converged if !fits => StopReason::BrokenTriangles,
            reason => reason,
        }
    }
}
