//! Edge paths from corner to corner of an opened surface, and the half-edges through which such a path leaves faces.

use super::{check_path, corners_along};
use crate::error::{Error, Result};
use crate::mesh::{HalfedgeId, Mesh};

/// A walk along an edge path through corners (half-edges of faces, each standing for the corner at its origin). See [`corner_walk`].
pub(crate) struct CornerWalk<'a> {
    mesh: &'a Mesh,
    at: HalfedgeId,
    path: &'a [HalfedgeId],
}

/// Walks along an edge path from the corner at the origin of `corner`, a half-edge of a face. Every step turns about the vertex to a side
/// of the next edge, and follows that side to its corner at the edge's end.
///
/// # Errors
///
/// [`Error::Argument`] for half-edges that form no path, or a path that does not start at that corner.
pub(crate) fn corner_walk<'a>(
    mesh: &'a Mesh,
    corner: HalfedgeId,
    path: &'a [HalfedgeId],
) -> Result<CornerWalk<'a>> {
    check_path(mesh, path)?;
    let starts =
        |h: HalfedgeId| !mesh.is_outside(h) && path.first().is_none_or(|&p| mesh.origin(p) == mesh.origin(h));
    if corner.index() >= mesh.n_halfedges() || !starts(corner) {
        let need = "take a half-edge of a face at the vertex where the path starts";
        return Err(Error::argument("corner", format!("half-edge {corner}"), need));
    }
    Ok(CornerWalk { mesh, at: corner, path })
}

/// The half-edges crossed by turning about a vertex from one of its corners to another: counterclockwise, unless the boundary is in the
/// way.
fn turn(mesh: &Mesh, from: HalfedgeId, to: HalfedgeId) -> Vec<HalfedgeId> {
    let (mut h, mut crossed) = (from, Vec::new());
    while h != to && !mesh.is_boundary_edge(mesh.prev(h).edge()) {
        crossed.push(mesh.prev(h));
        h = mesh.prev(h).twin();
    }
    if h == to {
        return crossed;
    }
    crossed.clear();
    h = from;
    while h != to && !mesh.is_boundary_edge(h.edge()) {
        crossed.push(h);
        h = mesh.next(h.twin());
    }
    crossed
}

/// All half-edges that such a walk crosses. On a closed path the last turn, back to `corner`, counts too.
///
/// # Errors
///
/// As [`corner_walk`].
pub(crate) fn crossed_halfedges(
    mesh: &Mesh,
    corner: HalfedgeId,
    path: &[HalfedgeId],
) -> Result<Vec<HalfedgeId>> {
    let (mut at, mut crossed) = (corner, Vec::new());
    for (turned, next) in corner_walk(mesh, corner, path)? {
        crossed.extend(turned);
        at = next;
    }
    if mesh.origin(at) == mesh.origin(corner) {
        crossed.extend(turn(mesh, at, corner));
    }
    Ok(crossed)
}

impl Iterator for CornerWalk<'_> {
    /// The half-edges crossed in a turn, and the corner at the end of the next edge.
    type Item = (Vec<HalfedgeId>, HalfedgeId);

    fn next(&mut self) -> Option<Self::Item> {
        let (&h, rest) = self.path.split_first()?;
        let [from, to] = corners_along(self.mesh, h);
        let crossed = turn(self.mesh, self.at, from);
        (self.at, self.path) = (to, rest);
        Some((crossed, to))
    }
}
