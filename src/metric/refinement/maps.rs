//! Values and points, carried between the input, the refinement and the final triangulation.

use super::Refinement;
use crate::error::{Result, check_size};
use crate::mesh::{FaceId, VertexId};

/// Values at vertices or corners with N components: positions, colours, normals, texture coordinates.
pub type Values<const N: usize> = Vec<[f64; N]>;

impl Refinement {
    /// Values at the refinement's vertices of values at the input's (`n_input_vertices` at least, linear along the input's edges):
    /// of positions in space, those on the input's surface.
    pub fn from_input_vertices<const N: usize>(&self, values: &[[f64; N]]) -> Result<Values<N>> {
        self.at_vertices(values, |c| (c.input_ends, c.input_weights))
    }

    /// Values at the refinement's vertices of values at the final triangulation's, linear along its edges in the final metric.
    ///
    /// Of a part that was kept, the vertices at the ends of final edges may lie outside: `values` has one entry per vertex of
    /// the final triangulation.
    pub fn from_final_vertices<const N: usize>(&self, values: &[[f64; N]]) -> Result<Values<N>> {
        self.at_vertices(values, |c| (c.final_ends, c.final_weights))
    }

    fn at_vertices<const N: usize>(
        &self,
        values: &[[f64; N]],
        on_edge: impl Fn(&super::Crossing) -> ([VertexId; 2], [f64; 2]),
    ) -> Result<Values<N>> {
        let ends = self.crossings.iter().flat_map(|c| on_edge(c).0);
        let need = ends.map(|v| v.index() + 1).fold(self.n_input_vertices, usize::max);
        check_size("vertex values", values.len().min(need), need)?;
        let crossings = self.crossings.iter().map(|c| {
            let (ends, weights) = on_edge(c);
            combine(&ends.map(|v| values[v.index()]), &weights)
        });
        Ok(values[..self.n_input_vertices].iter().copied().chain(crossings).collect())
    }

    /// Values at the corners of the refinement's triangles of values at the corners of the input's faces, linear in them.
    pub fn from_input_corners<const N: usize>(&self, values: &[[[f64; N]; 3]]) -> Result<Vec<[[f64; N]; 3]>> {
        self.at_corners(values, &self.input_face, |f| self.input_barycentric(f))
    }

    /// Values at the corners of the refinement's triangles of values at the corners of the final faces, linear in them.
    pub fn from_final_corners<const N: usize>(&self, values: &[[[f64; N]; 3]]) -> Result<Vec<[[f64; N]; 3]>> {
        self.at_corners(values, &self.final_face, |f| self.final_barycentric(f))
    }

    fn at_corners<const N: usize>(
        &self,
        values: &[[[f64; N]; 3]],
        face: &[FaceId],
        barycentric: impl Fn(FaceId) -> [[f64; 3]; 3],
    ) -> Result<Vec<[[f64; N]; 3]>> {
        let need = face.iter().map(|f| f.index() + 1).fold(0, usize::max);
        check_size("corner values", values.len().min(need), need)?;
        let of = |f: FaceId| barycentric(f).map(|b| combine(&values[face[f.index()].index()], &b));
        Ok(self.mesh.faces().map(of).collect())
    }

    /// The map of points from faces of the input to final faces.
    pub fn forward(&self) -> PointMap<'_> {
        PointMap::new(self, true)
    }

    /// The map of points from final faces to faces of the input.
    pub fn backward(&self) -> PointMap<'_> {
        PointMap::new(self, false)
    }
}

/// A map of points between the two triangulations: projective in each piece.
pub struct PointMap<'a> {
    refinement: &'a Refinement,
    forward: bool,
    /// The triangles, sorted by the face they are mapped from.
    order: Vec<FaceId>,
}

impl<'a> PointMap<'a> {
    fn new(refinement: &'a Refinement, forward: bool) -> PointMap<'a> {
        let mut order: Vec<_> = refinement.mesh.faces().collect();
        let map = PointMap { refinement, forward, order: Vec::new() };
        order.sort_by_key(|&f| (map.from(f), f));
        PointMap { order, ..map }
    }

    fn from(&self, f: FaceId) -> FaceId {
        if self.forward { self.refinement.input_face[f] } else { self.refinement.final_face[f] }
    }

    /// The image of the point with these barycentric coordinates in a face: face and coordinates. `None` if the refinement has no
    /// piece of that face. Linear in the pieces of the face, besides a search.
    pub fn image(&self, face: FaceId, barycentric: [f64; 3]) -> Option<(FaceId, [f64; 3])> {
        let r = self.refinement;
        let begin = self.order.partition_point(|&f| self.from(f) < face);
        let pieces = self.order[begin..].iter().copied().take_while(|&f| self.from(f) == face);
        // The triangle that contains the point, or fails to by least.
        let mut best: Option<(f64, FaceId, [f64; 3])> = None;
        for f in pieces {
            let corners = if self.forward { r.input_barycentric(f) } else { r.final_barycentric(f) };
            let parts =
                [0, 1, 2].map(|k| determinant(barycentric, corners[(k + 1) % 3], corners[(k + 2) % 3]));
            let total = parts[0] + parts[1] + parts[2];
            if total > 0.0 {
                let local = parts.map(|x| x / total);
                let inside = local.into_iter().fold(f64::INFINITY, f64::min);
                if best.is_none_or(|(most, ..)| inside > most) {
                    best = Some((inside, f, local));
                }
            }
        }
        let (_, f, local) = best?;
        // Relative to the largest weight, so that none overflows.
        let q = r.weights(f).map(|q| if self.forward { q } else { 1.0 / q });
        let largest = q.into_iter().fold(0.0, f64::max);
        let weights = [0, 1, 2].map(|k| local[k].max(0.0) * (q[k] / largest));
        let (to, corners) = if self.forward {
            (r.final_face[f], r.final_barycentric(f))
        } else {
            (r.input_face[f], r.input_barycentric(f))
        };
        let image = combine(&corners, &weights);
        let total = image[0] + image[1] + image[2];
        Some((to, if total > 0.0 { image.map(|x| x / total) } else { corners[0] }))
    }
}

/// Σ weights · values.
fn combine<const M: usize, const N: usize>(values: &[[f64; N]; M], weights: &[f64; M]) -> [f64; N] {
    std::array::from_fn(|i| (0..M).map(|k| weights[k] * values[k][i]).sum())
}

fn determinant(a: [f64; 3], b: [f64; 3], c: [f64; 3]) -> f64 {
    a[0] * (b[1] * c[2] - b[2] * c[1])
        + a[1] * (b[2] * c[0] - b[0] * c[2])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
}
