//! `ricci structure`: atlases of geometric structures.

mod args;
mod command;
mod drawn;
mod figures;
mod file;

pub use args::{HELP, StructureArgs};
pub use command::{execute, run};
