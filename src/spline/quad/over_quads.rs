//! Splines over the layouts of quad meshes: the lines between their irregular vertices bound the patches.

use super::fit::{FitStart, QuadFit, fit_from};
use super::fitted_surface::{FittedSurface, no_positions};
use super::layout::PatchLayout;
use super::patch_grid::{DividedQuads, PatchGrid, strips};
use super::relaxed_quads::RelaxedQuads;
use super::space::QuadSplineSpace;
use super::spline::QuadSpline;
use super::target::SplineTarget;
use crate::control::Control;
use crate::error::Result;
use crate::geometry::vector::{Vector, distance};
use crate::parallel;
use crate::quads::QuadLayout;
use crate::seamless::Seamless;
use std::collections::BTreeMap;
use std::sync::Arc;

/// The step with which fits from other splines begin, and the multiple of the tolerance within which these must be: others may lack a limb.
const LATE_STEP: usize = 10;
const NEAR: f64 = 10.0;
/// Places of a patch in each direction whose faces tell on which part of the surface it lies.
const PLACES_FOR_FACES: usize = 12;
/// The share of the distance below which a round has to bring it, and the rounds in a row that may gain nothing.
const WORTHWHILE: f64 = 0.85;
const MOST_FRUITLESS: usize = 1;
/// Spans in one direction of a patch that are shorter than those in the other by at most this factor are divided as well.
const ABOUT_AS_LONG: f64 = 1.5;
/// The multiple of the tolerance beyond which a strip with several spans gets two more at a time.
const FAR: f64 = 4.0;
/// The tolerance if none is asked for.
const USUAL_TOLERANCE: f64 = 1e-3;
/// The weights of bending if none is asked for: the most, for this noise over the diagonal, and the least.
const MOST_BENDING: f64 = 1e-8;
const NOISE_OF_MOST_BENDING: f64 = 1e-3;
pub(super) const LEAST_BENDING: f64 = 1e-11;
/// The factor by which the weight of bending falls from fit to fit.
const SOFTER: f64 = 0.1;

/// Options of [`fit_quad_layout`].
#[derive(Debug, Clone, PartialEq)]
pub struct LayoutFitOptions {
    /// The largest distance between spline and target, over its diagonal: where it is missed, patches get more spans. None: 1e-3 or, where that is
    /// more, four times the noise of the target, which more spans would follow.
    pub tolerance: Option<f64>,
    /// Most spans of a patch in each direction, from 1 to 32.
    pub most_spans: usize,
    /// The weight of bending at the last step of a fit, from 0 to 1e-5. None: 1e-8; where all spans that there may be do not suffice, less and less
    /// as far as suits the noise of the target, 1e-8 for a thousandth of its diagonal and in proportion to its square, down to 1e-11.
    pub bending: Option<f64>,
    /// Threads; 0: as many as the process may use.
    pub threads: usize,
}

impl Default for LayoutFitOptions {
    fn default() -> Self {
        LayoutFitOptions { tolerance: None, most_spans: 6, bending: None, threads: 0 }
    }
}

impl LayoutFitOptions {
    /// The largest distance of a fit, over the diagonal of its target.
    pub fn limit(&self, fit: &QuadFit) -> f64 {
        self.tolerance.unwrap_or_else(|| USUAL_TOLERANCE.max(fit.noise_limit()))
    }

    /// The least weight of bending, where the spans are as many as they may be.
    fn least_bending(&self, fit: &QuadFit) -> f64 {
        let of_noise = MOST_BENDING * (fit.noise / NOISE_OF_MOST_BENDING).powi(2);
        self.bending.unwrap_or_else(|| of_noise.clamp(LEAST_BENDING, MOST_BENDING))
    }

    /// True if no patch of a fit is turned over and no distance is larger than [`LayoutFitOptions::limit`].
    pub fn is_met_by(&self, fit: &QuadFit) -> bool {
        fit.is_within(self.limit(fit))
    }
}

