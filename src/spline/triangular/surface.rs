//! Spline surfaces: evaluation of points and derivatives.

use super::hole::Hole;
use super::index::{multi_indices, position};
use super::knots::omega;
use super::patch::Parameter;
use super::point::SurfacePoint;
use super::recurrence::Scratch;
use super::space::SplineSpace;
use crate::control::Control;
use crate::error::{Error, Result, check_size};
use crate::geometry::complex::doubled_area;
use crate::geometry::vector::Vector;
use crate::spline::batches::in_batches;
use std::sync::Arc;

/// Number of points that are evaluated between two checks for cancellation.
const BATCH: usize = 1 << 16;
/// The same of elements in another order, of which some take as long as a search for a nearest point.
const BATCH_ALONG: usize = 1 << 12;

/// Largest size of a coordinate, so that squares of distances stay finite.
pub(super) const LARGEST: f64 = 1e150;

/// A surface: a spline space with a control point in space for each basis function.
#[derive(Debug, Clone)]
pub struct Spline {
    space: Arc<SplineSpace>,
    control_points: Vec<Vector>,
    holes: Vec<Hole>,
}

impl Spline {
    /// A surface from its control points.
    ///
    /// # Errors
    /// [`Error::Size`]; [`Error::Spline`] for a control point that is not finite, or has a coordinate above 1e150 in size.
    pub fn new(space: Arc<SplineSpace>, control_points: Vec<Vector>) -> Result<Spline> {
        check_size("control points", control_points.len(), space.n_control_points())?;
        if let Some(at) = control_points.iter().position(|p| !p.iter().all(|x| x.abs() <= LARGEST)) {
            let message = "a coordinate is no finite number, or above 1e150".into();
            return Err(Error::Spline { what: "control point", index: at, message });
        }
        Ok(Spline { space, control_points, holes: Vec::new() })
    }

    /// The same surface with given holes and their fillings.
    pub fn with_holes(self, holes: Vec<Hole>) -> Spline {
        Spline { holes, ..self }
    }

    /// The holes around singular vertices, with their fillings.
    pub fn holes(&self) -> &[Hole] {
        &self.holes
    }

    /// True if the filling of a hole has a part in the surface at a place.
    pub fn is_in_hole(&self, at: Parameter) -> bool {
        self.holes.iter().any(|hole| hole.fill.is_some() && hole.contains(at))
    }

    /// The space of the spline.
    pub fn space(&self) -> &Arc<SplineSpace> {
        &self.space
    }

    /// The control points, one for each basis function.
    pub fn control_points(&self) -> &[Vector] {
        &self.control_points
    }

    /// The point at a place.
    ///
    /// # Errors
    /// [`Error::Spline`] for a patch that does not exist or a place outside its patch.
    pub fn point(&self, at: Parameter) -> Result<Vector> {
        self.at(at, 0, &mut Scratch::default()).map(|found| found.point)
    }

    /// The point at a place with first and second derivatives.
    ///
    /// # Errors
    /// Those of [`Spline::point`].
    pub fn surface_point(&self, at: Parameter) -> Result<SurfacePoint> {
        self.at(at, 2, &mut Scratch::default())
    }

    /// The points at many places, in parallel; derivatives up to `order` (0, 1, 2), zero beyond it.
    ///
    /// # Errors
    /// Those of [`Spline::point`], for the first such place; [`Error::Argument`] for another order; [`Error::Cancelled`].
    pub fn evaluate(
        &self,
        places: &[Parameter],
        order: usize,
        threads: usize,
        control: &Control,
    ) -> Result<Vec<SurfacePoint>> {
        if order > 2 {
            return Err(Error::argument("order of derivatives", order, "0, 1 or 2"));
        }
        let work = |scratch: &mut Scratch, place: &Parameter| self.at(*place, order, scratch);
        if places.is_sorted_by_key(|place| place.patch) {
            return in_batches(places, BATCH, threads, control, work);
        }
        // Places of one patch follow each other, so that what its basis functions need is at hand.
        let mut sorted: Vec<u32> = (0..places.len() as u32).collect();
        sorted.sort_by_key(|&i| (places[i as usize].patch, i));
        in_batches_along(&sorted, places, threads, control, work)
    }

