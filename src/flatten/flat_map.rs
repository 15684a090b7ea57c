//! The flat map of a surface, from its start to its report.

use super::descent::{MapDescent, MovingMap};
use super::descent_matrix::DescentMatrix;
use super::distortion::Distortion;
use super::energy::EnergyShares;
use super::options::FlattenOptions;
use super::plane_moves::PlaneMoves;
use super::plane_start::{PlaneStart, check_surface, plane_start};
use super::report::{FlattenReport, FlattenStop};
use super::rest_triangle::{RestTriangle, rest_triangles};
use super::rim::BorderRim;
use super::seam_ties::SeamTies;
use super::terms::Terms;
use super::upright::is_upright;
use crate::control::Control;
use crate::error::{Error, Result};
use crate::geometry::complex::{add, conj, mul, sub, unit as unit_vector};
use crate::geometry::cover_share::covered_again;
use crate::mesh::VertexId;
use crate::metric::Surface;
use crate::parallel;
use std::time::Instant;

/// A map of a surface to the plane that is linear on its triangles and turns none over, by exact arithmetic on these numbers.
#[derive(Debug, Clone, PartialEq)]
pub struct Flattening {
    /// Per vertex its place in the plane (V entries), in units of the surface's lengths.
    pub points: Vec<[f64; 2]>,
    /// How the map was found, and how much it distorts.
    pub report: FlattenReport,
}

/// The part of the progress that the start fills.
const OF_START: f64 = 0.3;
/// The most by which a condition is missed, in the root of the surface's area.
const MISFIT: f64 = 1e-12;
/// The part of what was missed before to which a descent is exact that is followed by others.
const NEXT_TOLERANCE: f64 = 0.1;
/// The most descents, each with other multipliers of the conditions.
const MOST_ROUNDS: usize = 100;

/// The map to the plane of least distortion of an open surface of genus 0, with a free boundary: Newton's method on the energy of the
/// options [SS15; SGK19], from the conformal layout that keeps the lengths of the outer loop.
///
/// A descent that does not converge leaves the best map found; [`FlattenReport::stop`] says why. Energies are not convex: other starts can
/// lead to other minima, which differ little.
///
/// # Errors
/// [`Error::Argument`] for options outside their ranges and for a surface that is not flat inside its triangles; [`Error::Layout`] for a surface
/// that is closed, of higher genus or of several components, for a triangle without area, and where no map to start from is found;
/// [`Error::TriangleInequality`]; [`Error::Factorisation`]; [`Error::Cancelled`].
pub fn flatten(surface: &Surface, options: &FlattenOptions, control: &Control) -> Result<Flattening> {
    let shares = options.shares()?;
    check_surface(surface)?;
    options.check_parts(surface.mesh())?;
    parallel::within(options.threads, || {
        let begun = Instant::now();
        // A power of two near the root of the area.
        let unit = surface.area()?.sqrt().log2().round().exp2();
        let rest = rest_triangles(surface, unit, &options.weights)?;
        let rim = BorderRim::new(surface.mesh());
        let start = plane_start(surface, options.injective.then_some(&rim), &control.part(0.0, OF_START))?;
        let seconds = begun.elapsed().as_secs_f64();
        let flat = Flattener { surface, rest, unit, shares, options, rim, ties: None };
        let found = flat.descended(start, &control.part(OF_START, 1.0))?;
        control.finish();
        let report =
            FlattenReport { seconds: [seconds, begun.elapsed().as_secs_f64() - seconds], ..found.report };
        Ok(Flattening { report, ..found })
    })
}

/// What a descent needs.
pub(super) struct Flattener<'a> {
    pub surface: &'a Surface,
    pub rest: Vec<RestTriangle>,
    pub unit: f64,
    pub shares: EnergyShares,
    pub options: &'a FlattenOptions,
    pub rim: BorderRim,
    /// Of points along seams; none where the surface is open itself.
    pub ties: Option<&'a SeamTies>,
}

