//! The choice among maps of several homotopy classes by their energies.

use crate::error::{Error, Result};

/// The map of least energy among those that were tried, and the first failure among the others.
pub(super) struct LeastEnergy<T> {
    best: Option<(f64, T)>,
    failure: Option<Error>,
    /// Energy below which no other class is tried.
    enough: f64,
    /// Number of maps whose energies were compared.
    pub compared: usize,
}

impl<T> LeastEnergy<T> {
    /// A search without any maps yet, which ends below this energy.
    pub fn until(enough: f64) -> LeastEnergy<T> {
        LeastEnergy { best: None, failure: None, enough, compared: 0 }
    }

    /// Takes in the next map with its energy, or the reason why its class has none; true if the search is at its end.
    ///
    /// # Errors
    /// [`Error::Cancelled`]; every other failure only rules this class out.
    pub fn enter(&mut self, variant: Result<(f64, T)>) -> Result<bool> {
        match variant {
            Ok((energy, map)) => {
                self.compared += 1;
                if self.best.as_ref().is_none_or(|(least, _)| energy < *least) {
                    self.best = Some((energy, map));
                }
            }
            Err(Error::Cancelled) => return Err(Error::Cancelled),
            Err(why) => self.failure = self.failure.take().or(Some(why)),
        }
        Ok(self.best.as_ref().is_some_and(|(energy, _)| *energy < self.enough))
    }

    /// The map of least energy so far.
    pub fn best(&self) -> Option<&T> {
        self.best.as_ref().map(|(_, map)| map)
    }

    /// The map of least energy.
    ///
    /// # Errors
    /// The first failure if no class has a map; [`Error::Matching`] with the message `none` if no class was tried.
    pub fn into_best(self, none: &str) -> Result<T> {
        match (self.best, self.failure) {
            (Some((_, map)), _) => Ok(map),
            (None, Some(why)) => Err(why),
            (None, None) => Err(Error::Matching(none.into())),
        }
    }
}
