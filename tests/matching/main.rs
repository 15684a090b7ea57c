//! Maps between two surfaces, by theorem.
#![allow(clippy::unwrap_used, clippy::print_stderr)]

mod boundary;
mod class;
#[path = "../common/mod.rs"]
mod common;
mod corpus;
mod errors;
mod known;
mod landmarks;
mod overlay;
mod round;
mod samples;
