//! Rotations about an axis by which two conformal factors fit each other, on a disk or a sphere.

mod conformal_factors;
mod turn_about_axis;

pub(super) use conformal_factors::{ConformalFactors, factors};
pub(super) use turn_about_axis::{PolarSample, best_turn, centre};
