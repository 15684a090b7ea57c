//! Spline surfaces: points, derivatives, curvatures.

use super::hole::Hole;
use super::index::{multi_indices, position};
use super::knots::omega;
use super::patch::Parameter;
use super::recurrence::Scratch;
use super::space::SplineSpace;
use crate::control::{Control, Stage};
use crate::error::{Error, Result, check_size};
use crate::geometry::complex::doubled_area;
use crate::geometry::vector::{self, Vector};
use crate::parallel::{self, Pool};
use std::sync::Arc;

/// Points that are evaluated between two looks at whether the caller has cancelled.
const BATCH: usize = 1 << 16;

/// A surface: a spline space with a control point in space for each basis function.
#[derive(Debug, Clone)]
pub struct Spline {
    space: Arc<SplineSpace>,
    control_points: Vec<Vector>,
    holes: Vec<Hole>,
}

/// A point of a surface with its derivatives by the coordinates (x, y) of the chart.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfacePoint {
    /// The point.
    pub point: Vector,
    /// First derivatives: by x, by y.
    pub first: [Vector; 2],
    /// Second derivatives: xx, xy, yy.
    pub second: [Vector; 3],
}

impl Spline {
    /// A surface from its control points.
    ///
    /// # Errors
    /// [`Error::Size`]; [`Error::Spline`] for a control point that is not finite.
    pub fn new(space: Arc<SplineSpace>, control_points: Vec<Vector>) -> Result<Spline> {
        check_size("control points", control_points.len(), space.n_control_points())?;
        if let Some(at) = control_points.iter().position(|p| !p.iter().all(|x| x.is_finite())) {
            let message = "a coordinate is no finite number".into();
            return Err(Error::Spline { what: "control point", index: at, message });
        }
        Ok(Spline { space, control_points, holes: Vec::new() })
    }

    /// The same surface with the surroundings of singular vertices replaced by what fills them.
    pub fn with_holes(self, holes: Vec<Hole>) -> Spline {
        Spline { holes, ..self }
    }

    /// The holes around singular vertices, with what fills them.
    pub fn holes(&self) -> &[Hole] {
        &self.holes
    }

    /// The basis.
    pub fn space(&self) -> &Arc<SplineSpace> {
        &self.space
    }

    /// One per basis function.
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
        Pool::new(threads)?.run(|| {
            let mut found = Vec::with_capacity(places.len());
            for batch in places.chunks(BATCH) {
                control.step(Stage::Layout, found.len() as f64 / places.len() as f64)?;
                let mut points = vec![Ok(SurfacePoint::default()); batch.len()];
                parallel::fill_with(&mut points, Scratch::default, |scratch, i| {
                    self.at(batch[i], order, scratch)
                });
                found.extend(points.into_iter().collect::<Result<Vec<_>>>()?);
            }
            Ok(found)
        })
    }

    fn at(&self, at: Parameter, order: usize, scratch: &mut Scratch) -> Result<SurfacePoint> {
        let mut sums = [[0.0; 3]; 6];
        let terms = [1, 3, 6][order];
        self.space.each(at, order, scratch, |control, jet| {
            let point = &self.control_points[control as usize];
            for (sum, weight) in sums[..terms].iter_mut().zip(jet) {
                (0..3).for_each(|x| sum[x] += weight * point[x]);
            }
        })?;
        let [point, x, y, xx, xy, yy] = sums;
        let found = SurfacePoint { point, first: [x, y], second: [xx, xy, yy] };
        let filled = self.holes.iter().find_map(|hole| hole.surface(at, &found));
        Ok(filled.map_or(found, |filled| filled.cut(order)))
    }

    /// The polar form of the polynomial that the surface is on Ω of a patch, at n points of its chart: the blossom, by the recurrence
    /// of B-patches \[Sei91\].
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

    /// Corners of the convex polygon Ω of a patch, inside which the surface is one polynomial; empty for a patch that does not exist.
    pub fn omega(&self, patch: usize) -> Vec<[f64; 2]> {
        self.space.patches().get(patch).map_or_else(Vec::new, |patch| omega(&patch.knots))
    }
}

impl Default for SurfacePoint {
    fn default() -> Self {
        SurfacePoint { point: [0.0; 3], first: [[0.0; 3]; 2], second: [[0.0; 3]; 3] }
    }
}

impl SurfacePoint {
    /// Derivatives beyond this order set to 0.
    fn cut(self, order: usize) -> SurfacePoint {
        let zero = SurfacePoint::default();
        let first = if order < 1 { zero.first } else { self.first };
        SurfacePoint { first, second: if order < 2 { zero.second } else { self.second }, ..self }
    }

    /// The unit normal, to the side from which the chart is seen counterclockwise; none where the first derivatives are parallel.
    pub fn normal(&self) -> Option<Vector> {
        let across = vector::cross(self.first[0], self.first[1]);
        let length = vector::norm(across);
        (length > 0.0).then(|| across.map(|x| x / length))
    }

    /// The principal curvatures, the larger one first, positive where the surface bends towards its normal; none without a normal.
    pub fn principal_curvatures(&self) -> Option<[f64; 2]> {
        let normal = self.normal()?;
        let [x, y] = self.first;
        let [e, f, g] = [vector::dot(x, x), vector::dot(x, y), vector::dot(y, y)];
        let [l, m, n] = self.second.map(|d| vector::dot(d, normal));
        let det = e * g - f * f;
        let mean = 0.5 * (e * n - 2.0 * f * m + g * l) / det;
        let gauss = (l * n - m * m) / det;
        let half = (mean * mean - gauss).max(0.0).sqrt();
        let curvatures = [mean + half, mean - half];
        curvatures.iter().all(|k| k.is_finite()).then_some(curvatures)
    }
}
