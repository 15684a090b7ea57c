//! Memory that goes from solve to solve, so that many solves of one flow do not ask for it again and again.

use super::evaluate::State;
use crate::mesh::PerVertex;

/// What solves have given back. Empty pieces have their memory still.
#[derive(Default)]
pub(super) struct Memory {
    states: Vec<State>,
    vectors: Vec<Vec<f64>>,
}

impl Memory {
    /// A state at this u, nothing of which is measured.
    pub fn state(&mut self, u: &PerVertex<f64>, low: &PerVertex<f64>) -> State {
        match self.states.pop() {
            Some(kept) => kept.at(u, low),
            None => State::new(u, low),
        }
    }

    /// `n` zeros.
    pub fn zeros(&mut self, n: usize) -> Vec<f64> {
        let mut vector = self.vectors.pop().unwrap_or_default();
        vector.clear();
        vector.resize(n, 0.0);
        vector
    }

    pub fn take_back(&mut self, state: State) {
        self.states.push(state);
    }

    pub fn take_back_vectors(&mut self, vectors: [Vec<f64>; 3]) {
        self.vectors.extend(vectors);
    }
}
