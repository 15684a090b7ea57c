//! Splines of few patches: over the coarsest layouts of seamless metrics with several choices of cones, of which the first rounds of the fits tell
//! the most promising.

use super::fit::QuadFit;
use super::over_quads::{LayoutFitOptions, fit_unless_folding};
use crate::control::Control;
use crate::error::{Error, Result};
use crate::mesh::EdgeId;
use crate::metric::Surface;
use crate::quads::{QuadLayout, QuadOptions, QuadSize, quad_layout};
use crate::seamless::{Seamless, SeamlessCones, SeamlessOptions, placed_cones, seamless};

/// Numbers of placed cones over which fits are tried where none are asked for; then those of the field.
const PLACED: [usize; 2] = [24, 40];
/// Layouts with more patches are tried only where there is no other: where placed cones lead to that many, lines wind around thin limbs.
const MOST_PATCHES: usize = 150;
/// Rounds after which a fit that has folded patches still waits until other choices of cones are tried: with one span in each direction, then two.
const FOLDING_ROUNDS: usize = 2;
/// Most choices of cones with which fits are made to the end.
const MOST_WHOLE: usize = 2;
/// The factor by which a layout may have more patches than the coarsest one with the same cones, where that does not suffice.
const MORE_PATCHES: usize = 2;
/// The multiple of the tolerance beyond which a finer layout is not tried: there none came within it, and they take longest.
const HOPELESS: f64 = 3.0;

/// Options of [`fit_few_patches`].
#[derive(Debug, Clone, Default)]
pub struct FewPatchesOptions {
    /// The cones, which become corners of patches. None: on a closed surface without features placed ones of several numbers
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

/// Fits a spline with few patches to a surface: over the coarsest layout of a seamless metric and, where that is not within three times the tolerance,
/// one with up to twice as many patches. Of several choices of cones those come last whose fits have folded patches after two rounds, those with
/// the fewest first; two choices at most are fitted to the end. The first fit within the tolerance, or else that with the fewest patches
/// folded, then the least distance.
///
/// # Errors
/// Those of [`seamless`], [`quad_layout`] and [`super::fit_quad_layout`] with the last of the cones.
pub fn fit_few_patches(
    surface: &Surface,
    options: &FewPatchesOptions,
    control: &Control,
) -> Result<LayoutFit> {
    let mut search = FewPatchesSearch { surface, options, best: None };
    // Instrumented builds make one attempt.
    let has_choice = !cfg!(fuzzing)
        && options.cones.is_none()
        && options.features.is_empty()
        && surface.mesh().is_closed();
    let is_found = if has_choice {
        search.is_found_by_choice(&control.part(0.0, 0.8))?
    } else {
        let cones = options.cones.clone().unwrap_or_default();
        let candidate = search.candidate(cones, &control.part(0.0, 0.1))?;
        search.fit_over(&candidate, usize::MAX, &control.part(0.1, 0.8))? == FitEnd::Found
    };
    if !is_found {
        search.refine(&control.part(0.8, 1.0))?;
    }
    search.best.ok_or_else(|| Error::Layout("no layout of the surface was found".into()))
}

/// How a fit over a layout ended.
#[derive(PartialEq)]
enum FitEnd {
    /// Within the tolerance.
    Found,
    /// Not within it, without folded patches.
    Missed,
    /// With this many folded patches.
    Folded(usize),
}

/// A layout over which a fit can be made.
struct LayoutCandidate {
    metric: Seamless,
    layout: QuadLayout,
}

/// A search for a fit within the tolerance, with the best so far.
struct FewPatchesSearch<'a> {
    surface: &'a Surface,
    options: &'a FewPatchesOptions,
    best: Option<LayoutFit>,
}

