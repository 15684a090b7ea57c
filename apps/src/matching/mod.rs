//! `ricci match`: maps between two surfaces.

mod args;
mod command;
mod files;
mod found;
mod marks;
mod pictures;

use crate::failure::Failure;
pub use args::{HELP, MatchArgs};
pub use command::{execute, run};

fn no_positions() -> Failure {
    Failure::Failed("an intrinsic metric has no positions in space".into())
}
