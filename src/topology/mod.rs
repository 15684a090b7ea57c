//! Spanning trees, homology generators, cut graphs, homotopy bases and lifts to the universal cover.
//!
//! All paths are sequences of half-edges, so that edges which are loops or have the same ends, as in a Δ-complex, need no special
//! treatment. Calls that take long have a [`crate::Control`] and can be cancelled.
//!
//! ```
//! use ricci::mesh::shapes;
//! use ricci::topology::{cut_graph, homotopy_basis, intersection_matrix};
//! use ricci::{Control, topology::cut::is_disk};
//! let (mesh, lengths) = shapes::flat_torus([0.0, 1.0], 4, 4)?.build()?;
//! let control = Control::new();
//! let basis = homotopy_basis(&mesh, &lengths, None, &control)?;
//! assert_eq!(basis.group.names(), ["a1", "b1"]);
//! assert_eq!(intersection_matrix(&mesh, &basis.loops)?, [[0, 1], [-1, 0]]);
//! let cut = cut_graph(&mesh, &lengths, &[], &control)?;
//! assert!(is_disk(&mesh, &cut.is_cut));
//! # Ok::<(), ricci::Error>(())
//! ```

mod brahana;
mod check;
mod corner;
mod corner_walk;
pub mod cut;
pub mod domain;
pub mod farthest;
pub mod group;
mod growing;
mod handle;
pub mod homology;
pub mod homotopy;
pub mod intersection;
pub mod lift;
pub(crate) mod nearest;
mod places;
mod polygon;
pub mod reduction;
mod rooted;
mod shorten;
pub mod spanning;
pub mod word;

pub(crate) use check::{check_lengths, check_path, check_vertex};
use check::{check_loop, corners_along};
pub(crate) use corner::number_corners;
pub(crate) use corner_walk::{corner_walk, crossed_halfedges};
pub(crate) use cut::check_connected;
pub use cut::{CutGraph, cut_graph};
pub use domain::{DomainSide, FundamentalDomain};
pub use farthest::{central_vertex, farthest_vertices};
pub use group::SurfaceGroup;
pub(crate) use growing::{cut_about, cut_about_centre, cut_about_joined};
pub use homology::homology_generators;
pub use homotopy::{HomotopyBasis, homotopy_basis};
pub use intersection::{intersection_matrix, intersection_number};
pub use lift::{Lift, LiftedPath};
pub(crate) use nearest::NearestQueue;
pub use reduction::Reduction;
pub(crate) use spanning::OutgoingEdges;
pub use spanning::{Forest, shortest_paths};
pub use word::{Letter, Word};