/// Fits a spline over the patches of a quad layout to the surface of its seamless metric. Each patch is fitted to the part of the surface on
/// which it lies, and to some more around it, up to features. Strips of patches that fold or are not within the
/// tolerance get more spans. The first fit within the tolerance, or else that with the fewest patches folded, then the least distance.
///
/// # Errors
/// [`crate::Error::Layout`] for a surface without positions, and for sides of patches that are not one arc; those of
/// [`super::fit_quads`], [`SplineTarget::of_patches`] and [`QuadSplineSpace::new`].
pub fn fit_quad_layout(
    seamless: &Seamless,
    layout: &QuadLayout,
    options: &LayoutFitOptions,
    control: &Control,
) -> Result<QuadFit> {
    fit_unless_folding(seamless, layout, options, usize::MAX, control)
}

/// [`fit_quad_layout`] that ends after this many rounds if all of them have folded patches.
///
/// # Errors
/// As there.
pub(super) fn fit_unless_folding(
    seamless: &Seamless,
    layout: &QuadLayout,
    options: &LayoutFitOptions,
    folding_rounds: usize,
    control: &Control,
) -> Result<QuadFit> {
    let vertices = layout.mesh.positions(&seamless.solution).ok_or_else(no_positions)?;
    parallel::within(options.threads, || {
        let surface = FittedSurface::new(seamless, layout)?;
        let RelaxedQuads { points, target } = RelaxedQuads::new(layout, vertices, &surface, control)?;
        let spans = vec![1; layout.arcs.len()];
        let start = LayoutStart::new(surface, &DividedQuads::of_layout(layout, &points), spans)?;
        LayoutStart { folding_rounds, ..start }.fitted(target, options, control)
    })
}

/// What fits over a layout start from.
pub(super) struct LayoutStart<'a> {
    surface: FittedSurface<'a>,
    grids: Vec<PatchGrid>,
    patches: PatchLayout,
    /// Per arc the spans along it.
    spans: Vec<usize>,
    /// The first step of the first fit.
    first_step: usize,
    /// Rounds after which fits end that have folded patches still.
    folding_rounds: usize,
}

impl<'a> LayoutStart<'a> {
    /// From the quads of a surface, with these spans along each arc.
    ///
    /// # Errors
    /// Those of [`DividedQuads::grids`] and [`DividedQuads::patch_layout`].
    pub fn new(
        surface: FittedSurface<'a>,
        divided: &DividedQuads<'_>,
        spans: Vec<usize>,
    ) -> Result<LayoutStart<'a>> {
        let grids = divided.grids()?;
        let angles: Vec<[f64; 4]> = grids.iter().map(PatchGrid::corner_angles).collect();
        let patches = divided.patch_layout()?.with_angles(&angles);
        Ok(LayoutStart { surface, grids, patches, spans, first_step: 0, folding_rounds: usize::MAX })
    }

    /// The same with points that lie on the surface as those of a spline do: fits begin with little bending.
    pub fn nearly_fitted(self) -> LayoutStart<'a> {
        LayoutStart { first_step: LATE_STEP, ..self }
    }

    /// Fits with more and more spans on the strips of patches that are not within the tolerance.
    pub fn fitted(
        &self,
        mut target: SplineTarget,
        options: &LayoutFitOptions,
        control: &Control,
    ) -> Result<QuadFit> {
        let LayoutStart { surface, grids, patches, .. } = self;
        let start = |p: usize, uv: [f64; 2]| grids[p].at(uv);
        let mut spans = self.spans.clone();
        let mut best: Option<QuadFit> = None;
        let mut bending = options.bending.unwrap_or(MOST_BENDING);
        let (mut round, mut fruitless) = (0, 0);
        loop {
            let space = Arc::new(QuadSplineSpace::with_spans(patches.clone(), spans.clone())?);
            let is_near = |fit: &&QuadFit| fit.is_within(NEAR * options.limit(fit));
            let whole = best.as_ref().filter(is_near);
            let last =
                |p: usize, uv: [f64; 2]| whole.map_or_else(|| start(p, uv), |fit| fit.spline.point_at(p, uv));
            let from = FitStart {
                map: &last,
                first_step: if whole.is_some() { LATE_STEP } else { self.first_step },
            };
            let fit = fit_from(space, &from, &target, bending, &control.attempt(round))?;
            round += 1;
            let folds = fit.folded_patches.len();
            let most = spans.iter().max().copied().unwrap_or(1);
            log::debug!(
                "round {round}: up to {most} spans, distances up to {:.1e}, {folds} folded",
                fit.max()
            );
            // More spans are of no use where they turned no patch up again or, where none is turned over, did not bring the last fit nearer.
            let is_gain = |best: &QuadFit| match (folds, best.folded_patches.len()) {
                (0, 0) => fit.max() <= WORTHWHILE * best.max(),
                (folds, before) => folds < before,
            };
            fruitless = if best.as_ref().is_none_or(is_gain) { 0 } else { fruitless + 1 };
            let mut is_more = raise_spans(patches, &mut spans, &fit, options);
            if !is_more && folds == 0 && bending > options.least_bending(&fit) {
                (bending, is_more) = (SOFTER * bending, true);
            }
            let is_stuck = fruitless > MOST_FRUITLESS;
            // Instrumented builds, in which every round takes minutes, make one.
            let folds_still = best.as_ref().map_or(folds, |best| best.folded_patches.len().min(folds)) > 0;
            let is_given_up = folds_still && round >= self.folding_rounds || cfg!(fuzzing);
            let is_done = options.is_met_by(&fit) || !is_more || is_stuck || is_given_up;
            if folds == 0 && !is_done {
                target = surface.target(&faces_of(&fit.spline, &target))?;
            }
            let best_yet = match best.take() {
                Some(best) if !fit.is_better_than(&best) => best,
                _ => fit,
            };
            if is_done {
                return Ok(best_yet);
            }
            best = Some(best_yet);
        }
    }
}

