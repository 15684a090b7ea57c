//! Quad meshes of seamless maps: T-meshes by motorcycle graphs, whole numbers for their arcs, integer-grid maps, and layouts of four-sided
//! patches.

mod arc_graph;
mod balance;
mod coarsening;
mod collapse;
mod descent;
mod embedded_squares;
mod from_seamless;
mod grid_charts;
mod grid_complex;
mod grid_distortion;
mod grid_lines;
mod grid_map;
mod grid_places;
mod grid_surface;
mod grid_vector;
mod line_heading;
mod motorcycle_graph;
mod options;
mod quad_division;
mod quad_figures;
mod quad_halfedges;
mod quad_layout;
mod quad_mesh;
mod quantisation;
mod reached;
mod relaxation;
mod separation;
mod t_mesh;
mod t_mesh_node;
mod walk_search;

pub use from_seamless::{quad_layout, quad_mesh};
pub use options::{QuadOptions, QuadSize};
pub use quad_figures::{QuadDistance, QuadShape, QuadTopology};
#[cfg(feature = "splines")]
pub(crate) use quad_layout::QuadPatches;
pub use quad_layout::{LayoutArc, LayoutNode, LayoutPatch, QuadLayout};
pub use quad_mesh::QuadMesh;
