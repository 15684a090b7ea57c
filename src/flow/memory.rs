//! Keeps the memory of solves for later ones, so that many solves of one flow do not allocate it again and again.

use super::evaluate::FlowState;
use crate::mesh::PerVertex;

/// States and vectors whose memory is used again.
#[derive(Default)]
pub(super) struct SolveMemory {
    states: Vec<FlowState>,
    vectors: Vec<Vec<f64>>,
}

impl SolveMemory {
    /// A state at this u, without measurements.
    pub fn state(&mut self, u: &PerVertex<f64>, low: &PerVertex<f64>) -> FlowState {
        match self.states.pop() {
            Some(kept) => kept.at(u, low),
            None => FlowState::new(u, low),
        }
    }

    /// `n` zeros.
    pub fn zeros(&mut self, n: usize) -> Vec<f64> {
        let mut vector = self.vectors.pop().unwrap_or_default();
        vector.clear();
        vector.resize(n, 0.0);
        vector
    }

    pub fn take_back(&mut self, state: FlowState) {
        self.states.push(state);
    }

    pub fn take_back_vectors(&mut self, vectors: [Vec<f64>; 3]) {
        self.vectors.extend(vectors);
    }
}
