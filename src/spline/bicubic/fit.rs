//! Bicubic patches made from a spline.

use super::outcome::{Bicubic, BicubicOptions};
use super::refine::Work;
use crate::control::Control;
use crate::error::{Error, Result};
use crate::spline::surface::Spline;

/// Least tolerance: nearer, the rounding errors of the spline itself would be refined.
const LEAST_TOLERANCE: f64 = 1e-10;

impl Spline {
    /// Bicubic patches that are within a tolerance of the spline and meet without gaps, three per patch of the spline, with as many spans
    /// as that takes.
    ///
    /// # Errors
    /// [`Error::Argument`] for options out of range; [`Error::Spline`] for a patch that 128 spans along each side do not bring within the
    /// tolerance, for sides of more than two patches, and for a spline without patches; [`Error::Cancelled`].
    pub fn to_bicubic(&self, options: &BicubicOptions, control: &Control) -> Result<Bicubic> {
        let BicubicOptions { tolerance, angle, .. } = *options;
        if !(LEAST_TOLERANCE..=1.0).contains(&tolerance) {
            return Err(Error::argument("tolerance", tolerance, "a share of the diagonal, 1e-10 to 1"));
        }
        if !(angle > 0.0 && angle.is_finite()) {
            return Err(Error::argument("angle", angle, "positive, in radians"));
        }
        let mut work = Work::new(self, *options, control)?;
        work.refine()?;
        work.finish()
    }
}
