//! Closed surfaces in their canonical shape: spheres as convex polyhedra inscribed in the unit sphere, all others as quotients of the
//! plane or the hyperbolic plane.

mod candidates;
mod lift;
mod puncture;
pub mod quotient;
pub mod sphere;
mod star;
mod tries;
pub mod uniformize;

pub use quotient::{Quotient, QuotientOptions, quotient_of, uniformize_quotient};
pub use sphere::{Sphere, SphereOptions, SphereReport, uniformize_sphere};
pub use uniformize::{Uniformization, uniformize};
