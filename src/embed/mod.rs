//! Layouts of metrics: a surface that is opened along a cut and developed into the space of its metric, the isometries between the two
//! sides of each seam, how much the map distorts, and charts that do not overlap.

pub(crate) mod apart;
pub mod border;
mod chart_growth;
pub mod charts;
pub mod circles;
pub mod cover;
pub mod deck;
mod develop;
pub mod dirichlet;
mod domain;
mod element;
mod faces;
mod frame;
pub mod layout;
mod line;
mod moving;
pub mod overlap;
pub mod pack;
mod pieces;
pub mod place;
pub(crate) mod planar;
mod polygon;
pub mod quality;
pub mod shape;
pub mod sides;
pub mod steps;
pub(crate) mod triangle;
pub mod unroll;
mod walk;

pub use border::Border;
pub use charts::{ChartOptions, Charts, charts};
pub use circles::{CirclePattern, VertexCircle};
pub use deck::DeckGroup;
pub use dirichlet::dirichlet_domain;
pub use domain::DirichletDomain;
pub use element::DeckElement;
pub use layout::{Layout, OnInput, Seam};
pub use place::{layout, layout_of};
pub use quality::Quality;
pub use sides::{BoundaryLoop, BoundarySide, boundary_sides};
pub use steps::{Steps, steps};
pub use unroll::{
    About, Scale, Source, UnrollOptions, cones_of, layout_about, refinement_of, unroll, unroll_by,
    unroll_source,
};
