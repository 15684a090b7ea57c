//! `ricci seamless`: metrics and maps whose seams are rotations by multiples of 90°.

mod args;
mod command;
mod figures;
mod picture;

pub use args::{ConesChoice, HELP, SeamlessArgs};
pub use command::chosen_cones;
