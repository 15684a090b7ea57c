//! Axis-parallel boxes around points of space.

use super::vector::{self, Vector};

/// An axis-parallel box.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Bounds {
    pub low: Vector,
    pub high: Vector,
}

impl Bounds {
    /// The least box that contains the points; without points it is empty.
    pub fn of(points: impl IntoIterator<Item = Vector>) -> Bounds {
        let none = Bounds { low: [f64::INFINITY; 3], high: [f64::NEG_INFINITY; 3] };
        points.into_iter().fold(none, |bounds, p| bounds.union(Bounds { low: p, high: p }))
    }

    /// The least box that contains both.
    pub fn union(self, other: Bounds) -> Bounds {
        let low = std::array::from_fn(|x| self.low[x].min(other.low[x]));
        Bounds { low, high: std::array::from_fn(|x| self.high[x].max(other.high[x])) }
    }

    /// The box with each side moved outwards by `by`.
    pub fn widened(self, by: f64) -> Bounds {
        Bounds { low: vector::sub(self.low, [by; 3]), high: vector::add(self.high, [by; 3]) }
    }
}
