//! Harmonic 1-forms, holomorphic forms and harmonic maps, by theorem.
#![allow(clippy::unwrap_used, clippy::print_stderr)]

#[path = "../common/mod.rs"]
mod common;
mod factor;
mod forms;
mod known;
mod maps;
mod open;
mod operators;
mod samples;
mod trajectories;
mod zeros;
