//! Orientation-preserving similarities of the plane, as maps between charts.

use crate::geometry::complex::{Complex, add, conj, mul, norm2, scale, sub};

/// The similarity z ↦ turn z + shift of the plane.
#[derive(Debug, Clone, Copy)]
pub(super) struct PlaneSimilarity {
    pub turn: Complex,
    pub shift: Complex,
}

impl PlaneSimilarity {
    pub const IDENTITY: PlaneSimilarity = PlaneSimilarity { turn: [1.0, 0.0], shift: [0.0, 0.0] };

    pub fn of(&self, p: Complex) -> Complex {
        add(mul(self.turn, p), self.shift)
    }

    /// The composition: first `other`, then this.
    pub fn after(&self, other: &PlaneSimilarity) -> PlaneSimilarity {
        PlaneSimilarity { turn: mul(self.turn, other.turn), shift: self.of(other.shift) }
    }

    pub fn inverse(&self) -> PlaneSimilarity {
        let turn = scale(1.0 / norm2(self.turn), conj(self.turn));
        PlaneSimilarity { turn, shift: mul(turn, sub([0.0; 2], self.shift)) }
    }

    pub fn of_rows([[a, _, x], [b, _, y]]: [[f64; 3]; 2]) -> PlaneSimilarity {
        PlaneSimilarity { turn: [a, b], shift: [x, y] }
    }

    pub fn rows(&self) -> [[f64; 3]; 2] {
        let ([a, b], [x, y]) = (self.turn, self.shift);
        [[a, -b, x], [b, a, y]]
    }
}
