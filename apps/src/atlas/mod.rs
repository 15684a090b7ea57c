//! `ricci atlas`: texture coordinates for a whole model, on its own faces.

mod args;
mod command;
mod files;
mod outcome;
mod scene;

pub use args::{HELP, TextureArgs};
