//! The three quadrilaterals of each triangle of a surface, cap triangles at infinity included.

use super::patch_quad::{PatchQuad, dense};
use super::split::divisions;
use crate::spline::triangular::{CapTriangle, Parameter, Spline, SurfaceTriangle};

/// A quadrilateral of a triangle of the surface.
#[derive(Debug, Clone)]
pub(super) enum SurfaceQuad {
    Patch(PatchQuad),
    /// In a cap triangle, at this corner: bilinear in the barycentric weights.
    Cap(CapTriangle, usize),
}

impl SurfaceQuad {
    /// The three quadrilaterals of each triangle.
    pub fn all(spline: &Spline, triangles: &[SurfaceTriangle<'_>]) -> Vec<SurfaceQuad> {
        let divisions = divisions(spline);
        let of = |(at, triangle): (usize, &SurfaceTriangle<'_>)| {
            [0, 1, 2].map(|k| match triangle {
                SurfaceTriangle::Patch(_) => {
                    SurfaceQuad::Patch(PatchQuad::new(spline, (at, k), &divisions[at]))
                }
                SurfaceTriangle::Cap(cap) => SurfaceQuad::Cap(*cap, k),
            })
        };
        triangles.iter().enumerate().flat_map(of).collect()
    }

    /// The patch of the spline that it belongs to, or the chart of a hole.
    pub fn patch(&self) -> usize {
        match self {
            SurfaceQuad::Patch(quad) => quad.patch as usize,
            SurfaceQuad::Cap(cap, _) => cap.chart as usize,
        }
    }

    /// The place at (s, t).
    pub fn place(&self, at: [f64; 2]) -> Parameter {
        let (cap, k) = match self {
            SurfaceQuad::Patch(quad) => return quad.place(at),
            SurfaceQuad::Cap(cap, k) => (cap, *k),
        };
        let [s, t] = at.map(dense);
        let mut weights = [s * t / 3.0; 3];
        weights[k] += (1.0 - s) * (1.0 - t) + 0.5 * (s * (1.0 - t) + t * (1.0 - s));
        weights[(k + 1) % 3] += 0.5 * s * (1.0 - t);
        weights[(k + 2) % 3] += 0.5 * t * (1.0 - s);
        cap.place(weights)
    }
}
