//! Fits of splines over four-sided patches, and the distances that they leave.

use super::descent::{Bendings, FitTarget, descend};
use super::nearest::vertex_places;
use super::noise::noise_of;
use super::piece_form::{FootPoint, PieceForm};
use super::quintic::QuinticBasis;
use super::space::QuadSplineSpace;
use super::span_direction::{MEASURED, measured_parameter};
use super::spline::QuadSpline;
use super::system::{FitPlace, QuadSystem};
use super::target::SplineTarget;
use crate::archive::stored;
use crate::control::{Control, Stage};
use crate::error::Result;
use crate::geometry::vector::{Vector, distance, dot, sub};
use crate::parallel;
use std::sync::Arc;

/// The multiple of the noise beyond which one of ten thousand vertices lies.
const NOISE_WITHIN: f64 = 4.0;

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

/// The distances of a spline from its target, over the target's diagonal.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct FitDistances {
    /// The root of the mean square.
    pub rms: f64,
    /// The largest.
    pub max: f64,
}
stored!(row FitDistances { rms: f64, max: f64 });

/// A fitted spline with its distances from the target.
#[derive(Clone)]
pub struct QuadFit {
    /// The spline.
    pub spline: QuadSpline,
    /// The distances of places of the patches from the target.
    pub to_target: FitDistances,
    /// The distances of the vertices of the target from the nearest places of the patches.
    pub of_vertices: FitDistances,
    /// Per patch the largest of both distances, over the diagonal.
    pub patch_max: Vec<f64>,
    /// The standard deviation of the noise of the vertices of the target, over its diagonal, as their heights over the spline tell.
    pub noise: f64,
    /// The largest angle between the normals of spline and target at these places, radians.
    pub normal_error: f64,
    /// The patches that are turned over somewhere: their normal is more than a right angle off the target's; ascending.
    pub folded_patches: Vec<usize>,
}
stored!(sections QuadFit { spline, to_target, of_vertices, patch_max, noise, normal_error, folded_patches });

impl QuadFit {
    /// The largest distance of either kind, over the diagonal.
    pub fn max(&self) -> f64 {
        self.to_target.max.max(self.of_vertices.max)
    }

    /// The larger root of the mean square of both kinds, over the diagonal.
    pub fn rms(&self) -> f64 {
        self.to_target.rms.max(self.of_vertices.rms)
    }

    /// The distance over the diagonal within which nearly all vertices with this noise lie: four times as much.
    pub fn noise_limit(&self) -> f64 {
        NOISE_WITHIN * self.noise
    }

    /// True if no patch is turned over and no distance is larger than this.
    pub fn is_within(&self, tolerance: f64) -> bool {
        self.folded_patches.is_empty() && self.max() <= tolerance
    }

    /// True if fewer patches are turned over than in another fit or, with equally many, the largest distance is less.
    pub fn is_better_than(&self, other: &QuadFit) -> bool {
        (self.folded_patches.len(), self.max()) < (other.folded_patches.len(), other.max())
    }

    /// The patch with the largest distance.
    pub fn worst_patch(&self) -> usize {
        let by_size = |a: &usize, b: &usize| self.patch_max[*a].total_cmp(&self.patch_max[*b]);
        (0..self.patch_max.len()).max_by(by_size).unwrap_or(0)
    }
}

/// A place on or near the target for a place of a patch; equal on common sides.
pub(super) type StartMap<'a> = &'a (dyn Fn(usize, [f64; 2]) -> Vector + Sync);

/// What a fit starts from.
pub(super) struct FitStart<'a> {
    pub map: StartMap<'a>,
    /// The first of the steps that are taken.
    pub first_step: usize,
}

