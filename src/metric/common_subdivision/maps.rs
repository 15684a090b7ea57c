//! Carries values and points from either triangulation to the common subdivision, and points from one triangulation to the other.

use super::data::{CommonSubdivision, FacePoint};
use crate::error::{Result, check_size};
use crate::geometry::vector::{cross, dot};
use crate::mesh::{FaceId, VertexId};

impl CommonSubdivision {
    /// Values at the vertices of one side (N components: positions, colours, normals), linear along its edges in its metric, at the
    /// vertices of the subdivision. `values` has at least one entry per vertex that an edge of a piece leads to: where only a part of the
    /// surface was kept, an edge that is cut may end outside of it.
    ///
    /// # Errors
    /// [`crate::Error::Size`].
    pub fn from_vertices<const N: usize>(&self, side: usize, values: &[[f64; N]]) -> Result<Vec<[f64; N]>> {
        let of_crossings = self.crossings.iter().flat_map(|crossing| crossing[side].ends);
        let of_points = self.points.iter().flat_map(|point| point[side].vertices);
        let shared = if self.points.is_empty() { self.n_vertices[side] } else { 0 };
        let need = of_crossings.chain(of_points).map(|v| v.index() + 1).fold(shared, usize::max);
        check_size("vertex values", values.len().min(need), need)?;
        let at = |v: VertexId| match (self.crossing(v), self.points.get(v.index())) {
            (Some(crossing), _) => {
                combine(&crossing[side].ends.map(|v| values[v.index()]), &crossing[side].weights)
            }
            (None, Some(point)) => {
                let FacePoint { vertices, weights } = point[side];
                combine(&vertices.map(|v| values[v.index()]), &weights)
            }
            (None, None) => values[v.index()],
        };
        Ok(self.mesh.vertices().map(at).collect())
    }

    /// Values at the corners of the faces of one side (normals, texture coordinates), linear in them, at the corners of the
    /// subdivision's triangles.
    ///
    /// # Errors
    /// [`crate::Error::Size`].
    pub fn from_corners<const N: usize>(
        &self,
        side: usize,
        values: &[[[f64; N]; 3]],
    ) -> Result<Vec<[[f64; N]; 3]>> {
        let face = &self.faces[side];
        let need = face.iter().map(|f| f.index() + 1).fold(0, usize::max);
        check_size("corner values", values.len().min(need), need)?;
        let of = |f: FaceId| self.barycentric(side, f).map(|b| combine(&values[face[f].index()], &b));
        Ok(self.mesh.faces().map(of).collect())
    }

    /// The map of points from faces of the first triangulation to faces of the second.
    pub fn forward(&self) -> PointMap<'_> {
        PointMap::new(self, 0)
    }

    /// The map of points from faces of the second triangulation to faces of the first.
    pub fn backward(&self) -> PointMap<'_> {
        PointMap::new(self, 1)
    }
}

/// A map of points from one triangulation to the other: projective in each piece.
pub struct PointMap<'a> {
    subdivision: &'a CommonSubdivision,
    /// The side that points are mapped from.
    from: usize,
    /// The triangles, sorted by the face they are mapped from.
    order: Vec<FaceId>,
}

impl<'a> PointMap<'a> {
    fn new(subdivision: &'a CommonSubdivision, from: usize) -> PointMap<'a> {
        let mut order: Vec<_> = subdivision.mesh.faces().collect();
        order.sort_by_key(|&f| (subdivision.faces[from][f], f));
        PointMap { subdivision, from, order }
    }

    /// The image of the point with these barycentric coordinates in a face: face and coordinates. `None` if the subdivision has no
    /// piece of that face. Takes time linear in the number of pieces of the face, besides a search.
    pub fn image(&self, face: FaceId, barycentric: [f64; 3]) -> Option<(FaceId, [f64; 3])> {
        let PointMap { subdivision, from, order } = self;
        let (faces, to) = (&subdivision.faces[*from], 1 - from);
        let begin = order.partition_point(|&f| faces[f] < face);
        let pieces = order[begin..].iter().copied().take_while(|&f| faces[f] == face);
        // The triangle that contains the point, or the one that the point is nearest to being inside of.
        let mut best: Option<(f64, FaceId, [f64; 3])> = None;
        for f in pieces {
            let corners = subdivision.barycentric(*from, f);
            let parts =
                [0, 1, 2].map(|k| dot(barycentric, cross(corners[(k + 1) % 3], corners[(k + 2) % 3])));
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
        // Homogeneous weights of the image over those of the point, relative to the largest, so that none overflows.
        let q = subdivision.weights(f).map(|q| if *from == 0 { q } else { 1.0 / q });
        let largest = q.into_iter().fold(0.0, f64::max);
        let weights = [0, 1, 2].map(|k| local[k].max(0.0) * (q[k] / largest));
        let corners = subdivision.barycentric(to, f);
        let image = combine(&corners, &weights);
        let total = image[0] + image[1] + image[2];
        Some((subdivision.faces[to][f], if total > 0.0 { image.map(|x| x / total) } else { corners[0] }))
    }
}

/// Σ weights · values.
fn combine<const M: usize, const N: usize>(values: &[[f64; N]; M], weights: &[f64; M]) -> [f64; N] {
    std::array::from_fn(|i| (0..M).map(|k| weights[k] * values[k][i]).sum())
}
