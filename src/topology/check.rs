//! Checks of arguments: elements exist, paths are connected, lengths are in the range of f64 formulas.

use crate::error::{Error, Result, check_size};
use crate::geometry::space::USABLE_LENGTHS;
use crate::mesh::{HalfedgeId, Mesh, PerEdge, VertexId};

/// Checks that a vertex exists.
pub(crate) fn check_vertex(mesh: &Mesh, v: VertexId) -> Result<()> {
    if v.index() < mesh.n_vertices() {
        return Ok(());
    }
    Err(Error::argument("vertex", v, "an existing vertex"))
}

/// Checks that the half-edges exist and that each starts at the end of the one before it.
pub(crate) fn check_path(mesh: &Mesh, path: &[HalfedgeId]) -> Result<()> {
    let known = |h: &HalfedgeId| h.index() < mesh.n_halfedges();
    let wrong = path.iter().find(|h| !known(h)).or_else(|| {
        let broken = path.windows(2).find(|pair| mesh.tip(pair[0]) != mesh.origin(pair[1]));
        broken.map(|pair| &pair[1])
    });
    let need = "each half-edge must exist and start where the one before it ends";
    wrong.map_or(Ok(()), |h| Err(Error::argument(PATH, h, need)))
}

const PATH: &str = "half-edge of a path";

/// The corners at the start and the end of a half-edge, as half-edges of its face; for a half-edge outside the surface, of the face of
/// its twin.
pub(super) fn corners_along(mesh: &Mesh, h: HalfedgeId) -> [HalfedgeId; 2] {
    if mesh.is_outside(h) { [mesh.next(h.twin()), h.twin()] } else { [h, mesh.next(h)] }
}

/// Checks that a path ends at its start.
pub(super) fn check_loop(mesh: &Mesh, path: &[HalfedgeId]) -> Result<()> {
    check_path(mesh, path)?;
    match (path.first(), path.last()) {
        (Some(&first), Some(&last)) if mesh.tip(last) != mesh.origin(first) => {
            Err(Error::argument(PATH, last, "the last half-edge must end where the first one starts"))
        }
        _ => Ok(()),
    }
}

/// Checks that there is one length per edge, each within [`USABLE_LENGTHS`]; the error names the first edge with another length.
pub(crate) fn check_lengths(mesh: &Mesh, lengths: &PerEdge<f64>) -> Result<()> {
    check_size("lengths", lengths.len(), mesh.n_edges())?;
    match lengths.iter().enumerate().find(|(_, l)| !USABLE_LENGTHS.contains(*l)) {
        Some((edge, &length)) => Err(Error::EdgeLength { edge, length }),
        None => Ok(()),
    }
}
