//! Triangular B-splines: piecewise polynomials over triangles in one plane domain or in the charts of an atlas, with the filled holes
//! around singular vertices, fits to points, tessellations and files.

mod cap;
mod closest;
mod descent;
mod ears;
mod equations;
mod fairness;
#[cfg(feature = "json")]
mod file;
mod fill;
mod fit;
mod hole;
mod identities;
mod index;
mod jet;
pub(super) mod knots;
mod locate;
pub(super) mod overlap;
mod patch;
mod plan;
mod point;
mod polar;
mod recurrence;
mod simplex;
mod space;
mod surface;
mod system;
mod tessellate;
mod triangulate;

pub(super) use cap::{CapTriangle, SurfaceTriangle};
pub use closest::{ClosestPoint, ClosestPoints};
pub(super) use descent::{DescentEnd, descend, is_convex};
pub(super) use fairness::FairnessUnit;
pub use fill::Fill;
pub use fit::{FitOptions, PlacedPoints, SplineFit, fit, fit_filled};
pub(super) use hole::INFINITE;
pub use hole::{Hole, Sector};
pub use identities::Identities;
pub(crate) use identities::{open_places, partition_of_unity};
pub use index::{MAX_DEGREE, basis_size, multi_indices};
pub use knots::{KnotOptions, PlaneDomain, SPREAD};
pub use locate::Locator;
pub use patch::{Parameter, Patch, Support};
pub use point::SurfacePoint;
pub use polar::{Polynomial, monomials};
pub use simplex::{simplex_spline, simplex_spline_gradient};
pub use space::SplineSpace;
pub use surface::Spline;
pub(super) use system::{FairnessWeights, FitSystem, PlacedRows, TangentPlanes, WeightedFit};
pub use triangulate::triangulate;