impl<'a> FitStart<'a> {
    /// From a map whose parameter lines may cross otherwise than those of splines: all steps are taken.
    pub fn of_map(map: StartMap<'a>) -> FitStart<'a> {
        FitStart { map, first_step: 0 }
    }
}

/// Fits a spline over four-sided patches to a target. `start`: a map of the patches, as (patch, (u, v)) → point, on or near the target; equal
/// on common sides. Minimised are the distances of the patches from the target and those of its vertices from the patches.
///
/// Every patch belongs to its own piece of the target, or to the smooth piece that is nearest to the middle of its start. Lengths of arcs,
/// which should be about 1 in the mean, should be about proportional to those on the surface.
///
/// # Errors
/// [`Argument`](crate::error::Error::Argument) for an option out of its range; [`Factorisation`](crate::error::Error::Factorisation);
/// [`Cancelled`](crate::error::Error::Cancelled).
pub fn fit_quads(
    space: Arc<QuadSplineSpace>,
    start: &(dyn Fn(usize, [f64; 2]) -> Vector + Sync),
    target: &SplineTarget,
    options: &QuadFitOptions,
    control: &Control,
) -> Result<QuadFit> {
    parallel::within(options.threads, || {
        fit_from(space, &FitStart::of_map(start), target, options.bending, control)
    })
}

/// [`fit_quads`] from either start, on the threads of the caller.
pub(super) fn fit_from(
    space: Arc<QuadSplineSpace>,
    start: &FitStart<'_>,
    target: &SplineTarget,
    bending: f64,
    control: &Control,
) -> Result<QuadFit> {
    let bendings = Bendings::new(bending, start.first_step)?;
    control.step(Stage::Layout, 0.0)?;
    let patches = space.layout().patches().len();
    let pieces = parallel::map(patches, |p| target.piece_of_patch(p, (start.map)(p, [0.5, 0.5])));
    let forms: Vec<Option<PieceForm>> = pieces.iter().map(|&piece| target.form(piece)).collect();
    log::debug!("{} of {patches} patches lie on planes or cylinders", forms.iter().flatten().count());
    let mut system = QuadSystem::new(space.clone(), &forms)?;
    let at_start =
        |p: usize, place: &FitPlace| FootPoint { point: (start.map)(p, place.parameters), normal: [0.0; 3] };
    let feet =
        parallel::map(patches, |p| system.places(p).map(|place| at_start(p, &place)).collect::<Vec<_>>());
    let spline = descend(&mut system, &feet, &FitTarget { target, pieces: &pieces }, &bendings, control)?;
    let fit = measured(spline, &pieces, target);
    control.step(Stage::Layout, 1.0)?;
    Ok(fit)
}

/// The distances of a patch.
#[derive(Default)]
struct PatchDistances {
    /// The sum of the squared distances of its places from its piece of the target, and the largest distance.
    squares: f64,
    largest: f64,
    /// The same of the vertices nearest to it, weighted by their shares.
    vertex_squares: f64,
    vertex_largest: f64,
    /// The heights of these vertices over the patch, along the normals of the target, by number.
    heights: Vec<(u32, f64)>,
    /// The least cosine between normals.
    cosine: f64,
}

fn measured(spline: QuadSpline, pieces: &[usize], target: &SplineTarget) -> QuadFit {
    let vertices = vertex_places(target, pieces, &|p, uv| spline.point_at(p, uv));
    let of_patch = |p: usize| {
        let mut found = PatchDistances { cosine: 1.0, ..PatchDistances::default() };
        let [along_u, along_v] = spline.space().patch_spans(p).map(|spans| {
            (0..MEASURED).map(|k| QuinticBasis::at(spans, measured_parameter(k))).collect::<Vec<_>>()
        });
        for (u, v) in along_u.iter().flat_map(|u| along_v.iter().map(move |v| (u, v))) {
            let at = spline.combined(p, u, v);
            let foot = target.foot(pieces[p], at.point);
            let far = distance(at.point, foot.point);
            found.squares += far * far;
            found.largest = found.largest.max(far);
            let normal = at.normal();
            let facing = target.foot_facing(pieces[p], at.point, foot, normal);
            found.cosine = found.cosine.min(dot(normal.unwrap_or([0.0; 3]), facing.normal));
        }
        for place in &vertices[p] {
            let nearest = spline.point_at(p, place.nearer(&spline, p).parameters);
            let far = distance(nearest, place.vertex.point);
            found.vertex_squares += place.vertex.share * far * far;
            found.vertex_largest = found.vertex_largest.max(far);
            found.heights.push((place.vertex.number, dot(sub(place.vertex.point, nearest), place.normal)));
        }
        found
    };
    let found = parallel::map(pieces.len(), of_patch);
    let places = (pieces.len() * MEASURED * MEASURED).max(1) as f64;
    let diagonal = target.diagonal();
    let sum = |squares: &dyn Fn(&PatchDistances) -> f64| found.iter().map(squares).sum::<f64>();
    let most = |largest: &dyn Fn(&PatchDistances) -> f64| found.iter().map(largest).fold(0.0f64, f64::max);
    let cosine = found.iter().fold(1.0f64, |least, patch| least.min(patch.cosine));
    // Noise is what is left, or less.
    let vertex_rms = sum(&|patch| patch.vertex_squares).sqrt();
    let heights = found.iter().flat_map(|patch| patch.heights.iter().copied()).collect();
    QuadFit {
        noise: noise_of(&heights, target.edges()).min(vertex_rms) / diagonal,
        to_target: FitDistances {
            rms: (sum(&|patch| patch.squares) / places).sqrt() / diagonal,
            max: most(&|patch| patch.largest) / diagonal,
        },
        of_vertices: FitDistances {
            rms: vertex_rms / diagonal,
            max: most(&|patch| patch.vertex_largest) / diagonal,
        },
        patch_max: found.iter().map(|patch| patch.largest.max(patch.vertex_largest) / diagonal).collect(),
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
