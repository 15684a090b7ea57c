//! The vertices of a surface opened along a cut, as numbers of corners.

use crate::mesh::{HalfedgeId, Mesh, PerEdge, PerHalfedge};

/// Numbers the vertices of the opened surface: corners around a vertex with no cut or boundary edge between them have the same number.
/// Returns the number for each half-edge (of the corner at its origin), and how many numbers there are.
///
/// Numbers follow the first corner in face order. A half-edge outside the surface has the number of the
/// corner at its origin in the face across the edge.
pub(crate) fn number_corners(mesh: &Mesh, is_cut: &PerEdge<bool>) -> (PerHalfedge<u32>, usize) {
    const UNSET: u32 = u32::MAX;
    let mut number = PerHalfedge::filled(mesh.n_halfedges(), UNSET);
    let mut n = 0;
    // The neighbouring outgoing half-edge at the same origin, unless an open edge lies between.
    let clockwise = |h: HalfedgeId| {
        let across = h.twin();
        (!is_cut[h.edge()] && !mesh.is_outside(across)).then(|| mesh.next(across))
    };
    let counterclockwise = |h: HalfedgeId| {
        let across = mesh.prev(h).twin();
        (!is_cut[across.edge()] && !mesh.is_outside(across)).then_some(across)
    };
    for corner in mesh.faces().flat_map(|f| mesh.face_halfedges(f)) {
        if number[corner] != UNSET {
            continue;
        }
        number[corner] = n;
        let mut at = clockwise(corner);
        while let Some(h) = at.filter(|&h| number[h] != n) {
            number[h] = n;
            at = clockwise(h);
        }
        let mut at = counterclockwise(corner);
        while let Some(h) = at.filter(|&h| number[h] != n) {
            number[h] = n;
            at = counterclockwise(h);
        }
        n += 1;
    }
    for h in mesh.halfedges().filter(|&h| mesh.is_outside(h)) {
        number[h] = number[mesh.next(h.twin())];
    }
    (number, n as usize)
}
