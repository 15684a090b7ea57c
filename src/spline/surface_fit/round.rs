//! One round of a fit to a whole surface: over one domain, fits alternate with corrections of the vertices' places.
//!
//! The first fits are least-squares fits to the vertices at their places. Those that follow minimise distances from tangent planes, with a
//! small weight for tangential ones, so that the spline slides along the surface to where it fits best (Gauss–Newton) \[WPL06\].

use super::domain::SurfaceDomain;
use super::plane::TURNS;
use super::setting::{FitSetting, cost, miss};
use super::sizes::VertexError;
use crate::control::{Control, Stage};
use crate::error::{Error, Result};
use crate::geometry::vector::Vector;
use crate::mesh::FaceId;
use crate::parallel::Pool;
use crate::spline::triangular::{
    FairnessUnit, FairnessWeights, FitSystem, PlacedRows, TangentPlanes, WeightedFit, open_places,
    partition_of_unity,
};
use crate::spline::{Hole, Parameter, Spline, SplineSpace, SurfacePoint};
use std::sync::Arc;

/// Number of fits at given places before those by tangent planes; the last of them chooses the weight of the fairness again.
const POSITIONS: usize = 2;
/// Corrections of the places that are made even if the tolerance is met.
const CORRECTIONS: usize = 5;
/// Corrections end once one leaves more than this share of the root mean square distance.
const GAIN: f64 = 0.98;
/// Part of the progress that is left after each correction: most rounds take five to ten.
const LEFT_AFTER_CORRECTION: f64 = 0.8;
/// Longest step of a place in one correction, over the longest side of its triangle.
const LONGEST_STEP: f64 = 0.25;
/// The weight of the fairness at which cross-validation starts, and the largest one.
const FAIRNESS: f64 = 1e-8;
const MOST_FAIRNESS: f64 = 1e-2;
/// The least weight for degree 0; for degree n it is 10ⁿ times smaller. With less, fits to points without noise bend where there are few
/// points, and splines near rough surfaces fold more.
const LEAST_FAIRNESS: f64 = 1e-6;
/// Weight of tangential distances in the first fit by tangent planes, its factors after a fit that is nearer and one that is not, and its
/// bounds.
const DAMPING: f64 = 0.1;
const LESS_DAMPING: f64 = 0.3;
const MORE_DAMPING: f64 = 10.0;
const DAMPING_BOUNDS: [f64; 2] = [1e-3, 1.0];

/// Largest deviation of the sum of all basis functions from 1: above rounding.
const UNITY: f64 = 1e-9;
/// Most times that patches in which a spline folds are made fairer.
const UNFOLDINGS: usize = 8;
/// Distance over the tolerance, and share of the patches that fold, from which on folds are left as they are.
const UNFOLDED_MISS: f64 = 2.0;
const UNFOLDED_SHARE: f64 = 0.3;
/// Factors of the weight of the fairness in a patch that folds, and for each one beside it.
const FAIRER: f64 = 10.0;
const FAIRER_BESIDE: f64 = 2.0;
/// The largest weight of the fairness of a patch, relative to that of all.
const MOST_WEIGHT: f64 = 1e6;

/// A domain and the spline fitted over it.
pub(super) struct FitRound {
    pub domain: SurfaceDomain,
    pub places: Vec<Parameter>,
    pub spline: Spline,
    /// Root mean square and largest distance of the vertices, over the diagonal.
    pub measures: [f64; 2],
    pub fairness: f64,
    /// The patches in which the spline folds.
    pub folds: Vec<usize>,
    /// The distance of each vertex, over the diagonal.
    pub distances: Vec<f64>,
}

