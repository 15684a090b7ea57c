//! The triangles that close a surface around a vertex at infinity.
//!
//! Patches end where the filling of the hole around infinity is the surface. From each side of the last of them, on the rim of the plane's
//! triangulation, a triangle leads to the vertex. In the coordinate w of the hole a straight side of the plane is an arc; with barycentric
//! weights l₀ of the vertex, l₁ and l₂ of the ends of the side,
//!
//! ```text
//!     w = l₁ w₁ + l₂ w₂ + (l₁ + l₂)³ c(l₂/(l₁ + l₂)),
//! ```
//!
//! where c is the distance of the arc from its chord: on the side that is the arc, and at the vertex the map has two continuous
//! derivatives.

use super::hole::Hole;
use super::patch::{Parameter, Patch};
use super::surface::Spline;
use crate::geometry::complex::{Complex, add, conj, norm2, scale, sub};
use std::collections::HashSet;

/// What stands for the vertex at infinity among the control points of a side.
const APEX: u32 = u32::MAX;

/// A triangle of the surface: a patch of the spline, or one of those that close it.
#[derive(Debug, Clone, Copy)]
pub(super) enum Triangle<'a> {
    Patch(&'a Patch),
    Cap(CapTriangle),
}

impl Triangle<'_> {
    /// What side k, from corner k to the next, has in common with that side of the triangle beyond, where it comes in the opposite order:
    /// its control points; of a side at the vertex at infinity that of its other end.
    pub fn along(&self, k: usize, spline: &Spline) -> Vec<u32> {
        let cap = match self {
            Triangle::Patch(patch) => return patch.along(k),
            Triangle::Cap(cap) => cap,
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

/// A triangle from the vertex at infinity, its corner 0, to a side of a patch, against whose direction it has this side.
#[derive(Debug, Clone, Copy)]
pub(super) struct CapTriangle {
    /// The hole's own chart.
    pub chart: u32,
    /// The patch with the side.
    pub patch: u32,
    /// From which of its corners the side runs.
    pub side: usize,
    /// Corners 1 and 2 in the plane, over the radius of the hole.
    ends: [Complex; 2],
}

impl CapTriangle {
    fn new(spline: &Spline, hole: &Hole, (patch, side): (usize, usize)) -> Option<CapTriangle> {
        let at = hole.sectors.iter().find(|sector| sector.patch as usize == patch)?;
        let knots = &spline.space().patches()[patch].knots;
        let end = |k: usize| scale(1.0 / hole.radius, at.in_common(knots[k % 3][0]));
        Some(CapTriangle { chart: hole.chart, patch: patch as u32, side, ends: [end(side + 1), end(side)] })
    }

    /// The place with these barycentric weights.
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
    /// The triangles of the surface: all patches, then those around a vertex at infinity.
    pub(super) fn triangles(&self) -> Vec<Triangle<'_>> {
        let cap = self.cap().into_iter().map(Triangle::Cap);
        self.space().patches().iter().map(Triangle::Patch).chain(cap).collect()
    }

    /// The triangles around the vertex at infinity; none where no hole is there.
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
        sides().filter(is_rim).filter_map(|side| CapTriangle::new(self, hole, side)).collect()
    }
}

/// 1/z.
fn inverse(z: Complex) -> Complex {
    scale(1.0 / norm2(z), conj(z))
}
