//! Splines of few patches: over the coarsest layouts of seamless metrics with other cones in turn, until one is within the tolerance.

use super::fit::QuadFit;
use super::over_quads::{LayoutFitOptions, fit_quad_layout};
use crate::control::Control;
use crate::error::{Error, Result};
use crate::mesh::EdgeId;
use crate::metric::Surface;
use crate::quads::{QuadLayout, QuadOptions, QuadSize, quad_layout};
use crate::seamless::{Seamless, SeamlessCones, SeamlessOptions, placed_cones, seamless};

/// Numbers of placed cones over which fits are tried where none are asked for; then those of the field.
const PLACED: [usize; 2] = [24, 40];
/// The multiple of the tolerance beyond which the cones of the field are not tried after placed ones: there they came no nearer, and take longest.
const HOPELESS: f64 = 3.0;
/// The factor by which a layout may have more patches than the coarsest one with the same cones, where that does not suffice.
const MORE_PATCHES: usize = 2;

/// Options of [`fit_few_patches`].
#[derive(Debug, Clone, Default)]
pub struct FewPatchesOptions {
    /// The cones, which become corners of patches. None: on a closed surface without features placed ones of several numbers are tried
    /// ([`placed_cones`]), then those of the field.
    pub cones: Option<SeamlessCones>,
    /// Edges that become sides of patches, across which normals may jump. Default none.
    pub features: Vec<EdgeId>,
    /// The fit; its threads are those of the whole work.
    pub fit: LayoutFitOptions,
}

/// A fitted spline with what it is over.
pub struct LayoutFit {
    /// The metric.
    pub seamless: Seamless,
    /// The layout.
    pub layout: QuadLayout,
    /// The fit.
    pub fit: QuadFit,
}

/// Fits a spline with few patches to a surface: over the coarsest layout of a seamless metric, with other cones where that is not within the tolerance
/// or folds, and last over a layout with up to twice as many patches; where placed cones leave more than three times the tolerance, that is the
/// end. The first fit within the tolerance, or else that with the fewest patches
/// folded, then the least distance.
///
/// # Errors
/// Those of [`seamless`], [`quad_layout`] and [`fit_quad_layout`] with the last of the cones.
pub fn fit_few_patches(
    surface: &Surface,
    options: &FewPatchesOptions,
    control: &Control,
) -> Result<LayoutFit> {
    let mut search = FewPatchesSearch { options, best: None };
    // Instrumented builds make one attempt.
    let has_choice = !cfg!(fuzzing)
        && options.cones.is_none()
        && options.features.is_empty()
        && surface.mesh().is_closed();
    let placed = PLACED.into_iter().filter(|_| has_choice).map(Some);
    for (k, n) in placed.chain([None]).enumerate() {
        if n.is_none() && search.is_hopeless() {
            break;
        }
        match search.is_found_with(surface, n, &control.attempt(k)) {
            Ok(true) => break,
            Ok(false) => {}
            Err(Error::Cancelled) => return Err(Error::Cancelled),
            // There need not be a metric with these cones, nor a layout.
            Err(error) if n.is_some() || search.best.is_some() => log::debug!("cones {n:?}: {error}"),
            Err(error) => return Err(error),
        }
    }
    search.best.ok_or_else(|| Error::Layout("no layout of the surface was found".into()))
}

/// A search for a fit within the tolerance, with the best so far.
struct FewPatchesSearch<'a> {
    options: &'a FewPatchesOptions,
    best: Option<LayoutFit>,
}

impl FewPatchesSearch<'_> {
    /// True if the best fit so far is so far off that another choice of cones will not do.
    fn is_hopeless(&self) -> bool {
        let limit = |fit: &QuadFit| HOPELESS * self.options.fit.limit(fit);
        self.best.as_ref().is_some_and(|best| best.fit.max() > limit(&best.fit))
    }

    /// Fits over the coarsest layout with this many placed cones, or with those that were asked for and then over a finer layout as well. True where one
    /// is within the tolerance.
    fn is_found_with(&mut self, surface: &Surface, placed: Option<usize>, control: &Control) -> Result<bool> {
        let cones = match placed
            .map_or_else(|| self.options.cones.clone().unwrap_or_default(), SeamlessCones::Auto)
        {
            // Valences 1 and 2 are none of corners of patches.
            SeamlessCones::Auto(n) => {
                SeamlessCones::Valences(placed_cones(surface, n, &control.part(0.0, 0.02))?)
            }
            other => other,
        };
        let metric = SeamlessOptions {
            cones,
            features: self.options.features.clone(),
            threads: self.options.fit.threads,
            ..SeamlessOptions::default()
        };
        let metric = seamless(surface, &metric, &control.part(0.02, 0.1))?;
        let (is_found, n) = self.is_found_over(&metric, QuadSize::Coarse, &control.part(0.1, 0.5))?;
        if is_found || placed.is_some() || cfg!(fuzzing) {
            return Ok(is_found);
        }
        match self.is_found_over(&metric, QuadSize::AtMost(MORE_PATCHES * n), &control.part(0.5, 1.0)) {
            Ok((is_found, _)) => Ok(is_found),
            // There need not be another layout.
            Err(Error::Layout(_)) => Ok(false),
            Err(error) => Err(error),
        }
    }

    /// Fits over a layout; true where that is within the tolerance; and the number of its patches.
    fn is_found_over(
        &mut self,
        metric: &Seamless,
        size: QuadSize,
        control: &Control,
    ) -> Result<(bool, usize)> {
        let options = &self.options.fit;
        let sized = QuadOptions { size, threads: options.threads };
        let layout = quad_layout(metric, &sized, &control.part(0.0, 0.2))?;
        let n = layout.patches.len();
        let fit = fit_quad_layout(metric, &layout, options, &control.part(0.2, 1.0))?;
        log::debug!("{n} patches: distances up to {:.1e}, {} folded", fit.max(), fit.folded_patches.len());
        let is_found = options.is_met_by(&fit);
        if self.best.as_ref().is_none_or(|best| fit.is_better_than(&best.fit)) {
            self.best = Some(LayoutFit { seamless: metric.clone(), layout, fit });
        }
        Ok((is_found, n))
    }
}
