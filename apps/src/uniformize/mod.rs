//! `ricci uniformize` and `ricci cover`: surfaces in their metric of constant curvature, and their universal covers.

mod args;
mod boundary;
mod command;
mod copies;
mod cover_glb;
mod figures;
mod files;
mod group_file;
mod lifts;
mod model_place;
mod opened;
mod outline;
mod pictures;
mod pieces;
mod quotient;
mod request;
mod shape;
mod sphere;
mod sphere_figures;
mod sphere_picture;
mod summary;
mod task;
mod tiling;

pub use args::{COVER_HELP, CoverArgs, UNIFORMIZE_HELP, UniformizeArgs};
pub use boundary::CornersChoice;
pub use request::CanonicalJob;
