//! Layouts of metrics: developing a cut surface, the isometries between the sides of its seams, how much the map distorts, and
//! charts that do not overlap.

mod chart_growth;
pub mod charts;
pub(crate) mod corner;
pub mod cover;
pub mod deck;
pub(crate) mod develop;
pub mod dirichlet;
pub mod layout;
pub mod overlap;
pub mod pack;
pub mod quality;
pub mod refined;
mod refined_develop;
pub mod seam;
mod shape;
mod space_develop;
pub mod space_layout;
mod space_lift;
pub mod space_refined;
pub mod space_refined_develop;
mod triangle;

pub use charts::{ChartOptions, Charts, charts};
pub use deck::{DeckElement, DeckGroup};
pub use dirichlet::{DirichletDomain, dirichlet_domain};
pub use layout::{Layout, layout, layout_of};
pub use quality::{Quality, quality};
pub use refined::{RefinedLayout, layout_refined, refined_cut};
pub use seam::Seam;
pub use space_layout::{SpaceLayout, layout_in_space};
pub use space_refined::{RefinedSpaceLayout, refine_space_layout};
pub use space_refined_develop::{layout_refined_in_space, refined_lengths, unroll_refined_in_space};
