//! Options and results of the conversion of a spline to bicubic patches.

use super::angles::NormalAngles;
use super::surface::BicubicSurface;

/// Options of [`to_bicubic`](crate::spline::Spline::to_bicubic).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BicubicOptions {
    /// Largest distance of the patches from the spline, over the diagonal of its bounding box: 1e-10 to 1. Default 1e-4.
    pub tolerance: f64,
    /// Largest angle, in radians, between the normals of neighbouring patches, minus that between the spline's own normals there. Default:
    /// half a degree.
    pub angle: f64,
    /// Most control points of all patches together; where more are needed the conversion stops. Default: no limit.
    pub control_points: Option<usize>,
    /// True for patches of a spline that folds too. Default: false, since no system takes a surface that turns back on itself.
    pub folds: bool,
    /// Number of threads; 0 (default) is one for each core. The result does not depend on it.
    pub threads: usize,
}

impl Default for BicubicOptions {
    fn default() -> Self {
        BicubicOptions {
            tolerance: 1e-4,
            angle: 0.5f64.to_radians(),
            control_points: None,
            folds: false,
            threads: 0,
        }
    }
}

/// Bicubic patches near a spline, with their measured deviations from it.
#[derive(Debug, Clone, PartialEq)]
pub struct BicubicFit {
    /// The patches.
    pub surface: BicubicSurface,
    /// The diagonal of the bounding box of the corners, middles of sides and centroids of the spline's patches.
    pub diagonal: f64,
    /// Largest distance of a patch from the spline's point with the same parameters, over the diagonal. It is measured at nine places of
    /// each cell between knots; none of these is interpolated.
    pub distance: f64,
    /// Angles between the normals of neighbouring patches, at three places of each span of their common curves.
    pub angles: NormalAngles,
    /// The least and the largest number of spans along a side.
    pub spans: [usize; 2],
    /// Number of times that patches were refined.
    pub rounds: usize,
}
