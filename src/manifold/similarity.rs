//! Similarities of the plane.

use crate::geometry::complex::{Complex, add, conj, mul, norm2, scale, sub};

/// An orientation-preserving similarity of the plane: z ↦ turn z + shift.
#[derive(Debug, Clone, Copy)]
pub(super) struct Similarity {
    pub turn: Complex,
    pub shift: Complex,
}

impl Similarity {
    pub const IDENTITY: Similarity = Similarity { turn: [1.0, 0.0], shift: [0.0, 0.0] };

    pub fn of(&self, p: Complex) -> Complex {
        add(mul(self.turn, p), self.shift)
    }

    /// First `other`, then this.
    pub fn after(&self, other: &Similarity) -> Similarity {
        Similarity { turn: mul(self.turn, other.turn), shift: self.of(other.shift) }
    }

    pub fn inverse(&self) -> Similarity {
        let turn = scale(1.0 / norm2(self.turn), conj(self.turn));
        Similarity { turn, shift: mul(turn, sub([0.0; 2], self.shift)) }
    }

    pub fn of_rows([[a, _, x], [b, _, y]]: [[f64; 3]; 2]) -> Similarity {
        Similarity { turn: [a, b], shift: [x, y] }
    }

    pub fn rows(&self) -> [[f64; 3]; 2] {
        let ([a, b], [x, y]) = (self.turn, self.shift);
        [[a, -b, x], [b, a, y]]
    }
}
