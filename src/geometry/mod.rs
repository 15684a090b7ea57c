//! Pure formulas, no mesh: spaces, triangles, isometries, predicates.

pub mod space;
pub mod triangle;

pub use space::Space;
