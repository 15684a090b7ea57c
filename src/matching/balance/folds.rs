//! Folds of a triangulation in its domain, which are opened by moving few vertices.
//!
//! The canonical metric is found on a triangulation with flipped edges. The faces of the surface itself, drawn with straight sides, may
//! fold where edges were flipped.

use super::solve::balance;
use super::springs::{Springs, VertexFreedom};
use crate::control::Control;
use crate::error::{Error, Result};
use crate::matching::cover::PlacedMesh;
use crate::mesh::{FaceId, PerHalfedge, PerVertex, VertexId};

/// Most rounds; the number of rings of faces around a fold that may move doubles with each.
const MOST_ROUNDS: usize = 9;

/// Puts the vertices around folded faces at the means of their neighbours by positive weights until no face is folded: first those of the
/// faces alone, then more and more rings around them. The vertices `held` stay. Returns the number of vertices that were moved.
///
/// # Errors
/// [`Error::Matching`] if folds remain; those of [`balance`].
pub(crate) fn unfold(
    placed: &mut PlacedMesh,
    weights: &PerHalfedge<f64>,
    held: &[VertexId],
    control: &Control,
) -> Result<usize> {
    let mesh = placed.cover.mesh.clone();
    let mut moved = vec![false; mesh.n_vertices()];
    let mut rings = 1;
    for _ in 0..MOST_ROUNDS {
        control.check()?;
        let folded = placed.flipped();
        if folded.is_empty() {
            return Ok(moved.iter().filter(|m| **m).count());
        }
        let is_free = around(placed, &folded, rings);
        let freedom = PerVertex::from_fn(mesh.n_vertices(), |v: VertexId| {
            if is_free[v] && !mesh.is_boundary_vertex(v) && !held.contains(&v) {
                VertexFreedom::Free
            } else {
                VertexFreedom::Held
            }
        });
        let before = placed.clone();
        match balance(placed, Springs { weights, freedom: &freedom }, control) {
            Ok(_) => {}
            Err(Error::Cancelled) => return Err(Error::Cancelled),
            // The vertices of a large part of a sphere have no mean: they stay where they were, and the next round is larger.
            Err(_) => *placed = before,
        }
        mesh.vertices().filter(|&v| freedom[v] == VertexFreedom::Free).for_each(|v| moved[v.index()] = true);
        rings *= 2;
    }
    let folded = placed.flipped();
    match folded.first() {
        None => Ok(moved.iter().filter(|m| **m).count()),
        Some(f) => Err(Error::Matching(format!(
            "{} faces fold in the canonical domain and could not be opened, the first face {f}: refine the surface (`ricci refine --edge L`)",
            folded.len()
        ))),
    }
}

/// True for the vertices of these faces and of this number of rings around them.
pub(crate) fn around(placed: &PlacedMesh, faces: &[FaceId], rings: usize) -> PerVertex<bool> {
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
