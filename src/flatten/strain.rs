//! The strain of a sheet that is cut by a flat map and then takes the shape of the surface, along its warp and its weft.

use super::rest_triangle::rest_triangles;
use crate::error::{Error, Result, check_size};
use crate::geometry::complex::{dot, norm};
use crate::metric::Surface;
use crate::parallel;

/// The strain of one triangle, from the plane to the surface.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct FaceStrain {
    /// Length on the surface over length in the plane along the warp, less 1: positive where the sheet is stretched.
    pub warp: f64,
    /// The same along the weft, which is at a right angle to the warp in the plane.
    pub weft: f64,
    /// Radians by which the angle between them on the surface is less than a right one.
    pub shear: f64,
    /// The triangle's share of the area of the surface.
    pub share: f64,
}

/// What a material bears: the largest |strain| along the warp, along the weft, and the largest |shear| in radians; infinite for no limit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StrainLimits {
    /// Along the warp.
    pub warp: f64,
    /// Along the weft.
    pub weft: f64,
    /// Of the angle between them, radians.
    pub shear: f64,
}

impl Default for StrainLimits {
    /// No limit.
    fn default() -> StrainLimits {
        StrainLimits { warp: f64::INFINITY, weft: f64::INFINITY, shear: f64::INFINITY }
    }
}

impl StrainLimits {
    /// The largest part of its limit that a strain takes: more than 1 where it is passed.
    pub fn taken(&self, strain: &FaceStrain) -> f64 {
        let parts = [strain.warp / self.warp, strain.weft / self.weft, strain.shear / self.shear];
        parts.into_iter().fold(0.0, |most, part| f64::max(most, part.abs()))
    }

    /// # Errors
    /// [`Error::Argument`] for limits that are not positive.
    pub(super) fn check(&self) -> Result<()> {
        for (what, limit) in [
            ("limit along the warp", self.warp),
            ("limit along the weft", self.weft),
            ("limit of shear", self.shear),
        ] {
            if limit.is_nan() || limit <= 0.0 {
                return Err(Error::argument(what, limit, "a positive number"));
            }
        }
        Ok(())
    }
}

/// The strain of every triangle of a flat map. `points`: per vertex its place in the plane, in units of the surface's lengths; `warp`: the
/// angle of the warp in the plane from the x axis, radians.
///
/// # Errors
/// [`Error::Size`]; [`Error::Layout`] for a triangle without area on the surface or in the plane; [`Error::Argument`] for an angle that is
/// no number.
pub fn strains(surface: &Surface, points: &[[f64; 2]], warp: f64) -> Result<Vec<FaceStrain>> {
    let mesh = surface.mesh();
    check_size("points", points.len(), mesh.n_vertices())?;
    if !warp.is_finite() {
        return Err(Error::argument("warp", warp, "an angle in radians"));
    }
    let rest = rest_triangles(surface, 1.0, &[])?;
    let corners = mesh.triangles();
    let (sin, cos) = warp.sin_cos();
    let mut strains = vec![FaceStrain::default(); rest.len()];
    parallel::fill(&mut strains, |f| {
        // The map to the plane is [[a, b], [c, d]]; its inverse takes the two threads to the surface.
        let [[a, b], [c, d]] = rest[f].matrix(corners[f].map(|v| points[v as usize]));
        let det = a * d - b * c;
        let thread = |[x, y]: [f64; 2]| [(d * x - b * y) / det, (a * y - c * x) / det];
        let (along, across) = (thread([cos, sin]), thread([-sin, cos]));
        let [p, q] = [along, across].map(norm);
        let shear = (dot(along, across) / (p * q)).clamp(-1.0, 1.0).asin();
        FaceStrain { warp: p - 1.0, weft: q - 1.0, shear, share: rest[f].share }
    });
    match strains.iter().position(|s| !(s.warp.is_finite() && s.weft.is_finite() && s.shear.is_finite())) {
        Some(f) => Err(Error::Layout(format!("face {f} has no area in the plane"))),
        None => Ok(strains),
    }
}
