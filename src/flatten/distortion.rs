//! How much a map to the plane changes lengths, areas and angles.

use super::energy::EnergyShares;
use super::rest_triangle::RestTriangle;
use crate::mesh::{EdgeId, VertexId};
use crate::metric::Surface;
use crate::parallel;

/// The change of lengths, areas and angles by a map that is linear on triangles; 1 or 0 is no change, means are weighed with the areas of
/// the surface's triangles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Distortion {
    /// The symmetric Dirichlet energy: the mean of σ² + τ² + σ⁻² + τ⁻² of the singular values σ, τ of the maps of the triangles; at least 4 \[SS15\].
    pub energy: f64,
    /// The least singular value of a triangle: the strongest compression along a direction.
    pub least_stretch: f64,
    /// The largest singular value of a triangle: the strongest stretch along a direction.
    pub most_stretch: f64,
    /// The mean over the edges of |length in the plane / length − 1|.
    pub mean_length_error: f64,
    /// The largest of these.
    pub max_length_error: f64,
    /// The mean of |area in the plane / area − 1| of the triangles.
    pub mean_area_error: f64,
    /// The largest of these.
    pub max_area_error: f64,
    /// The mean dilatation σ/τ.
    pub mean_dilatation: f64,
    /// The largest dilatation.
    pub max_dilatation: f64,
    /// The area in the plane over that of the surface.
    pub area: f64,
}

const ISOMETRIC: EnergyShares = EnergyShares { isometric: 1.0, conformal: 0.0, area: 0.0, arap: 0.0 };

/// The map of one triangle: its energy, its singular values and determinant.
#[derive(Clone, Copy, Default)]
struct TriangleDistortion {
    energy: f64,
    singular: [f64; 2],
    det: f64,
}

impl Distortion {
    /// `unit`: the length on the surface that is 1 in `points`.
    pub(super) fn of(surface: &Surface, rest: &[RestTriangle], points: &[[f64; 2]], unit: f64) -> Distortion {
        let corners = surface.mesh().triangles();
        let length = |[v, w]: [VertexId; 2]| {
            let [[a, b], [c, d]] = [v, w].map(|v| points[v.index()]);
            (a - c).hypot(b - d) * unit
        };
        Distortion::of_triangles(surface, rest, |f| corners[f].map(|v| points[v as usize]), length)
    }

    /// `corners`: the triangles in the unit in which `rest` is, each in a plane of its own; `length`: of an edge, in the surface's unit.
    pub(super) fn of_triangles(
        surface: &Surface,
        rest: &[RestTriangle],
        corners: impl Fn(usize) -> [[f64; 2]; 3] + Sync,
        length: impl Fn([VertexId; 2]) -> f64,
    ) -> Distortion {
        let mesh = surface.mesh();
        let mut maps = vec![TriangleDistortion::default(); rest.len()];
        parallel::fill(&mut maps, |f| {
            let at = corners(f);
            let ([square, det], singular) = (rest[f].square_and_det(at), rest[f].map(at).singular);
            TriangleDistortion { energy: ISOMETRIC.value(square, det), singular, det }
        });
        let mean = |of: &dyn Fn(&TriangleDistortion) -> f64| {
            maps.iter().zip(rest).map(|(map, rest)| rest.share * of(map)).sum::<f64>()
        };
        let most = |of: &dyn Fn(&TriangleDistortion) -> f64| maps.iter().map(of).fold(0.0, f64::max);
        let dilatation = |map: &TriangleDistortion| map.singular[0] / map.singular[1];
        let area_error = |map: &TriangleDistortion| (map.det - 1.0).abs();
        let length_error = |e: EdgeId| (length(mesh.ends(e)) / surface.lengths()[e] - 1.0).abs();
        Distortion {
            energy: mean(&|map| map.energy),
            least_stretch: maps.iter().map(|map| map.singular[1]).fold(f64::INFINITY, f64::min),
            most_stretch: most(&|map| map.singular[0]),
            mean_length_error: mesh.edges().map(length_error).sum::<f64>() / mesh.n_edges() as f64,
            max_length_error: mesh.edges().map(length_error).fold(0.0, f64::max),
            mean_area_error: mean(&area_error),
            max_area_error: most(&area_error),
            mean_dilatation: mean(&dilatation),
            max_dilatation: most(&dilatation),
            area: mean(&|map| map.det),
        }
    }
}
