//! The choice among the maps that were tried (*candidates*), which mostly are of several homotopy classes, by their energies.

use crate::error::{Error, Result};

/// The candidate of least energy among those that were offered, and the first failure among the others.
pub(super) struct LeastEnergy<T> {
    best: Option<(f64, T)>,
    failure: Option<Error>,
    /// Energy below which no other candidate is tried.
    stop_below: f64,
    /// Number of candidates with an energy.
    pub compared: usize,
}

impl<T> LeastEnergy<T> {
    /// A search without any candidate yet, which ends below this energy.
    pub fn new(stop_below: f64) -> LeastEnergy<T> {
        LeastEnergy { best: None, failure: None, stop_below, compared: 0 }
    }

    /// Takes in the next candidate with its energy, or the reason why there is none; true if the search is at its end. An energy that is
    /// not a number counts as larger than all numbers.
    ///
    /// # Errors
    /// [`Error::Cancelled`]; every other failure only rules this candidate out.
    pub fn offer(&mut self, candidate: Result<(f64, T)>) -> Result<bool> {
        match candidate {
            Ok((energy, map)) => {
                self.compared += 1;
                let is_less = |least: f64| energy < least || (least.is_nan() && !energy.is_nan());
                if self.best.as_ref().is_none_or(|(least, _)| is_less(*least)) {
                    self.best = Some((energy, map));
                }
            }
            Err(Error::Cancelled) => return Err(Error::Cancelled),
            Err(why) => self.failure = self.failure.take().or(Some(why)),
        }
        Ok(self.best.as_ref().is_some_and(|(energy, _)| *energy < self.stop_below))
    }

    /// The candidate of least energy so far.
    pub fn best(&self) -> Option<&T> {
        self.best.as_ref().map(|(_, map)| map)
    }

    /// The candidate of least energy.
    ///
    /// # Errors
    /// The first failure if every candidate failed; [`Error::Matching`] with the message `if_none_tried` if none was offered.
    pub fn into_best(self, if_none_tried: &str) -> Result<T> {
        match (self.best, self.failure) {
            (Some((_, map)), _) => Ok(map),
            (None, Some(why)) => Err(why),
            (None, None) => Err(Error::Matching(if_none_tried.into())),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_energy_that_is_not_a_number_is_never_the_least() {
        let mut least = LeastEnergy::new(f64::NEG_INFINITY);
        for candidate in [(f64::NAN, "first"), (2.0, "second"), (-f64::NAN, "third"), (3.0, "fourth")] {
            assert!(!least.offer(Ok(candidate)).unwrap());
        }
        assert_eq!((least.compared, least.best()), (4, Some(&"second")));
        assert_eq!(least.into_best("").unwrap(), "second");
    }
}
