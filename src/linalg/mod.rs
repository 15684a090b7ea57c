//! Sparse symmetric positive definite systems.
