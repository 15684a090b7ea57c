//! `ricci structure`: atlases of geometric structures.

mod args;
mod command;
mod figures;
mod file;
mod picture;

pub use args::{HELP, StructureArgs};
