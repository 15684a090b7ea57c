//! The conversion of a spline to bicubic patches.

use super::outcome::{BicubicFit, BicubicOptions};
use super::refine::BicubicRefinement;
use crate::control::Control;
use crate::error::{Error, Result};
use crate::spline::triangular::Spline;

/// Least tolerance; with a smaller one, rounding errors of the spline itself would be refined.
const LEAST_TOLERANCE: f64 = 1e-10;

impl Spline {
    /// Bicubic patches within a tolerance of the spline, three for each of its patches, which meet without gaps and have as many spans as
    /// the tolerance needs.
    ///
    /// # Errors
    /// [`Error::Argument`] for options out of range; [`Error::Spline`] for a patch that 128 spans along each side do not bring within the
    /// tolerance, for sides of more than two patches, for a spline without patches, for one that folds, unless that is allowed, and where
    /// more control points than allowed are needed; [`Error::Cancelled`].
    pub fn to_bicubic(&self, options: &BicubicOptions, control: &Control) -> Result<BicubicFit> {
        let BicubicOptions { tolerance, angle, .. } = *options;
        if !(LEAST_TOLERANCE..=1.0).contains(&tolerance) {
            return Err(Error::argument("tolerance", tolerance, "a share of the diagonal, 1e-10 to 1"));
        }
        if !(angle > 0.0 && angle.is_finite()) {
            return Err(Error::argument("angle", angle, "positive, in radians"));
        }
        if !options.folds {
            self.check_folds(options, control)?;
        }
        let mut work = BicubicRefinement::new(self, *options, control)?;
        work.refine()?;
        work.finish()
    }

    fn check_folds(&self, options: &BicubicOptions, control: &Control) -> Result<()> {
        let folds = self.folds(options.threads, &control.still())?;
        let Some(&index) = folds.first() else { return Ok(()) };
        let message = format!(
            "the spline turns back on itself there, and in {} further patches: fit it again, with more fairness or more control points, or \
             allow folds",
            folds.len() - 1,
        );
        Err(Error::Spline { what: "patch", index, message })
    }
}
