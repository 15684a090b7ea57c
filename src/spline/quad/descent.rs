//! Steps of a fit: the distance along normals and the bending, whose weight falls from step to step.
//!
//! Where neighbouring patches meet, the space of splines prescribes how parameter lines cross. The map from which a fit starts crosses
//! otherwise, so the surface has to slide along itself. A weight of the way along the surface keeps places where their feet are known: it falls
//! after steps that come nearer and rises after those that do not, which are not taken [Mar63].

use super::nearest::{NearestToVertex, vertex_places};
use super::spline::QuadSpline;
use super::system::{FitGoal, FitWeights, QuadSystem};
use super::target::{FootPoint, SplineTarget};
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
/// The weights of the distance along the surface: the first, the least, and the one beyond which no step comes nearer.
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

/// The spline after steps of a fit from another one.
///
/// # Errors
/// [`Error::Factorisation`]; [`Error::Cancelled`].
pub(super) fn descend(
    system: &mut QuadSystem<'_>,
    from: QuadSpline,
    target: &FitTarget<'_>,
    bendings: &Bendings,
    control: &Control,
) -> Result<QuadSpline> {
    let mut at = FitIterate::new(system, from, target);
    let mut tangential = FIRST_TANGENTIAL;
    let most = bendings.steps() + MORE_STEPS;
    for step in 0..most {
        control.step(Stage::Layout, (step + 1) as f64 / (most + 2) as f64)?;
        let bending = bendings.at(step);
        let before = at.energy(bending);
        let next = loop {
            let spline = at.solved(system, FitWeights { normal: 1.0, tangential, bending })?;
            let next = FitIterate::new(system, spline, target);
            let (energy, folded) = (next.energy(bending), next.folded());
            log::debug!(
                "fit: bending {bending:.1e}, tangential {tangential:.1e}, energy {energy:.3e}, {folded} folded"
            );
            if folded <= at.folded() && energy <= before {
                break Some(next);
            }
            tangential *= AFTER_REFUSAL;
            if tangential > MOST_TANGENTIAL {
                break None;
            }
            control.check()?;
        };
        let Some(next) = next else { break };
        at = next;
        tangential = (tangential * AFTER_STEP).max(LEAST_TANGENTIAL);
        if step >= bendings.steps() && at.energy(bending) > SETTLED * SETTLED * before {
            break;
        }
    }
    Ok(at.spline)
}

impl FitIterate {
    fn new(system: &QuadSystem<'_>, spline: QuadSpline, target: &FitTarget<'_>) -> FitIterate {
        // All patches are searched at every step: vertices that are held in a patch from which they have moved away make it fold.
        let nearest = vertex_places(target.target, target.pieces, &|p, uv| spline.point_at(p, uv));
        let patch = |p: usize| PatchIterate::new(system, &spline, p, target, &nearest[p]);
        let patches = parallel::map(nearest.len(), patch);
        FitIterate { patches, bending: system.bending_of(&spline), spline }
    }

    fn solved(&self, system: &mut QuadSystem<'_>, weights: FitWeights) -> Result<QuadSpline> {
        let feet = |p: usize| &self.patches[p].feet[..];
        let vertices = |p: usize| &self.patches[p].vertices[..];
        let free = system.solve(&FitGoal { weights, feet: &feet, vertices: &vertices })?;
        QuadSpline::of_free(self.spline.space().clone(), &free)
    }

    /// What is to be least, with this weight of bending.
    fn energy(&self, bending: f64) -> f64 {
        self.patches.iter().map(|patch| patch.squares).sum::<f64>() + bending * self.bending
    }

    /// The number of patches that are turned over somewhere.
    fn folded(&self) -> usize {
        self.patches.iter().filter(|patch| patch.is_folded).count()
    }
}

impl PatchIterate {
    fn new(
        system: &QuadSystem<'_>,
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
        let mut vertices: Vec<NearestToVertex> =
            nearest.iter().map(|place| place.nearer(spline, p)).collect();
        let squares = system.squares(spline, p, &feet, &vertices);
        vertices.retain(|place| !place.is_beyond(spline, p));
        PatchIterate { feet, vertices, squares, is_folded }
    }
}
