//! Curvature, area and the Gauss–Bonnet residual of a metric given by its edge lengths.
//!
//! ```
//! # use ricci::{Surface, geometry::Space, mesh::shapes, metric::curvature::curvature};
//! let sphere = Surface::from_soup(&shapes::icosphere(4)?)?;
//! let curvature = curvature(sphere.mesh(), Space::E2, sphere.lengths())?;
//! assert!(curvature.broken.is_empty() && curvature.gauss_bonnet < 1e-12);
//! # Ok::<(), ricci::Error>(())
//! ```

use super::lengths::face_lengths;
use crate::error::Result;
use crate::geometry::Space;
use crate::geometry::double_double::two_sum;
use crate::geometry::scaled::scaled;
use crate::geometry::triangle::{self, Angles, angles_from, area_from, half_differences};
use crate::mesh::{FaceId, Mesh, PerEdge, PerVertex};
use crate::parallel;
use crate::topology::check_lengths;
use std::f64::consts::PI;

/// Discrete curvature of a metric.
#[derive(Debug, Clone, PartialEq)]
pub struct Curvature {
    /// K_i, radians: 2π − Σθ inside, π − Σθ on the boundary.
    pub at: PerVertex<f64>,
    /// Faces that break the triangle inequality (their angles are the extension (π, 0, 0)).
    pub broken: Vec<FaceId>,
    /// Total area, by formulas that use no angle.
    pub area: f64,
    /// |Σ K + λ·area − 2πχ|, zero to rounding (the angles of a broken triangle add up to π).
    pub gauss_bonnet: f64,
}

/// Curvature of the metric with these edge lengths (E entries).
///
/// # Errors
/// [`crate::Error::Size`]; [`crate::Error::EdgeLength`] for a length that is not positive and finite.
pub fn curvature(mesh: &Mesh, space: Space, lengths: &PerEdge<f64>) -> Result<Curvature> {
    check_lengths(mesh, lengths)?;
    Ok(curvature_of(mesh, space, |f| (half_differences(face_lengths(mesh, lengths, f)), 0)))
}

/// Curvature from the half-perimeter differences of the faces and the exponents of their units.
pub(super) fn curvature_of(
    mesh: &Mesh,
    space: Space,
    differences: impl Fn(FaceId) -> ([f64; 3], i32) + Sync,
) -> Curvature {
    let (mut angles, mut areas) = (vec![Angles { at: [0.0; 3] }; mesh.n_faces()], vec![0.0; mesh.n_faces()]);
    parallel::fill_both(&mut angles, &mut areas, |f| {
        let (r, unit) = differences(f.into());
        (angles_from(space, r), scaled(area_from(space, r), 2 * unit))
    });
    let at = curvature_from_angles(mesh, angles.iter().map(|a| a.at));
    let broken = mesh.faces().filter(|f| angles[f.index()].broken()).collect();
    let area = areas.iter().sum::<f64>();
    let gauss_bonnet = gauss_bonnet(mesh, space, &at, area);
    Curvature { at, broken, area, gauss_bonnet }
}

/// |Σ K + λ·area − 2πχ|
pub(crate) fn gauss_bonnet(mesh: &Mesh, space: Space, curvature: &PerVertex<f64>, area: f64) -> f64 {
    let total: f64 = curvature.iter().sum();
    // In E², where λ = 0, the area may be infinite.
    let curved = if space == Space::E2 { 0.0 } else { space.curvature() * area };
    (total + curved - 2.0 * PI * mesh.euler() as f64).abs()
}

/// π − (π rounded to f64). Without it the curvature of every vertex is off by twice this, always to the same side, and the total
/// curvature of a closed surface by V times as much.
const PI_LOW: f64 = 1.224_646_799_147_353_2e-16;

/// K from the corner angles of each face, in face order. The rounding errors of each sum are added up too and put back at the end, so
/// that a vertex of a thousand triangles is as exact as one of six.
pub fn curvature_from_angles(mesh: &Mesh, angles: impl Iterator<Item = [f64; 3]>) -> PerVertex<f64> {
    let mut at = PerVertex::filled(mesh.n_vertices(), 0.0);
    curvature_into(mesh, angles, &mut at, &mut Vec::new());
    at
}

/// [`curvature_from_angles`] into `at` (V entries); `lost` is memory for the rounding errors of the sums.
pub(crate) fn curvature_into(
    mesh: &Mesh,
    angles: impl Iterator<Item = [f64; 3]>,
    at: &mut PerVertex<f64>,
    lost: &mut Vec<f64>,
) {
    lost.resize(mesh.n_vertices(), 0.0);
    for v in mesh.vertices() {
        let halves = if mesh.is_boundary_vertex(v) { 1.0 } else { 2.0 };
        (at[v], lost[v.index()]) = (halves * PI, halves * PI_LOW);
    }
    for (f, angles) in angles.enumerate() {
        for (v, angle) in mesh.face_vertices(FaceId::from(f)).into_iter().zip(angles) {
            let (sum, error) = two_sum(at[v], -angle);
            at[v] = sum;
            lost[v.index()] += error;
        }
    }
    mesh.vertices().for_each(|v| at[v] += lost[v.index()]);
}

/// Total area of the metric with these edge lengths (E entries).
///
/// # Errors
/// As [`curvature`].
pub fn area(mesh: &Mesh, space: Space, lengths: &PerEdge<f64>) -> Result<f64> {
    check_lengths(mesh, lengths)?;
    Ok(mesh.faces().map(|f| triangle::area(space, face_lengths(mesh, lengths, f))).sum())
}
