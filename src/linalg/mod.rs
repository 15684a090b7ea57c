//! Sparse linear systems, above all symmetric positive definite ones whose pattern is analysed once and whose values change often.
//!
//! Order of elimination and symbolic analysis of the Cholesky factorisation are faer's. Its numeric phase and substitution are written here
//! (`multifrontal`, `substitution`), because they divide the work in a way that depends on the pattern alone: the bits are the same for any
//! number of threads, and two threads take 0.10 s instead of faer's 0.16 s on one at 200,000 unknowns (docs/results/bench.md; on one
//! thread both take the same time). They also hold a factor in single precision, and refill its memory in place.
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
pub use number::FactorNumber;
pub use pattern::{Pattern, Symmetric};

/// The scalar product, summed in the order of the entries for any number of threads.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
