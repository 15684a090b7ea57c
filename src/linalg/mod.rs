//! Sparse symmetric positive definite systems: a fixed pattern, refilled and refactorised.
//!
//! ```
//! use ricci::linalg::{Cholesky, Pattern, Symmetric};
//! // [[2, 1], [1, 2]] x = [3, 3]
//! let pattern = Pattern::new(2, &[(0, 1)])?;
//! let mut values = vec![2.0; pattern.entries()];
//! values[pattern.position(0, 1).unwrap()] = 1.0;
//! let mut cholesky = Cholesky::analyse(&pattern)?;
//! cholesky.factor(Symmetric { pattern: &pattern, values: &values }).unwrap();
//! let mut x = [3.0, 3.0];
//! cholesky.solve(&mut x);
//! assert!(x.iter().all(|x| (x - 1.0).abs() < 1e-15));
//! # Ok::<(), ricci::Error>(())
//! ```

pub mod cholesky;
pub mod conjugate;
pub mod dense;
mod front;
pub mod gmres;
pub mod lu;
mod multifrontal;
pub mod number;
mod order;
pub mod pattern;
mod pool;
mod substitution;
mod tree;

pub use cholesky::Cholesky;
pub use number::Number;
pub use pattern::{Pattern, Symmetric};

/// The sum of products, in the order of the entries whatever the threads.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
