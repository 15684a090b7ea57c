//! Uniformization of closed surfaces of genus 1 and more, deck groups and universal covers, by theorem.
#![allow(clippy::unwrap_used, clippy::print_stdout, clippy::print_stderr)]

#[path = "../common/mod.rs"]
mod common;

mod cover;
mod known;
mod lift;
mod polygon;
mod quotient;
mod surfaces;
