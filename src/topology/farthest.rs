//! Farthest-point sampling along edges.

use super::spanning::shortest_paths;
use crate::mesh::{Mesh, PerEdge, VertexId};

/// `count` vertices (at most V): `first`, then again and again the vertex farthest along edges from those
/// chosen (the smallest index among equals). Deterministic; O(count · E log V).
pub fn farthest_vertices(
    mesh: &Mesh,
    lengths: &PerEdge<f64>,
    first: VertexId,
    count: usize,
) -> Vec<VertexId> {
    let mut chosen = Vec::new();
    let mut next = first;
    while chosen.len() < count.min(mesh.n_vertices()) {
        chosen.push(next);
        let distance = shortest_paths(mesh, lengths, chosen.iter().copied()).distance;
        let farther = |best, v| if distance[v] > distance[best] { v } else { best };
        next = mesh.vertices().fold(VertexId(0), farther);
    }
    chosen
}
