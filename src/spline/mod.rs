//! Triangular B-splines: piecewise polynomial surfaces over triangles, as smooth as their degree allows, on the plane or on a surface
//! with an affine atlas [DMS92; Sei91; GHQ06].

mod index;
mod knots;
mod overlap;
mod patch;
mod plan;
mod polar;
mod recurrence;
mod simplex;
mod space;
mod surface;

pub use index::{MAX_DEGREE, basis_size, multi_indices};
pub use knots::{Domain, KnotOptions, SPREAD};
pub use patch::{Parameter, Patch, Support};
pub use polar::{Polynomial, monomials};
pub use simplex::{simplex_spline, simplex_spline_gradient};
pub use space::SplineSpace;
pub use surface::{Spline, SurfacePoint};
