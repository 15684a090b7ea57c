//! Layouts of metrics: a surface that is opened along a cut and developed into the space of its metric, the isometries between the two
//! sides of each seam, how much the map distorts, and charts that do not overlap.

mod chart_growth;
pub mod charts;

pub mod cover;
pub mod deck;
mod develop;
pub mod dirichlet;
mod faces;
mod frame;
pub mod layout;
pub mod overlap;
pub mod pack;
mod pieces;
pub mod place;
pub(crate) mod planar;
pub mod quality;
pub mod shape;
mod triangle;
pub mod unroll;

pub use charts::{ChartOptions, Charts, charts};
pub use deck::{DeckElement, DeckGroup};
pub use dirichlet::{DirichletDomain, dirichlet_domain};
pub use layout::{Layout, OnInput, Seam};
pub use place::{layout, layout_of};
pub use quality::Quality;
pub use unroll::{Scale, Source, UnrollOptions, cones_of, unroll, unroll_source};
