//! Least-squares fits of splines to points with given places.

use super::fairness::FairnessUnit;
use super::hole::Hole;
use super::patch::Parameter;
use super::space::SplineSpace;
use super::surface::Spline;
use super::system::FitSystem;
use crate::control::{Control, Stage};
use crate::error::{Error, Result, check_size};
use crate::geometry::vector::{Vector, distance};
use crate::parallel::Pool;
use std::sync::Arc;

/// Options of [`fit`].
#[derive(Debug, Clone, PartialEq)]
pub struct FitOptions {
    /// Weight of the fairness energy ∫ h² |D³F|² + 0.1 |D²F|², times the area of the domain, relative to the mean square distance; h is the
    /// mean side of a triangle. Splines of degree 1 have ∫ |DF|² instead. Default 1e-12: it matters where there are few points, and hardly
    /// changes a fit to many.
    pub fairness: f64,
    /// Number of threads; 0 (default) is one for each core. The result does not depend on it.
    pub threads: usize,
}

impl Default for FitOptions {
    fn default() -> Self {
        FitOptions { fairness: 1e-12, threads: 0 }
    }
}

/// Points in space, each with the place in the domain that it belongs to.
#[derive(Debug, Clone, Copy)]
pub struct PlacedPoints<'a> {
    /// The places.
    pub places: &'a [Parameter],
    /// The points, as many as places.
    pub points: &'a [Vector],
}

/// A spline fitted to points, with its distances from them.
#[derive(Debug, Clone)]
pub struct SplineFit {
    /// The spline.
    pub spline: Spline,
    /// Root mean square of the distances between points and their places on the spline.
    pub rms: f64,
    /// The largest such distance.
    pub max: f64,
}

/// The spline of a space that is the least-squares fit to points at given places.
///
/// # Errors
/// [`Error::Size`] where points and places differ in number; [`Error::Argument`] for a fairness that is negative, or points that are not
/// finite; [`Error::Factorisation`] where the points do not determine the spline (more of them, or a fairness above 0, would);
/// [`Error::Spline`] for places outside their patches; [`Error::Cancelled`].
pub fn fit(
    space: &Arc<SplineSpace>,
    places: &[Parameter],
    points: &[Vector],
    options: &FitOptions,
    control: &Control,
) -> Result<SplineFit> {
    fit_filled(space, &[], PlacedPoints { places, points }, options, control)
}

/// The spline with holes whose filled surface is the least-squares fit to points at given places. Control points and coefficients of the
/// fillings are found together; a hole has a filling if it comes with one, such as a [`Hole::blank`] of the wanted size.
///
/// # Errors
/// Those of [`fit`].
pub fn fit_filled(
    space: &Arc<SplineSpace>,
    holes: &[Hole],
    PlacedPoints { places, points }: PlacedPoints<'_>,
    options: &FitOptions,
    control: &Control,
) -> Result<SplineFit> {
    check_size("points", points.len(), places.len())?;
    let FitOptions { fairness, threads } = *options;
    if !(fairness >= 0.0 && fairness.is_finite()) {
        return Err(Error::argument("fairness", fairness, "0 or positive, and finite"));
    }
    if let Some(at) = points.iter().position(|p| !p.iter().all(|x| x.is_finite())) {
        return Err(Error::argument("point", at, "one with finite coordinates"));
    }
    let spline = Pool::new(threads)?.run(|| {
        control.step(Stage::Flow, 0.0)?;
        let mut system = FitSystem::new(space, holes, places, FairnessUnit::Domain, control)?;
        control.step(Stage::Flow, 0.6)?;
        let placed = system.placed(places, points)?;
        let unknowns = system.fit(&placed, fairness)?;
        system.spline(space, holes, &unknowns)
    })?;
    let found = spline.evaluate(places, 0, threads, &control.part(0.9, 1.0))?;
    let (mut sum, mut max) = (0.0, 0.0f64);
    for (found, point) in found.iter().zip(points) {
        let miss = distance(found.point, *point);
        (sum, max) = (sum + miss * miss, max.max(miss));
    }
    Ok(SplineFit { spline, rms: (sum / points.len().max(1) as f64).sqrt(), max })
}
