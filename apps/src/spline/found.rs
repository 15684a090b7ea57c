//! What fits of splines come to.

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
