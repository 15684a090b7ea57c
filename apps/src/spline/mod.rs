//! `ricci spline`: triangular B-splines fitted, evaluated, drawn as triangles.

mod args;
mod eval;
mod fit;
mod height_field;
mod picture;

pub use args::{HELP, SplineArgs, SplineCommand};
pub use eval::eval;
pub use fit::fit;
