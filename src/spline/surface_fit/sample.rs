//! Vertices spread over a surface at prescribed distances.

use crate::control::{Control, Stage};
use crate::error::Result;
use crate::mesh::shapes::SplitMix64;
use crate::mesh::{Mesh, PerEdge, PerVertex, VertexId};
use std::cmp::{Ordering, Reverse};
use std::collections::BinaryHeap;

/// Halvings of the interval that holds the factor of the distances.
const HALVINGS: usize = 24;
/// Share by which the number of vertices may be less than asked for.
const NEAR: f64 = 0.02;

/// The vertices that may be taken, and their distances.
pub(super) struct VertexSampling<'a> {
    pub mesh: &'a Mesh,
    /// The seed of the order in which vertices are considered.
    pub seed: u64,
    pub lengths: &'a PerEdge<f64>,
    /// The distances of a vertex from its neighbours, up to a common factor; infinite where only the growth limits them.
    pub sizes: PerVertex<f64>,
    /// The largest growth of this distance per length: with 1, the triangles between neighbours stay fat.
    pub growth: f64,
    /// The vertices that are taken at any distance.
    pub always: &'a [VertexId],
    /// True for the other vertices that may be taken.
    pub allowed: PerVertex<bool>,
}

impl VertexSampling<'_> {
    /// Chooses up to `count` vertices, and at most 2 % less. Along edges, no two of them are nearer than the mean of their sizes times one
    /// common factor, except for those that are always taken.
    ///
    /// # Errors
    /// [`crate::Error::Cancelled`].
    pub fn spread(&self, count: usize, control: &Control) -> Result<PerVertex<bool>> {
        let mesh = self.mesh;
        let mut order: Vec<VertexId> = mesh.vertices().filter(|&v| self.allowed[v]).collect();
        let mut random = SplitMix64::new(self.seed);
        for i in (1..order.len()).rev() {
            order.swap(i, (random.bits() % (i as u64 + 1)) as usize);
        }
        // The boundary comes first: an inner vertex near it would make a thin triangle.
        order.sort_by_key(|&v| !mesh.is_boundary_vertex(v));
        // Sizes and lengths range over decades, so the factor is bisected on a logarithmic scale.
        let finite = self.sizes.iter().copied().filter(|size| size.is_finite());
        let [least, most] = extent(finite);
        let shortest = extent(self.lengths.iter().copied())[0];
        let (mut low, mut high) = (shortest / most, self.lengths.iter().sum::<f64>() / least);
        let mut best = PerVertex::filled(mesh.n_vertices(), false);
        self.always.iter().for_each(|&v| best[v] = true);
        let mut found = 0;
        for step in 0..HALVINGS {
            control.step(Stage::Layout, step as f64 / HALVINGS as f64)?;
            let factor = (low * high).sqrt();
            let chosen = self.chosen(&order, &self.distances(factor));
            let n = chosen.iter().filter(|&&c| c).count();
            if n > count {
                low = factor;
                continue;
            }
            high = factor;
            if n > found {
                (best, found) = (chosen, n);
            }
            if n as f64 >= (1.0 - NEAR) * count as f64 {
                break;
            }
        }
        Ok(best)
    }

    /// The sizes times a factor, reduced to the allowed growth.
    fn distances(&self, factor: f64) -> PerVertex<f64> {
        let mut distances = PerVertex::from_fn(self.mesh.n_vertices(), |v| factor * self.sizes[v]);
        let finite = self.mesh.vertices().filter(|&v| distances[v].is_finite());
        let mut heap: BinaryHeap<_> = finite.map(|v| Reverse(VertexAtDistance(distances[v], v))).collect();
        while let Some(Reverse(VertexAtDistance(distance, v))) = heap.pop() {
            if distance > distances[v] {
                continue;
            }
            for h in self.mesh.outgoing(v) {
                let (w, most) = (self.mesh.tip(h), distance + self.growth * self.lengths[h.edge()]);
                if most < distances[w] {
                    distances[w] = most;
                    heap.push(Reverse(VertexAtDistance(most, w)));
                }
            }
        }
        distances
    }

    fn chosen(&self, order: &[VertexId], distances: &PerVertex<f64>) -> PerVertex<bool> {
        let n = self.mesh.n_vertices();
        let mut chosen = PerVertex::filled(n, false);
        let mut covered = PerVertex::filled(n, false);
        // The distance of each vertex from the last chosen vertex that reached it, and the number of that one.
        let mut reached = PerVertex::filled(n, (f64::INFINITY, u32::MAX));
        let mut heap = BinaryHeap::new();
        for (i, &v) in self.always.iter().chain(order).enumerate() {
            if covered[v] && i >= self.always.len() {
                continue;
            }
            chosen[v] = true;
            reached[v] = (0.0, v.0);
            heap.push(Reverse(VertexAtDistance(0.0, v)));
            while let Some(Reverse(VertexAtDistance(d, at))) = heap.pop() {
                if d > reached[at].0 {
                    continue;
                }
                covered[at] = true;
                for h in self.mesh.outgoing(at) {
                    let (w, far) = (self.mesh.tip(h), d + self.lengths[h.edge()]);
                    let is_near = far < 0.5 * (distances[v] + distances[w]);
                    if is_near && !(reached[w].1 == v.0 && reached[w].0 <= far) {
                        reached[w] = (far, v.0);
                        heap.push(Reverse(VertexAtDistance(far, w)));
                    }
                }
            }
        }
        chosen
    }
}

/// The least and the largest of some positive numbers.
fn extent(numbers: impl Iterator<Item = f64>) -> [f64; 2] {
    numbers.fold([f64::INFINITY, 0.0], |[least, most], x| [f64::min(least, x), f64::max(most, x)])
}

/// A vertex with a distance, ordered by the distance.
#[derive(PartialEq)]
struct VertexAtDistance(f64, VertexId);

impl Eq for VertexAtDistance {}

impl PartialOrd for VertexAtDistance {
    fn partial_cmp(&self, other: &VertexAtDistance) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for VertexAtDistance {
    fn cmp(&self, other: &VertexAtDistance) -> Ordering {
        self.0.total_cmp(&other.0).then(self.1.cmp(&other.1))
    }
}
