//! `ricci harmonic`: harmonic maps to a disk, a polygon, a rectangle, the sphere, or with given boundary values.

mod args;
mod command;
mod files;
mod found;

pub use args::{HELP, HarmonicArgs};
pub use command::{execute, run};
