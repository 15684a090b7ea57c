//! Pure formulas, no mesh: spaces, triangles, isometries, predicates.

pub mod barycentre;
pub mod circle;
pub mod conformal;
pub mod flip;
pub mod hyperelliptic;
pub mod isometry;
pub mod modulus;
pub mod predicates;
pub mod space;
pub mod sphere;
pub mod symplectic;
pub mod triangle;
pub(crate) mod twofold;
pub mod vector;

pub use isometry::PlaneIsometry;
pub use space::Space;
