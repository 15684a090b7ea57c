//! `ricci quads` and `ricci layout`: quad meshes of seamless maps, and their patches.

mod args;
mod command;
mod figures;
mod files;
mod layout_command;
mod picture;
mod texture;

pub use args::{HELP, LAYOUT_HELP, LayoutArgs, QuadsArgs};
pub use command::with_positions;
