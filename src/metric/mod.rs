//! Metrics in a conformal class: one formula for five schemes, mixed types and three geometries.

pub mod class;
pub mod curvature;
pub mod delaunay;
mod flip_queue;
pub mod initial;
pub mod isometric;
pub mod lengths;
pub mod precise;
pub mod refinement;
pub mod scheme;
pub mod start;
pub mod surface;
pub mod target;

pub use class::Class;
pub use curvature::{Curvature, curvature};
pub use initial::{Initial, initial_metric};
pub use isometric::Triangulated;
pub use lengths::{Metric, lengths_from_positions};
pub use refinement::Refinement;
pub use scheme::Scheme;
pub use start::{StartOptions, delaunay_start};
pub use surface::Surface;
pub use target::Target;
