//! Values and points, carried between the input, the refinement and the final triangulation.

use super::super::overlay::Overlay;
use super::parts::{Refinement, Side};
use crate::error::{Result, check_size};
use crate::geometry::vector::{cross, dot};
use crate::mesh::{FaceId, Mesh, PerFace};

/// Values at vertices with N components: positions, colours, normals.
pub type Values<const N: usize> = Vec<[f64; N]>;
/// Values at the corners of every face with N components: normals, texture coordinates.
pub type CornerValues<const N: usize> = Vec<[[f64; N]; 3]>;

impl Refinement {
    /// Values at the refinement's vertices of values at the input's (`n_input_vertices` at least, linear along the input's edges):
    /// of positions in space, those on the input's surface.
    ///
    /// # Errors
    /// [`crate::Error::Size`].
    pub fn from_input_vertices<const N: usize>(&self, values: &[[f64; N]]) -> Result<Values<N>> {
        self.at_vertices(values, Side::Input)
    }

    /// Values at the refinement's vertices of values at the final triangulation's, linear along its edges in the final metric.
    ///
    /// `values` has one entry per vertex of the final triangulation: where only a part of the surface was kept, an edge that is cut
    /// may end outside of it.
    ///
    /// # Errors
    /// [`crate::Error::Size`].
    pub fn from_final_vertices<const N: usize>(&self, values: &[[f64; N]]) -> Result<Values<N>> {
        self.at_vertices(values, Side::Final)
    }

    fn at_vertices<const N: usize>(&self, values: &[[f64; N]], side: Side) -> Result<Values<N>> {
        let ends = self.crossings.iter().flat_map(|c| c.on(side).0);
        let need = ends.map(|v| v.index() + 1).fold(self.n_input_vertices, usize::max);
        check_size("vertex values", values.len().min(need), need)?;
        let crossings = self.crossings.iter().map(|c| {
            let (ends, weights) = c.on(side);
            combine(&ends.map(|v| values[v.index()]), &weights)
        });
        Ok(values[..self.n_input_vertices].iter().copied().chain(crossings).collect())
    }

    /// Values at the corners of the refinement's triangles of values at the corners of the input's faces, linear in them.
    ///
    /// # Errors
    /// [`crate::Error::Size`].
    pub fn from_input_corners<const N: usize>(&self, values: &[[[f64; N]; 3]]) -> Result<CornerValues<N>> {
        self.at_corners(values, Side::Input)
    }

    /// Values at the corners of the refinement's triangles of values at the corners of the final faces, linear in them.
    ///
    /// # Errors
    /// [`crate::Error::Size`].
    pub fn from_final_corners<const N: usize>(&self, values: &[[[f64; N]; 3]]) -> Result<CornerValues<N>> {
        self.at_corners(values, Side::Final)
    }

    fn at_corners<const N: usize>(&self, values: &[[[f64; N]; 3]], side: Side) -> Result<CornerValues<N>> {
        let face = self.faces(side);
        let need = face.iter().map(|f| f.index() + 1).fold(0, usize::max);
        check_size("corner values", values.len().min(need), need)?;
        let of = |f: FaceId| self.barycentric(f, side).map(|b| combine(&values[face[f].index()], &b));
        Ok(self.mesh.faces().map(of).collect())
    }

    /// The map of points from faces of the input to final faces.
    pub fn forward(&self) -> PointMap<'_> {
        PointMap::new(self, [Side::Input, Side::Final])
    }

    /// The map of points from final faces to faces of the input.
    pub fn backward(&self) -> PointMap<'_> {
        PointMap::new(self, [Side::Final, Side::Input])
    }
}

impl Overlay {
    /// The map of points from faces of the source to faces of the target.
    pub fn forward(&self) -> PointMap<'_> {
        PointMap::sorted(Pieces::Overlaid(self, [0, 1]))
    }

    /// The map of points from faces of the target to faces of the source.
    pub fn backward(&self) -> PointMap<'_> {
        PointMap::sorted(Pieces::Overlaid(self, [1, 0]))
    }
}

