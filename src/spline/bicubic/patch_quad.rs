//! The three quadrilaterals of a patch, and their coordinates.
//!
//! The s and t below are functions of the grid's coordinates σ and τ, s = σ (1 + 3 σ)/4 and t likewise, except along sides at a singular
//! vertex.
//!
//! ```text
//!              C₂                 Quadrilateral k has the corners C_k, the middle of side k, the centroid, and the
//!             /  \                middle of the side before; (s, t) is (0, 0), (1, 0), (1, 1), (0, 1) there.
//!            / 2  \
//!          M₂--G--M₁              In u, which is the chart's coordinate from C_k on, it is the Coons patch of its sides
//!          M₂--G--M₁              In u, the chart's coordinate relative to C_k, it is the Coons patch of its sides
//!        C₀----M₀---C₁                u = s a(t) + t b(s) − s t D,   a(t) from M_k to G, b(s) from M_{k−1} to G, D = u(G)
//! ```
//!
//! [Coo67], which is bilinear in the chart. Around a singular vertex with total angle 2πm the surface is smooth in w = z^{1/m}. There u =
//! w: the sides at the vertex are rays on which |w| grows linearly, and a(t), b(s) are the images of straight segments. If that patch turns
//! over or leaves the triangle, M and G are moved along the lines from the vertex on which they lie ([`super::split`]). If no choice helps,
//! the place is the bilinear one times (s + t − s t)^{m−1}, which is the same on all four sides.

use crate::geometry::complex::{Complex, add, conj, cross, mul, norm, norm2, scale, sub, unit};
use crate::spline::triangular::{Parameter, Spline};

/// Cells along a side of the grid on which a Coons patch is checked.
const CELLS: u8 = 16;
/// Share of a triangle by which a place on its side may lie outside: rounding.
const INSIDE: f64 = 1e-12;
/// The grid is 1 + DENSER times denser at a corner than an even one, because a spline bends most between the knots of a vertex.
const DENSER: f64 = 3.0;

/// The points at which a patch is divided into three quadrilaterals.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PatchDivision {
    /// For each side, the share of its length from its first corner at which it is divided.
    pub middles: [f64; 3],
    /// Barycentric weights of the common corner of the three quadrilaterals.
    pub centre: [f64; 3],
    /// For each corner the total angle of its vertex in turns: m of a singular vertex, otherwise 1.
    pub turns: [f64; 3],
}

/// The disk around a singular vertex in which the filling alone is the surface.
#[derive(Debug, Clone, Copy)]
struct FilledDisk {
    /// The chart of its hole.
    chart: u32,
    /// The ratio of the coordinate of that chart to the quadrilateral's coordinate w.
    scale: Complex,
    /// Largest size of that coordinate in the disk.
    inner: f64,
}

/// A quadrilateral of a patch.
#[derive(Debug, Clone)]
pub(super) struct PatchQuad {
    pub patch: u32,
    /// The position of u = 0 in the chart.
    corner: Complex,
    /// The vector u = 1 in the chart: a length and a direction.
    frame: Complex,
    /// The number of turns m of the corner.
    turns: f64,
    /// The disk of the filling, if the corner is a singular vertex with a filling.
    filled: Option<FilledDisk>,
    /// The vectors from the corner to the middles of the two sides at it, over `frame`.
    ends: [Complex; 2],
    /// The vector from the corner to the centroid, over `frame`.
    centroid: Complex,
    /// True if the Coons patch in w neither turns over nor leaves the triangle, as it can where that has a wide angle at a singular vertex.
    /// A sound one is taken.
    is_sound: bool,
}

impl PatchQuad {
    /// The quadrilateral at corner k of a patch.
    pub fn new(spline: &Spline, (patch, k): (usize, usize), division: &PatchDivision) -> PatchQuad {
        let knots = &spline.space().patches()[patch].knots;
        let [a, b, c] = [0, 1, 2].map(|j| knots[(k + j) % 3][0]);
        let (next, last) = (sub(b, a), sub(c, a));
        let turns = division.turns[k];
        let frame = if turns == 1.0 { [1.0, 0.0] } else { unit(next) };
        let over = |z: Complex| scale(1.0 / norm2(frame), mul(z, conj(frame)));
        let [second, third] = [1, 2].map(|j| division.centre[(k + j) % 3]);
        let centroid = over(add(scale(second, next), scale(third, last)));
        let (from, to) = (division.middles[k], 1.0 - division.middles[(k + 2) % 3]);
        let ends = [over(scale(from, next)), over(scale(to, last))];
        let patch = patch as u32;
        let filled = spline.holes().iter().filter(|_| turns != 1.0).find_map(|hole| {
            let [p, q] = [a, add(a, frame)].map(|[x, y]| Parameter { patch, x, y });
            let scale = hole.spoke(p, q)?;
            Some(FilledDisk { chart: hole.chart, scale, inner: hole.inner })
        });
        let quad = PatchQuad { patch, corner: a, frame, turns, filled, ends, centroid, is_sound: true };
        let is_sound = turns == 1.0 || quad.has_sound_coons_patch(from, to);
        PatchQuad { is_sound, ..quad }
    }