    pub(super) fn at(&self, at: Parameter, order: usize, scratch: &mut Scratch) -> Result<SurfacePoint> {
        if let Some(hole) = self.holes.iter().find(|hole| hole.chart == at.patch) {
            return Ok(hole.in_chart(at)?.truncated(order));
        }
        let found = self.unfilled(at, order, scratch)?;
        let filled = self.holes.iter().find_map(|hole| hole.surface(at, &found));
        Ok(filled.map_or(found, |filled| filled.truncated(order)))
    }

    /// The spline without the fillings of its holes.
    pub(super) fn unfilled(
        &self,
        at: Parameter,
        order: usize,
        scratch: &mut Scratch,
    ) -> Result<SurfacePoint> {
        let mut sums = [[0.0; 3]; 6];
        let terms = [1, 3, 6][order];
        self.space.each(at, order, scratch, |control, jet| {
            let point = &self.control_points[control as usize];
            for (sum, weight) in sums[..terms].iter_mut().zip(jet) {
                (0..3).for_each(|x| sum[x] += weight * point[x]);
            }
        })?;
        let [point, x, y, xx, xy, yy] = sums;
        Ok(SurfacePoint { point, first: [x, y], second: [xx, xy, yy] })
    }

    /// The blossom of the polynomial that the surface is on Ω of a patch, at n points of the patch's chart, by the recurrence of B-patches
    /// \[Sei91\].
    ///
    /// # Errors
    /// [`Error::Size`] for another count of points; [`Error::Spline`] for a patch that does not exist.
    pub fn blossom(&self, patch: usize, at: &[[f64; 2]]) -> Result<Vector> {
        let degree = self.space.degree();
        check_size("arguments of the blossom", at.len(), degree)?;
        let Some(of) = self.space.patches().get(patch) else {
            return Err(Error::Spline { what: "patch", index: patch, message: "it does not exist".into() });
        };
        let mut points: Vec<Vector> = of.control.iter().map(|&c| self.control_points[c as usize]).collect();
        for (step, &u) in at.iter().enumerate() {
            let below = degree - step - 1;
            points = multi_indices(below)
                .map(|beta| {
                    let corners = [0, 1, 2].map(|k| of.knots[k][beta[k]]);
                    let whole = doubled_area([corners[0], corners[1], corners[2]]);
                    let mut sum = [0.0; 3];
                    for k in 0..3 {
                        let weight = doubled_area([u, corners[(k + 1) % 3], corners[(k + 2) % 3]]) / whole;
                        let mut raised = beta;
                        raised[k] += 1;
                        let part = points[position(raised)];
                        (0..3).for_each(|x| sum[x] += weight * part[x]);
                    }
                    sum
                })
                .collect();
        }
        Ok(points[0])
    }

    /// The corners of the convex polygon Ω of a patch, inside which the surface is one polynomial; empty for a patch that does not exist.
    pub fn omega(&self, patch: usize) -> Vec<[f64; 2]> {
        self.space.patches().get(patch).map_or_else(Vec::new, |patch| omega(&patch.knots))
    }
}

/// [`in_batches`] with the elements in another order, given by their numbers; results, and the first error, are as without it.
pub(super) fn in_batches_along<A: Sync, T: Send>(
    order: &[u32],
    all: &[A],
    threads: usize,
    control: &Control,
    work: impl Fn(&mut Scratch, &A) -> Result<T> + Sync,
) -> Result<Vec<T>> {
    let of = |scratch: &mut Scratch, i: &u32| work(scratch, &all[*i as usize]);
    let found = match in_batches(order, BATCH_ALONG, threads, control, of) {
        Ok(found) => found,
        Err(Error::Cancelled) => return Err(Error::Cancelled),
        // The first element in the given order that fails is named.
        Err(_) => return in_batches(all, BATCH_ALONG, threads, control, work),
    };
    let mut placed: Vec<Option<T>> = all.iter().map(|_| None).collect();
    order.iter().zip(found).for_each(|(&i, of)| placed[i as usize] = Some(of));
    Ok(placed.into_iter().flatten().collect())
}
