//! Triangular B-splines: piecewise polynomial surfaces over triangles, as smooth as their degree allows, on the plane or on a surface
//! with an affine atlas [DMS92; Sei91; GHQ06].

mod bicubic;
mod cap;
mod closest;
mod descent;
mod ears;
#[cfg(feature = "json")]
mod file;
mod fill;
mod fit;
mod hole;
mod identities;
mod index;
mod jet;
pub(crate) mod knots;
mod locate;
pub(crate) mod overlap;
mod patch;
mod plan;
mod point;
mod polar;
mod recurrence;
mod simplex;
mod space;
mod surface;
mod tessellate;
mod triangulate;

pub use bicubic::{
    Bicubic, BicubicOptions, BicubicPatch, BicubicSurface, NormalAngles, PatchCurve, PatchSide,
};
#[cfg(feature = "step")]
pub use bicubic::{LengthUnit, StepOptions};
pub use closest::{ClosestPoint, ClosestPoints};
pub use fill::Fill;
pub use fit::{FitOptions, Fitted, fit, fit_filled};
pub(crate) use hole::INFINITE;
pub use hole::{Hole, Sector};
pub use identities::Identities;
pub use index::{MAX_DEGREE, basis_size, multi_indices};
pub use knots::{Domain, KnotOptions, SPREAD};
pub use locate::Locator;
pub use patch::{Parameter, Patch, Support};
pub use point::SurfacePoint;
pub use polar::{Polynomial, monomials};
pub use simplex::{simplex_spline, simplex_spline_gradient};
pub use space::SplineSpace;
pub use surface::Spline;
pub use triangulate::triangulate;
