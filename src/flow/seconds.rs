//! The time of a flow by phase.

use std::time::Instant;

/// Seconds by phase.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct FlowSeconds {
    /// Lengths, angles, curvature, derivative.
    pub assemble: f64,
    /// Ordering and symbolic analysis; on several threads some of it is done when the flow is made, and counts in its first solve.
    pub analyse: f64,
    /// Numeric factorisations.
    pub factor: f64,
    /// Triangular solves.
    pub solve: f64,
    /// Edge flips.
    pub flip: f64,
    /// The whole call, and what was done for it when the flow was made.
    pub total: f64,
}

impl std::ops::AddAssign for FlowSeconds {
    fn add_assign(&mut self, rest: FlowSeconds) {
        self.assemble += rest.assemble;
        self.analyse += rest.analyse;
        self.factor += rest.factor;
        self.solve += rest.solve;
        self.flip += rest.flip;
        self.total += rest.total;
    }
}

/// Do some work, and add the seconds that it takes to a phase.
pub(super) fn timed<R>(phase: &mut f64, work: impl FnOnce() -> R) -> R {
    let start = Instant::now();
    let result = work();
    *phase += start.elapsed().as_secs_f64();
    result
}
