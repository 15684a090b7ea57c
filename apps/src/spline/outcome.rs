//! A spline near a mesh, with its figures and checks.

use crate::input::Input;
use crate::report::{Checks, Figures};
use ricci::spline::Spline;
use serde_json::{Map, Value};

pub struct FitOutcome {
    pub input: Input,
    pub spline: Spline,
    /// The root of the mean of the squared distances of the vertices, over the diagonal of the bounding box.
    pub rms: f64,
    /// The largest distance of a vertex, over the same diagonal.
    pub max: f64,
    /// The options that were left open, with the values chosen for them.
    pub defaults: Map<String, Value>,
    pub figures: Figures,
    pub checks: Checks,
}
