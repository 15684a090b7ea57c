//! Vertices that are evenly spread over a surface, denser where they are wanted denser.

use crate::control::{Control, Stage};
use crate::error::{Result, check_size};
use crate::mesh::shapes::SplitMix64;
use crate::mesh::{Mesh, PerEdge, PerVertex, VertexId};
use std::cmp::{Ordering, Reverse};
use std::collections::BinaryHeap;

/// Seed of the order in which vertices are looked at.
const SEED: u64 = 1;
/// Halvings of the interval in which the distance is looked for.
const HALVINGS: usize = 20;
/// How far the count may be from the one asked for.
const NEAR: f64 = 0.02;

/// About `count` vertices, those of `always` among them: no two of the others are nearer along edges than a common distance times the
/// mean of their `size` (V positive entries, relative).
///
/// # Errors
/// [`crate::Error::Size`]; [`crate::Error::Cancelled`].
pub fn spread_vertices(
    (mesh, lengths): (&Mesh, &PerEdge<f64>),
    size: &PerVertex<f64>,
    always: &[VertexId],
    count: usize,
    control: &Control,
) -> Result<PerVertex<bool>> {
    check_size("sizes", size.len(), mesh.n_vertices())?;
    let mut order: Vec<VertexId> = mesh.vertices().collect();
    let mut random = SplitMix64::new(SEED);
    for i in (1..order.len()).rev() {
        order.swap(i, (random.bits() % (i as u64 + 1)) as usize);
    }
    let order: Vec<VertexId> = always.iter().copied().chain(order).collect();
    let whole: f64 = lengths.iter().sum();
    let (mut low, mut high) = (0.0, whole);
    let mut best = PerVertex::filled(mesh.n_vertices(), true);
    for step in 0..HALVINGS {
        control.step(Stage::Layout, step as f64 / HALVINGS as f64)?;
        // The count falls with the square of the distance, so the first steps are in proportion.
        let distance = if low > 0.0 { 0.5 * (low + high) } else { high * 0.5 };
        let chosen = chosen((mesh, lengths), size, (&order, always.len()), distance);
        let n = chosen.iter().filter(|&&c| c).count();
        if n >= count {
            low = distance;
        } else {
            high = distance;
        }
        best = chosen;
        if (n as f64 - count as f64).abs() <= NEAR * count as f64 {
            break;
        }
    }
    Ok(best)
}

/// A vertex at some distance, nearest first.
#[derive(PartialEq)]
struct At(f64, VertexId);

impl Eq for At {}

impl PartialOrd for At {
    fn partial_cmp(&self, other: &At) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for At {
    fn cmp(&self, other: &At) -> Ordering {
        self.0.total_cmp(&other.0).then(self.1.cmp(&other.1))
    }
}

fn chosen(
    (mesh, lengths): (&Mesh, &PerEdge<f64>),
    size: &PerVertex<f64>,
    (order, always): (&[VertexId], usize),
    distance: f64,
) -> PerVertex<bool> {
    let n = mesh.n_vertices();
    let mut chosen = PerVertex::filled(n, false);
    let mut covered = PerVertex::filled(n, false);
    // The distance from the vertex that is being chosen, and which that was.
    let mut reached = PerVertex::filled(n, (f64::INFINITY, u32::MAX));
    let mut heap = BinaryHeap::new();
    for (i, &v) in order.iter().enumerate() {
        if covered[v] && i >= always {
            continue;
        }
        chosen[v] = true;
        reached[v] = (0.0, v.0);
        heap.push(Reverse(At(0.0, v)));
        while let Some(Reverse(At(d, at))) = heap.pop() {
            if d > reached[at].0 {
                continue;
            }
            covered[at] = true;
            for h in mesh.outgoing(at) {
                let (w, far) = (mesh.tip(h), d + lengths[h.edge()]);
                let is_near = far < distance * 0.5 * (size[v] + size[w]);
                if is_near && !(reached[w].1 == v.0 && reached[w].0 <= far) {
                    reached[w] = (far, v.0);
                    heap.push(Reverse(At(far, w)));
                }
            }
        }
    }
    chosen
}
