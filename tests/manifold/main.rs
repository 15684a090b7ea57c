//! Splines over whole surfaces.

mod coarse;
mod hole;
mod space;
