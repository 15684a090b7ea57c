//! `ricci seamless`: metrics and maps whose seams are rotations by multiples of 90°.

mod args;
mod command;
mod figures;

pub use args::{HELP, SeamlessArgs};
