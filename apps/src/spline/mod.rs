//! `ricci spline`: triangular B-splines fitted, evaluated, drawn as triangles, handed to CAD.

mod args;
mod eval;
mod export;
mod fit;
mod height_field;
mod outcome;
mod picture;
mod planar;
mod whole;

pub use args::{HELP, SplineArgs, UnitChoice};
pub use picture::{curvature, reflection};

use crate::failure::Failure;
use crate::runner;
use args::SplineCommand;
use ricci::Control;

/// Run the subcommand; returns the exit code.
pub fn run(args: &SplineArgs, control: &Control) -> Result<u8, Failure> {
    match &args.command {
        SplineCommand::Fit(args) => runner::run(args, control),
        SplineCommand::Eval(args) => runner::run(args, control),
        SplineCommand::Export(args) => runner::run(args, control),
    }
}
