//! `ricci quads` and `ricci layout`: quad meshes of seamless maps, and their patches.

mod args;
mod command;
mod figures;
mod files;
mod layout_command;

pub use args::{HELP, LAYOUT_HELP, LayoutArgs, QuadSourceArgs, QuadsArgs};
pub use command::solved;
