//! Spanning trees, homology generators, cut graphs.

pub mod farthest;

pub use farthest::farthest_vertices;
