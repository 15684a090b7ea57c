//! The `ricci` command as its users see it: exit codes, the files of the contract, and what is in them, recomputed here
//! with formulas of our own.

#![allow(clippy::unwrap_used)]

mod atlas;
mod attributes;
mod boundaries;
mod brain;
mod charts;
mod circles;
mod complex;
mod cover;
mod files;
mod flat;
mod flatten;
mod flips;
mod flow;
mod forms;
mod gallery;
mod harmonic;
mod info;
mod lengths;
mod make;
mod matching;
mod on_input;
mod outputs;
mod picture;
mod quads;
mod refine;
mod repair;
mod run;
mod schemes;
mod spline;
mod structure;
mod surface;
mod surfaces;
mod uniformize;
mod usage;
mod view;
