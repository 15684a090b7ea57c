//! `ricci lengths`: closed geodesics of the metric of constant curvature, and their lengths.

mod args;
mod command;
mod curves;
mod figures;

pub use args::{HELP, LengthsArgs};
