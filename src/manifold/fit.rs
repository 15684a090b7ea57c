//! Splines over a whole surface, fitted to its vertices.

use super::domain::SurfaceDomain;
use super::flat::Flat;
use super::grade::{Grade, Miss};
use super::plane::TURNS;
use crate::control::Control;
use crate::error::{Error, Result};
use crate::geometry::vector::{Vector, diagonal, distance};
use crate::mesh::VertexId;
use crate::metric::Surface;
use crate::spline::{
    Fill, FitOptions, Fitted, Hole, Parameter, Spline, SplineSpace, SurfacePoint, fit_filled,
};
use std::sync::Arc;

/// Least number of vertices in a hole, and largest share of all vertices.
const LEAST_INSIDE: usize = 60;
const MOST_INSIDE: f64 = 0.3;
/// Where knots are far apart, a spline bends less sharply between its triangles.
const WIDE: f64 = 0.9;
/// Vertices in a hole per coefficient of its filling.
const POINTS: f64 = 6.0;
/// The root of the mean squared distance that is asked for, over the largest distance.
const RMS: f64 = 0.1;
/// Factor of the fairness after a round that misses the mean distance asked for.
const LESS_FAIR: f64 = 0.6;
/// Corrections that are made although the tolerance is met.
const CORRECTIONS: usize = 5;
/// No correction follows one after which the mean distance is still more than this share of what it was.
const GAIN: f64 = 0.98;
/// Times that a domain is made again with fewer vertices where it has too many control points.
const TRIES: usize = 4;
/// Growth of the hole's radius in the coordinate in which its vertex is a point as any other.
const GROWTH: f64 = 1.15;
/// Longest step of a parameter in one correction, over the longest side of its triangle.
const LONGEST_STEP: f64 = 0.25;

/// What [`fit_surface`] can be asked.
#[derive(Debug, Clone, PartialEq)]
pub struct SurfaceFitOptions {
    /// 1 to 5. Default 3.
    pub degree: usize,
    /// Number of control points at most; default a quarter of the vertices.
    pub control_points: Option<usize>,
    /// Largest distance of a vertex from the spline that is asked for, over the diagonal of the bounding box; that of the root of the mean
    /// square is a tenth of it. Default 0.01.
    pub tolerance: f64,
    /// Times that the triangles' sizes are adapted to the errors. Default 6.
    pub rounds: usize,
    /// Times at most that the places of the vertices are moved to where the spline is nearest: fewer where the tolerance is met, or little
    /// is gained. Default 20.
    pub corrections: usize,
    /// [`FitOptions::fairness`] of the first round; less in later ones while the mean distance is missed. Default 1e-10.
    pub fairness: f64,
    /// [`crate::spline::KnotOptions::spread`]. Default 0.9.
    pub spread: f64,
    /// Area of a hole over m² mean triangles, for a vertex with a total angle of m turns. Default 1.5.
    pub hole: f64,
    /// Threads; 0 (default) is one per core. The result does not depend on it.
    pub threads: usize,
}

impl Default for SurfaceFitOptions {
    fn default() -> Self {
        SurfaceFitOptions {
            degree: 3,
            control_points: None,
            tolerance: 0.01,
            rounds: 6,
            corrections: 20,
            fairness: 1e-10,
            spread: WIDE,
            hole: 1.5,
            threads: 0,
        }
    }
}

/// A spline over a whole surface.
#[derive(Debug, Clone)]
pub struct SurfaceFit {
    /// The spline.
    pub spline: Spline,
    /// Its domain.
    pub domain: SurfaceDomain,
    /// Per vertex of the surface its place.
    pub places: Vec<Parameter>,
    /// The singular vertices inside the surface, around which the spline has its holes, in their order.
    pub singular: Vec<VertexId>,
    /// Root of the mean of the squared distances of the vertices from their places on the spline, over the diagonal of the bounding box.
    pub rms: f64,
    /// The largest such distance, over the same.
    pub max: f64,
    /// Patches in which the spline folds, [`SurfaceDomain::folds`].
    pub folds: Vec<usize>,
    /// Rounds that were made.
    pub rounds: usize,
}

