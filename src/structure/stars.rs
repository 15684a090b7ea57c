//! Charts that are the stars of vertices.

use super::draft::Draft;
use super::sheet::Sheet;
use crate::mesh::{HalfedgeId, VertexId};

/// The star of a vertex in the universal cover, the vertex at the origin; none where a face of it is excluded. Two lifts of one face are
/// two faces of it.
pub(super) fn star(sheet: &Sheet, v: VertexId) -> Option<Draft> {
    let mesh = sheet.mesh();
    let corner = |h: HalfedgeId| mesh.corner(h).filter(|(f, _)| !sheet.excluded[*f]);
    // Counterclockwise, on the boundary from the first half-edge of a face on.
    let mut first = mesh.outgoing(v).find(|&h| !mesh.is_outside(h))?;
    if mesh.is_boundary_vertex(v) {
        while !mesh.is_boundary_edge(first.edge()) {
            first = mesh.next(first.twin());
        }
    }
    let (mut draft, mut h) = (Draft::default(), first);
    let (f, k) = corner(h)?;
    let mut here = draft.push(f, sheet.place_about(f, Some(k)));
    loop {
        let across = mesh.prev(h);
        let (_, side) = corner(across)?;
        let next = across.twin();
        if mesh.is_boundary_edge(across.edge()) {
            break;
        }
        let (g, l) = corner(next)?;
        if next == first {
            draft.join((here, side), (0, l));
            break;
        }
        let place = draft.places[here as usize].compose(&sheet.steps.across[across]);
        let there = draft.push(g, place);
        draft.join((here, side), (there, l));
        (here, h) = (there, next);
    }
    draft.finish(sheet);
    Some(draft)
}
