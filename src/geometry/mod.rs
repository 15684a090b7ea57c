//! Pure formulas, no mesh: spaces, triangles, isometries, predicates.

pub mod circle;
pub mod modulus;
pub mod space;
pub mod triangle;

pub use space::Space;
