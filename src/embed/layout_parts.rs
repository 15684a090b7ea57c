//! The parts of a layout in archives, and a check that those that were read fit each other.

use super::layout::Layout;
use crate::archive::{in_range, invalid, stored};
use crate::error::{Result, check_size};
use crate::mesh::{HalfedgeId, Mesh};
use crate::topology::CutGraph;

stored!(sections Layout { space, cut, corner_index, points, coordinates, seams, flipped, degenerate, broken,
    disagreement, local_consistency, radius, diameter, area, scale, remainders, pieces, input, side,
    n_steps, frames, patch } check check_parts);

/// Checks that a cut is one of this mesh.
fn check_cut(cut: &CutGraph, mesh: &Mesh) -> Result<()> {
    check_size("cut edges", cut.is_cut.len(), mesh.n_edges())?;
    in_range("node of the cut", cut.nodes.iter().map(|v| v.index()), mesh.n_vertices())?;
    in_range("edge of the cut", cut.segments.iter().flatten().map(|h| h.index()), mesh.n_halfedges())
}

/// Checks that the arrays of a layout fit each other.
fn check_parts(layout: &Layout) -> Result<()> {
    let (mesh, n_points) = (layout.mesh(), layout.points.len());
    check_cut(&layout.cut, mesh)?;
    check_size("corners", layout.corner_index.len(), mesh.n_halfedges())?;
    let inside = mesh.halfedges().filter(|&h: &HalfedgeId| !mesh.is_outside(h));
    in_range("point of a corner", inside.map(|h| layout.corner_index[h] as usize), n_points)?;
    check_size("coordinates", layout.coordinates.len(), n_points)?;
    check_size("seams", layout.seams.len(), layout.cut.segments.len())?;
    let named = layout.flipped.iter().chain(&layout.degenerate).chain(&layout.broken);
    in_range("face", named.map(|f| f.index()), mesh.n_faces())?;
    if !layout.remainders.is_empty() {
        check_size("remainders", layout.remainders.len(), n_points)?;
    }
    check_size("sides of seams", layout.side.len(), mesh.n_halfedges())?;
    in_range("seam", layout.side.iter().map(|k| k.unsigned_abs() as usize), layout.seams.len() + 1)?;
    if !layout.frames.is_empty() {
        check_size("frames of faces", layout.patch.len(), mesh.n_faces())?;
        in_range("frame", layout.patch.iter().map(|&k| k as usize), layout.frames.len())?;
    }
    let Some((input, cut)) = &layout.input else { return Ok(()) };
    check_cut(cut, input)?;
    match layout.common_subdivision() {
        Some(subdivision) => {
            in_range("face", subdivision.faces[0].iter().map(|f| f.index()), input.n_faces())
        }
        None if input.n_halfedges() == mesh.n_halfedges() => Ok(()),
        None => Err(invalid("surface of a layout", "the mesh that is laid out")),
    }
}
