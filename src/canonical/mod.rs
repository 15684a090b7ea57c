//! Closed surfaces in their canonical shape: metrics of constant curvature.

pub mod quotient;

pub use quotient::{Quotient, QuotientOptions, quotient_of, uniformize_quotient};
