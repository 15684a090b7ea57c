//! The three quadrilaterals of each triangle of a surface, those that close it around a vertex at infinity among them.

use super::patch_quad::{PatchQuad, dense};
use super::split::divisions;
use crate::spline::cap::{CapTriangle, Triangle};
use crate::spline::patch::Parameter;
use crate::spline::surface::Spline;

/// A quadrilateral of a triangle of the surface.
#[derive(Debug, Clone)]
pub(super) enum Quad {
    Patch(PatchQuad),
    /// In a triangle at infinity, at this corner: bilinear in its barycentric weights.
    Cap(CapTriangle, usize),
}

impl Quad {
    /// The three quadrilaterals of each triangle.
    pub fn all(spline: &Spline, triangles: &[Triangle<'_>]) -> Vec<Quad> {
        let divisions = divisions(spline);
        let of = |(at, triangle): (usize, &Triangle<'_>)| {
            [0, 1, 2].map(|k| match triangle {
                Triangle::Patch(_) => Quad::Patch(PatchQuad::new(spline, (at, k), &divisions[at])),
                Triangle::Cap(cap) => Quad::Cap(*cap, k),
            })
        };
        triangles.iter().enumerate().flat_map(of).collect()
    }

    /// The patch of the spline in which it lies, or the chart of a hole.
    pub fn patch(&self) -> usize {
        match self {
            Quad::Patch(quad) => quad.patch as usize,
            Quad::Cap(cap, _) => cap.chart as usize,
        }
    }

    /// The place of (s, t).
    pub fn place(&self, at: [f64; 2]) -> Parameter {
        let (cap, k) = match self {
            Quad::Patch(quad) => return quad.place(at),
            Quad::Cap(cap, k) => (cap, *k),
        };
        let [s, t] = at.map(dense);
        let mut weights = [s * t / 3.0; 3];
        weights[k] += (1.0 - s) * (1.0 - t) + 0.5 * (s * (1.0 - t) + t * (1.0 - s));
        weights[(k + 1) % 3] += 0.5 * s * (1.0 - t);
        weights[(k + 2) % 3] += 0.5 * t * (1.0 - s);
        cap.place(weights)
    }
}
