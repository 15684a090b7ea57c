//! Splines over a whole surface, fitted to its vertices.

use super::coarse::Coarse;
use super::domain::SurfaceDomain;
use super::flat::{FLAT, Flat};
use super::sample::spread_vertices;
use crate::control::Control;
use crate::error::{Error, Result};
use crate::geometry::complex::Complex;
use crate::geometry::vector::{Vector, distance, dot, sub};
use crate::mesh::{Mesh, PerVertex, VertexId};
use crate::metric::Surface;
use crate::spline::{FitOptions, Fitted, Parameter, SPREAD, Spline, fit};
use std::sync::Arc;

/// Sizes of triangles change by at most this factor from round to round, and stay within [`SIZES`].
const CHANGE: [f64; 2] = [0.6, 1.4];
/// Least and largest size of a triangle over the one of an even distribution.
const SIZES: [f64; 2] = [0.1, 3.0];
/// Rounds in which a size becomes the mean of itself and its neighbours'.
const SMOOTHINGS: usize = 5;
/// Longest step of a parameter in one correction, over the longest side of its triangle.
const LONGEST_STEP: f64 = 0.25;

/// What [`fit_surface`] can be asked.
#[derive(Debug, Clone, PartialEq)]
pub struct SurfaceFitOptions {
    /// 1 to 5. Default 3.
    pub degree: usize,
    /// Number of control points at most; default a quarter of the vertices.
    pub control_points: Option<usize>,
    /// Largest distance of a vertex from the spline that is asked for, over the diagonal of the bounding box. Default 0.01.
    pub tolerance: f64,
    /// Times that the triangles' sizes are adapted to the errors. Default 6.
    pub rounds: usize,
    /// Times that the places of the vertices are moved to where the spline is nearest. Default 2.
    pub corrections: usize,
    /// [`FitOptions::fairness`]. Default 1e-10.
    pub fairness: f64,
    /// [`crate::spline::KnotOptions::spread`].
    pub spread: f64,
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
            corrections: 2,
            fairness: 1e-10,
            spread: SPREAD,
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
    /// Root of the mean of the squared distances of the vertices from their places on the spline, over the diagonal of the bounding box.
    pub rms: f64,
    /// The largest such distance, over the same.
    pub max: f64,
    /// Rounds that were made.
    pub rounds: usize,
}

/// A spline fitted to the vertices of a surface in space, on a flat metric of it: triangles of the domain about as long on the surface, and smaller where
/// the fit is worse. The best of all rounds; they end early where the tolerance is met.
///
/// # Errors
/// [`Error::Argument`] for a surface without positions, a metric that is not flat or lives on a double; [`Error::Spline`]; [`Error::Factorisation`];
/// [`Error::Cancelled`].
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
    let curvature = flat.curvature()?;
    let always: Vec<VertexId> = mesh.vertices().filter(|&v| curvature[v].abs() > FLAT).collect();
    let diagonal = diagonal(points);
    let most = options.control_points.unwrap_or(mesh.n_vertices() / 4);
    // Of a closed surface with many triangles there are n² control points per two of these, and so per vertex.
    let count = most / (options.degree * options.degree).max(1);
    let mut sizes = PerVertex::filled(mesh.n_vertices(), 1.0);
    let mut best: Option<SurfaceFit> = None;
    for round in 0..options.rounds.max(1) {
        let chosen = spread_vertices((mesh, surface.lengths()), &sizes, &always, count, control)?;
        let keep = PerVertex::from_fn(flat.mesh.n_vertices(), |v: VertexId| {
            v.index() < mesh.n_vertices() && chosen[v]
        });
        let domain = SurfaceDomain::new(Coarse::new(flat, &keep, control)?)?;
        let space = Arc::new(domain.space(options.degree, options.spread)?);
        let mut found = Round { domain, places: Vec::new(), misses: Vec::new(), fitted: None };
        let places = found.domain.coarse().places.iter().take(mesh.n_vertices());
        found.places = places.map(|&p| found.domain.parameter(p)).collect();
        let fit_options = FitOptions { fairness: options.fairness, threads: options.threads };
        for correction in 0..=options.corrections {
            if correction > 0 {
                found.correct(points, options.threads, control)?;
            }
            found.fitted = Some(fit(&space, &found.places, points, &fit_options, control)?);
        }
        found.fill_holes(points, options.threads, control)?;
        found.measure(points, options.threads, control)?;
        adapt(mesh, &found, options.degree, &mut sizes);
        let Some(Fitted { spline, .. }) = found.fitted else { continue };
        let squares: f64 = found.misses.iter().map(|miss| miss * miss).sum();
        let rms = (squares / points.len().max(1) as f64).sqrt() / diagonal;
        let max = found.misses.iter().copied().fold(0.0, f64::max) / diagonal;
        if best.as_ref().is_none_or(|best| max < best.max) {
            let rounds = round + 1;
            best = Some(SurfaceFit { spline, domain: found.domain, places: found.places, rms, max, rounds });
        }
    }
    best.ok_or_else(|| Error::argument("rounds", options.rounds, "1 or more"))
}