/// A spline fitted to the vertices of a surface in space, on a flat metric of it: triangles of the domain about as long on the surface, and
/// smaller where the fit is worse. The best of all rounds; they end early where the tolerance is met and the spline does not fold.
///
/// # Errors
/// [`Error::Argument`] for a surface without positions, a metric that is not flat or lives on a double; [`Error::Spline`];
/// [`Error::Factorisation`]; [`Error::Cancelled`].
pub fn fit_surface(
    surface: &Surface,
    flat: &Flat,
    options: &SurfaceFitOptions,
    control: &Control,
) -> Result<SurfaceFit> {
    let Some(points) = surface.positions() else {
        return Err(Error::argument("surface", "without positions", "in space, to be fitted"));
    };
    let mesh = surface.mesh();
    if flat.mesh.n_vertices() < mesh.n_vertices() {
        let need = "at least those of the surface, which come first";
        return Err(Error::argument("vertices of the flat metric", flat.mesh.n_vertices(), need));
    }
    let plan = Plan::new(points, options);
    let mut grade = Grade::new(surface, flat, plan.triangles, |turns| plan.inside(turns), control)?;
    let singular = flat.singular()?;
    let mut best: Option<SurfaceFit> = None;
    let mut fairness = options.fairness;
    for rounds in 1..=options.rounds.max(1) {
        let domain = plan.domain(&grade, flat, control)?;
        let found = match Round::new(domain, &plan, fairness, control) {
            Ok(found) => found,
            // Another round has given a spline: this one cannot do better.
            Err(Error::Spline { .. } | Error::Factorisation { .. }) if best.is_some() => break,
            Err(error) => return Err(error),
        };
        grade.adapt(mesh, &found.triangles(control)?, (found.space.patches().len(), options.degree));
        let [rms, max] = plan.relative(&found.fitted);
        let Round { domain, places, fitted, folds, .. } = found;
        let (spline, singular) = (fitted.spline, singular.clone());
        let next = SurfaceFit { spline, domain, places, singular, rms, max, folds, rounds };
        let is_done = next.miss(options.tolerance) <= 1.0 && next.folds.is_empty();
        if best.as_ref().is_none_or(|best| next.cost(options.tolerance) < best.cost(options.tolerance)) {
            best = Some(next);
        }
        if is_done {
            break;
        }
        if rms > RMS * options.tolerance {
            fairness *= LESS_FAIR;
        }
    }
    best.ok_or_else(|| Error::argument("rounds", options.rounds, "1 or more"))
}

impl SurfaceFit {
    /// How far it misses what is asked for, 1 where it just does not.
    fn miss(&self, tolerance: f64) -> f64 {
        miss([self.rms, self.max], tolerance)
    }

    /// What is less for a better fit: first to be near, then not to fold, then to be nearer.
    fn cost(&self, tolerance: f64) -> (f64, usize, f64) {
        let miss = self.miss(tolerance);
        (if miss <= 1.0 { 0.0 } else { miss }, self.folds.len(), miss)
    }
}

/// The mean distance over the one asked for, or the largest one, whichever is worse.
fn miss([rms, max]: [f64; 2], tolerance: f64) -> f64 {
    f64::max(max, rms / RMS) / tolerance
}

/// Vertices of a triangulation of this surface, or plane, that has at most so many control points: of V vertices at most n²V − (n² − 1)χ,
/// less for each edge of the boundary.
fn vertices_for(control_points: usize, flat: &Flat, degree: usize) -> usize {
    let square = (degree * degree).max(1) as i64;
    let euler = if flat.plane.is_some() { 1 } else { flat.mesh.euler() };
    let vertices = (control_points as i64 + (square - 1) * euler) / square;
    vertices.max(1) as usize
}

