//! `ricci match`: maps between two surfaces.

mod args;
mod command;
mod files;
mod marks;
mod outcome;
mod pictures;

pub use args::{HELP, MatchArgs};
