//! Open surfaces of genus 0 laid flat with as little stretch as possible: maps to the plane of least distortion energy, with a free boundary
//! and without a triangle that is turned over.
//!
//! The map starts at the conformal layout that keeps the lengths of the outer loop ([`crate::Target::Outer`]), whose holes are closed while
//! that is solved for. From there Newton's method descends the symmetric Dirichlet energy \[SS15\], or one of its relatives
//! ([`DistortionEnergy`]), whose Hessian is known by its eigenvalues in every triangle \[SGK19\]. These energies grow without bound before a
//! triangle loses its area; steps end before the first one does, and each accepted map is checked by exact arithmetic.
//!
//! ```
//! use ricci::flatten::{FlattenOptions, flatten};
//! use ricci::{Control, Surface, mesh::shapes};
//! // A bowl, which is curved, and so is stretched a little.
//! let mut bowl = shapes::disk(8)?;
//! bowl.positions.iter_mut().for_each(|[x, y, z]| *z = 0.3 * (*x * *x + *y * *y));
//! let flat = flatten(&Surface::from_soup(&bowl)?, &FlattenOptions::default(), &Control::new())?;
//! assert!(flat.report.converged() && flat.points.len() == bowl.positions.len());
//! assert!(flat.report.after.energy < flat.report.before.energy && flat.report.after.energy > 4.0);
//! # Ok::<(), ricci::Error>(())
//! ```

mod coarse_rings;
mod coarse_sphere;
mod darts;
#[cfg(test)]
mod derivative_tests;
mod descent;
mod descent_matrix;
mod distortion;
mod energy;
mod flat_map;
mod inflate;
mod medial_wall;
mod options;
mod plane_moves;
mod plane_start;
mod report;
mod rest_triangle;
pub(crate) mod rim;
mod ring_distances;
// Made for seams alone, which seamless metrics have.
#[cfg_attr(not(feature = "quads"), expect(dead_code))]
mod seam_ties;
#[cfg(feature = "quads")]
mod seamless_flat_map;
mod sphere_flat_map;
mod sphere_moves;
mod sphere_triangle;
mod step_bound;
mod strain;
mod term;
mod terms;
mod tied_matrix;
mod tutte;
mod upright;

pub use darts::{Dart, DartOptions, DartedFlattening, cut_open, flatten_with_darts};
pub use distortion::Distortion;
pub use flat_map::{Flattening, flatten};
pub use inflate::{INFLATE_STEPS, INFLATE_TIME, InflateOptions, inflate};
pub use medial_wall::{flat_part, medial_wall};
pub use options::{
    AREA_CONFORMAL, DISTANCE_ISOMETRIC, DistortionEnergy, FlattenOptions, MAX_ITERATIONS, RINGS, TOLERANCE,
};
pub use report::{FlattenReport, FlattenStart, FlattenStop};
#[cfg(feature = "quads")]
pub use seamless_flat_map::{SeamlessFlattening, flatten_seamless};
pub use sphere_flat_map::{SphereFlattening, flatten_sphere};
pub use strain::{FaceStrain, StrainLimits, strains};
