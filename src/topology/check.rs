//! What is checked of arguments: elements that exist, paths that are connected, lengths that doubles can work with.

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
pub(super) fn corners_along(mesh: &Mesh, h: HalfedgeId) -> [HalfedgeId; 2] {
    match mesh.is_outside(h) {
        false => [h, mesh.next(h)],
        true => [mesh.next(h.twin()), h.twin()],
    }
}

/// A path that ends where it starts.
pub(super) fn check_loop(mesh: &Mesh, path: &[HalfedgeId]) -> Result<()> {
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
