//! Fits of splines over four-sided patches: the distance along normals, with weights of fairness and of tangential distance that fall from
//! step to step.
//!
//! Where neighbouring patches meet, the space of splines prescribes how parameter lines cross. The map from which a fit starts crosses
//! otherwise, so the surface has to slide along itself, which large weights at first make smooth.

use super::quintic::QuinticBasis;
use super::space::QuadSplineSpace;
use super::spline::QuadSpline;
use super::system::{FitWeights, QuadSystem};
use super::target::{FootPoint, SplineTarget};
use crate::control::{Control, Stage};
use crate::error::{Error, Result};
use crate::geometry::vector::{Vector, distance, dot};
use crate::parallel;
use std::sync::Arc;

/// Steps from the first weights to the last.
const STEPS: usize = 14;
/// The weights of bending and of tangential distance at the first step, and the latter at the last one.
const FIRST_BENDING: f64 = 1e-5;
const FIRST_TANGENTIAL: f64 = 1e-2;
const LAST_TANGENTIAL: f64 = 1e-6;
/// Places of a patch in each direction at which a fit is measured: other ones than those of the fit.
const MEASURED: usize = 23;

/// Options of fits over four-sided patches.
#[derive(Debug, Clone, PartialEq)]
pub struct QuadFitOptions {
    /// The weight of bending at the last step, from 0 on: 1e-11 suits surfaces without noise, 1e-8 scans with a noise of a thousandth of the
    /// diagonal.
    pub bending: f64,
    /// Threads; 0: as many as the process may use.
    pub threads: usize,
}

impl Default for QuadFitOptions {
    fn default() -> Self {
        QuadFitOptions { bending: 1e-11, threads: 0 }
    }
}

/// A fitted spline with its distances from the target.
pub struct QuadFit {
    /// The spline.
    pub spline: QuadSpline,
    /// The root of the mean square of the distances of places of the patches from the target, over its diagonal.
    pub rms: f64,
    /// The largest of these distances, over the diagonal.
    pub max: f64,
    /// The patch with the largest distance.
    pub worst_patch: usize,
    /// The largest angle between the normals of spline and target at these places, radians.
    pub normal_error: f64,
    /// The patches that are turned over somewhere: their normal is more than a right angle off the target's; ascending.
    pub folded_patches: Vec<usize>,
}

/// The distances of a patch from its piece of the target.
#[derive(Clone, Copy, Default)]
struct PatchDistances {
    squares: f64,
    largest: f64,
    /// The least cosine between normals.
    cosine: f64,
}

/// Fits a spline over four-sided patches to a target. `start`: a map of the patches, as (patch, (u, v)) → point, on or near the target; equal
/// on common sides.
///
/// Every patch belongs to its own piece of the target, or to the smooth piece that is nearest to the middle of its start. Lengths of arcs, which should be about 1 in
/// the mean, should be about proportional to those on the surface.
///
/// # Errors
/// [`Error::Argument`] for an option out of its range; [`Error::Factorisation`]; [`Error::Cancelled`].
pub fn fit_quads(
    space: Arc<QuadSplineSpace>,
    start: &(dyn Fn(usize, [f64; 2]) -> Vector + Sync),
    target: &SplineTarget,
    options: &QuadFitOptions,
    control: &Control,
) -> Result<QuadFit> {
    if !(options.bending >= 0.0 && options.bending <= FIRST_BENDING) {
        return Err(Error::argument("bending", options.bending, "a number from 0 to 1e-5"));
    }
    parallel::within(options.threads, || {
        control.step(Stage::Layout, 0.0)?;
        let mut system = QuadSystem::new(&space)?;
        let patches = space.layout().patches().len();
        let pieces = parallel::map(patches, |p| target.piece_of_patch(p, start(p, [0.5, 0.5])));
        let places: Vec<[f64; 2]> = system.places.iter().map(|place| place.parameters).collect();
        let at_start =
            |p: usize, place: usize| FootPoint { point: start(p, places[place]), normal: [0.0; 3] };
        let first = FitWeights { normal: 0.0, tangential: 1.0, bending: FIRST_BENDING };
        let mut spline = QuadSpline::of_free(space.clone(), &system.solve(first, at_start)?)?;
        let bases: Vec<[QuinticBasis; 2]> = system.places.iter().map(|place| place.basis).collect();
        for step in 0..STEPS {
            control.step(Stage::Layout, (step + 1) as f64 / (STEPS + 2) as f64)?;
            let weights = weights_of(step, options.bending);
            let foot = |p: usize, place: usize| {
                let [u, v] = &bases[place];
                target.foot(pieces[p], spline.combined(p, u, v).point)
            };
            let free = system.solve(weights, foot)?;
            spline = QuadSpline::of_free(space.clone(), &free)?;
        }
        let fit = measured(spline, &pieces, target);
        control.step(Stage::Layout, 1.0)?;
        Ok(fit)
    })
}

/// The weights of a step, which fall geometrically.
fn weights_of(step: usize, last_bending: f64) -> FitWeights {
    let share = step as f64 / (STEPS - 1) as f64;
    let between = |first: f64, last: f64| {
        if last > 0.0 { first * (last / first).powf(share) } else { first * (1.0 - share) }
    };
    FitWeights {
        normal: 1.0,
        tangential: between(FIRST_TANGENTIAL, LAST_TANGENTIAL),
        bending: between(FIRST_BENDING, last_bending),
    }
}

fn measured(spline: QuadSpline, pieces: &[usize], target: &SplineTarget) -> QuadFit {
    let along: Vec<QuinticBasis> = (0..MEASURED)
        .map(|k| QuinticBasis::at(spline.space().spans(), k as f64 / (MEASURED - 1) as f64))
        .collect();
    let of_patch = |p: usize| {
        let mut found = PatchDistances { cosine: 1.0, ..PatchDistances::default() };
        for (u, v) in along.iter().flat_map(|u| along.iter().map(move |v| (u, v))) {
            let at = spline.combined(p, u, v);
            let foot = target.foot(pieces[p], at.point);
            let far = distance(at.point, foot.point);
            found.squares += far * far;
            found.largest = found.largest.max(far);
            let normal = at.normal().unwrap_or([0.0; 3]);
            found.cosine = found.cosine.min(dot(normal, foot.normal));
        }
        found
    };
    let found = parallel::map(pieces.len(), of_patch);
    let places = (pieces.len() * MEASURED * MEASURED).max(1) as f64;
    let diagonal = target.diagonal();
    let by_size = |a: &usize, b: &usize| found[*a].largest.total_cmp(&found[*b].largest);
    let worst_patch = (0..found.len()).max_by(by_size).unwrap_or(0);
    let cosine = found.iter().fold(1.0f64, |least, patch| least.min(patch.cosine));
    QuadFit {
        rms: (found.iter().map(|patch| patch.squares).sum::<f64>() / places).sqrt() / diagonal,
        max: found.iter().fold(0.0f64, |most, patch| most.max(patch.largest)) / diagonal,
        worst_patch,
        normal_error: cosine.clamp(-1.0, 1.0).acos(),
        folded_patches: (0..found.len()).filter(|&p| found[p].cosine <= 0.0).collect(),
        spline,
    }
}

/// The bilinear map of each patch from the positions of its nodes: a start for fits over meshes of quadrilaterals.
pub fn bilinear(corners: [Vector; 4], [u, v]: [f64; 2]) -> Vector {
    let weights = [(1.0 - u) * (1.0 - v), u * (1.0 - v), u * v, (1.0 - u) * v];
    [0, 1, 2].map(|x| (0..4).map(|k| weights[k] * corners[k][x]).sum())
}
