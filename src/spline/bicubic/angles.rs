//! Angles between the normals of neighbouring patches.

use super::sample::{QuadPlace, within};
use super::surface::{BicubicPatch, BicubicSurface};
use crate::error::Result;
use crate::geometry::vector::{Vector, cross, distance, dot, norm};
use crate::spline::triangular::SurfacePoint;

/// Angles, in radians, between the normals on both sides of curves that patches have in common.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NormalAngles {
    /// The largest angle.
    pub largest: f64,
    /// The mean over the places of measurement.
    pub mean: f64,
    /// The largest angle between the spline's own normals at the same places; at creases it is not 0.
    pub of_spline: f64,
}

/// The measured distances and angles on one curve.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct CurveFigures {
    /// Largest distance of the curve from the spline.
    pub miss: f64,
    /// Largest angle between the normals of the patches minus the angle between those of the spline.
    pub excess: f64,
    largest: f64,
    of_spline: f64,
    sum: f64,
    count: usize,
}

impl NormalAngles {
    pub(super) fn of(curves: &[CurveFigures]) -> NormalAngles {
        let largest = |of: fn(&CurveFigures) -> f64| curves.iter().map(of).fold(0.0, f64::max);
        let count: usize = curves.iter().map(|curve| curve.count).sum();
        let sum: f64 = curves.iter().map(|curve| curve.sum).sum();
        NormalAngles {
            largest: largest(|curve| curve.largest),
            mean: sum / count.max(1) as f64,
            of_spline: largest(|curve| curve.of_spline),
        }
    }
}

/// The figures of some curves. `uses` has for each curve the sides of quadrilaterals that it is; `evaluate` gives the spline with its first
/// derivatives.
pub(super) fn measure(
    surface: &BicubicSurface,
    curves: &[usize],
    uses: &[Vec<(usize, usize)>],
    evaluate: impl Fn(&[QuadPlace]) -> Result<Vec<SurfacePoint>>,
) -> Result<Vec<CurveFigures>> {
    let places = |&curve: &usize| {
        let spans = surface.curves[curve].control.len() - 3;
        let both = uses[curve].iter().map(move |&(q, k)| {
            let reversed = surface.patches[q].sides[k].reversed;
            within(spans)
                .map(move |x| (q, BicubicPatch::on_side(k, if reversed { 1.0 - x } else { x })))
                .collect::<Vec<QuadPlace>>()
        });
        both.collect::<Vec<_>>()
    };
    let at: Vec<Vec<Vec<QuadPlace>>> = curves.iter().map(places).collect();
    let all: Vec<QuadPlace> = at.iter().flatten().flatten().copied().collect();
    let found = evaluate(&all)?;
    let mut rest = &found[..];
    let mut figures = Vec::with_capacity(curves.len());
    for uses in &at {
        let mut of = CurveFigures::default();
        let count = uses[0].len();
        let (here, later) = rest.split_at(count * uses.len());
        rest = later;
        for i in 0..count {
            let pairs = uses.iter().enumerate().map(|(side, places)| {
                let (q, place) = places[i];
                (surface.patches[q].evaluate(place), &here[side * count + i])
            });
            of.add(&pairs.collect::<Vec<_>>());
        }
        figures.push(of);
    }
    Ok(figures)
}

impl CurveFigures {
    /// Includes a place: for each patch there the patch's point and the spline's.
    fn add(&mut self, sides: &[(SurfacePoint, &SurfacePoint)]) {
        for (patch, spline) in sides {
            self.miss = self.miss.max(distance(patch.point, spline.point));
        }
        let [(a, spline_a), (b, spline_b)] = sides else { return };
        let (Some(between), Some(of_spline)) = (angle(a, b), angle(spline_a, spline_b)) else { return };
        self.largest = self.largest.max(between);
        self.of_spline = self.of_spline.max(of_spline);
        self.excess = self.excess.max(between - of_spline);
        self.sum += between;
        self.count += 1;
    }
}

/// The angle between two normals; none if one of them does not exist.
fn angle(a: &SurfacePoint, b: &SurfacePoint) -> Option<f64> {
    let [m, n]: [Vector; 2] = [a.normal()?, b.normal()?];
    Some(norm(cross(m, n)).atan2(dot(m, n)))
}
