//! `ricci`: a geometry kernel for discrete surface Ricci flow.
//!
//! Give it a triangle mesh and a target curvature, and it finds the discrete conformal metric that has it.
//! The floors, bottom to top (a floor imports only floors below it; a test holds this):
//!
//! | floor | what lives there |
//! |---|---|
//! | [`error`], [`control`], [`parallel`] | error codes, progress and cancel, the thread pool of one call |
//! | [`archive`] | results as bytes and files that read back bit for bit |
//! | [`geometry`] | pure formulas: spaces, triangles, isometries, predicates |
//! | [`linalg`] | sparse symmetric matrices with a fixed pattern, Cholesky |
//! | [`mesh`] | connectivity (half-edge Δ-complex), building, diagnosis, files, generators |
//! | [`topology`] | spanning trees, homology, cut graphs, homotopy bases, lifts to the cover |
//! | [`metric`] | conformal classes (ε, η), lengths, angles, curvature, targets |
//! | [`flow`] | Newton and gradient flow, cones |
//! | [`embed`] | layouts, their quality, charts; deck groups, universal covers |
//! | [`harmonic`] | Laplacian, harmonic maps and 1-forms, period matrices, trajectories |
//! | [`mod@flatten`] | maps to the plane of least stretch, without a turned triangle |
//! | [`canonical`] | canonical shapes: uniformization, spheres, circle domains, straight boundaries |
//! | [`seamless`] | metrics and maps whose cones and handles turn by multiples of 90° |
//! | [`moduli`] | period matrices with proven bounds |
//! | [`quads`] | T-meshes, integer-grid maps, quad meshes and layouts of seamless maps |
//! | [`texture`] | texture atlases of whole models: charts on the faces, packed into a page |
//! | [`matching`] | maps between two surfaces |
//! | [`structure`] | atlases: conformal, spherical, affine, hyperbolic, projective, integer |
//! | [`spline`] | triangular B-splines, fits over whole surfaces, bicubic patches for CAD |
//! | [`records`] | what the files of results hold |
//!
//! Cargo features, on by default, add file formats and the crates that they need: `gltf` reads and writes .glb and reads .gltf, `gifti` reads
//! .gii and reads and writes .vtp, `gzip` reads what gzip has packed, `json` reads and writes splines. Two others are the floors `splines` ([`spline`]) and `quads`
//! ([`seamless`] and [`quads`]). `step`, off by default, writes STEP files of splines.

// Readers and writers of formats, whose functions follow their formats, are excepted in mesh/io.
#![warn(clippy::too_many_lines)]

pub mod archive;
pub mod canonical;
pub mod control;
pub mod embed;
pub mod error;
pub mod flatten;
pub mod flow;
pub mod geometry;
pub mod harmonic;
pub mod linalg;
pub mod matching;
pub mod mesh;
pub mod metric;
pub mod moduli;
pub mod parallel;
#[cfg(feature = "quads")]
pub mod quads;
pub mod records;
#[cfg(feature = "quads")]
pub mod seamless;
#[cfg(feature = "splines")]
pub mod spline;
pub mod structure;
pub mod texture;
pub mod topology;

pub use control::Control;
pub use error::{Error, FilePosition, Result};
pub use flow::{Flow, Solution};
pub use metric::{Class, Surface, Target};

/// The README's Rust example is compiled and run with the tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
pub struct Readme;
