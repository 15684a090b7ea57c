//! Splines over a whole surface, fitted to its vertices in rounds: domain, fit, corrected places, adapted sizes.

use super::areas::vertex_areas;
use super::domain::SurfaceDomain;
use super::flat::FlatMetric;
use super::plane::TURNS;
use super::sizes::{TriangleSizes, VertexError};
use crate::control::Control;
use crate::error::{Error, Result};
use crate::geometry::vector::{Vector, diagonal, distance};
use crate::mesh::VertexId;
use crate::metric::Surface;
use crate::spline::{
    Fill, FitOptions, Hole, Parameter, PlacedPoints, Spline, SplineFit, SplineSpace, SurfacePoint, fit_filled,
};
use std::sync::Arc;

/// Least number of vertices in a hole.
const LEAST_INSIDE: usize = 60;
/// Largest share of all vertices in a hole.
const MOST_INSIDE: f64 = 0.3;
/// Default spread of knots: with knots far apart, a spline bends less sharply between its triangles.
const WIDE: f64 = 0.9;
/// Vertices in a hole for each coefficient of its filling.
const POINTS: f64 = 6.0;
/// Tolerance of the root mean square distance, over that of the largest distance.
const RMS: f64 = 0.1;
/// Factor of the fairness weight after a round that misses the tolerance of the root mean square distance.
const LESS_FAIR: f64 = 0.6;
/// Corrections of the places that are made even if the tolerance is met.
const CORRECTIONS: usize = 5;
/// Corrections end once one leaves more than this share of the root mean square distance.
const GAIN: f64 = 0.98;
/// Times that a domain with too many control points is made again with fewer vertices.
const TRIES: usize = 4;
/// Growth of a hole's radius from trial to trial, in the coordinate in which its vertex is a regular point.
const GROWTH: f64 = 1.15;
/// Longest step of a place in one correction, over the longest side of its triangle.
const LONGEST_STEP: f64 = 0.25;

