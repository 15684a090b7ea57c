//! Splines over whole surfaces: their domains on flat metrics, fits, and what is made of them.

mod coarse;
mod domain;

pub use coarse::{Coarse, Place};
pub use domain::SurfaceDomain;
