//! The C face of `ricci`. All `unsafe` of the project is here.
//!
//! Names are those of C. What functions do is said once, in the headers of `include/ricci`, which are written by hand;
//! `tests/header.rs` holds their declarations, structs and constants against this crate. One file per concept of the library;
//! underneath them:
//!
//! | file | what it keeps |
//! |---|---|
//! | `guard` | nothing unwinds into C; a handle that was being changed is poisoned by a panic |
//! | `environment` | the host's floating-point environment |
//! | `memory` | what the system refuses is asked for before the work |
//! | `arrays`, `structs`, `choice`, `paths` | arrays, structs, enum values, edge paths and words from and to C |
//! | `failure`, `kept`, `status` | what went wrong, last on every thread |
//!
//! # Safety
//! Every function here is called from C, so each has the same contract, which the header states and no
//! function repeats: a pointer is NULL or points to what its argument line says, a handle came from this
//! library and was not freed, and a `T *` is in use by one thread only.

#![allow(non_camel_case_types)]
// The headers document what C sees.
#![allow(missing_docs)]
#![allow(clippy::missing_safety_doc)]
#![warn(clippy::too_many_lines)]

mod arrays;
mod boundary;
mod choice;
mod environment;
mod failure;
mod guard;
mod kept;
mod memory;
mod paths;
mod structs;
mod texture;

pub mod atlas;
pub mod bicubic;
pub mod circle_domain;
pub mod control;
pub mod deck;
pub mod dirichlet;
pub mod domain;
pub mod flow;
pub mod forms;
pub mod harmonic;
pub mod homotopy;
pub mod init;
pub mod last_error;
pub mod layout;
pub mod log;
pub mod map;
pub mod matching;
pub mod mesh;
pub mod metric;
pub mod report;
pub mod shapes;
pub mod soup;
pub mod spline;
pub mod spline_file;
pub mod spline_fit;
pub mod spline_places;
pub mod spline_surface;
pub mod status;
pub mod structure;
pub mod structure_parts;
pub mod target;
pub mod uniformize;
pub mod version;
