//! Splines over whole surfaces: their domains on flat metrics, fits, and what is made of them.

mod coarse;
mod domain;
mod fit;
mod sample;

pub use coarse::{Coarse, Place};
pub use domain::SurfaceDomain;
pub use fit::{SurfaceFit, SurfaceFitOptions, fit_surface};
pub use sample::spread_vertices;
