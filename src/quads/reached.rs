//! The order in which searches for cheapest walks look at states.

use std::cmp::Ordering;

/// A state and the cost of the way to it; the cheapest is the greatest.
#[derive(PartialEq)]
pub(super) struct Reached(pub f64, pub usize);

impl Eq for Reached {}

impl PartialOrd for Reached {
    fn partial_cmp(&self, other: &Reached) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Reached {
    fn cmp(&self, other: &Reached) -> Ordering {
        other.0.total_cmp(&self.0).then(other.1.cmp(&self.1))
    }
}
