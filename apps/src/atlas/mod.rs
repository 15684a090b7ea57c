//! `ricci atlas`: texture coordinates for a whole model, on its own faces.

mod args;
mod command;
mod files;
mod outcome;

pub use args::{HELP, TextureArgs};