/// Options of [`fit_surface`].
#[derive(Debug, Clone, PartialEq)]
pub struct SurfaceFitOptions {
    /// Degree of the spline, 1 to 5. Default 3.
    pub degree: usize,
    /// Most control points. Default: a quarter of the number of vertices.
    pub control_points: Option<usize>,
    /// Largest distance of a vertex from the spline, over the diagonal of the bounding box; the root mean square distance is to be a tenth
    /// of it. Default 0.01.
    pub tolerance: f64,
    /// Times that the triangles' sizes are adapted to the errors. Default 6.
    pub rounds: usize,
    /// Most times that the places of the vertices are moved to the nearest points of the spline; fewer if the tolerance is met or little is
    /// gained. Default 20.
    pub corrections: usize,
    /// [`FitOptions::fairness`] of the first round; later rounds use less while the tolerance is missed. Default 1e-10.
    pub fairness: f64,
    /// [`crate::spline::KnotOptions::spread`]. Default 0.9.
    pub spread: f64,
    /// Area of a hole over that of m² mean triangles, for a vertex with a total angle of m turns. Default 1.5.
    pub hole: f64,
    /// Number of threads; 0 (default) is one for each core. The result does not depend on it.
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

/// A spline over a whole surface, with its domain and its distance from the vertices.
#[derive(Debug, Clone)]
pub struct SurfaceFit {
    /// The spline.
    pub spline: Spline,
    /// Its domain.
    pub domain: SurfaceDomain,
    /// The place of each vertex of the surface.
    pub places: Vec<Parameter>,
    /// The singular vertices inside the surface, around which the spline has its holes, in the order of the holes.
    pub singular: Vec<VertexId>,
    /// Root mean square of the distances of the vertices from their places on the spline, over the diagonal of the bounding box.
    pub rms: f64,
    /// The largest such distance, over the diagonal.
    pub max: f64,
    /// The patches in which the spline folds, see [`SurfaceDomain::folds`].
    pub folds: Vec<usize>,
    /// The number of rounds that were made until this spline.
    pub rounds: usize,
}

impl SurfaceFit {
    /// The share of the surface that lies in patches in which the spline folds: of the area around the vertices whose places are in them.
    /// `surface`: that which was fitted.
    pub fn folded_share(&self, surface: &Surface) -> f64 {
        let areas = vertex_areas(surface.mesh(), surface.lengths());
        let is_folded = |at: &Parameter| self.folds.binary_search(&(at.patch as usize)).is_ok();
        let (mut folded, mut all) = (0.0, 0.0);
        for (at, area) in self.places.iter().zip(areas.iter()) {
            all += area;
            folded += if is_folded(at) { *area } else { 0.0 };
        }
        if all > 0.0 { folded / all } else { 0.0 }
    }
}

/// Fits a spline to the vertices of a surface in space, over a flat metric of it. The triangles of the domain are about equally long on the
/// surface in the first round, and become smaller where the fit is worse. Returned is the best of all rounds; they end early once the
/// tolerance is met and the spline does not fold.
///
/// # Errors
/// [`Error::Argument`] for a surface without positions, a metric that is not flat or lives on a double; [`Error::Spline`];
/// [`Error::Factorisation`]; [`Error::Cancelled`].
pub fn fit_surface(
    surface: &Surface,
    flat: &FlatMetric,
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
    let setting = FitSetting::new(points, options);
    let mut sizes =
        TriangleSizes::new(surface, flat, setting.triangles, |turns| setting.inside(turns), control)?;
    let singular = flat.singular()?;
    let mut best: Option<SurfaceFit> = None;
    let mut fairness = options.fairness;
    for rounds in 1..=options.rounds.max(1) {
        let domain = setting.domain(&sizes, flat, control)?;
        let found = match FitRound::new(domain, &setting, fairness, control) {
            Ok(found) => found,
            // An earlier round has given a spline, which is kept.
            Err(Error::Spline { .. } | Error::Factorisation { .. }) if best.is_some() => break,
            Err(error) => return Err(error),
        };
        sizes.adapt(mesh, &found.triangles(control)?, found.space.patches().len(), options.degree);
        let [rms, max] = setting.relative(&found.fitted);
        let FitRound { domain, places, fitted, folds, .. } = found;
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
    /// The distance over the tolerance: at most 1 if the tolerance is met.
    fn miss(&self, tolerance: f64) -> f64 {
        miss([self.rms, self.max], tolerance)
    }

    /// A number that is smaller for a better fit: first by the tolerance, then by the count of folds, then by the distance.
    fn cost(&self, tolerance: f64) -> (f64, usize, f64) {
        let miss = self.miss(tolerance);
        (if miss <= 1.0 { 0.0 } else { miss }, self.folds.len(), miss)
    }
}

/// The largest distance over its tolerance, or the root mean square distance over its own, whichever is larger.
fn miss([rms, max]: [f64; 2], tolerance: f64) -> f64 {
    f64::max(max, rms / RMS) / tolerance
}

/// The number of vertices of a triangulation of this surface, or plane, that has at most `control_points` control points of a spline: V
/// vertices have at most n²V − (n² − 1)χ, less for each edge of the boundary.
fn vertices_for(control_points: usize, flat: &FlatMetric, degree: usize) -> usize {
    let square = (degree * degree).max(1) as i64;
    let euler = if flat.plane.is_some() { 1 } else { flat.mesh.euler() };
    let vertices = (control_points as i64 + (square - 1) * euler) / square;
    vertices.max(1) as usize
}

/// Points, options and sizes that all rounds of a fit have in common.
struct FitSetting<'a> {
    points: &'a [Vector],
    diagonal: f64,
    options: &'a SurfaceFitOptions,
    /// Triangles of a closed surface with as many control points as are wanted, which has n² for each two triangles.
    triangles: usize,
}

impl<'a> FitSetting<'a> {
    fn new(points: &'a [Vector], options: &'a SurfaceFitOptions) -> FitSetting<'a> {
        let setting = FitSetting { points, diagonal: diagonal(points), options, triangles: 0 };
        let triangles = 2 * setting.most_control_points() / (options.degree * options.degree).max(1);
        FitSetting { triangles, ..setting }
    }

    fn most_control_points(&self) -> usize {
        self.options.control_points.unwrap_or(self.points.len() / 4)
    }

    /// A domain whose splines have no more control points than wanted, the coefficients of fillings included.
    fn domain(
        &self,
        sizes: &TriangleSizes<'_>,
        flat: &FlatMetric,
        control: &Control,
    ) -> Result<SurfaceDomain> {
        let degree = self.options.degree;
        let fills: usize = sizes.turns().map(|turns| self.coefficients(turns)).sum();
        let most = self.most_control_points().saturating_sub(fills);
        let mut count = vertices_for(most, flat, degree).saturating_sub(sizes.added());
        let mut domain = sizes.domain(count, control)?;
        for _ in 0..TRIES {
            // The domain can have vertices beside those that were chosen.
            let excess = control_points(&domain, degree).saturating_sub(most);
            if excess == 0 {
                break;
            }
            count = count.saturating_sub(excess.div_ceil(degree * degree).max(1));
            domain = sizes.domain(count, control)?;
        }
        Ok(domain)
    }

    /// The root mean square distance and the largest one, over the diagonal.
    fn relative(&self, fitted: &SplineFit) -> [f64; 2] {
        [fitted.rms, fitted.max].map(|distance| distance / self.diagonal)
    }

