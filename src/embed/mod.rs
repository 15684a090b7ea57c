//! Layouts of metrics: a surface that is opened along a cut and developed into the space of its metric, the isometries between the two
//! sides of each seam, how much the map distorts, and charts that do not overlap.

mod bisector_polygon;
pub mod boundary_lift;
mod chart_growth;
pub mod charts;
pub mod circles;
pub mod cover;
mod cover_walk;
pub mod deck;
mod develop;
pub mod dirichlet;
mod domain;
mod edge_lengths;
mod element;
mod face_transitions;
mod faces;
mod frame;
pub mod layout;
mod layout_options;
pub mod lifted_loop;
mod moving;
mod of_planar_domain;
mod of_solution;
mod pieces;
pub mod quality;
mod separate_faces;
pub mod sides;
pub(crate) mod unfold;

pub use boundary_lift::BoundaryLift;
pub use charts::{ChartOptions, Charts, charts};
pub use circles::{CirclePattern, VertexCircle};
pub use deck::DeckGroup;
pub use dirichlet::dirichlet_domain;
pub use domain::DirichletDomain;
pub use element::DeckElement;
pub use face_transitions::FaceTransitions;
pub use layout::{Layout, OnInput, Seam};
pub use layout_options::{CONE_TOLERANCE, LayoutOpening, LayoutOptions, LayoutScale, cones_of};
pub use lifted_loop::LiftedLoop;
pub(crate) use of_planar_domain::PlanarPlaces;
pub(crate) use of_solution::BasedLayout;
pub use quality::Quality;
pub(crate) use separate_faces::SeparateFaces;
pub use sides::{BoundaryLoop, BoundarySide, boundary_sides};
