//! Splines over whole surfaces: their domains on flat metrics, fits, and what is made of them.

mod areas;
mod coarse;
mod domain;
mod fit;
mod flat;
mod folds;
mod holes;
mod infinity;
mod plane;
mod pole;
mod sample;
mod similarity;
mod sizes;

pub use coarse::CoarseTriangulation;
pub use domain::SurfaceDomain;
pub use fit::{SurfaceFit, SurfaceFitOptions, fit_surface};
pub use flat::{FlatMetric, FlatMetricOptions};