    /// The number of vertices of the surface in the hole of a singular vertex with this number of turns: [`SurfaceFitOptions::hole`] times
    /// the area of turns² triangles.
    fn inside(&self, turns: u32) -> usize {
        let vertices = self.points.len() as f64;
        let wanted = self.options.hole * f64::from(turns * turns) * vertices / self.triangles.max(1) as f64;
        (wanted as usize).clamp(LEAST_INSIDE, LEAST_INSIDE.max((MOST_INSIDE * vertices) as usize))
    }

    /// The number of coefficients of the filling of that hole.
    fn coefficients(&self, turns: u32) -> usize {
        Fill::blank((self.inside(turns) as f64 / POINTS) as usize).coefficients().len()
    }

    /// The hole around a singular vertex: the widest with no more vertices than wanted, so that triangles beyond it are small compared to
    /// their distance from the vertex.
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

/// The number of control points of splines of degree n over a domain: one for each vertex, n − 1 for each edge, (n − 1)(n − 2)/2 for each
/// triangle.
fn control_points(domain: &SurfaceDomain, degree: usize) -> usize {
    let mesh = &domain.coarse().mesh;
    let inner = degree.saturating_sub(1);
    mesh.n_vertices() + inner * mesh.n_edges() + inner * degree.saturating_sub(2) / 2 * mesh.n_faces()
}

/// One round of a fit: a domain and the spline fitted over it.
struct FitRound<'a> {
    setting: &'a FitSetting<'a>,
    domain: SurfaceDomain,
    space: Arc<SplineSpace>,
    /// The holes, not yet filled.
    holes: Vec<Hole>,
    places: Vec<Parameter>,
    fitted: SplineFit,
    /// The patches in which the spline folds.
    folds: Vec<usize>,
}

impl<'a> FitRound<'a> {
    /// Fits a spline over a domain, corrects the places, and looks for folds.
    fn new(
        domain: SurfaceDomain,
        setting: &'a FitSetting<'a>,
        fairness: f64,
        control: &Control,
    ) -> Result<FitRound<'a>> {
        let FitSetting { points, options, .. } = setting;
        let space = Arc::new(domain.space(options.degree, options.spread)?);
        let places = domain.places(points.len())?;
        let holes: Vec<Hole> = match &domain.infinity {
            Some(infinity) => vec![infinity.hole.clone().blank(setting.coefficients(TURNS))],
            None => domain
                .singular()
                .into_iter()
                .map(|v| setting.hole(&domain, &places, v))
                .collect::<Result<_>>()?,
        };
        let fit_options = FitOptions { fairness, threads: options.threads };
        let fitted =
            fit_filled(&space, &holes, PlacedPoints { places: &places, points }, &fit_options, control)?;
        let mut round = FitRound { setting, domain, space, holes, places, fitted, folds: Vec::new() };
        round.improve(&fit_options, control)?;
        round.folds = round.domain.folds(&round.fitted.spline, options.threads, control)?;
        Ok(round)
    }

    /// Alternates corrections of the places with fits until the spline is near enough or little is gained.
    fn improve(&mut self, options: &FitOptions, control: &Control) -> Result<()> {
        let setting = self.setting;
        for done in 1..=setting.options.corrections {
            self.correct(control)?;
            let placed = PlacedPoints { places: &self.places, points: setting.points };
            let next = fit_filled(&self.space, &self.holes, placed, options, control)?;
            let is_slow = next.rms > GAIN * self.fitted.rms;
            self.fitted = next;
            let is_near = miss(setting.relative(&self.fitted), setting.options.tolerance) <= 1.0;
            if done >= CORRECTIONS && (is_near || is_slow) {
                break;
            }
        }
        Ok(())
    }

    /// True if the filling of a hole alone is the surface at a place.
    fn is_covered(&self, at: Parameter) -> bool {
        self.fitted.spline.holes().iter().any(|hole| hole.is_core(at))
    }

    /// Moves each place towards the nearest point of the spline to its vertex, by one Gauss–Newton step.
    fn correct(&mut self, control: &Control) -> Result<()> {
        let found = self.fitted.spline.evaluate(&self.places, 1, self.setting.options.threads, control)?;
        for (k, &point) in self.setting.points.iter().enumerate() {
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

    /// For each vertex its triangle and its distance from the spline; none where the filling of a hole alone is the surface.
    fn triangles(&self, control: &Control) -> Result<Vec<VertexError>> {
        let found = self.fitted.spline.evaluate(&self.places, 0, self.setting.options.threads, control)?;
        let all = self.places.iter().zip(found.iter().zip(self.setting.points));
        let miss = |(&at, (found, point)): (&Parameter, (&SurfacePoint, &Vector))| {
            (!self.is_covered(at)).then(|| (at.patch as usize, distance(found.point, *point)))
        };
        Ok(all.map(miss).collect())
    }
}
