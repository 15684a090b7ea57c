//! Splines over whole surfaces.

mod coarse;
mod space;
