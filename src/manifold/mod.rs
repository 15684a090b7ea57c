//! Splines over whole surfaces: their domains on flat metrics, fits, and what is made of them.

mod areas;
mod coarse;
mod domain;
mod fit;
mod flat;
mod folds;
mod grade;
mod holes;
mod infinity;
mod plane;
mod pole;
mod sample;
mod similarity;

pub use crate::mesh::Place;
pub use coarse::Coarse;
pub use domain::SurfaceDomain;
pub use fit::{SurfaceFit, SurfaceFitOptions, fit_surface};
pub use flat::{Flat, FlatOptions};
