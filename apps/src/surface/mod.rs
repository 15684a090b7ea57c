//! `ricci surface`: from a scan to few large patches with common tangent planes.

mod args;
mod command;
mod figures;
mod picture;

pub use args::{HELP, ScanArgs};
