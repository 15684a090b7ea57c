//! The spline at the places of a grid, with differences for derivatives.
//!
//! A derivative at the end of a span is the difference quotient of four values inside it. So the patches follow what the spline does over
//! spans, and not what it does between knots much closer to each other, where its derivatives say nothing of its neighbourhood.

use crate::geometry::vector::{Vector, add, cross, scale, sub};

/// Parts into which a span is divided.
pub(super) const PARTS: usize = 3;
/// Weights of four values at distances 0, ⅓, ⅔, 1 in the derivative at the first; exact for cubics.
const WEIGHTS: [f64; PARTS + 1] = [-5.5, 9.0, -4.5, 1.0];

/// Where in a span the distance from the spline is measured: inside the span, where the interpolation errs most, and nearer to its ends.
pub(super) const WITHIN: [f64; 3] = [1.0 / 6.0, 0.5, 5.0 / 6.0];
/// A place in a quadrilateral.
pub(super) type At = (usize, [f64; 2]);

/// The points of a quadrilateral with m × n spans, and its derivatives along the rim by s or t.
#[derive(Debug, Clone, Default)]
pub(super) struct Sample {
    /// Points at the ends of spans: `points[j][i]`, i along s.
    pub points: Vec<Vec<Vector>>,
    /// Derivatives across the sides t = 0, s = 1, t = 1, s = 0, by t or s, at the ends of spans.
    pub across: [Vec<Vector>; 4],
    /// Mixed derivatives at (0, 0), (1, 0), (0, 1), (1, 1).
    pub twists: [Vector; 4],
}

/// Places of a grid with so many spans, each divided in [`PARTS`], row by row.
pub(super) fn grid([m, n]: [usize; 2]) -> impl Iterator<Item = [f64; 2]> {
    let at = |i: usize, spans: usize| i as f64 / (PARTS * spans) as f64;
    (0..=PARTS * n).flat_map(move |j| (0..=PARTS * m).map(move |i| [at(i, m), at(j, n)]))
}

/// Places between the knots of so many equal spans.
pub(super) fn within(spans: usize) -> impl Iterator<Item = f64> {
    (0..spans).flat_map(move |i| WITHIN.map(|x| (i as f64 + x) / spans as f64))
}

impl Sample {
    /// From the points of a [`grid`].
    pub fn new(points: &[Vector], [m, n]: [usize; 2]) -> Sample {
        let rows: Vec<&[Vector]> = points.chunks(PARTS * m + 1).collect();
        let [last, top] = [PARTS * m, PARTS * n];
        let by_s =
            |j: usize, right: bool| derivative(m, right, |k| rows[j][if right { last - k } else { k }]);
        let by_t = |i: usize, high: bool| derivative(n, high, |k| rows[if high { top - k } else { k }][i]);
        let twist =
            |right: bool, high: bool| derivative(n, high, |k| by_s(if high { top - k } else { k }, right));
        let (along_s, along_t) = (|| (0..=m).map(|i| PARTS * i), || (0..=n).map(|j| PARTS * j));
        Sample {
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

    /// ∂s × ∂t at corner k of the way around.
    pub fn normal(&self, k: usize) -> Vector {
        let [s, t] = [[0, 0], [1, 0], [1, 1], [0, 1]][k];
        cross(self.ends([0, 2][t])[s], self.ends([3, 1][s])[t])
    }
}

/// The derivative at one end of k spans in the unit interval, of values at steps from that end; at 1 the steps go backwards.
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
        let sample = Sample::new(&points, [2, 4]);
        let near = |a: Vector, b: Vector| (0..3).all(|x| (a[x] - b[x]).abs() < 1e-12);
        assert!(near(sample.points[4][2], at([1.0, 1.0])));
        assert!(near(sample.ends(2)[1], [3.0, 1.0, 1.0]) && near(sample.ends(1)[0], [-1.0, 0.0, 1.0]));
        assert!(near(sample.across[3][2], [0.0, 0.25, 0.5]) && near(sample.across[0][1], [-1.0, 0.0, 0.5]));
        assert!(near(sample.twists[3], [0.0, 2.0, 1.0]) && near(sample.twists[0], [0.0, 0.0, 1.0]));
        assert!(near(sample.normal(2), cross([3.0, 1.0, 1.0], [-1.0, 8.0, 1.0])));
    }
}
