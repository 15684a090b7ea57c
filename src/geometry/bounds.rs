//! Axis-parallel boxes.

use super::vector::{self, Vector};

/// An axis-parallel box.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Bounds {
    pub low: Vector,
    pub high: Vector,
}

impl Bounds {
    /// Of points; without points it has no inside.
    pub fn of(points: impl IntoIterator<Item = Vector>) -> Bounds {
        let none = Bounds { low: [f64::INFINITY; 3], high: [f64::NEG_INFINITY; 3] };
        points.into_iter().fold(none, |bounds, p| bounds.union(Bounds { low: p, high: p }))
    }

    /// The least box around two.
    pub fn union(self, other: Bounds) -> Bounds {
        let low = std::array::from_fn(|x| self.low[x].min(other.low[x]));
        Bounds { low, high: std::array::from_fn(|x| self.high[x].max(other.high[x])) }
    }

    /// Wider by this much on every side.
    pub fn widened(self, by: f64) -> Bounds {
        Bounds { low: vector::sub(self.low, [by; 3]), high: vector::add(self.high, [by; 3]) }
    }
}