/// What all rounds have in common.
struct Plan<'a> {
    points: &'a [Vector],
    diagonal: f64,
    options: &'a SurfaceFitOptions,
    /// Those of a closed surface with as many control points as are wanted: n² per two of them.
    triangles: usize,
}

impl<'a> Plan<'a> {
    fn new(points: &'a [Vector], options: &'a SurfaceFitOptions) -> Plan<'a> {
        let plan = Plan { points, diagonal: diagonal(points), options, triangles: 0 };
        let triangles = 2 * plan.most_control_points() / (options.degree * options.degree).max(1);
        Plan { triangles, ..plan }
    }

    fn most_control_points(&self) -> usize {
        self.options.control_points.unwrap_or(self.points.len() / 4)
    }

    /// A domain whose splines have no more control points than wanted, coefficients of fillings included.
    fn domain(&self, grade: &Grade<'_>, flat: &Flat, control: &Control) -> Result<SurfaceDomain> {
        let degree = self.options.degree;
        let fills: usize = grade.turns().map(|turns| self.coefficients(turns)).sum();
        let most = self.most_control_points().saturating_sub(fills);
        let mut count = vertices_for(most, flat, degree).saturating_sub(grade.added());
        let mut domain = grade.domain(count, control)?;
        for _ in 0..TRIES {
            // Vertices may have been added to those that were chosen.
            let excess = control_points(&domain, degree).saturating_sub(most);
            if excess == 0 {
                break;
            }
            count = count.saturating_sub(excess.div_ceil(degree * degree).max(1));
            domain = grade.domain(count, control)?;
        }
        Ok(domain)
    }

    /// Root of the mean square of the distances and the largest one, over the diagonal.
    fn relative(&self, fitted: &Fitted) -> [f64; 2] {
        [fitted.rms, fitted.max].map(|distance| distance / self.diagonal)
    }

    /// Vertices of the surface that the hole of a singular vertex with this number of turns covers: [`SurfaceFitOptions::hole`] times the
    /// area of turns² triangles.
    fn inside(&self, turns: u32) -> usize {
        let vertices = self.points.len() as f64;
        let wanted = self.options.hole * f64::from(turns * turns) * vertices / self.triangles.max(1) as f64;
        (wanted as usize).clamp(LEAST_INSIDE, LEAST_INSIDE.max((MOST_INSIDE * vertices) as usize))
    }

    /// Coefficients of the filling of that hole.
    fn coefficients(&self, turns: u32) -> usize {
        Fill::blank((self.inside(turns) as f64 / POINTS) as usize).coefficients().len()
    }

    /// The hole around a singular vertex: the widest with no more vertices than wanted, so that triangles beyond it are small beside their
    /// distance from the vertex.
    fn hole(&self, domain: &SurfaceDomain, places: &[Parameter], v: VertexId) -> Result<Hole> {
        let mut hole = domain.hole(v)?;
        let wanted = self.inside(hole.turns.unsigned_abs());
        let growth = GROWTH.powi(hole.turns);
        loop {
            let wider = domain.wide_hole(v, growth * hole.radius)?;
            let inside = places.iter().filter(|&&at| wider.contains(at)).count();
            if wider.radius <= hole.radius || inside > wanted {
                break;
            }
            hole = wider;
        }
        let coefficients = self.coefficients(hole.turns.unsigned_abs());
        Ok(hole.blank(coefficients))
    }
}

/// Control points of splines of a degree over a domain: n − 1 on each edge and (n − 1)(n − 2)/2 in each triangle beside those of the
/// vertices.
fn control_points(domain: &SurfaceDomain, degree: usize) -> usize {
    let mesh = &domain.coarse().mesh;
    let inner = degree.saturating_sub(1);
    mesh.n_vertices() + inner * mesh.n_edges() + inner * degree.saturating_sub(2) / 2 * mesh.n_faces()
}

