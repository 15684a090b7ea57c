//! Pure formulas, no mesh: spaces, triangles, isometries, predicates.

pub mod space;

pub use space::Space;
