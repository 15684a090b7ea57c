//! `ricci circles`: surfaces with boundary in a metric of constant curvature whose boundary loops are circles.

mod args;
mod command;
mod figures;
mod outcome;
mod picture;

pub use args::{CirclesArgs, HELP};