impl Flattener<'_> {
    /// The map of least energy that steps from a start lead to.
    ///
    /// # Errors
    /// [`Error::Layout`] where a triangle loses its area to rounding; [`Error::Factorisation`]; [`Error::Cancelled`].
    pub fn descended(&self, start: PlaneStart, control: &Control) -> Result<Flattening> {
        let mesh = self.surface.mesh();
        let corners = mesh.triangles();
        let points = self.scaled(&corners, start.points)?;
        let before = Distortion::of(self.surface, &self.rest, &points, self.unit);
        let points = self.beside_pins(points);
        if !is_upright(&corners, &points) {
            return Err(out_of_range());
        }
        let terms = Terms::new(self.surface, self.options, self.unit, control)?;
        control.check()?;
        let mut system = DescentMatrix::new(mesh, terms.standing_pairs(), self.ties, control)?;
        let map = PlaneMoves { corners: &corners, rest: &self.rest, shares: self.shares, terms };
        let mut descent = MapDescent::new(map, points);
        let stop = self.settled(&mut descent, &mut system, control)?;
        descent.map.look_at(&descent.points, &mut system, control)?;
        descent.map.assemble(&mut system, &descent.points, true);
        let gradient = system.steepest() * diameter(&descent.points);
        let missed = descent.map.terms.misfit(&descent.points);
        let misfit = missed / diameter(&descent.points);
        let MapDescent { points, energies, unclamped, decrement, .. } = descent;
        let (points, after) = self.placed(&corners, points, missed <= MISFIT)?;
        let report = FlattenReport {
            start: start.way,
            stop,
            energies,
            unclamped,
            decrement,
            gradient,
            before,
            after,
            overlap: self.overlap(&points),
            one_to_one: self.rim.is_one_to_one(&corners, &points),
            misfit,
            seconds: [0.0; 2],
        };
        Ok(Flattening { points, report })
    }

    /// Descends, with conditions again and again, each time with multipliers of the conditions that let them be met better.
    fn settled(
        &self,
        descent: &mut MapDescent<PlaneMoves<'_>>,
        system: &mut DescentMatrix<'_>,
        control: &Control,
    ) -> Result<FlattenStop> {
        let FlattenOptions { tolerance, max_iterations, .. } = *self.options;
        if !descent.map.terms.has_conditions() {
            return descent.run(system, tolerance, max_iterations, control);
        }
        let mut missed = descent.map.terms.misfit(&descent.points);
        for _ in 0..MOST_ROUNDS {
            let made = descent.energies.len().saturating_sub(1);
            let exact = f64::max(tolerance, NEXT_TOLERANCE * missed.min(1.0));
            let stop = descent.run(system, exact, max_iterations - made, control)?;
            let now = descent.map.terms.misfit(&descent.points);
            let is_met = now <= MISFIT;
            if stop == FlattenStop::MaxIterations || (is_met && exact == tolerance) {
                return Ok(stop);
            }
            descent.map.terms.raise(&descent.points, missed);
            missed = now;
        }
        Ok(FlattenStop::Unmet)
    }

    /// The map turned and shifted so that pinned vertices are near their places.
    fn beside_pins(&self, mut points: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
        let pins = &self.options.pins;
        if pins.is_empty() {
            return points;
        }
        let mean = |of: &dyn Fn(&(VertexId, [f64; 2])) -> [f64; 2]| {
            pins.iter().map(of).fold([0.0; 2], add).map(|x| x / pins.len() as f64)
        };
        let wanted = |pin: &(VertexId, [f64; 2])| pin.1.map(|x| x / self.unit);
        let (from, to) = (mean(&|pin| points[pin.0.index()]), mean(&wanted));
        let turn = mean(&|pin| mul(sub(wanted(pin), to), conj(sub(points[pin.0.index()], from))));
        let turn = if turn == [0.0; 2] { [1.0, 0.0] } else { unit_vector(turn) };
        points.iter_mut().for_each(|p| *p = add(to, mul(turn, sub(*p, from))));
        points
    }

    /// The map in units of the surface's lengths, pinned vertices at their places if they came there, and its distortion.
    fn placed(
        &self,
        corners: &[[u32; 3]],
        mut points: Vec<[f64; 2]>,
        is_met: bool,
    ) -> Result<(Vec<[f64; 2]>, Distortion)> {
        if self.shares.is_of_shape_alone() && self.options.pins.is_empty() {
            let scale = Distortion::of(self.surface, &self.rest, &points, self.unit).area.sqrt().recip();
            points = self.times(corners, points, scale)?;
        }
        // A power of two changes no digits.
        points.as_flattened_mut().iter_mut().for_each(|x| *x *= self.unit);
        if is_met {
            self.options.pins.iter().for_each(|&(v, at)| points[v.index()] = at);
        }
        if !is_upright(corners, &points) {
            return Err(out_of_range());
        }
        let in_units: Vec<[f64; 2]> = points.iter().map(|p| p.map(|x| x / self.unit)).collect();
        let after = Distortion::of(self.surface, &self.rest, &in_units, self.unit);
        Ok((points, after))
    }

    /// The map at the size at which its symmetric Dirichlet energy is least.
    fn scaled(&self, corners: &[[u32; 3]], points: Vec<[f64; 2]>) -> Result<Vec<[f64; 2]>> {
        let mut parts = vec![[0.0; 2]; corners.len()];
        parallel::fill(&mut parts, |f| {
            let [square, det] = self.rest[f].square_and_det(corners[f].map(|v| points[v as usize]));
            [square, square / (det * det)].map(|x| self.rest[f].share * x)
        });
        let [direct, inverse] =
            parts.into_iter().fold([0.0; 2], |sum, part| [0, 1].map(|k| sum[k] + part[k]));
        self.times(corners, points, (inverse / direct).powf(0.25))
    }

    /// The map times a factor.
    fn times(&self, corners: &[[u32; 3]], mut points: Vec<[f64; 2]>, factor: f64) -> Result<Vec<[f64; 2]>> {
        points.as_flattened_mut().iter_mut().for_each(|x| *x *= factor);
        let is_finite = points.as_flattened().iter().all(|x| x.is_finite());
        if is_finite && is_upright(corners, &points) { Ok(points) } else { Err(out_of_range()) }
    }

    fn overlap(&self, points: &[[f64; 2]]) -> f64 {
        let mesh = self.surface.mesh();
        let rims = mesh.halfedges().filter(|&h| mesh.is_outside(h.twin()));
        let sides: Vec<_> = rims.map(|h| [mesh.origin(h), mesh.tip(h)].map(|v| points[v.index()])).collect();
        covered_again(&sides)
    }
}

pub(super) fn out_of_range() -> Error {
    let why = "a triangle loses its area to rounding: parts of the surface are too small for doubles beside the rest; weld or remesh them";
    Error::Layout(why.into())
}

/// The diagonal of the bounding box.
fn diameter(points: &[[f64; 2]]) -> f64 {
    let span = |c: usize| {
        let all = || points.iter().map(|p| p[c]);
        all().fold(f64::NEG_INFINITY, f64::max) - all().fold(f64::INFINITY, f64::min)
    };
    span(0).hypot(span(1))
}
