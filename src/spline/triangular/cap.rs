//! The cap triangles, which close a surface around a vertex at infinity.
//!
//! Patches end inside the hole around infinity, where its filling alone is the surface. A cap triangle leads from each patch side on the
//! rim of the plane's triangulation to the vertex. In the coordinate w of the hole a straight side of the plane is an arc. With barycentric
//! weights l₀ of the vertex, l₁ and l₂ of the ends of the side, the place in the triangle is
//!
//! ```text
//!     w = l₁ w₁ + l₂ w₂ + (l₁ + l₂)³ c(l₂/(l₁ + l₂)),
//! ```
//!
//! where c is the vector from the chord of the arc to the arc. So the side is the arc, and the map has two continuous derivatives at the
//! vertex.

use super::hole::Hole;
use super::patch::{Parameter, Patch};
use super::surface::Spline;
use crate::geometry::complex::{Complex, add, conj, norm2, scale, sub};
use std::collections::HashSet;

/// The number that stands for the vertex at infinity among the control points of a side.
const APEX: u32 = u32::MAX;

/// A triangle of the surface: a patch of the spline, or a cap triangle.
#[derive(Debug, Clone, Copy)]
pub(crate) enum SurfaceTriangle<'a> {
    Patch(&'a Patch),
    Cap(CapTriangle),
}

impl SurfaceTriangle<'_> {
    /// The control points along side k, from corner k to the next; of a side at the vertex at infinity, [`APEX`] and the point of the other
    /// end. The triangle beyond the side has the same ones in the opposite order.
    pub fn along(&self, k: usize, spline: &Spline) -> Vec<u32> {
        let cap = match self {
            SurfaceTriangle::Patch(patch) => return patch.along(k),
            SurfaceTriangle::Cap(cap) => cap,
        };
        let mut rim = spline.space().patches()[cap.patch as usize].along(cap.side);
        rim.reverse();
        match k {
            0 => vec![APEX, rim[0]],
            1 => rim,
            _ => vec![rim[rim.len() - 1], APEX],
        }
    }
}

/// A triangle from the vertex at infinity, its corner 0, to a side of a patch; it has this side in the opposite direction.
#[derive(Debug, Clone, Copy)]
pub(crate) struct CapTriangle {
    /// The chart of the hole.
    pub chart: u32,
    /// The patch with the side.
    pub patch: u32,
    /// The corner of the patch at which the side begins.
    pub side: usize,
    /// The positions of corners 1 and 2 in the plane, over the radius of the hole.
    ends: [Complex; 2],
}

impl CapTriangle {
    fn new(spline: &Spline, hole: &Hole, patch: usize, side: usize) -> Option<CapTriangle> {
        let at = hole.sectors.iter().find(|sector| sector.patch as usize == patch)?;
        let knots = &spline.space().patches()[patch].knots;
        let end = |k: usize| scale(1.0 / hole.radius, at.in_common(knots[k % 3][0]));
        Some(CapTriangle { chart: hole.chart, patch: patch as u32, side, ends: [end(side + 1), end(side)] })
    }

    /// The place with given barycentric weights.
    pub fn place(&self, [_, a, b]: [f64; 3]) -> Parameter {
        let sum = a + b;
        let along = if sum > 0.0 { b / sum } else { 0.0 };
        let [p, q] = self.ends;
        let [w1, w2] = self.ends.map(inverse);
        let chord = add(scale(1.0 - along, w1), scale(along, w2));
        let arc = inverse(add(scale(1.0 - along, p), scale(along, q)));
        let [x, y] = add(scale(sum, chord), scale(sum * sum * sum, sub(arc, chord)));
        Parameter { patch: self.chart, x, y }
    }
}

impl Spline {
    /// The triangles of the surface: all patches, then the cap triangles.
    pub(crate) fn triangles(&self) -> Vec<SurfaceTriangle<'_>> {
        let cap = self.cap().into_iter().map(SurfaceTriangle::Cap);
        self.space().patches().iter().map(SurfaceTriangle::Patch).chain(cap).collect()
    }

    /// The cap triangles; none without a hole around infinity.
    fn cap(&self) -> Vec<CapTriangle> {
        let Some(hole) = self.holes().iter().find(|hole| hole.is_at_infinity() && hole.fill.is_some()) else {
            return Vec::new();
        };
        let patches = self.space().patches();
        let sides = || (0..patches.len()).flat_map(|patch| (0..3).map(move |k| (patch, k)));
        let known: HashSet<Vec<u32>> = sides().map(|(patch, k)| patches[patch].along(k)).collect();
        let is_rim = |&(patch, k): &(usize, usize)| {
            let mut along = patches[patch].along(k);
            along.reverse();
            !known.contains(&along)
        };
        sides().filter(is_rim).filter_map(|(patch, k)| CapTriangle::new(self, hole, patch, k)).collect()
    }
}

/// The inverse 1/z.
fn inverse(z: Complex) -> Complex {
    scale(1.0 / norm2(z), conj(z))
}
