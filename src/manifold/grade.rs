//! How large the triangles of a domain are to be.

use crate::control::Control;
use crate::error::Result;
use crate::mesh::{Mesh, PerVertex, VertexId};
use crate::metric::Surface;
use crate::topology::shortest_paths;

/// Sizes change by at most these factors from round to round.
const CHANGE: [f64; 2] = [0.6, 1.4];
/// Least and largest size of a triangle over the one of an even distribution.
const SIZES: [f64; 2] = [0.1, 3.0];
/// Rounds in which a size becomes the mean of itself and its neighbours'.
const SMOOTHINGS: usize = 5;
/// At a distance r from a vertex with a total angle of m turns the flat metric changes by a factor over r/m. Triangles are at most so much
/// larger, so that the surface is smooth on each of them in its flat coordinates.
const NATURAL: f64 = 1.5;

/// Sizes of triangles, relative to an even distribution.
pub(super) struct Grade {
    pub sizes: PerVertex<f64>,
    /// Largest size that the singular vertices allow.
    natural: PerVertex<f64>,
}

/// The error of a vertex that is to be spread evenly; none where a hole is filled by something else than the triangles.
pub(super) type Miss = Option<(usize, f64)>;

impl Grade {
    /// Sizes for so many triangles, and singular vertices with these numbers of turns.
    pub fn new(
        surface: &Surface,
        triangles: usize,
        singular: &[(VertexId, u32)],
        control: &Control,
    ) -> Result<Grade> {
        let mesh = surface.mesh();
        let even = (4.0 / 3f64.sqrt() * surface.area()? / triangles.max(1) as f64).sqrt();
        let mut natural = PerVertex::filled(mesh.n_vertices(), SIZES[1]);
        for &(v, turns) in singular {
            let far = shortest_paths(mesh, surface.lengths(), [v], control)?.distance;
            for u in mesh.vertices() {
                natural[u] = natural[u].min(NATURAL * far[u] / (f64::from(turns) * even));
            }
        }
        natural.iter_mut().for_each(|size| *size = size.max(SIZES[0]));
        let sizes = PerVertex::from_fn(mesh.n_vertices(), |v| natural[v].min(1.0));
        Ok(Grade { sizes, natural })
    }

    /// Sizes for triangles whose errors would be alike: a polynomial of degree n misses by the power n + 1 of the size. `misses`: per vertex its triangle and
    /// its error.
    pub fn adapt(&mut self, mesh: &Mesh, misses: &[Miss], (triangles, degree): (usize, usize)) {
        let mut worst = vec![0.0f64; triangles];
        for &(triangle, miss) in misses.iter().flatten() {
            worst[triangle] = worst[triangle].max(miss);
        }
        let mut sorted: Vec<f64> = worst.iter().copied().filter(|&miss| miss > 0.0).collect();
        sorted.sort_by(f64::total_cmp);
        let middle = sorted.get(sorted.len() / 2).copied().unwrap_or(1.0);
        for (v, miss) in mesh.vertices().zip(misses) {
            let Some((triangle, _)) = *miss else { continue };
            let error = worst[triangle].max(f64::MIN_POSITIVE);
            let change = (middle / error).powf(1.0 / (degree + 1) as f64).clamp(CHANGE[0], CHANGE[1]);
            self.sizes[v] *= change;
        }
        for _ in 0..SMOOTHINGS {
            let before = self.sizes.clone();
            for v in mesh.vertices() {
                let around = mesh.outgoing(v).map(|h| before[mesh.tip(h)]);
                let (sum, n) = around.fold((0.0, 0.0), |(sum, n), size| (sum + size, n + 1.0));
                self.sizes[v] = 0.5 * (before[v] + sum / n);
            }
        }
        for (v, miss) in mesh.vertices().zip(misses) {
            if miss.is_some() {
                self.sizes[v] = self.sizes[v].min(self.natural[v]).clamp(SIZES[0], SIZES[1]);
            }
        }
        // What a hole covers needs no smaller triangles than its rim.
        let is_rim = |v: &VertexId| mesh.outgoing(*v).any(|h| misses[mesh.tip(h).index()].is_none());
        let rim = mesh.vertices().filter(|v| misses[v.index()].is_some()).filter(is_rim);
        let least = rim.map(|v| self.sizes[v]).fold(SIZES[1], f64::min);
        let covered = mesh.vertices().filter(|v| misses[v.index()].is_none());
        covered.for_each(|v| self.sizes[v] = least);
    }
}
