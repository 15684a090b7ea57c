//! Surfaces with boundary in their canonical shape: geodesic loops in H², straight sides in E², by known answers.
#![allow(clippy::unwrap_used, clippy::print_stdout, clippy::print_stderr)]

#[path = "../common/mod.rs"]
mod common;

mod geodesic;
mod straight;
mod surfaces;
