//! Tests of the library in one program, so that it is linked once: a module for each subject.
#![allow(clippy::unwrap_used, clippy::print_stdout, clippy::print_stderr)]

mod archives;
mod bordered;
mod cancel;
mod charts;
mod circles;
#[path = "../common/mod.rs"]
mod common;
mod common_subdivision;
mod cones;
mod control_mesh;
mod delaunay;
mod derivative;
mod descent;
mod extreme;
mod few_patches;
mod flatten;
mod flatten_conditions;
mod flatten_darts;
#[cfg(feature = "quads")]
mod flatten_seams;
mod flatten_sphere;
mod flip_formula;
mod flips;
mod flips_open;
mod flips_random;
mod flips_solver;
mod flow;
mod generators;
mod harmonic;
mod hints;
mod holes;
mod homotopy;
mod layout;
mod matching;
#[cfg(feature = "gltf")]
mod mesh_attributes;
#[cfg(all(feature = "gifti", feature = "gzip"))]
mod mesh_brain;
mod mesh_build;
mod mesh_files;
#[cfg(all(feature = "gltf", feature = "gifti"))]
mod mesh_formats;
#[cfg(feature = "gifti")]
mod mesh_gifti;
#[cfg(feature = "gltf")]
mod mesh_gltf;
mod mesh_odd;
mod outer;
mod progress;
#[cfg(feature = "quads")]
mod quads;
mod range;
mod refine;
mod repair;
#[cfg(feature = "gltf")]
mod scene;
#[cfg(feature = "gltf")]
mod scene_build;
#[cfg(feature = "quads")]
mod seamless;
#[cfg(feature = "quads")]
mod seamless_features;
mod shapes;
mod solution;
mod solver;
mod sphere;
#[cfg(feature = "splines")]
mod spline;
mod structure;
#[cfg(feature = "splines")]
mod surface_fit;
mod surfaces;
mod target;
mod texture;
mod topology;
mod unfold;
mod uniformization;
