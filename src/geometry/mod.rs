//! Pure formulas, no mesh: spaces, triangles, isometries, predicates.

pub mod circle;
pub mod conformal;
pub mod isometry;
pub mod modulus;
pub mod predicates;
pub mod space;
pub mod triangle;

pub use isometry::PlaneIsometry;
pub use space::Space;
