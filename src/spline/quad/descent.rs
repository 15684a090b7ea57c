//! Steps of a fit: the distance along normals and the bending, whose weight falls from step to step.
//!
//! Where neighbouring patches meet, the space of splines prescribes how parameter lines cross. The map from which a fit starts crosses
//! otherwise, so the surface has to slide along itself. A weight of the way along the surface keeps places where their feet are known: it falls
//! after steps that come nearer and rises after those that do not, which are not taken [Mar63]. In patches on planes and cylinders, and in those that
//! folds have stopped, it is the gradient of the way that is weighed: they keep their shape and go with their sides.

use super::layout::PatchCorner;
use super::nearest::{NearestToVertex, vertex_places};
use super::piece_form::FootPoint;
use super::quintic::QuinticBasis;
use super::spline::QuadSpline;
use super::system::{FitGoal, FitWeights, QuadSystem};
use super::target::SplineTarget;
use crate::control::{Control, Stage};
use crate::error::{Error, Result};
use crate::geometry::vector::dot;
use crate::parallel;

/// Steps from the first weight of bending to the last.
const STEPS: usize = 14;
/// Most further steps with the last weight, and the share of the root of the energy below which one has to bring it for another to follow.
const MORE_STEPS: usize = 12;
const SETTLED: f64 = 0.96;
const FIRST_BENDING: f64 = 1e-5;
/// Steps between the weights of bending with which a start is tried.
const SOFTER: usize = 3;
/// The weights of the way along the surface, or of its gradient: the first, the least, and the one beyond which no step comes nearer.
const FIRST_TANGENTIAL: f64 = 1e-2;
const LEAST_TANGENTIAL: f64 = 1e-6;
const MOST_TANGENTIAL: f64 = 1.0;
/// Factors of that weight after a step, and after one that was not taken.
const AFTER_STEP: f64 = 0.4;
const AFTER_REFUSAL: f64 = 8.0;

/// The weights of bending of the steps of a fit, which fall geometrically.
pub(super) struct Bendings {
    last: f64,
    first_step: usize,
}

impl Bendings {
    /// From the weight at one of the steps to this one at the last.
    ///
    /// # Errors
    /// [`Error::Argument`] for a last weight out of its range.
    pub fn new(last: f64, first_step: usize) -> Result<Bendings> {
        if (0.0..=FIRST_BENDING).contains(&last) {
            Ok(Bendings { last, first_step })
        } else {
            Err(Error::argument("bending", last, "a number from 0 to 1e-5"))
        }
    }

    /// The weight of the k-th step that is taken.
    pub fn at(&self, k: usize) -> f64 {
        let share = (self.first_step + k).min(STEPS - 1) as f64 / (STEPS - 1) as f64;
        if self.last > 0.0 {
            FIRST_BENDING * (self.last / FIRST_BENDING).powf(share)
        } else {
            FIRST_BENDING * (1.0 - share)
        }
    }

    /// The number of steps to the last weight.
    fn steps(&self) -> usize {
        STEPS.saturating_sub(self.first_step)
    }
}

/// A target with the piece to which each patch is fitted.
pub(super) struct FitTarget<'a> {
    pub target: &'a SplineTarget,
    pub pieces: &'a [usize],
}

/// What the next step needs to know of a patch.
struct PatchIterate {
    /// The feet of its places.
    feet: Vec<FootPoint>,
    /// The vertices that are nearest to it.
    vertices: Vec<NearestToVertex>,
    /// The weighted sum of the squared distances of both.
    squares: f64,
    /// True if it is turned over somewhere.
    is_folded: bool,
}

/// A spline with what the next step needs to know of it.
struct FitIterate {
    spline: QuadSpline,
    patches: Vec<PatchIterate>,
    bending: f64,
}

/// The spline after steps of a fit. `feet`: per patch the points where its places are at first.
///
/// # Errors
/// [`Error::Factorisation`]; [`Error::Cancelled`].
pub(super) fn descend(
    system: &mut QuadSystem,
    feet: &[Vec<FootPoint>],
    target: &FitTarget<'_>,
    bendings: &Bendings,
    control: &Control,
) -> Result<QuadSpline> {
    let (skipped, mut at) = stiffest_start(system, feet, target, bendings)?;
    let mut tangential = vec![FIRST_TANGENTIAL; at.patches.len()];
    let mut keeps_shape: Vec<bool> =
        target.pieces.iter().map(|&piece| target.target.form(piece).is_some()).collect();
    let most = bendings.steps() + MORE_STEPS;
    for step in skipped..most {
        control.step(Stage::Layout, (step + 1) as f64 / (most + 2) as f64)?;
        let bending = bendings.at(step);
        let before = at.energy(bending);
        let next = loop {
            let weights = FitWeights { normal: 1.0, bending };
            let spline = at.solved(system, weights, &tangential, &keeps_shape)?;
            let next = FitIterate::new(system, spline, target);
            let (energy, folded) = (next.energy(bending), next.folded());
            log::debug!("fit: bending {bending:.1e}, energy {energy:.3e}, {folded} folded");
            if folded <= at.folded() && energy <= before {
                break Some(next);
            }
            if step >= bendings.steps() && energy > SETTLED * SETTLED * before {
                // Nothing but a smaller step could still come nearer, and not by much.
                break None;
            }
            let around_folds = next.around_new_folds(&at);
            let is_held = if energy <= before { around_folds.clone() } else { vec![true; tangential.len()] };
            for (weight, _) in tangential.iter_mut().zip(is_held).filter(|(_, is_held)| *is_held) {
                *weight *= AFTER_REFUSAL;
            }
            keeps_shape.iter_mut().zip(around_folds).for_each(|(keeps, folds)| *keeps |= folds);
            if tangential.iter().any(|&weight| weight > MOST_TANGENTIAL) {
                break None;
            }
            control.check()?;
        };
        let Some(next) = next else { break };
        at = next;
        tangential.iter_mut().for_each(|weight| *weight = (*weight * AFTER_STEP).max(LEAST_TANGENTIAL));
        if step >= bendings.steps() && at.energy(bending) > SETTLED * SETTLED * before {
            break;
        }
    }
    Ok(at.spline)
}

