//! Samples of the spline on the grid of a quadrilateral, with difference quotients as derivatives.
//!
//! A derivative at the end of a span is the difference quotient of four values inside the span. So the patches follow the spline on the
//! scale
//! of spans, and not on that of knots which lie much closer to each other, where its derivatives are not typical of the neighbourhood.

use crate::geometry::vector::{Vector, add, cross, scale, sub};

/// Number of parts into which a span is divided.
pub(super) const PARTS: usize = 3;
/// Weights of the values at distances 0, ⅓, ⅔, 1 in the derivative at the first; exact for cubics.
const WEIGHTS: [f64; PARTS + 1] = [-5.5, 9.0, -4.5, 1.0];

/// Places in a span at which the distance from the spline is measured: in the middle, where the interpolation errs most, and nearer to the
/// ends.
pub(super) const WITHIN: [f64; 3] = [1.0 / 6.0, 0.5, 5.0 / 6.0];
/// A place in a quadrilateral: its number and (s, t).
pub(super) type QuadPlace = (usize, [f64; 2]);

/// The spline's points on a quadrilateral with m × n spans, and its derivatives by s or t along the rim.
#[derive(Debug, Clone, Default)]
pub(super) struct QuadSample {
    /// The points at the ends of spans: `points[j][i]`, i along s.
    pub points: Vec<Vec<Vector>>,
    /// The derivatives across the sides t = 0, s = 1, t = 1, s = 0, by t or s, at the ends of spans.
    pub across: [Vec<Vector>; 4],
    /// The mixed derivatives at (0, 0), (1, 0), (0, 1), (1, 1).
    pub twists: [Vector; 4],
}

/// The places of a grid with m × n spans, each divided into [`PARTS`], row by row.
pub(super) fn grid([m, n]: [usize; 2]) -> impl Iterator<Item = [f64; 2]> {
    let at = |i: usize, spans: usize| i as f64 / (PARTS * spans) as f64;
    (0..=PARTS * n).flat_map(move |j| (0..=PARTS * m).map(move |i| [at(i, m), at(j, n)]))
}

/// The places of measurement in a number of equal spans.
pub(super) fn within(spans: usize) -> impl Iterator<Item = f64> {
    (0..spans).flat_map(move |i| WITHIN.map(|x| (i as f64 + x) / spans as f64))
}

impl QuadSample {
    /// The sample with given points of a [`grid`].
    pub fn new(points: &[Vector], [m, n]: [usize; 2]) -> QuadSample {
        let rows: Vec<&[Vector]> = points.chunks(PARTS * m + 1).collect();
        let [last, top] = [PARTS * m, PARTS * n];
        let by_s =
            |j: usize, right: bool| derivative(m, right, |k| rows[j][if right { last - k } else { k }]);
        let by_t = |i: usize, high: bool| derivative(n, high, |k| rows[if high { top - k } else { k }][i]);
        let twist =
            |right: bool, high: bool| derivative(n, high, |k| by_s(if high { top - k } else { k }, right));
        let (along_s, along_t) = (|| (0..=m).map(|i| PARTS * i), || (0..=n).map(|j| PARTS * j));
        QuadSample {
            points: along_t().map(|j| along_s().map(|i| rows[j][i]).collect()).collect(),
            across: [
                along_s().map(|i| by_t(i, false)).collect(),
                along_t().map(|j| by_s(j, true)).collect(),
                along_s().map(|i| by_t(i, true)).collect(),
                along_t().map(|j| by_s(j, false)).collect(),
            ],
            twists: [twist(false, false), twist(true, false), twist(false, true), twist(true, true)],
        }
    }

    /// The points along a side, in the direction of s or t.
    pub fn along(&self, side: usize) -> Vec<Vector> {
        let last = self.points[0].len() - 1;
        match side {
            0 => self.points[0].clone(),
            1 => self.points.iter().map(|row| row[last]).collect(),
            2 => self.points[self.points.len() - 1].clone(),
            _ => self.points.iter().map(|row| row[0]).collect(),
        }
    }

    /// The derivatives along a side at its ends, in the direction of s or t: those across the sides that meet it.
    pub fn ends(&self, side: usize) -> [Vector; 2] {
        let (sides, at) = ([[3, 1], [0, 2]][side % 2], [0, usize::MAX, usize::MAX, 0][side]);
        sides.map(|k| self.across[k][at.min(self.across[k].len() - 1)])
    }

    /// The normal ∂s × ∂t at corner k of the way around.
    pub fn normal(&self, k: usize) -> Vector {
        let [s, t] = [[0, 0], [1, 0], [1, 1], [0, 1]][k];
        cross(self.ends([0, 2][t])[s], self.ends([3, 1][s])[t])
    }
}

/// The derivative at 0 of a function on the unit interval with k spans, from its values at steps from there; at 1 the steps go backwards.
fn derivative(spans: usize, backwards: bool, value: impl Fn(usize) -> Vector) -> Vector {
    let sum = (1..=PARTS).fold([0.0; 3], |sum, k| add(sum, scale(WEIGHTS[k], sub(value(k), value(0)))));
    scale(if backwards { -(spans as f64) } else { spans as f64 }, sum)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_of_cubics_are_their_derivatives() {
        let at = |[s, t]: [f64; 2]| [s * s * s - t, 2.0 * t * t * t + s * t * t, 1.0 + s * t];
        let points: Vec<Vector> = grid([2, 4]).map(at).collect();
        let sample = QuadSample::new(&points, [2, 4]);
        let near = |a: Vector, b: Vector| (0..3).all(|x| (a[x] - b[x]).abs() < 1e-12);
        assert!(near(sample.points[4][2], at([1.0, 1.0])));
        assert!(near(sample.ends(2)[1], [3.0, 1.0, 1.0]) && near(sample.ends(1)[0], [-1.0, 0.0, 1.0]));
        assert!(near(sample.across[3][2], [0.0, 0.25, 0.5]) && near(sample.across[0][1], [-1.0, 0.0, 0.5]));
        assert!(near(sample.twists[3], [0.0, 2.0, 1.0]) && near(sample.twists[0], [0.0, 0.0, 1.0]));
        assert!(near(sample.normal(2), cross([3.0, 1.0, 1.0], [-1.0, 8.0, 1.0])));
    }
}
