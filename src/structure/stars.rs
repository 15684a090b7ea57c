//! The charts that are stars of vertices.

use super::developable::DevelopableSurface;
use super::draft::ChartDraft;
use crate::mesh::{HalfedgeId, VertexId};

/// The star of a vertex in the universal cover, with the vertex at the origin; none if a face of it is excluded. A face that the star meets
/// twice is there twice.
pub(super) fn star(surface: &DevelopableSurface, v: VertexId) -> Option<ChartDraft> {
    let mesh = surface.mesh();
    let corner = |h: HalfedgeId| mesh.corner(h).filter(|(f, _)| !surface.excluded[*f]);
    // Counterclockwise; on the boundary from the first half-edge that belongs to a face.
    let mut first = mesh.outgoing(v).find(|&h| !mesh.is_outside(h))?;
    if mesh.is_boundary_vertex(v) {
        while !mesh.is_boundary_edge(first.edge()) {
            first = mesh.next(first.twin());
        }
    }
    let (mut draft, mut h) = (ChartDraft::default(), first);
    let (f, k) = corner(h)?;
    let mut here = draft.push(f, surface.place_about(f, Some(k)));
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
        let place = draft.places[here as usize].compose(&surface.faces.across[across]);
        let there = draft.push(g, place);
        draft.join((here, side), (there, l));
        (here, h) = (there, next);
    }
    draft.finish(surface);
    Some(draft)
}