/// One domain, and what is fitted on it.
struct Round<'a> {
    plan: &'a Plan<'a>,
    domain: SurfaceDomain,
    space: Arc<SplineSpace>,
    /// Without the fillings that the fit finds.
    holes: Vec<Hole>,
    places: Vec<Parameter>,
    fitted: Fitted,
    /// Patches in which the spline folds.
    folds: Vec<usize>,
}

impl<'a> Round<'a> {
    /// Fit, correct, and look for folds.
    fn new(domain: SurfaceDomain, plan: &'a Plan<'a>, fairness: f64, control: &Control) -> Result<Round<'a>> {
        let Plan { points, options, .. } = plan;
        let space = Arc::new(domain.space(options.degree, options.spread)?);
        let places = domain.places(points.len())?;
        let holes: Vec<Hole> = match &domain.infinity {
            Some(infinity) => vec![infinity.hole.clone().blank(plan.coefficients(TURNS))],
            None => domain
                .singular()
                .into_iter()
                .map(|v| plan.hole(&domain, &places, v))
                .collect::<Result<_>>()?,
        };
        let fit_options = FitOptions { fairness, threads: options.threads };
        let fitted = fit_filled((&space, &holes), (&places, points), &fit_options, control)?;
        let mut round = Round { plan, domain, space, holes, places, fitted, folds: Vec::new() };
        round.improve(&fit_options, control)?;
        round.folds = round.domain.folds(&round.fitted.spline, options.threads, control)?;
        Ok(round)
    }

    /// Correct the places and fit again, until that is near enough, or gains little.
    fn improve(&mut self, options: &FitOptions, control: &Control) -> Result<()> {
        let plan = self.plan;
        for done in 1..=plan.options.corrections {
            self.correct(control)?;
            let holes = (&self.space, &self.holes[..]);
            let next = fit_filled(holes, (&self.places, plan.points), options, control)?;
            let is_slow = next.rms > GAIN * self.fitted.rms;
            self.fitted = next;
            let is_near = miss(plan.relative(&self.fitted), plan.options.tolerance) <= 1.0;
            if done >= CORRECTIONS && (is_near || is_slow) {
                break;
            }
        }
        Ok(())
    }

    /// Whether the spline has no weight at a place.
    fn is_covered(&self, at: Parameter) -> bool {
        self.fitted.spline.holes().iter().any(|hole| hole.is_core(at))
    }

    /// Move every place to where the spline is nearest to its vertex, by one step of Gauss and Newton.
    fn correct(&mut self, control: &Control) -> Result<()> {
        let found = self.fitted.spline.evaluate(&self.places, 1, self.plan.options.threads, control)?;
        for (k, &point) in self.plan.points.iter().enumerate() {
            let (place, at) = (self.places[k], &found[k]);
            if let Some(inside) =
                self.fitted.spline.holes().iter().find_map(|hole| hole.nearer(&self.space, place, point))
            {
                self.places[k] = inside;
                continue;
            }
            let is_in_patch = (place.patch as usize) < self.space.patches().len();
            let Some(step) = at.step_towards(point).filter(|_| is_in_patch) else { continue };
            let length = f64::hypot(step[0], step[1]);
            if length > 0.0 {
                let shorter = f64::min(1.0, LONGEST_STEP / length);
                self.places[k] = self.domain.walk(place, step.map(|x| shorter * x));
            }
        }
        Ok(())
    }

    /// Per vertex its triangle and its distance from its place, outside what holes take the place of.
    fn triangles(&self, control: &Control) -> Result<Vec<Miss>> {
        let found = self.fitted.spline.evaluate(&self.places, 0, self.plan.options.threads, control)?;
        let all = self.places.iter().zip(found.iter().zip(self.plan.points));
        let miss = |(&at, (found, point)): (&Parameter, (&SurfacePoint, &Vector))| {
            (!self.is_covered(at)).then(|| (at.patch as usize, distance(found.point, *point)))
        };
        Ok(all.map(miss).collect())
    }
}
