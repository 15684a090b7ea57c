//! The curvature of a surface whose metric lives on the surface with caps on its loops ([`Solution::caps`]), without the caps.

use super::solution::Solution;
use crate::control::Control;
use crate::error::Result;
use crate::geometry::complex::distance;
use crate::geometry::{Space, triangle};
use crate::mesh::{FaceId, PerVertex, VertexId};
use crate::metric::Curvature;
use crate::metric::curvature::curvature_from_angles;
use crate::metric::lengths::face_lengths;
use crate::parallel;

impl Solution {
    /// The curvature per given vertex and the area of the given surface, from the curvature of the surface with its caps.
    ///
    /// Edges of the final triangulation may cross the loops, so angles at a loop are measured on the common subdivision.
    ///
    /// # Errors
    /// Those of [`Solution::common_subdivision`] and [`crate::Metric::lengths`].
    pub(super) fn without_caps(&self, whole: Curvature) -> Result<Curvature> {
        let subdivision = self.common_subdivision(&Control::new())?;
        let lengths = self.metric().lengths(self.mesh())?;
        let mut sides = vec![[0.0; 3]; subdivision.mesh.n_faces()];
        parallel::fill(&mut sides, |f| {
            let f = FaceId::from(f);
            let corners = corners_in_plane(face_lengths(self.mesh(), &lengths, subdivision.faces[1][f]));
            let points = subdivision
                .barycentric(1, f)
                .map(|weights| [0, 1].map(|i| (0..3).map(|k| weights[k] * corners[k][i]).sum::<f64>()));
            [1, 2, 0].map(|k| distance(points[k], points[(k + 1) % 3]))
        });
        let angles = sides.iter().map(|&sides| triangle::angles(Space::E2, sides).at);
        let on_pieces = curvature_from_angles(&subdivision.mesh, angles);
        let given = self.given();
        let at = |v: VertexId| if given.is_boundary_vertex(v) { on_pieces[v] } else { whole.at[v] };
        Ok(Curvature {
            at: PerVertex::from_fn(given.n_vertices(), at),
            area: sides.iter().map(|&sides| triangle::area(Space::E2, sides)).sum(),
            ..whole
        })
    }
}

/// The corners of a triangle in the plane with these sides, each opposite the corner of its number.
fn corners_in_plane(sides: [f64; 3]) -> [[f64; 2]; 3] {
    let angle = triangle::angles(Space::E2, sides).at[0];
    [[0.0, 0.0], [sides[2], 0.0], [sides[1] * angle.cos(), sides[1] * angle.sin()]]
}
