//! Layouts of metrics: developing a cut surface, the isometries between the sides of its seams, and how much
//! the map distorts.

mod corner;
mod develop;
pub mod layout;
pub mod quality;
pub mod seam;
mod triangle;

pub use layout::{Layout, layout, layout_of};
pub use quality::{Quality, quality};
pub use seam::Seam;
