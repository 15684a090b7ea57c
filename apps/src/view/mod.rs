//! `ricci view`: a page in which surfaces turn.

mod args;
mod command;
mod quantities;

pub use args::{HELP, ViewArgs};
