//! Closed surfaces in their canonical shape: spheres as convex polyhedra inscribed in the unit sphere.

mod candidates;
mod lift;
mod puncture;
pub mod sphere;
mod star;
mod tries;

pub use sphere::{Sphere, SphereOptions, SphereReport, uniformize_sphere};
