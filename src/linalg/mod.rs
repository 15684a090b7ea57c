//! Sparse symmetric positive definite systems: a fixed pattern, refilled and refactorised.

pub mod cholesky;
pub mod pattern;

pub use cholesky::Cholesky;
pub use pattern::{Pattern, Symmetric};
