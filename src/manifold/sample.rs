//! Vertices that are spread over a surface, denser where they are wanted denser.

use crate::control::{Control, Stage};
use crate::error::Result;
use crate::mesh::shapes::SplitMix64;
use crate::mesh::{Mesh, PerEdge, PerVertex, VertexId};
use std::cmp::{Ordering, Reverse};
use std::collections::BinaryHeap;

/// Halvings of the interval in which the distance is looked for.
const HALVINGS: usize = 24;
/// How much smaller than asked for the count may be.
const NEAR: f64 = 0.02;

/// Where vertices are taken, and how far apart.
pub(super) struct Sampling<'a> {
    pub mesh: &'a Mesh,
    /// Of the order in which vertices are looked at.
    pub seed: u64,
    pub lengths: &'a PerEdge<f64>,
    /// Distances from neighbours, relative to each other; infinite where only the growth limits them.
    pub sizes: PerVertex<f64>,
    /// How much the distance between neighbours may grow per length: 1 keeps the triangles between them fat.
    pub growth: f64,
    /// Vertices that are taken whatever their distance.
    pub always: &'a [VertexId],
    /// The others that may be taken.
    pub allowed: PerVertex<bool>,
}

impl Sampling<'_> {
    /// Up to `count` vertices, and few less: no two are nearer along edges than the mean of their distances, all sizes times one factor,
    /// but for those that are always taken.
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
        // The boundary before the rest: an inner vertex near it would make a thin triangle.
        order.sort_by_key(|&v| !mesh.is_boundary_vertex(v));
        // Sizes and lengths range over decades: the factor is looked for on a logarithmic scale.
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

    /// The sizes times a factor, as far as they grow no faster than they may.
    fn distances(&self, factor: f64) -> PerVertex<f64> {
        let mut distances = PerVertex::from_fn(self.mesh.n_vertices(), |v| factor * self.sizes[v]);
        let finite = self.mesh.vertices().filter(|&v| distances[v].is_finite());
        let mut heap: BinaryHeap<_> = finite.map(|v| Reverse(At(distances[v], v))).collect();
        while let Some(Reverse(At(distance, v))) = heap.pop() {
            if distance > distances[v] {
                continue;
            }
            for h in self.mesh.outgoing(v) {
                let (w, most) = (self.mesh.tip(h), distance + self.growth * self.lengths[h.edge()]);
                if most < distances[w] {
                    distances[w] = most;
                    heap.push(Reverse(At(most, w)));
                }
            }
        }
        distances
    }

    fn chosen(&self, order: &[VertexId], distances: &PerVertex<f64>) -> PerVertex<bool> {
        let n = self.mesh.n_vertices();
        let mut chosen = PerVertex::filled(n, false);
        let mut covered = PerVertex::filled(n, false);
        // The distance from the vertex that is being chosen, and which that was.
        let mut reached = PerVertex::filled(n, (f64::INFINITY, u32::MAX));
        let mut heap = BinaryHeap::new();
        for (i, &v) in self.always.iter().chain(order).enumerate() {
            if covered[v] && i >= self.always.len() {
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
                for h in self.mesh.outgoing(at) {
                    let (w, far) = (self.mesh.tip(h), d + self.lengths[h.edge()]);
                    let is_near = far < 0.5 * (distances[v] + distances[w]);
                    if is_near && !(reached[w].1 == v.0 && reached[w].0 <= far) {
                        reached[w] = (far, v.0);
                        heap.push(Reverse(At(far, w)));
                    }
                }
            }
        }
        chosen
    }
}

/// The least and the largest of positive numbers.
fn extent(numbers: impl Iterator<Item = f64>) -> [f64; 2] {
    numbers.fold([f64::INFINITY, 0.0], |[least, most], x| [f64::min(least, x), f64::max(most, x)])
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
