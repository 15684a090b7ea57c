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
use crate::mesh::{Mesh, PerEdge, VertexId};

/// Lengths outside this range are refused: their squares would leave the range of doubles.
const LENGTHS: std::ops::RangeInclusive<f64> = 1e-150..=1e150;

/// The vertex exists.
pub(crate) fn check_vertex(mesh: &Mesh, v: VertexId) -> Result<()> {
    if v.index() < mesh.n_vertices() {
        return Ok(());
    }
    Err(Error::Argument { what: "vertex", value: v.to_string(), need: "an existing vertex" })
}

/// One positive length per edge, neither too small nor too large for doubles, or the error that names the first edge without.
pub(crate) fn check_lengths(mesh: &Mesh, lengths: &PerEdge<f64>) -> Result<()> {
    check_size("lengths", lengths.len(), mesh.n_edges())?;
    match lengths.iter().enumerate().find(|(_, l)| !LENGTHS.contains(*l)) {
        Some((edge, &length)) => Err(Error::EdgeLength { edge, length }),
        None => Ok(()),
    }
}