impl FitRound {
    /// Fits a spline over a domain, corrects the places, and looks for folds. `factor`: of the weight of the fairness. `is_checked`: a domain
    /// whose basis functions do not add up to 1 is refused.
    pub fn new(
        domain: SurfaceDomain,
        setting: &FitSetting<'_>,
        factor: f64,
        is_checked: bool,
        control: &Control,
    ) -> Result<FitRound> {
        let FitSetting { points, options, .. } = setting;
        let pool = Pool::new(options.threads)?;
        let space = pool.run(|| domain.space(options.degree, options.spread, control))?;
        let space = Arc::new(space);
        control.check()?;
        let places = domain.places(points.len())?;
        control.check()?;
        let holes: Vec<Hole> = match &domain.infinity {
            Some(infinity) => vec![infinity.hole.clone().blank(setting.coefficients(setting.inside(TURNS)))],
            None => domain
                .singular()
                .into_iter()
                .map(|v| setting.hole(&domain, &space, &places, v))
                .collect::<Result<_>>()?,
        };
        if is_checked {
            check_unity(&space, &holes, options.threads, &control.part(0.0, 0.1))?;
        }
        let best = pool.run(|| {
            let system = FitSystem::new(&space, &holes, &places, FairnessUnit::Patches, control)?;
            let mut fitting =
                RoundFitting { setting, domain: &domain, space: &space, holes: &holes, system, factor };
            let best = fitting.run(places, &control.part(0.1, 0.9))?;
            fitting.unfold(best, &control.part(0.9, 1.0))
        })?;
        let (FittedPlaces { places, spline, measures, distances, fairness }, folds) = best;
        Ok(FitRound { domain, places, spline, measures, fairness, folds, distances })
    }

    /// For each vertex its triangle and its distance from the spline; none where the filling of a hole alone is the surface.
    pub fn triangles(&self) -> Vec<VertexError> {
        let is_covered = |at: Parameter| self.spline.holes().iter().any(|hole| hole.is_core(at));
        let all = self.places.iter().zip(&self.distances);
        all.map(|(&at, &miss)| (!is_covered(at)).then_some((at.patch as usize, miss))).collect()
    }
}

/// Refuses a space whose basis functions do not add up to 1 somewhere outside the cores of holes.
fn check_unity(space: &Arc<SplineSpace>, holes: &[Hole], threads: usize, control: &Control) -> Result<()> {
    let (patch, error) = partition_of_unity(space, &open_places(space, holes), threads, control)?;
    if error > UNITY {
        let message = format!(
            "the basis functions miss the sum 1 by {error:.1e} there, as triangles of so coarse a domain reach around a singular vertex; allow more control points"
        );
        return Err(Error::Spline { what: "patch", index: patch, message });
    }
    Ok(())
}

/// A spline with the places of the vertices and their distances.
struct FittedPlaces {
    places: Vec<Parameter>,
    spline: Spline,
    measures: [f64; 2],
    distances: Vec<f64>,
    fairness: f64,
}

/// The fits of a round.
struct RoundFitting<'a> {
    setting: &'a FitSetting<'a>,
    domain: &'a SurfaceDomain,
    space: &'a Arc<SplineSpace>,
    holes: &'a [Hole],
    system: FitSystem<'a>,
    factor: f64,
}

