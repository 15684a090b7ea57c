//! The C face of `ricci`: `include/ricci/ricci.h` is generated from this crate. All `unsafe` of the project
//! is here.
//!
//! Names are those of C. One file per concept, mirroring the library; underneath them:
//!
//! | file | what it keeps |
//! |---|---|
//! | `guard` | nothing unwinds into C; handles are checked, and poisoned after a panic |
//! | `environment` | the host's floating-point environment |
//! | `arrays`, `sized`, `choice`, `integer` | arrays, structs and enum values that come from C |
//! | `edges`, `letters` | edge paths and words as signed numbers |
//! | `drawing` | what layouts in the plane and in the hyperbolic plane have in common |
//! | `failure`, `status`, `last_error` | what went wrong |
//! | `debug` | a panic on request, for tests |
//!
//! # Safety
//! Every function here is called from C, so each has the same contract, which the header states and no
//! function repeats: a pointer is NULL or points to what its argument line says, a handle came from this
//! library and was not freed, and a `T *` is in use by one thread only.

#![allow(non_camel_case_types)]
// The comments are the header's: brackets there are C's arrays.
#![allow(rustdoc::broken_intra_doc_links)]
#![allow(clippy::missing_safety_doc)]
#![warn(clippy::too_many_lines)]

mod arrays;
mod choice;
mod edges;
mod environment;
mod failure;
mod guard;
mod integer;
mod letters;
mod sized;

pub mod status;

pub mod last_error;

pub mod version;

pub mod log;

pub mod control;

pub mod space;

pub mod mesh;

pub mod mesh_file;

pub mod shapes;

pub mod intrinsic;

pub mod diagnosis;

pub mod repair;

pub mod scheme;

pub mod metric;

pub mod triangulation;

pub mod target;

pub mod report;

pub mod flow;

pub mod hyperbolic;
pub mod layout;

pub mod refined;

pub mod transfer;

pub mod charts;

pub mod layout_file;

pub mod model;

pub mod uniformize_options;

pub mod uniformize;

pub mod sphere;

pub mod stereographic;

pub mod quotient;

pub mod quotient_layout;

pub mod homotopy;

pub mod word;

pub mod domain;

pub mod deck;

pub mod dirichlet;

pub mod debug;
