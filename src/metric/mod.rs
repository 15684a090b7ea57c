//! Metrics in a conformal class: one formula for five schemes, mixed types and three geometries.
//!
//! ```
//! # use ricci::{Class, Surface, geometry::Space, mesh::shapes};
//! let torus = Surface::from_soup(&shapes::torus(2.0, 1.0, 24, 12)?)?;
//! let metric = torus.initial(Class::yamabe(Space::E2))?.metric;
//! assert!(metric.curvature(torus.mesh())?.at.iter().sum::<f64>().abs() < 1e-12);
//! # Ok::<(), ricci::Error>(())
//! ```

pub mod angle_refinement;
pub mod class;
pub mod common_subdivision;
pub mod curvature;
pub mod delaunay;
pub(crate) mod flip_queue;
pub mod initial;
pub mod isometric;
pub mod lengths;
pub mod measured;
mod plane_walk;
pub mod precise;
pub mod scheme;
pub mod scheme_distance;
pub mod shape_quality;
mod signposts;
pub mod split;
pub mod start;
pub mod surface;
pub mod target;

pub use angle_refinement::{AngleRefinement, AngleReport, FinerMetric};
pub use class::Class;
pub use common_subdivision::CommonSubdivision;
pub use curvature::{Curvature, curvature};
pub use initial::{Initial, initial_metric};
pub use isometric::Triangulated;
pub use lengths::{Metric, lengths_from_positions};
pub use measured::Measured;
pub use scheme::Scheme;
pub use scheme_distance::SchemeDistance;
pub use shape_quality::ShapeQuality;
pub use split::Split;
pub use start::{StartOptions, delaunay_start};
pub use surface::Surface;
pub use target::Target;
