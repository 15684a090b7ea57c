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
    /// tolerance, for sides of more than two patches, and for a spline without patches; [`Error::Cancelled`].
    pub fn to_bicubic(&self, options: &BicubicOptions, control: &Control) -> Result<BicubicFit> {
        let BicubicOptions { tolerance, angle, .. } = *options;
        if !(LEAST_TOLERANCE..=1.0).contains(&tolerance) {
            return Err(Error::argument("tolerance", tolerance, "a share of the diagonal, 1e-10 to 1"));
        }
        if !(angle > 0.0 && angle.is_finite()) {
            return Err(Error::argument("angle", angle, "positive, in radians"));
        }
        let mut work = BicubicRefinement::new(self, *options, control)?;
        work.refine()?;
        work.finish()
    }
}
