//! `ricci harmonic`: harmonic maps to a disk, a polygon, a rectangle, the sphere, or with given boundary values.

mod args;
mod command;
mod files;
mod outcome;

pub use args::{HELP, HarmonicArgs};
