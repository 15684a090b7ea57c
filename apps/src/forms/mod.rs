//! `ricci forms`: harmonic and holomorphic 1-forms, their periods and zeros.

mod args;
mod command;
mod figures;
mod file;
mod outcome;
mod picture;

pub use args::{FormsArgs, HELP, width};
pub use file::BoundsFile;
