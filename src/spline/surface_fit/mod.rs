//! Splines over whole surfaces: their domains on flat metrics, fits, and what is made of them.

mod areas;
mod bare;
mod coarse;
mod domain;
mod fit;
mod flat;
mod folds;
mod holes;
mod infinity;
mod plane;
mod pole;
mod round;
mod sample;
mod setting;
mod similarity;
mod singular;
mod sizes;
mod verdict;

pub use coarse::CoarseTriangulation;
pub use domain::SurfaceDomain;
pub use fit::{SurfaceFit, fit_surface, fit_surface_over};
pub use flat::{FlatMetric, flat_curvatures};
pub use setting::SurfaceFitOptions;
pub use singular::{FlatMetricOptions, SingularVertices};
pub use verdict::{FitCondition, FitFailure};