/// The spline that is nearest to the feet, with the largest weight of bending with which no patch is turned over, or else the fewest are; and the
/// number of steps before that with this weight. Stiff splines cross sides as they have to and do not reach into thin limbs; soft ones do.
fn stiffest_start(
    system: &mut QuadSystem,
    feet: &[Vec<FootPoint>],
    target: &FitTarget<'_>,
    bendings: &Bendings,
) -> Result<(usize, FitIterate)> {
    let mut with_bending_of = |step: usize| {
        let goal = FitGoal {
            weights: FitWeights { normal: 0.0, bending: bendings.at(step) },
            tangential: &vec![1.0; feet.len()],
            shape: None,
            feet: &|p| &feet[p],
            vertices: &|_| &[],
        };
        let free = system.solve(&goal)?;
        Ok(FitIterate::new(system, QuadSpline::of_free(system.space().clone(), &free)?, target))
    };
    let mut best = (0, with_bending_of(0)?);
    for step in (SOFTER..=bendings.steps()).step_by(SOFTER) {
        if best.1.folded() == 0 {
            break;
        }
        let found = with_bending_of(step)?;
        if found.folded() < best.1.folded() {
            best = (step, found);
        }
    }
    Ok(best)
}

impl FitIterate {
    fn new(system: &QuadSystem, spline: QuadSpline, target: &FitTarget<'_>) -> FitIterate {
        // All patches are searched at every step: vertices that are held in a patch from which they have moved away make it fold.
        let nearest = vertex_places(target.target, target.pieces, &|p, uv| spline.point_at(p, uv));
        let patch = |p: usize| PatchIterate::new(system, &spline, p, target, &nearest[p]);
        let patches = parallel::map(nearest.len(), patch);
        FitIterate { patches, bending: system.bending_of(&spline), spline }
    }

    /// The spline of the next step. `tangential`: per patch the weight of the way along the surface.
    /// `keeps_shape`: per patch true if that is the weight of its gradient.
    fn solved(
        &self,
        system: &mut QuadSystem,
        weights: FitWeights,
        tangential: &[f64],
        keeps_shape: &[bool],
    ) -> Result<QuadSpline> {
        let feet = |p: usize| &self.patches[p].feet[..];
        let vertices = |p: usize| &self.patches[p].vertices[..];
        let shape = Some((&self.spline, keeps_shape));
        let free = system.solve(&FitGoal { weights, tangential, shape, feet: &feet, vertices: &vertices })?;
        QuadSpline::of_free(system.space().clone(), &free)
    }

    /// What is to be least, with this weight of bending.
    fn energy(&self, bending: f64) -> f64 {
        self.patches.iter().map(|patch| patch.squares).sum::<f64>() + bending * self.bending
    }

    /// Per patch true if it is turned over and was not before, or is beside one.
    fn around_new_folds(&self, before: &FitIterate) -> Vec<bool> {
        let layout = self.spline.space().layout();
        let is_new = |p: usize| self.patches[p].is_folded && !before.patches[p].is_folded;
        let beside = |p: usize| {
            (0..4).filter_map(move |corner| layout.smooth_neighbour(PatchCorner { patch: p, corner }))
        };
        (0..self.patches.len()).map(|p| is_new(p) || beside(p).any(|at| is_new(at.patch))).collect()
    }

    /// The number of patches that are turned over somewhere.
    fn folded(&self) -> usize {
        self.patches.iter().filter(|patch| patch.is_folded).count()
    }
}

impl PatchIterate {
    fn new(
        system: &QuadSystem,
        spline: &QuadSpline,
        p: usize,
        target: &FitTarget<'_>,
        nearest: &[NearestToVertex],
    ) -> PatchIterate {
        let (mut feet, mut is_folded) = (Vec::new(), false);
        for place in system.places(p) {
            let at = spline.combined(p, &place.basis[0], &place.basis[1]);
            let foot = target.target.foot(target.pieces[p], at.point);
            is_folded |= at.normal().is_none_or(|normal| dot(normal, foot.normal) <= 0.0);
            feet.push(foot);
        }
        // Small folds lie between these places, where a fit is measured.
        let turns = |([u, v], k): ([&QuinticBasis; 2], usize)| {
            let at = spline.combined(p, u, v);
            let normal = at.normal();
            normal.is_none_or(|normal| dot(normal, feet[k].normal) <= 0.0)
                && target.target.is_turned_over(target.pieces[p], at.point, normal)
        };
        is_folded = is_folded || system.measured(p).any(turns);
        let mut vertices: Vec<NearestToVertex> =
            nearest.iter().map(|place| place.nearer(spline, p)).collect();
        let squares = system.squares(spline, p, &feet, &vertices);
        vertices.retain(|place| !place.is_beyond(spline, p));
        PatchIterate { feet, vertices, squares, is_folded }
    }
}
