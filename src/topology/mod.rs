//! Spanning trees, homology generators, cut graphs, homotopy bases and lifts to the universal cover.
//! Everything is walked through half-edges, so loops and repeated edges of a Δ-complex are no special cases.
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
mod places;
mod polygon;
pub mod reduction;
mod rooted;
mod shorten;
pub mod spanning;
pub mod word;

pub(crate) use corner_walk::{corner_walk, crossed_halfedges};
pub use cut::{CutGraph, cut_graph};
pub use domain::{FundamentalDomain, Side};
pub use farthest::{central_vertex, farthest_vertices};
pub use group::SurfaceGroup;
pub(crate) use growing::cut_about;
pub use homology::homology_generators;
pub use homotopy::{HomotopyBasis, homotopy_basis};
pub use intersection::{intersection_matrix, intersection_number};
pub use lift::{Lift, LiftedPath};
pub use reduction::Reduction;
pub use spanning::{Forest, shortest_paths};
pub use word::{Letter, Word};

use crate::error::{Error, Result, check_size};
use crate::geometry::space::USABLE_LENGTHS;
use crate::mesh::{HalfedgeId, Mesh, PerEdge, VertexId};

/// The vertex exists.
pub(crate) fn check_vertex(mesh: &Mesh, v: VertexId) -> Result<()> {
    if v.index() < mesh.n_vertices() {
        return Ok(());
    }
    Err(Error::Argument { what: "vertex", value: v.to_string(), need: "an existing vertex" })
}

/// The half-edges exist and each starts where the one before it ends.
pub(crate) fn check_path(mesh: &Mesh, path: &[HalfedgeId]) -> Result<()> {
    let known = |h: &HalfedgeId| h.index() < mesh.n_halfedges();
    let wrong = path.iter().find(|h| !known(h)).or_else(|| {
        let broken = path.windows(2).find(|pair| mesh.tip(pair[0]) != mesh.origin(pair[1]));
        broken.map(|pair| &pair[1])
    });
    wrong.map_or(Ok(()), |&h| {
        Err(bad_path(h, "each half-edge must exist and start where the one before it ends"))
    })
}

/// The corners at the start and the end of a half-edge, as half-edges of its face; outside the surface, of the face of its twin.
fn corners_along(mesh: &Mesh, h: HalfedgeId) -> [HalfedgeId; 2] {
    match mesh.is_outside(h) {
        false => [h, mesh.next(h)],
        true => [mesh.next(h.twin()), h.twin()],
    }
}

/// The surface is connected and not empty; `advice` says what to do with one that is not.
fn check_connected(mesh: &Mesh, advice: &str) -> Result<()> {
    if cut::is_connected(mesh, |_| false) {
        return Ok(());
    }
    Err(Error::Layout(format!("the surface is empty or has several components: {advice} each alone")))
}

/// A path that ends where it starts.
fn check_loop(mesh: &Mesh, path: &[HalfedgeId]) -> Result<()> {
    check_path(mesh, path)?;
    match (path.first(), path.last()) {
        (Some(&first), Some(&last)) if mesh.tip(last) != mesh.origin(first) => {
            Err(bad_path(last, "the last half-edge must end where the first one starts"))
        }
        _ => Ok(()),
    }
}

fn bad_path(h: HalfedgeId, need: &'static str) -> Error {
    Error::Argument { what: "half-edge of a path", value: h.to_string(), need }
}

/// One positive length per edge, neither too small nor too large for doubles, or the error that names the
/// first edge without.
pub(crate) fn check_lengths(mesh: &Mesh, lengths: &PerEdge<f64>) -> Result<()> {
    check_size("lengths", lengths.len(), mesh.n_edges())?;
    match lengths.iter().enumerate().find(|(_, l)| !USABLE_LENGTHS.contains(*l)) {
        Some((edge, &length)) => Err(Error::EdgeLength { edge, length }),
        None => Ok(()),
    }
}