impl RoundFitting<'_> {
    /// Alternates corrections of the places with fits until the spline is near enough or little is gained.
    fn run(&mut self, places: Vec<Parameter>, control: &Control) -> Result<FittedPlaces> {
        let placed = self.system.placed(&places, self.setting.points)?;
        let fit = self.fit(&placed, FAIRNESS)?;
        self.improve(places, fit, 1, control)
    }

    /// [`Self::run`] from a fit on, `first` being the number of the first correction.
    fn improve(
        &mut self,
        mut places: Vec<Parameter>,
        mut fit: WeightedFit,
        first: usize,
        control: &Control,
    ) -> Result<FittedPlaces> {
        let FitSetting { points, options, .. } = self.setting;
        let mut placed = self.system.placed(&places, points)?;
        let mut best = self.measured(&places, &placed, &fit)?;
        let (mut before, mut damping) = (f64::INFINITY, DAMPING);
        for done in first..=options.corrections {
            control.step(Stage::Flow, 1.0 - LEFT_AFTER_CORRECTION.powi(done as i32))?;
            let spline = self.system.spline(self.space, self.holes, &fit.unknowns)?;
            let found = spline.evaluate(&places, 1, options.threads, &control.still())?;
            self.correct(&mut places, &found, &spline);
            placed = self.system.placed(&places, points)?;
            let next = self.measured(&places, &placed, &fit)?;
            let ([rms, _], is_near) = (next.measures, miss(next.measures, options.tolerance) <= 1.0);
            if rms <= best.measures[0] {
                best = next;
            }
            if done >= CORRECTIONS && (is_near || rms > GAIN * before) || done == options.corrections {
                break;
            }
            if done <= POSITIONS {
                fit = self.refit(&placed, fit.fairness, done == POSITIONS)?;
            } else {
                let change = if rms < before { LESS_DAMPING } else { MORE_DAMPING };
                damping = (damping * change).clamp(DAMPING_BOUNDS[0], DAMPING_BOUNDS[1]);
                let normals = self.normals(&found);
                let planes = TangentPlanes { normals: &normals, damping };
                fit = self.system.fit_tangentially(&placed, &planes, fit)?;
            }
            before = rms;
        }
        Ok(best)
    }

    /// Makes the patches in which the spline folds fairer, and fits again from its places, until none folds. Returns the best spline, and the
    /// patches in which it folds.
    fn unfold(&mut self, mut best: FittedPlaces, control: &Control) -> Result<(FittedPlaces, Vec<usize>)> {
        let options = self.setting.options;
        let cost_of = |fit: &FittedPlaces, folds: &[usize]| cost(fit.measures, folds, options.tolerance);
        let mut weights = FairnessWeights::even(self.space, self.holes);
        let mut folds = self.domain.folds(&best.spline, options.threads, &control.still())?;
        let mut last = (folds.clone(), miss(best.measures, options.tolerance));
        for k in 0..UNFOLDINGS {
            let control = &control.part_of(k, UNFOLDINGS);
            let is_far = last.1 > UNFOLDED_MISS;
            if last.0.is_empty()
                || is_far
                || folds.len() as f64 > UNFOLDED_SHARE * weights.patches.len() as f64
            {
                break;
            }
            self.make_fairer(&mut weights, &last.0);
            self.system.weigh(&weights);
            let placed = self.system.placed(&best.places, self.setting.points)?;
            let fairness = best.fairness;
            let fit = WeightedFit { unknowns: self.system.fit(&placed, fairness)?, fairness };
            let next = self.improve(best.places.clone(), fit, POSITIONS + 1, control)?;
            last = (
                self.domain.folds(&next.spline, options.threads, &control.still())?,
                miss(next.measures, options.tolerance),
            );
            if cost_of(&next, &last.0) < cost_of(&best, &folds) {
                (best, folds) = (next, last.0.clone());
            }
        }
        Ok((best, folds))
    }

    /// Raises the weights of patches in which a spline folds and of those beside them. At a hole that of its filling: the spline of a patch
    /// there goes around a point where its derivatives have no bound.
    fn make_fairer(&self, weights: &mut FairnessWeights, folds: &[usize]) {
        let mesh = &self.domain.coarse().mesh;
        let filled: Vec<&Hole> = self.holes.iter().filter(|hole| hole.fill.is_some()).collect();
        let is_at = |hole: &Hole, patch: usize| hole.sectors.iter().any(|s| s.patch as usize == patch);
        let raise = |weight: &mut f64, factor: f64| *weight = (*weight * factor).min(MOST_WEIGHT);
        let is_at_hole = |patch: usize| filled.iter().any(|hole| is_at(hole, patch));
        for (hole, weight) in filled.iter().zip(&mut weights.fillings) {
            if folds.iter().any(|&patch| is_at(hole, patch)) {
                raise(weight, FAIRER);
            }
        }
        for &patch in folds.iter().filter(|&&patch| !is_at_hole(patch)) {
            raise(&mut weights.patches[patch], FAIRER);
            let beside = mesh.face_halfedges(FaceId(patch as u32)).map(|h| mesh.corner(h.twin()));
            for f in beside.into_iter().flatten().map(|(f, _)| f.index()).filter(|&f| !is_at_hole(f)) {
                raise(&mut weights.patches[f], FAIRER_BESIDE);
            }
        }
    }

    /// The normals of the tangent planes; none on the boundary, which would slide over the border of the mesh.
    fn normals(&self, found: &[SurfacePoint]) -> Vec<Option<Vector>> {
        let all = found.iter().zip(&self.setting.is_boundary);
        all.map(|(at, &is_boundary)| at.normal().filter(|_| !is_boundary)).collect()
    }

    /// The spline of a solution with its distances.
    fn measured(
        &self,
        places: &[Parameter],
        placed: &PlacedRows<'_>,
        fit: &WeightedFit,
    ) -> Result<FittedPlaces> {
        let distances: Vec<f64> =
            placed.distances(&fit.unknowns).into_iter().map(|miss| miss / self.setting.diagonal).collect();
        let (sum, max) = distances.iter().fold((0.0, 0.0f64), |(sum, max), &m| (sum + m * m, max.max(m)));
        let measures = [(sum / distances.len().max(1) as f64).sqrt(), max];
        let spline = self.system.spline(self.space, self.holes, &fit.unknowns)?;
        Ok(FittedPlaces { places: places.to_vec(), spline, measures, distances, fairness: fit.fairness })
    }

    /// The first fit, whose weight of the fairness is given or chosen from `start` on.
    fn fit(&mut self, placed: &PlacedRows<'_>, start: f64) -> Result<WeightedFit> {
        let given = self.setting.options.fairness;
        if given > 0.0 {
            let fairness = given * self.factor;
            return Ok(WeightedFit { unknowns: self.system.fit(placed, fairness)?, fairness });
        }
        let least = LEAST_FAIRNESS * 0.1f64.powi(self.setting.options.degree as i32);
        let WeightedFit { fairness, unknowns } =
            self.system.fit_cross_validated(placed, start, [least, MOST_FAIRNESS])?;
        if self.factor == 1.0 {
            return Ok(WeightedFit { unknowns, fairness });
        }
        let fairness = self.factor * fairness;
        Ok(WeightedFit { unknowns: self.system.fit(placed, fairness)?, fairness })
    }

    fn refit(&mut self, placed: &PlacedRows<'_>, fairness: f64, choose: bool) -> Result<WeightedFit> {
        if choose {
            return self.fit(placed, fairness / self.factor);
        }
        Ok(WeightedFit { unknowns: self.system.fit(placed, fairness)?, fairness })
    }

    /// Moves each place towards the nearest point of the spline to its vertex, by one Gauss–Newton step. `found`: the surface there.
    fn correct(&self, places: &mut [Parameter], found: &[SurfacePoint], spline: &Spline) {
        let points = self.setting.points.iter();
        for ((place, at), &point) in places.iter_mut().zip(found).zip(points) {
            if let Some(inside) =
                spline.holes().iter().find_map(|hole| hole.nearer(self.space, *place, point))
            {
                *place = inside;
                continue;
            }
            let is_in_patch = (place.patch as usize) < self.space.patches().len();
            let Some(step) = at.step_towards(point).filter(|_| is_in_patch) else { continue };
            let length = f64::hypot(step[0], step[1]);
            if length > 0.0 {
                let shorter = f64::min(1.0, LONGEST_STEP / length);
                *place = self.domain.walk(*place, step.map(|x| shorter * x));
            }
        }
    }
}
