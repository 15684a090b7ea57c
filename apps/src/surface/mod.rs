//! `ricci surface`: from a scan to few large patches with common tangent planes.

mod args;
mod command;
mod figures;

pub use args::{HELP, ScanArgs};
