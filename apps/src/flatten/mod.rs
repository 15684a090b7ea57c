//! `ricci flatten`: maps to the plane of least stretch, without a triangle that is turned over.

mod args;
mod command;
mod conditions;
mod descent;
mod figures;
mod files;
mod outcome;
mod part;
mod round;
mod seamed;
mod sheet;
mod vertex_values;

pub use args::{FlattenArgs, HELP};
pub use descent::distortion;
pub use part::named_vertices;
