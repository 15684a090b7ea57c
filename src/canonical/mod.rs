//! Surfaces in their canonical shape: spheres as convex polyhedra inscribed in the unit sphere, all others as quotients of the plane or the
//! hyperbolic plane, with straight boundary if they have any.
//!
//! ```
//! use ricci::canonical::{QuotientOptions, Uniformization, uniformize};
//! use ricci::geometry::Space;
//! use ricci::mesh::shapes;
//! use ricci::{Control, Surface};
//! let surface = Surface::from_soup(&shapes::torus(2.0, 1.0, 24, 12)?)?;
//! let torus = uniformize(&surface, &QuotientOptions::default(), &Control::new())?;
//! assert!(torus.converged() && torus.space() == Space::E2);
//! assert!(matches!(torus, Uniformization::Quotient(_)));
//! # Ok::<(), ricci::Error>(())
//! ```

pub mod boundary;
mod candidates;
pub mod circle_domain;
mod lift;
mod puncture;
pub mod quotient;
pub mod sphere;
pub mod spherical_flow;
mod star;
mod tries;
pub mod uniformize;

#[cfg(feature = "splines")]
pub(crate) use boundary::evenly;
pub use boundary::{Boundary, BoundaryCorner, Corners};
pub use circle_domain::{
    CircleDomain, CircleDomainOptions, DomainCircle, DomainFrame, Normalisation, circle_domain,
};
pub use quotient::{Quotient, QuotientOptions, quotient_of, uniformize_quotient};
pub use sphere::{Sphere, SphereOptions, SphereReport, uniformize_sphere};
pub use spherical_flow::{FlowedSphere, flow_to_sphere};
pub use uniformize::{Uniformization, uniformize};
