//! The C face of `ricci`. All `unsafe` code of the project is in this crate.
//!
//! The names are those of C. The documentation of a function is its comment in the headers of `include/ricci`, which are
//! written by hand; `tests/header.rs` compares their declarations, structs and constants with this crate. Each concept of the
//! library has a file. The other files are shared by all of them:
//!
//! | file | purpose |
//! |---|---|
//! | `guard` | runs the body of every entry point, so that nothing unwinds into C; a panic poisons the handle that was being changed |
//! | `float_environment` | sets the floating-point environment, and puts the host's back |
//! | `memory` | asks the system for memory before the work, so that a refusal becomes a status |
//! | `arrays`, `structs`, `choice`, `paths` | move arrays, structs, enum values, edge paths and words from and to C |
//! | `call_control` | finds the control of the call that a thread is in |
//! | `failure`, `thread_failure`, `status` | describe an error, and keep the last one of every thread |
//!
//! # Safety
//! Every function here is called from C, so each has the same contract, which the header states and no
//! function repeats: a pointer is NULL or points to what its argument line says, a handle came from this
//! library and was not freed, and a `T *` is in use by one thread only.

#![allow(non_camel_case_types)]
// The headers document everything that C sees.
#![allow(missing_docs)]
#![allow(clippy::missing_safety_doc)]
#![warn(clippy::too_many_lines)]

#[cfg(any(feature = "quads", feature = "splines"))]
mod archive_parts;
mod archive_records;
mod arrays;
mod boundary;
mod call_control;
mod choice;
mod data_file;
mod failure;
pub mod flatten;
mod float_environment;
#[cfg(any(test, not(all(feature = "gifti", feature = "quads", feature = "splines"))))]
mod functions_left_out;
mod guard;
#[cfg(not(all(feature = "gltf", feature = "quads", feature = "step")))]
mod left_out;
mod memory;
mod optional;
mod paths;
mod soup_cache;
mod soup_file;
#[cfg(feature = "splines")]
mod spline_memory;
mod structs;
mod texture;
mod thread_failure;
mod wording;

pub mod archive;
#[cfg(feature = "splines")]
pub mod bicubic;
pub mod charts;
pub mod circle_domain;
pub mod circles;
pub mod control;
#[cfg(all(feature = "quads", feature = "splines"))]
pub mod control_mesh;
mod cortex;
mod darts;
pub mod deck;
pub mod defect_texts;
pub mod dirichlet;
pub mod domain;
pub mod flow;
pub mod forms;
mod freesurfer;
#[cfg(feature = "gifti")]
pub mod gifti;
#[cfg(feature = "gifti")]
pub mod gifti_columns;
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
pub mod moduli;
pub mod polygons;
#[cfg(feature = "quads")]
#[cfg_attr(not(feature = "splines"), allow(dead_code, reason = "what splines over layouts read"))]
pub mod quad_layout;
#[cfg(all(feature = "quads", feature = "splines"))]
pub mod quad_patch;
#[cfg(all(feature = "quads", feature = "splines"))]
pub mod quad_spline;
#[cfg(all(feature = "quads", feature = "splines"))]
pub mod quad_spline_file;
#[cfg(all(feature = "quads", feature = "splines"))]
pub mod quad_spline_places;
#[cfg(feature = "quads")]
#[cfg_attr(not(feature = "splines"), allow(dead_code, reason = "what splines over layouts read"))]
pub mod quads;
pub mod quality;
pub mod refine;
pub mod repaired_input;
pub mod report;
pub mod scene;
#[cfg(feature = "quads")]
pub mod seamless;
#[cfg(feature = "quads")]
pub mod seamless_flat;
pub mod shape_matching;
pub mod shapes;
pub mod sheet;
pub mod soup;
pub mod soup_lists;
pub mod sphere;
#[cfg(feature = "splines")]
pub mod spline;
#[cfg(feature = "splines")]
pub mod spline_file;
#[cfg(feature = "splines")]
pub mod spline_fit;
#[cfg(feature = "splines")]
pub mod spline_places;
#[cfg(feature = "splines")]
pub mod spline_surface;
pub mod status;
pub mod structure;
pub mod structure_parts;
pub mod target;
pub mod texture_atlas;
pub mod uniformize;
pub mod version;
