//! The three quadrilaterals of a triangle, and their coordinates.
//!
//! What stands below as s and t is a function of the grid's coordinates σ and τ, s = σ (1 + 3 σ)/4 and t likewise, but along sides at a singular vertex.
//!
//! ```text
//!              C₂                 Quadrilateral k has the corners C_k, the middle of side k, the centroid, and the
//!             /  \                middle of the side before; (s, t) is (0, 0), (1, 0), (1, 1), (0, 1) there.
//!            / 2  \
//!          M₂--G--M₁              In u, which is the chart's coordinate from C_k on, it is the Coons patch of its sides
//!          / 0 | 1 \
//!        C₀----M₀---C₁                u = s a(t) + t b(s) − s t D,   a(t) from M_k to G, b(s) from M_{k−1} to G, D = u(G)
//! ```
//!
//! [Coo67], and bilinear in the chart. Around a singular vertex with the total angle 2πm the surface is smooth in w = z^{1/m}: there
//! u = w, so that the sides at the vertex are rays on which |w| grows linearly, and a(t), b(s) are the images of straight segments.

use crate::geometry::complex::{Complex, add, conj, distance, mul, norm, norm2, scale, sub, unit};
use crate::spline::hole::Sector;
use crate::spline::patch::Parameter;
use crate::spline::space::affine;
use crate::spline::surface::Spline;

/// A corner is the vertex of a hole where it is nearer to it than this share of its side: rounding.
const AT_VERTEX: f64 = 1e-6;

/// The grid is 1 + DENSER times denser at a corner than it would be evenly: there, between the knots of a vertex, a spline bends most.
const DENSER: f64 = 3.0;

/// A quadrilateral of a triangle.
#[derive(Debug, Clone)]
pub(super) struct Quad {
    patch: u32,
    /// Where u = 0 lies in the chart.
    corner: Complex,
    /// What u = 1 is in the chart: a length and a direction.
    frame: Complex,
    /// m.
    turns: i32,
    /// From the corner to the middles of the side from it and of the side to it, and to the centroid, over `frame`.
    ends: [Complex; 2],
    centroid: Complex,
}

impl Quad {
    /// The quadrilateral at corner k of a patch.
    pub fn new(spline: &Spline, patch: usize, k: usize) -> Quad {
        let knots = &spline.space().patches()[patch].knots;
        let [a, b, c] = [0, 1, 2].map(|j| knots[(k + j) % 3][0]);
        let (next, last) = (scale(0.5, sub(b, a)), scale(0.5, sub(c, a)));
        let is_here = |s: &Sector| {
            let [corner, other] = [a, b].map(|p| affine(&s.to, p));
            s.patch as usize == patch && norm(corner) < AT_VERTEX * distance(corner, other)
        };
        let hole = spline.holes().iter().find(|hole| hole.sectors.iter().any(is_here));
        let (turns, frame) = hole.map_or((1, [1.0, 0.0]), |hole| (hole.turns as i32, unit(next)));
        let over = |z: Complex| scale(1.0 / norm2(frame), mul(z, conj(frame)));
        let centroid = over(scale(2.0 / 3.0, add(next, last)));
        Quad { patch: patch as u32, corner: a, frame, turns, ends: [over(next), over(last)], centroid }
    }

    /// The patch of the spline in which it lies.
    pub fn patch(&self) -> usize {
        self.patch as usize
    }

    /// The place of (s, t).
    pub fn place(&self, at: [f64; 2]) -> Parameter {
        let [s, t] = self.dense(at);
        let towards = |end: usize, x: f64| add(self.ends[end], scale(x, sub(self.centroid, self.ends[end])));
        let [a, b, d] = [towards(0, t), towards(1, s), self.centroid].map(|z| self.root(z));
        let u = sub(add(scale(s, a), scale(t, b)), scale(s * t, d));
        let z = (0..self.turns).fold(self.frame, |z, _| mul(z, u));
        let [x, y] = add(self.corner, z);
        Parameter { patch: self.patch, x, y }
    }

    /// The grid's coordinates in the quadrilateral. Sides at a singular vertex stay even: |w| grows along them, whose powers would be lost beside the
    /// corner's coordinates.
    fn dense(&self, [s, t]: [f64; 2]) -> [f64; 2] {
        let dense = |x: f64| x * (1.0 + DENSER * x) / (1.0 + DENSER);
        if self.turns == 1 {
            return [dense(s), dense(t)];
        }
        [(1.0 - t) * s + t * dense(s), (1.0 - s) * t + s * dense(t)]
    }

    /// z^{1/m}.
    fn root(&self, z: Complex) -> Complex {
        if self.turns == 1 {
            return z;
        }
        let share = 1.0 / f64::from(self.turns);
        let (size, angle) = (norm(z).powf(share), share * z[1].atan2(z[0]));
        [size * angle.cos(), size * angle.sin()]
    }
}
