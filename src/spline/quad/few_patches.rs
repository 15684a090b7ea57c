//! Splines of few patches: over the coarsest layout of a seamless metric, or one with more patches where that is not within the tolerance.

use super::fit::QuadFit;
use super::over_quads::{LayoutFitOptions, fit_quad_layout};
use crate::control::Control;
use crate::error::{Error, Result};
use crate::quads::{QuadLayout, QuadOptions, QuadSize, quad_layout};
use crate::seamless::Seamless;

/// Layouts that are tried, each with at most so many times as many patches as the coarsest one.
const MORE_PATCHES: [usize; 2] = [1, 2];

/// A fitted spline with the layout that it is over.
pub struct LayoutFit {
    /// The layout.
    pub layout: QuadLayout,
    /// The fit.
    pub fit: QuadFit,
}

/// Fits a spline with as few patches as possible to the surface of a seamless metric: over the coarsest layout or, where that is not within the
/// tolerance or folds, one with up to twice as many patches. The first that is within it, or else that with the fewest patches folded, then the
/// least distance.
///
/// # Errors
/// Those of [`quad_layout`] and [`fit_quad_layout`].
pub fn fit_few_patches(
    seamless: &Seamless,
    options: &LayoutFitOptions,
    control: &Control,
) -> Result<LayoutFit> {
    let mut best: Option<LayoutFit> = None;
    let mut least = 0;
    for (k, more) in MORE_PATCHES.into_iter().enumerate() {
        let size = if more == 1 { QuadSize::Coarse } else { QuadSize::AtMost(more * least) };
        let of_attempt = control.attempt(k);
        let sized = QuadOptions { size, threads: options.threads };
        let layout = match quad_layout(seamless, &sized, &of_attempt.part(0.0, 0.2)) {
            // There need not be another layout.
            Err(Error::Layout(_)) if best.is_some() => break,
            other => other?,
        };
        if more == 1 {
            least = layout.patches.len();
        } else if layout.patches.len() <= least {
            break;
        }
        let fit = fit_quad_layout(seamless, &layout, options, &of_attempt.part(0.2, 1.0))?;
        let is_done = options.is_met_by(&fit);
        if best.as_ref().is_none_or(|best| fit.is_better_than(&best.fit)) {
            best = Some(LayoutFit { layout, fit });
        }
        if is_done {
            break;
        }
    }
    best.ok_or_else(|| Error::Layout("no layout of the surface was found".into()))
}
