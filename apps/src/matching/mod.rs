//! `ricci match`: maps between two surfaces.

mod args;
mod command;
mod files;
mod found;
mod marks;

pub use args::{HELP, MatchArgs};
pub use command::{execute, run};