fn diagonal(points: &[Vector]) -> f64 {
    let bound = |pick: fn(f64, f64) -> f64| {
        points.iter().copied().reduce(|a, b| [0, 1, 2].map(|k| pick(a[k], b[k]))).unwrap_or_default()
    };
    distance(bound(f64::min), bound(f64::max))
}

/// A fit with what it misses.
struct Round {
    domain: SurfaceDomain,
    places: Vec<Parameter>,
    /// Per vertex its distance from its place.
    misses: Vec<f64>,
    fitted: Option<Fitted>,
}

impl Round {
    /// Move every place to where the spline is nearest to its vertex, by one step of Gauss and Newton.
    fn correct(&mut self, points: &[Vector], threads: usize, control: &Control) -> Result<()> {
        let Some(fitted) = &self.fitted else { return Ok(()) };
        let found = fitted.spline.evaluate(&self.places, 1, threads, control)?;
        for ((place, at), point) in self.places.iter_mut().zip(found).zip(points) {
            let [x, y] = at.first;
            let miss = sub(*point, at.point);
            let (a, b, c) = (dot(x, x), dot(x, y), dot(y, y));
            let (p, q) = (dot(x, miss), dot(y, miss));
            let det = a * c - b * b;
            let step: Complex = [(c * p - b * q) / det, (a * q - b * p) / det];
            let length = f64::hypot(step[0], step[1]);
            if length.is_finite() && length > 0.0 {
                let shorter = f64::min(1.0, LONGEST_STEP / length);
                *place = self.domain.walk(*place, step.map(|x| shorter * x));
            }
        }
        Ok(())
    }

    /// Fill the surroundings of the singular vertices, from the spline around them and the vertices in them.
    fn fill_holes(&mut self, points: &[Vector], threads: usize, control: &Control) -> Result<()> {
        let Some(fitted) = &mut self.fitted else { return Ok(()) };
        let space = fitted.spline.space().clone();
        let mut holes = Vec::new();
        for v in self.domain.singular() {
            let mut hole = self.domain.hole(v)?;
            let rings = hole.rings(&space);
            let found = fitted.spline.evaluate(&rings, 0, threads, control)?;
            let places = [&rings[..], &self.places].concat();
            let points = found.iter().map(|at| at.point).chain(points.iter().copied());
            hole.fill(&space, &places, &points.collect::<Vec<_>>())?;
            holes.push(hole);
        }
        fitted.spline = fitted.spline.clone().with_holes(holes);
        Ok(())
    }

    fn measure(&mut self, points: &[Vector], threads: usize, control: &Control) -> Result<()> {
        let Some(fitted) = &self.fitted else { return Ok(()) };
        let found = fitted.spline.evaluate(&self.places, 0, threads, control)?;
        self.misses = found.iter().zip(points).map(|(at, point)| distance(at.point, *point)).collect();
        Ok(())
    }
}

/// Sizes for triangles whose errors would be alike: a polynomial of degree n misses by the power n + 1 of the size.
fn adapt(mesh: &Mesh, found: &Round, degree: usize, sizes: &mut PerVertex<f64>) {
    let mut worst = vec![0.0f64; found.domain.coarse().mesh.n_faces()];
    for (place, &miss) in found.places.iter().zip(&found.misses) {
        let of = &mut worst[place.patch as usize];
        *of = of.max(miss);
    }
    let mut sorted = worst.clone();
    sorted.sort_by(f64::total_cmp);
    let middle = sorted[sorted.len() / 2].max(f64::MIN_POSITIVE);
    for v in mesh.vertices() {
        let error = worst[found.places[v.index()].patch as usize].max(f64::MIN_POSITIVE);
        let change = (middle / error).powf(1.0 / (degree + 1) as f64).clamp(CHANGE[0], CHANGE[1]);
        sizes[v] = (sizes[v] * change).clamp(SIZES[0], SIZES[1]);
    }
    for _ in 0..SMOOTHINGS {
        let before = sizes.clone();
        for v in mesh.vertices() {
            let (sum, n) = mesh.outgoing(v).fold((0.0, 0.0), |(s, n), h| (s + before[mesh.tip(h)], n + 1.0));
            sizes[v] = 0.5 * (before[v] + sum / n);
        }
    }
}