/// Per patch the faces of its target at some of its places.
fn faces_of(spline: &QuadSpline, target: &SplineTarget) -> Vec<Vec<u32>> {
    let place = |k: usize| (k as f64 + 0.5) / PLACES_FOR_FACES as f64;
    let of_patch = |p: usize| {
        let places =
            (0..PLACES_FOR_FACES).flat_map(|i| (0..PLACES_FOR_FACES).map(move |j| [place(i), place(j)]));
        places.map(|uv| target.face_near(p, spline.point_at(p, uv))).collect()
    };
    parallel::map(spline.space().layout().patches().len(), of_patch)
}

/// Gives one more span to the strips of patches that fold or are not within the tolerance, two where they are far from it: to that in the
/// direction in which spans are longer, or to both where they are about as long. False if there is none with fewer than the most.
fn raise_spans(
    patches: &PatchLayout,
    spans: &mut [usize],
    fit: &QuadFit,
    options: &LayoutFitOptions,
) -> bool {
    let strips = strips(patches.arcs().len(), patches.patches());
    let mut raised: BTreeMap<usize, usize> = BTreeMap::new();
    for (p, sides) in patches.patches().iter().enumerate() {
        if fit.patch_max[p] <= options.limit(fit) && !fit.folded_patches.contains(&p) {
            continue;
        }
        let arcs = [0, 1].map(|k| sides[k].arc as usize);
        let net = fit.spline.net(p);
        let along_u = |j: usize| net.windows(2).map(|two| distance(two[0][j], two[1][j])).sum::<f64>();
        let along_v = |row: &Vec<Vector>| row.windows(2).map(|two| distance(two[0], two[1])).sum::<f64>();
        let lengths =
            [(0..net[0].len()).map(along_u).fold(0.0, f64::max), net.iter().map(along_v).fold(0.0, f64::max)];
        let of_span = [0, 1].map(|k| lengths[k] / spans[arcs[k]] as f64);
        for k in 0..2 {
            let other = of_span[1 - k];
            if spans[arcs[k]] < options.most_spans
                && (of_span[k] * ABOUT_AS_LONG >= other || spans[arcs[1 - k]] >= options.most_spans)
            {
                let is_far = spans[arcs[k]] > 1 && fit.patch_max[p] > FAR * options.limit(fit);
                let more = raised.entry(strips[arcs[k]]).or_default();
                *more = (*more).max(if is_far { 2 } else { 1 });
            }
        }
    }
    for (arc, spans) in spans.iter_mut().enumerate() {
        let more = raised.get(&strips[arc]).copied().unwrap_or(0);
        *spans = (*spans + more).min(options.most_spans.max(*spans));
    }
    !raised.is_empty()
}
