//! Splines over a whole surface, fitted to its vertices in rounds: domain, fit, corrected places, adapted sizes.

use super::areas::{area_share, vertex_areas};
use super::domain::SurfaceDomain;
use super::flat::FlatMetric;
use super::round::FitRound;
use super::setting::{FitSetting, SurfaceFitOptions, cost, miss};
use super::sizes::TriangleSizes;
use crate::control::Control;
use crate::error::{Error, Result};
use crate::mesh::VertexId;
use crate::metric::Surface;
use crate::spline::{Parameter, Spline};

/// Factors of the fairness weight after a round that misses the tolerance, and after one that meets it with folds.
const LESS_FAIR: f64 = 0.3;
const FAIRER: f64 = 100.0;
/// Distance over the tolerance from which on a second round is the last.
const HOPELESS: f64 = 2.0;
/// Domains that are refused, each with its own order of vertices, before one is taken whose basis functions do not add up to 1 everywhere.
const TRIES: usize = 3;
/// Most control points that are tried beyond a quarter of the number of vertices: fits with more take long.
const MOST_TRIED: usize = 4000;

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
    /// The weight of the fairness with which this spline was fitted.
    pub fairness: f64,
    /// The distance of each vertex from its place on the spline, over the diagonal.
    pub distances: Vec<f64>,
}

impl SurfaceFit {
    /// The share of the surface that lies in patches in which the spline folds: of the area around the vertices whose places are in them.
    /// `surface`: that which was fitted.
    pub fn folded_share(&self, surface: &Surface) -> f64 {
        area_share(&vertex_areas(surface.mesh(), surface.lengths()), |v| self.is_folded(v))
    }

    /// True if the place of a vertex lies in a patch in which the spline folds.
    pub(super) fn is_folded(&self, vertex: usize) -> bool {
        self.folds.binary_search(&(self.places[vertex].patch as usize)).is_ok()
    }
}

/// Fits a spline to the vertices of a surface in space, over a flat metric of it. The triangles of the domain are about equally long on the
/// surface in the first round, and become smaller where the fit is worse. Returned is the best of all rounds; they end early once the
/// tolerance is met and the spline does not fold, and after the second where the tolerance is far, or a round gains nothing.
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
    let setting = FitSetting::new(mesh, points, options);
    let mut sizes = TriangleSizes::new(
        surface,
        flat,
        setting.triangles,
        |turns| setting.inside(turns),
        &control.still(),
    )?;
    let singular = flat.singular()?;
    let (mut best, mut failure): (Option<SurfaceFit>, _) = (None, None);
    let (mut factor, mut rounds, mut refused) = (1.0, 0, 0);
    while rounds < options.rounds.max(1) {
        let control = &control.attempt(rounds);
        let domain = setting.domain(&sizes, flat, &control.part(0.0, 0.1))?;
        let found = match FitRound::new(domain, &setting, factor, refused < TRIES, &control.part(0.1, 1.0)) {
            Ok(found) => found,
            // An earlier round has given a spline, which is kept; or the vertices of another round make a better domain.
            Err(Error::Spline { .. } | Error::Factorisation { .. }) if best.is_some() => break,
            Err(error @ (Error::Spline { .. } | Error::Factorisation { .. })) if refused < TRIES => {
                (failure, refused) = (failure.or(Some(error)), refused + 1);
                sizes.reorder();
                continue;
            }
            Err(Error::Cancelled) => return Err(Error::Cancelled),
            Err(error) => return Err(failure.unwrap_or(error)),
        };
        rounds += 1;
        sizes.adapt(mesh, &found.triangles(), found.spline.space().patches().len(), options.degree);
        let [rms, max] = found.measures;
        let FitRound { domain, places, spline, distances, fairness, folds, .. } = found;
        let singular = singular.clone();
        let next =
            SurfaceFit { spline, domain, places, singular, rms, max, folds, rounds, fairness, distances };
        let (miss, is_whole) = (next.miss(options.tolerance), next.folds.is_empty());
        let is_better =
            best.as_ref().is_none_or(|best| next.cost(options.tolerance) < best.cost(options.tolerance));
        // A fit that is far from the tolerance after two rounds, or becomes no better, would miss it after all rounds.
        let is_hopeless = rounds > 1 && (miss > HOPELESS || !is_better);
        if is_better {
            best = Some(next);
        }
        if miss <= 1.0 && is_whole || is_hopeless {
            break;
        }
        factor *= if miss > 1.0 { LESS_FAIR } else { FAIRER };
    }
    best.ok_or_else(|| failure.unwrap_or_else(|| Error::argument("rounds", options.rounds, "1 or more")))
}

/// [`fit_surface`] over several flat metrics in turn, until a fit holds its tolerance without folds; the best of them, with the number of
/// its metric. Where no number of control points is given and no spline with a quarter as many as vertices holds, twice and four times as many
/// are tried over the best metric, up to 4000.
///
/// # Errors
/// Those of [`fit_surface`], if it fails over every metric; [`Error::Argument`] for no metric.
pub fn fit_surface_over(
    surface: &Surface,
    metrics: &[FlatMetric],
    options: &SurfaceFitOptions,
    control: &Control,
) -> Result<(SurfaceFit, usize)> {
    let (mut best, mut failure): (Option<(SurfaceFit, usize)>, _) = (None, None);
    let all = counts(surface.mesh().n_vertices(), options.control_points);
    for (i, &count) in all.iter().enumerate() {
        let of_count = control.attempt(i);
        let options = SurfaceFitOptions { control_points: Some(count), ..options.clone() };
        let chosen = best.as_ref().map(|&(_, k)| k);
        for (k, flat) in metrics.iter().enumerate().filter(|&(k, _)| chosen.is_none_or(|best| best == k)) {
            let tried = if chosen.is_some() { of_count.clone() } else { of_count.attempt(k) };
            match fit_surface(surface, flat, &options, &tried) {
                Ok(fit) if fit.holds(options.tolerance) => return Ok((fit, k)),
                Ok(fit) => {
                    let cost = fit.cost(options.tolerance);
                    if best.as_ref().is_none_or(|(best, _)| cost < best.cost(options.tolerance)) {
                        best = Some((fit, k));
                    }
                }
                Err(Error::Cancelled) => return Err(Error::Cancelled),
                Err(error) => failure = failure.or(Some(error)),
            }
        }
    }
    let none = || Error::argument("flat metrics", 0, "one or more");
    best.ok_or_else(|| failure.unwrap_or_else(none))
}

/// The numbers of control points with which fits are tried, of which later ones only if no earlier one holds: the given one, or from a
/// quarter of the vertices on twice as many each time, up to the number of vertices.
fn counts(vertices: usize, given: Option<usize>) -> Vec<usize> {
    let Some(given) = given else {
        let quarter = vertices / 4;
        let more = [2 * quarter, vertices].into_iter().filter(|&n| n <= MOST_TRIED);
        return std::iter::once(quarter).chain(more).collect();
    };
    vec![given]
}

impl SurfaceFit {
    /// True if the tolerance is met, and no patch folds.
    pub fn holds(&self, tolerance: f64) -> bool {
        self.miss(tolerance) <= 1.0 && self.folds.is_empty()
    }

    /// The distance over the tolerance: at most 1 if the tolerance is met.
    fn miss(&self, tolerance: f64) -> f64 {
        miss([self.rms, self.max], tolerance)
    }

    /// [`cost`] of this fit.
    fn cost(&self, tolerance: f64) -> (f64, usize, f64) {
        cost([self.rms, self.max], &self.folds, tolerance)
    }
}
