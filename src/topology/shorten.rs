//! Shortening of edge paths by pulling them across triangles.

use crate::control::Control;
use crate::error::Result;
use crate::mesh::{HalfedgeId, Mesh, PerEdge};

/// The share of the length it replaces that a move of a path or a cut must save. It is far above the rounding of a sum of lengths, so
/// that no sequence of moves returns to an earlier state.
pub(super) const LEAST_SAVING: f64 = 1e-12;

/// Most moves of one path or cut, per face of the mesh; removing a spur does not count. Paths and cuts made of shortest paths need far
/// fewer moves; the bound keeps the worst case linear.
pub(super) const MOVES_PER_FACE: usize = 8;

/// Half-edges of a path that are processed between two checks of the control: they take a fraction of a millisecond.
const STEPS_PER_CHECK: usize = 4096;

/// A path with the same ends, homotopic to `path` and no longer.
///
/// ```text
///      x1 --- x2         Two successive edges u → v → w give way to the edges opposite v on their left or right,
///     / \    / \         where faces fill that side, if these are shorter: the path is swept across the faces.
///    /   \  /   \        A spur, u = w by the same edge, has no face on one side and goes.
///   u ---- v --- w
/// ```
///
/// At the end no vertex of the path allows another move: every vertex is visited again after its edges have changed. A path may pass a
/// vertex or an edge several times.
pub(super) fn shorten(
    mesh: &Mesh,
    lengths: &PerEdge<f64>,
    path: impl DoubleEndedIterator<Item = HalfedgeId>,
    control: &Control,
) -> Result<Vec<HalfedgeId>> {
    let mut ahead: Vec<_> = path.rev().collect();
    let mut behind: Vec<HalfedgeId> = Vec::new();
    let mut budget = MOVES_PER_FACE * mesh.n_faces();
    let mut steps = 0;
    while let Some(leave) = ahead.pop() {
        control.check_every(STEPS_PER_CHECK, &mut steps)?;
        match behind.last() {
            Some(&enter) if enter == leave.twin() => drop(behind.pop()),
            Some(&enter) if budget > 0 => match shorter_side(mesh, lengths, enter, leave) {
                Some(way) => {
                    budget -= 1;
                    behind.pop();
                    ahead.extend(way.into_iter().rev());
                }
                None => behind.push(leave),
            },
            _ => behind.push(leave),
        }
    }
    Ok(behind)
}

/// The shorter of the two paths around the vertex between two edges, if it is shorter than they are.
fn shorter_side(
    mesh: &Mesh,
    lengths: &PerEdge<f64>,
    enter: HalfedgeId,
    leave: HalfedgeId,
) -> Option<Vec<HalfedgeId>> {
    let old = lengths[enter.edge()] + lengths[leave.edge()];
    let limit = old * (1.0 - LEAST_SAVING);
    let right = fan(mesh, lengths, [enter.twin(), leave], limit);
    let limit = right.as_ref().map_or(limit, |&(_, length)| length);
    match fan(mesh, lengths, [leave, enter.twin()], limit) {
        Some((left, _)) => Some(left.into_iter().rev().map(HalfedgeId::twin).collect()),
        None => right.map(|(way, _)| way),
    }
}

/// The edges opposite the origin of `from` in the fan counterclockwise from it to `to`, with their length;
/// `None` if that reaches `limit` or the fan leaves the surface.
pub(super) fn fan(
    mesh: &Mesh,
    lengths: &PerEdge<f64>,
    [from, to]: [HalfedgeId; 2],
    limit: f64,
) -> Option<(Vec<HalfedgeId>, f64)> {
    let (mut way, mut length, mut h) = (Vec::new(), 0.0, from);
    while h != to {
        if mesh.is_outside(h) {
            return None;
        }
        let opposite = mesh.next(h);
        length += lengths[opposite.edge()];
        if length >= limit {
            return None;
        }
        way.push(opposite);
        h = mesh.prev(h).twin();
    }
    Some((way, length))
}

/// The length of an edge path.
pub(super) fn path_length(lengths: &PerEdge<f64>, path: &[HalfedgeId]) -> f64 {
    path.iter().fold(0.0, |sum, h| sum + lengths[h.edge()])
}
