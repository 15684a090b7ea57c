//! `ricci quads`: quad meshes of seamless maps.

mod args;
mod command;
mod figures;

pub use args::{HELP, QuadsArgs};
