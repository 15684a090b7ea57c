//! What fits of splines have in common.

use crate::report::{Checks, Figures};
use ricci::spline::Spline;
use serde_json::{Map, Value};

/// A spline near a mesh.
pub struct Found {
    pub spline: Spline,
    /// Root of the mean of the squared distances, and the largest distance, over the diagonal of the bounding box.
    pub rms: f64,
    pub max: f64,
    /// The options that were left open.
    pub defaults: Map<String, Value>,
    pub figures: Figures,
    pub checks: Checks,
}

/// The diagonal of the bounding box of points.
pub fn diagonal(points: &[[f64; 3]]) -> f64 {
    let extent = |x: usize| {
        let all = points.iter().map(|p| p[x]);
        all.clone().fold(f64::NEG_INFINITY, f64::max) - all.fold(f64::INFINITY, f64::min)
    };
    [0, 1, 2].map(extent).iter().map(|x| x * x).sum::<f64>().sqrt()
}
