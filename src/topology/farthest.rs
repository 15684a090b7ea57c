//! Farthest-point sampling along edges, and central vertices.
//!
//! ```
//! use ricci::mesh::{VertexId, shapes};
//! use ricci::{Control, topology::farthest_vertices};
//! let (mesh, lengths) = shapes::flat_torus([0.0, 1.0], 4, 4)?.build()?;
//! let far = farthest_vertices(&mesh, &lengths, VertexId(0), 2, &Control::new())?;
//! assert_eq!(far.len(), 2);
//! # Ok::<(), ricci::Error>(())
//! ```

use super::check_vertex;
use super::spanning::{Forest, OutgoingEdges};
use crate::control::Control;
use crate::error::Result;
use crate::mesh::{HalfedgeId, Mesh, PerEdge, PerVertex, VertexId};

/// `count` vertices (at most V): `first`, then repeatedly the vertex that is farthest along edges from those chosen (of equal ones the
/// lowest index). Deterministic; O(count · E log V).
///
/// # Errors
///
/// As [`super::shortest_paths`].
pub fn farthest_vertices(
    mesh: &Mesh,
    lengths: &PerEdge<f64>,
    first: VertexId,
    count: usize,
    control: &Control,
) -> Result<Vec<VertexId>> {
    check_vertex(mesh, first)?;
    let outgoing = OutgoingEdges::new(mesh, lengths)?;
    let mut chosen = Vec::new();
    let mut next = first;
    while chosen.len() < count.min(mesh.n_vertices()) {
        chosen.push(next);
        let distance = outgoing.shortest_paths(&chosen, control)?.distance;
        next = farthest(mesh, &distance, VertexId(0));
    }
    Ok(chosen)
}

/// The vertex with the largest distance; of equal ones `start` if it is among them, else the one of lowest index.
pub(super) fn farthest(mesh: &Mesh, distance: &PerVertex<f64>, start: VertexId) -> VertexId {
    mesh.vertices().fold(start, |far, v| if distance[v] > distance[far] { v } else { far })
}

/// Most moves of the search for a central vertex. On the closed meshes of the corpus the distance changes little after three.
const MAX_MOVES: usize = 6;

/// A vertex from which no other is far along edges. The search moves to the middle of the path to the farthest vertex as long as that
/// makes the largest distance smaller. Deterministic; O(E log V).
///
/// # Errors
///
/// As [`super::shortest_paths`].
pub fn central_vertex(mesh: &Mesh, lengths: &PerEdge<f64>, control: &Control) -> Result<VertexId> {
    central(mesh, lengths, control).map(|(v, _)| v)
}

/// [`central_vertex`], and the distance along edges from it to each vertex.
pub(super) fn central(
    mesh: &Mesh,
    lengths: &PerEdge<f64>,
    control: &Control,
) -> Result<(VertexId, PerVertex<f64>)> {
    let outgoing = OutgoingEdges::new(mesh, lengths)?;
    let search = |at: VertexId| -> Result<_> {
        let forest = outgoing.shortest_paths(&[at], control)?;
        let far = farthest(mesh, &forest.distance, at);
        Ok((at, far, forest))
    };
    let mut best = search(VertexId(0))?;
    for _ in 1..MAX_MOVES {
        let (_, far, Forest { distance, parent }) = &best;
        let before = |v: VertexId| parent[v].map(|h: HalfedgeId| mesh.origin(h));
        let path = std::iter::successors(Some(*far), |&v| before(v));
        let off = |v: VertexId| (distance[v] - 0.5 * distance[*far]).abs();
        let middle = path.fold(*far, |middle, v| if off(v) < off(middle) { v } else { middle });
        let next = search(middle)?;
        if next.2.distance[next.1] >= distance[*far] {
            break;
        }
        best = next;
    }
    let (centre, _, Forest { distance, .. }) = best;
    Ok((centre, distance))
}
