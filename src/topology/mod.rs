//! Spanning trees, homology generators and cut graphs. Everything is walked through half-edges, so loops and
//! repeated edges of a Δ-complex are no special cases.

pub mod cut;
pub mod farthest;
pub mod homology;
pub mod spanning;

pub use cut::{CutGraph, cut_graph};
pub use farthest::farthest_vertices;
pub use homology::homology_generators;
pub use spanning::{Forest, shortest_paths};

use crate::error::{Error, Result, check_size};
use crate::mesh::{Mesh, PerEdge};

/// One finite positive length per edge, or the error that names the first edge without.
pub(crate) fn check_lengths(mesh: &Mesh, lengths: &PerEdge<f64>) -> Result<()> {
    check_size("lengths", lengths.len(), mesh.n_edges())?;
    match lengths.iter().enumerate().find(|(_, l)| !(l.is_finite() && **l > 0.0)) {
        Some((edge, &length)) => Err(Error::EdgeLength { edge, length }),
        None => Ok(()),
    }
}