impl FewPatchesSearch<'_> {
    /// Fits over the coarsest layouts with several choices of cones; true where one is within the tolerance.
    fn is_found_by_choice(&mut self, control: &Control) -> Result<bool> {
        let choices = PLACED.map(SeamlessCones::Auto).into_iter().chain([SeamlessCones::Field]);
        let share = 1.0 / (PLACED.len() + 2) as f64;
        let part = |k: usize| control.part(k as f64 * share, (k + 1) as f64 * share);
        let (mut whole, mut folding, mut fine, mut last_error) = (0, Vec::new(), None, None);
        for (k, cones) in choices.enumerate() {
            if whole == MOST_WHOLE {
                break;
            }
            let control = part(k);
            let found = self.candidate(cones, &control.part(0.0, 0.2)).and_then(|candidate| {
                let is_few = candidate.layout.patches.len() <= MOST_PATCHES;
                let fit = || self.fit_over(&candidate, FOLDING_ROUNDS, &control.part(0.2, 1.0));
                Ok((is_few.then(fit).transpose()?, candidate))
            });
            match found {
                Ok((Some(FitEnd::Found), _)) => return Ok(true),
                Ok((Some(FitEnd::Missed), _)) => whole += 1,
                Ok((Some(FitEnd::Folded(n)), candidate)) => folding.push((n, candidate)),
                Ok((None, candidate)) => fine = Some(candidate),
                Err(Error::Cancelled) => return Err(Error::Cancelled),
                // There need not be a metric with these cones, nor a layout.
                Err(error) => last_error = Some(error),
            }
        }
        folding.sort_by_key(|(n, _)| *n);
        let mut rest: Vec<LayoutCandidate> = folding.into_iter().map(|(_, candidate)| candidate).collect();
        if self.best.is_none() {
            rest.extend(fine);
        }
        for (k, candidate) in rest.iter().take(MOST_WHOLE - whole).enumerate() {
            if self.fit_over(candidate, usize::MAX, &part(PLACED.len() + 1).attempt(k))? == FitEnd::Found {
                return Ok(true);
            }
        }
        match last_error {
            Some(error) if self.best.is_none() => Err(error),
            _ => Ok(false),
        }
    }

    /// The coarsest layout with these cones.
    fn candidate(&self, cones: SeamlessCones, control: &Control) -> Result<LayoutCandidate> {
        let cones = match cones {
            // Valences 1 and 2 are none of corners of patches.
            SeamlessCones::Auto(n) => {
                SeamlessCones::Valences(placed_cones(self.surface, n, &control.part(0.0, 0.1))?)
            }
            other => other,
        };
        let metric = SeamlessOptions {
            cones,
            features: self.options.features.clone(),
            threads: self.options.fit.threads,
            ..SeamlessOptions::default()
        };
        let metric = seamless(self.surface, &metric, &control.part(0.1, 0.5))?;
        let layout = quad_layout(&metric, &self.sized(QuadSize::Coarse), &control.part(0.5, 1.0))?;
        Ok(LayoutCandidate { metric, layout })
    }

    fn sized(&self, size: QuadSize) -> QuadOptions {
        QuadOptions { size, threads: self.options.fit.threads }
    }

    /// Fits over a layout, for this many rounds if all of them have folded patches.
    fn fit_over(
        &mut self,
        candidate: &LayoutCandidate,
        folding_rounds: usize,
        control: &Control,
    ) -> Result<FitEnd> {
        let options = &self.options.fit;
        let LayoutCandidate { metric, layout } = candidate;
        let fit = fit_unless_folding(metric, layout, options, folding_rounds, control)?;
        let (n, folded) = (layout.patches.len(), fit.folded_patches.len());
        log::debug!("{n} patches: distances up to {:.1e}, {folded} folded", fit.max());
        let end = match folded {
            _ if options.is_met_by(&fit) => FitEnd::Found,
            0 => FitEnd::Missed,
            n => FitEnd::Folded(n),
        };
        if self.best.as_ref().is_none_or(|best| fit.is_better_than(&best.fit)) {
            self.best = Some(LayoutFit { seamless: metric.clone(), layout: layout.clone(), fit });
        }
        Ok(end)
    }

    /// Fits over a layout with more patches and the same cones, where the best fit so far is not within the tolerance but not hopeless.
    fn refine(&mut self, control: &Control) -> Result<()> {
        let Some(best) = &self.best else { return Ok(()) };
        let options = &self.options.fit;
        let is_settled = options.is_met_by(&best.fit) || best.fit.max() > HOPELESS * options.limit(&best.fit);
        if is_settled || cfg!(fuzzing) {
            return Ok(());
        }
        let (metric, n) = (best.seamless.clone(), best.layout.patches.len());
        let size = self.sized(QuadSize::AtMost(MORE_PATCHES * n));
        match quad_layout(&metric, &size, &control.part(0.0, 0.2)) {
            Ok(layout) if layout.patches.len() > n => {
                let finer = LayoutCandidate { metric, layout };
                self.fit_over(&finer, usize::MAX, &control.part(0.2, 1.0)).map(drop)
            }
            // There need not be another layout.
            Ok(_) | Err(Error::Layout(_)) => Ok(()),
            Err(error) => Err(error),
        }
    }
}
