//! Folds of a triangulation in its domain, opened by moving few vertices.
//!
//! A surface in its canonical shape is triangulated with flipped edges. Its own faces, drawn straight, may fold where edges were flipped.

use super::balance::{Freedom, balance};
use super::cover::Placed;
use crate::control::Control;
use crate::error::{Error, Result};
use crate::mesh::{FaceId, PerHalfedge, PerVertex, VertexId};

/// Rings of faces around a fold that may move, round by round; each twice the last.
const MOST_ROUNDS: usize = 9;

/// Puts the vertices around folded faces at the means of their neighbours by positive weights, first those of the faces alone, then more
/// and more rings, until no face is folded; those that are held stay. The number of vertices that were moved.
///
/// # Errors
/// [`Error::Matching`] where folds stay; those of [`balance`].
pub(super) fn unfold(
    placed: &mut Placed,
    weights: &PerHalfedge<f64>,
    held: &[VertexId],
    control: &Control,
) -> Result<usize> {
    let mesh = placed.cover.mesh.clone();
    let mut moved = vec![false; mesh.n_vertices()];
    let mut rings = 1;
    for _ in 0..MOST_ROUNDS {
        let folded = placed.flipped();
        if folded.is_empty() {
            return Ok(moved.iter().filter(|m| **m).count());
        }
        let is_free = around(placed, &folded, rings);
        let freedom = PerVertex::from_fn(mesh.n_vertices(), |v: VertexId| {
            if is_free[v] && !mesh.is_boundary_vertex(v) && !held.contains(&v) {
                Freedom::Free
            } else {
                Freedom::Held
            }
        });
        let before = placed.clone();
        match balance(placed, weights, &freedom, control) {
            Ok(_) => {}
            Err(Error::Cancelled) => return Err(Error::Cancelled),
            // A part of a sphere that is too large to be drawn together has no mean: what it was stays, and the next round is larger.
            Err(_) => *placed = before,
        }
        mesh.vertices().filter(|&v| freedom[v] == Freedom::Free).for_each(|v| moved[v.index()] = true);
        rings *= 2;
    }
    let folded = placed.flipped();
    match folded.first() {
        None => Ok(moved.iter().filter(|m| **m).count()),
        Some(f) => Err(Error::Matching(format!(
            "{} faces fold in the canonical domain and could not be opened, the first face {f}: refine the surface there",
            folded.len()
        ))),
    }
}

/// The vertices of some faces and of so many rings around them.
pub(super) fn around(placed: &Placed, faces: &[FaceId], rings: usize) -> PerVertex<bool> {
    let mesh = &placed.cover.mesh;
    let mut inside = PerVertex::filled(mesh.n_vertices(), false);
    let mut last: Vec<VertexId> = Vec::new();
    for v in faces.iter().flat_map(|&f| mesh.face_vertices(f)) {
        if !std::mem::replace(&mut inside[v], true) {
            last.push(v);
        }
    }
    for _ in 1..rings {
        let mut next = Vec::new();
        for v in last.drain(..) {
            for h in mesh.outgoing(v) {
                let tip = mesh.tip(h);
                if !std::mem::replace(&mut inside[tip], true) {
                    next.push(tip);
                }
            }
        }
        last = next;
    }
    inside
}
