//! `ricci brain`: the maps of a cortical hemisphere, to the sphere, inflated and flat, with their distortion.

mod args;
mod command;
mod figures;
mod files;
mod hemisphere;
mod names;
mod outcome;
mod picture;
mod side;

pub use args::{BrainArgs, HELP};