/// A map of points between the two triangulations: projective in each piece.
pub struct PointMap<'a> {
    pieces: Pieces<'a>,
    /// The triangles, sorted by the face they are mapped from.
    order: Vec<FaceId>,
}

impl<'a> PointMap<'a> {
    fn new(refinement: &'a Refinement, sides: [Side; 2]) -> PointMap<'a> {
        PointMap::sorted(Pieces::Flipped(refinement, sides))
    }

    fn sorted(pieces: Pieces<'a>) -> PointMap<'a> {
        let mut order: Vec<_> = pieces.mesh().faces().collect();
        let from = pieces.faces(0);
        order.sort_by_key(|&f| (from[f], f));
        PointMap { pieces, order }
    }

    /// The image of the point with these barycentric coordinates in a face: face and coordinates. `None` if the refinement has no
    /// piece of that face. Takes time linear in the number of pieces of the face, besides a search.
    pub fn image(&self, face: FaceId, barycentric: [f64; 3]) -> Option<(FaceId, [f64; 3])> {
        let r = &self.pieces;
        let faces = r.faces(0);
        let begin = self.order.partition_point(|&f| faces[f] < face);
        let pieces = self.order[begin..].iter().copied().take_while(|&f| faces[f] == face);
        // The triangle that contains the point, or the one that the point is nearest to being inside of.
        let mut best: Option<(f64, FaceId, [f64; 3])> = None;
        for f in pieces {
            let corners = r.barycentric(0, f);
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
        // Relative to the largest weight, so that none overflows.
        let q = r.weights(f);
        let largest = q.into_iter().fold(0.0, f64::max);
        let weights = [0, 1, 2].map(|k| local[k].max(0.0) * (q[k] / largest));
        let corners = r.barycentric(1, f);
        let image = combine(&corners, &weights);
        let total = image[0] + image[1] + image[2];
        Some((r.faces(1)[f], if total > 0.0 { image.map(|x| x / total) } else { corners[0] }))
    }
}

/// The triangles of a common refinement. Of what is there twice, number 0 is where points are mapped from.
enum Pieces<'a> {
    Flipped(&'a Refinement, [Side; 2]),
    Overlaid(&'a Overlay, [usize; 2]),
}

impl Pieces<'_> {
    fn mesh(&self) -> &Mesh {
        match self {
            Pieces::Flipped(refinement, _) => &refinement.mesh,
            Pieces::Overlaid(overlay, _) => &overlay.mesh,
        }
    }

    fn faces(&self, k: usize) -> &PerFace<FaceId> {
        match self {
            Pieces::Flipped(refinement, sides) => refinement.faces(sides[k]),
            Pieces::Overlaid(overlay, sides) => &overlay.faces[sides[k]],
        }
    }

    fn barycentric(&self, k: usize, f: FaceId) -> [[f64; 3]; 3] {
        match self {
            Pieces::Flipped(refinement, sides) => refinement.barycentric(f, sides[k]),
            Pieces::Overlaid(overlay, sides) => overlay.barycentric[sides[k]][f],
        }
    }

    /// What barycentric coordinates are multiplied by on the way.
    fn weights(&self, f: FaceId) -> [f64; 3] {
        let (weights, is_forward) = match self {
            Pieces::Flipped(refinement, sides) => (refinement.weights(f), sides[0] == Side::Input),
            Pieces::Overlaid(overlay, sides) => (overlay.weights(f), sides[0] == 0),
        };
        if is_forward { weights } else { weights.map(|q| 1.0 / q) }
    }
}

/// Σ weights · values.
fn combine<const M: usize, const N: usize>(values: &[[f64; N]; M], weights: &[f64; M]) -> [f64; N] {
    std::array::from_fn(|i| (0..M).map(|k| weights[k] * values[k][i]).sum())
}
