//! `ricci spline`: triangular B-splines fitted, evaluated, drawn as triangles, handed to CAD.

mod args;
mod eval;
mod export;
mod fit;
mod found;
mod height_field;
mod picture;
mod planar;
mod whole;

pub use args::{HELP, SplineArgs};

use crate::failure::Failure;
use args::SplineCommand;
use ricci::Control;

/// Run the subcommand; the exit code is 1 if a check fails.
pub fn run(args: &SplineArgs, control: &Control) -> Result<u8, Failure> {
    match &args.command {
        SplineCommand::Fit(args) => fit::fit(args, control),
        SplineCommand::Eval(args) => eval::eval(args, control),
        SplineCommand::Export(args) => export::export(args, control),
    }
}
