//! Circle domains: surfaces with boundary in a metric of constant curvature whose boundary loops are circles [BPS15; BL23].
//!
//! Every loop is filled by a hub ([`crate::flow`]), and the closed surface is brought to its constant curvature: the vertices of a loop
//! then lie on a circle about its hub. An edge of a loop that is not Delaunay is flipped like any other. The edge then
//! crosses edges at the hub, and the points where it does are vertices of the loop too, on its circle.
//!
//! ```
//! use ricci::canonical::{CircleDomainOptions, circle_domain};
//! use ricci::{Control, Surface, mesh::shapes};
//! let annulus = Surface::from_soup(&shapes::annulus(0.5, 1.0, 6, 60)?)?;
//! let domain = circle_domain(&annulus, &CircleDomainOptions::default(), &Control::new())?;
//! assert!(domain.report.converged && domain.circles.len() == 2);
//! assert!((domain.modulus.unwrap() - 2f64.ln() / std::f64::consts::TAU).abs() < 1e-3);
//! # Ok::<(), ricci::Error>(())
//! ```

mod anchors;
mod closed;
mod disk;
mod domain;
mod find;
mod options;
mod place;
mod planar;
mod precise_map;
mod prepare;
mod strip;
mod verdict;
mod view;

pub use domain::{CircleDomain, CircleReport, DomainCircle};
pub use find::circle_domain;
pub use options::{CircleDomainOptions, DomainFrame, LEAST_LOOP, Normalisation, ROUND};
