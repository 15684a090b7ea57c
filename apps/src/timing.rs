//! The seconds that the phases of a command take.

use serde::Serialize;
use std::time::Instant;

/// Wall-clock seconds by phase; `write` is without pictures and ends before the report itself is written.
#[derive(Serialize, Default, Clone, Copy)]
pub struct PhaseSeconds {
    pub total: f64,
    pub read: f64,
    pub build: f64,
    pub assemble: f64,
    pub analyse: f64,
    pub factor: f64,
    pub solve: f64,
    pub bounds: f64,
    pub flip: f64,
    pub refine: f64,
    pub layout: f64,
    pub picture: f64,
    pub write: f64,
}

impl PhaseSeconds {
    /// Add the seconds of a flow.
    pub fn add_flow(&mut self, flow: &ricci::flow::FlowSeconds) {
        self.assemble += flow.assemble;
        self.analyse += flow.analyse;
        self.factor += flow.factor;
        self.solve += flow.solve;
        self.flip += flow.flip;
    }
}

/// Run `work` and add its seconds to a phase.
pub fn timed<T>(phase: &mut f64, work: impl FnOnce() -> T) -> T {
    let start = Instant::now();
    let result = work();
    *phase += start.elapsed().as_secs_f64();
    result
}
