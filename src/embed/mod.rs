//! Layouts of metrics: developing a cut surface, the isometries between the sides of its seams, and how much
//! the map distorts.

mod corner;
mod develop;
pub mod layout;
pub mod quality;
pub mod refined;
mod refined_develop;
pub mod seam;
mod triangle;

pub use layout::{Layout, layout, layout_of};
pub use quality::{Quality, quality};
pub use refined::{RefinedLayout, layout_refined, refined_cut};
pub use seam::Seam;