    /// True if the Coons patch in w neither turns over nor leaves the triangle; the quadrilateral is that patch then.
    pub fn is_sound(&self) -> bool {
        self.is_sound
    }

    /// The place at (s, t). Where the filling around a singular vertex alone is the surface, it is in the chart of the hole: there z = wᵐ
    /// is so small that its digits would be lost in the coordinates of the patch.
    pub fn place(&self, at: [f64; 2]) -> Parameter {
        let local = self.local(at);
        let in_filling = self.filled.map(|filled| (filled, mul(filled.scale, root(local, self.turns))));
        match in_filling {
            Some((FilledDisk { chart, inner, .. }, w)) if norm(w) <= inner => {
                Parameter { patch: chart, x: w[0], y: w[1] }
            }
            _ => {
                let [x, y] = add(self.corner, mul(self.frame, local));
                Parameter { patch: self.patch, x, y }
            }
        }
    }

    /// The position at (s, t) relative to the corner, over the frame.
    fn local(&self, at: [f64; 2]) -> Complex {
        let [s, t] = self.dense(at);
        if !self.is_sound {
            let [a, b, d] = [
                scale(s * (1.0 - t), self.ends[0]),
                scale(t * (1.0 - s), self.ends[1]),
                scale(s * t, self.centroid),
            ];
            let size = s + t - s * t;
            let stretch = if size > 0.0 { size.powf(self.turns - 1.0) } else { 0.0 };
            return scale(stretch, add(add(a, b), d));
        }
        let towards = |end: usize, x: f64| add(self.ends[end], scale(x, sub(self.centroid, self.ends[end])));
        let [a, b, d] = [towards(0, t), towards(1, s), self.centroid].map(|z| root(z, self.turns));
        let u = sub(add(scale(s, a), scale(t, b)), scale(s * t, d));
        root(u, 1.0 / self.turns)
    }

    /// True if the cells of a grid are counterclockwise and inside the triangle; `from` and `to` are the shares of its sides at the corner.
    fn has_sound_coons_patch(&self, from: f64, to: f64) -> bool {
        let at = |i: u8, j: u8| self.local([i, j].map(|k| f64::from(k) / f64::from(CELLS)));
        let [next, last] = [scale(1.0 / from, self.ends[0]), scale(1.0 / to, self.ends[1])];
        let whole = cross(next, last);
        let is_inside = |z: Complex| {
            let [p, q] = [cross(z, last), cross(next, z)].map(|x| x / whole);
            p.min(q).min(1.0 - p - q) > -INSIDE
        };
        let is_upright = |i: u8, j: u8| {
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            cross(sub(b, a), sub(d, a)) > 0.0 && cross(sub(d, c), sub(b, c)) > 0.0
        };
        (0..CELLS).all(|i| (0..CELLS).all(|j| is_upright(i, j) && is_inside(at(i + 1, j + 1))))
    }

    /// The coordinates (s, t) of grid coordinates. Sides at a singular vertex stay even, since no knots lie near it, where the filling is
    /// as smooth as elsewhere.
    fn dense(&self, [s, t]: [f64; 2]) -> [f64; 2] {
        if self.turns == 1.0 {
            return [dense(s), dense(t)];
        }
        [(1.0 - t) * s + t * dense(s), (1.0 - s) * t + s * dense(t)]
    }
}

/// The coordinate s of a grid coordinate σ.
pub(super) fn dense(x: f64) -> f64 {
    x * (1.0 + DENSER * x) / (1.0 + DENSER)
}

/// The root z^{1/m}.
pub(super) fn root(z: Complex, turns: f64) -> Complex {
    if turns == 1.0 {
        return z;
    }
    let share = 1.0 / turns;
    let (size, angle) = (norm(z).powf(share), share * z[1].atan2(z[0]));
    [size * angle.cos(), size * angle.sin()]
}
