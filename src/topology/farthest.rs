//! Farthest-point sampling along edges.

use crate::mesh::{Mesh, PerEdge, VertexId};
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// `count` vertices (at most V): `first`, then again and again the vertex farthest along edges from those chosen
/// (the smallest index among equals). Deterministic; O(count · V log V).
pub fn farthest_vertices(
    mesh: &Mesh,
    lengths: &PerEdge<f64>,
    first: VertexId,
    count: usize,
) -> Vec<VertexId> {
    let mut distance = vec![f64::INFINITY; mesh.n_vertices()];
    let mut chosen = Vec::new();
    let mut next = first;
    while chosen.len() < count.min(mesh.n_vertices()) {
        chosen.push(next);
        lower_distances(mesh, lengths, next, &mut distance);
        let farther = |best: usize, v: usize| if distance[v] > distance[best] { v } else { best };
        next = VertexId::from((0..mesh.n_vertices()).fold(0, farther));
    }
    chosen
}

/// Dijkstra from one more source: lower `distance` where the new source is nearer.
fn lower_distances(mesh: &Mesh, lengths: &PerEdge<f64>, source: VertexId, distance: &mut [f64]) {
    distance[source.index()] = 0.0;
    // Non-negative doubles order like their bits.
    let mut queue = BinaryHeap::from([(Reverse(0u64), Reverse(source))]);
    while let Some((Reverse(bits), Reverse(v))) = queue.pop() {
        let here = f64::from_bits(bits);
        if here > distance[v.index()] {
            continue;
        }
        for h in mesh.outgoing(v) {
            let (tip, there) = (mesh.tip(h), here + lengths[h.edge()]);
            if there < distance[tip.index()] {
                distance[tip.index()] = there;
                queue.push((Reverse(there.to_bits()), Reverse(tip)));
            }
        }
    }
}
