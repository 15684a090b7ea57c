//! Farthest-point sampling along edges.

use super::check_vertex;
use super::spanning::shortest_paths;
use crate::error::Result;
use crate::mesh::{Mesh, PerEdge, VertexId};

/// `count` vertices (at most V): `first`, then again and again the vertex farthest along edges from those
/// chosen (the smallest index among equals). Deterministic; O(count · E log V). Errors: as
/// [`shortest_paths`].
pub fn farthest_vertices(
    mesh: &Mesh,
    lengths: &PerEdge<f64>,
    first: VertexId,
    count: usize,
) -> Result<Vec<VertexId>> {
    check_vertex(mesh, first)?;
    let mut chosen = Vec::new();
    let mut next = first;
    while chosen.len() < count.min(mesh.n_vertices()) {
        chosen.push(next);
        let distance = shortest_paths(mesh, lengths, chosen.iter().copied())?.distance;
        let farther = |best, v| if distance[v] > distance[best] { v } else { best };
        next = mesh.vertices().fold(VertexId(0), farther);
    }
    Ok(chosen)
}
