//! `ricci circles`: surfaces with boundary in a metric of constant curvature whose boundary loops are circles.

mod args;
mod command;
mod figures;
mod found;
mod picture;

pub use args::{CirclesArgs, HELP};
pub use command::{execute, run};
