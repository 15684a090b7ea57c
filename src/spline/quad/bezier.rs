//! Bézier points of splines over four-sided patches: in every span of a patch the surface is one polynomial.

use super::quintic::{LOCAL, MULTIPLICITY, QUINTIC, QuinticBasis};
use super::space::QuadSplineSpace;
use super::spline::QuadSpline;
use crate::geometry::vector::{Vector, add, lerp, scale};

/// The Bézier points of a polynomial over a rectangle of parameters: `[a][b]`, a along u, b along v.
pub(super) type BezierNet = [[Vector; LOCAL]; LOCAL];

/// Per span the Bézier points of a curve as combinations of the span's control points: `[k][j]` is the weight of control point 3 × span + j in
/// point k.
pub type BezierExtraction = Vec<[[f64; LOCAL]; LOCAL]>;

impl QuadSplineSpace {
    /// The Bézier extraction of a patch along u and along v. The Bézier points of a span are the products of both.
    pub fn bezier_extraction(&self, patch: usize) -> [BezierExtraction; 2] {
        self.patch_spans(patch).map(|spans| (0..spans).map(|span| bezier_weights(spans, span)).collect())
    }
}

/// The weights of the control points of a span in its Bézier points. The first three of these follow from the value and both derivatives of
/// the basis functions at the span's start, the others from those at its end: splines are twice continuously differentiable.
fn bezier_weights(spans: usize, span: usize) -> [[f64; LOCAL]; LOCAL] {
    let mut weights = [[0.0; LOCAL]; LOCAL];
    for (place, is_end) in [(span, false), (span + 1, true)] {
        let step = if is_end { -1.0 } else { 1.0 } / spans as f64;
        let basis = QuinticBasis::at(spans, place as f64 / spans as f64);
        // At an inner knot the basis is that of the span behind it, whose first functions are the last ones of this span.
        let shift = basis.first - MULTIPLICITY * span;
        for j in shift..LOCAL {
            let [value, slope, bend] = [0, 1, 2].map(|order| basis.derivatives[order][j - shift]);
            let degree = QUINTIC as f64;
            let second = value + step * slope / degree;
            let third = step * step * bend / (degree * (degree - 1.0)) + 2.0 * second - value;
            for (k, weight) in [value, second, third].into_iter().enumerate() {
                weights[if is_end { QUINTIC - k } else { k }][j] = weight;
            }
        }
    }
    weights
}

impl QuadSpline {
    /// The Bézier points of the spans of a patch: that of span i along u and j along v at i × n + j, with n spans along v.
    pub(super) fn bezier_nets(&self, patch: usize) -> Vec<BezierNet> {
        let net = self.net(patch);
        let [along_u, along_v] = self.space().bezier_extraction(patch);
        let mut nets = Vec::with_capacity(along_u.len() * along_v.len());
        for (i, of_u) in along_u.iter().enumerate() {
            for (j, of_v) in along_v.iter().enumerate() {
                let point = |a: usize, b: usize| {
                    let mut sum = [0.0; 3];
                    for (k, l) in (0..LOCAL).flat_map(|k| (0..LOCAL).map(move |l| (k, l))) {
                        let control = net[MULTIPLICITY * i + k][MULTIPLICITY * j + l];
                        sum = add(sum, scale(of_u[a][k] * of_v[b][l], control));
                    }
                    sum
                };
                nets.push(std::array::from_fn(|a| std::array::from_fn(|b| point(a, b))));
            }
        }
        nets
    }
}

/// The Bézier points of both halves of a rectangle along u.
fn halves(net: &BezierNet) -> [BezierNet; 2] {
    let (mut first, mut second) = (*net, *net);
    for b in 0..LOCAL {
        let mut points = std::array::from_fn::<_, LOCAL, _>(|a| net[a][b]);
        for a in 0..LOCAL {
            first[a][b] = points[0];
            second[QUINTIC - a][b] = points[QUINTIC - a];
            for k in 0..QUINTIC - a {
                points[k] = lerp(points[k], points[k + 1], 0.5);
            }
        }
    }
    [first, second]
}

/// The Bézier points of the quarters of a rectangle, at [0][1] that of small u and large v.
pub(super) fn quarters(net: &BezierNet) -> [[BezierNet; 2]; 2] {
    halves(net).map(|half| halves(&transposed(&half)).map(|quarter| transposed(&quarter)))
}

/// The Bézier points with u and v exchanged.
fn transposed(net: &BezierNet) -> BezierNet {
    std::array::from_fn(|a| std::array::from_fn(|b| net[b][a]))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The value at t of the polynomial of degree 5 with these Bézier coefficients.
    fn value(coefficients: [f64; LOCAL], t: f64) -> f64 {
        let binomials = [1.0, 5.0, 10.0, 10.0, 5.0, 1.0];
        let term =
            |k: usize| binomials[k] * t.powi(k as i32) * (1.0 - t).powi(5 - k as i32) * coefficients[k];
        (0..LOCAL).map(term).sum()
    }

    #[test]
    fn the_weights_give_the_basis_functions_in_every_span() {
        for spans in [1, 2, 3, 7, 32] {
            for span in 0..spans {
                let weights = bezier_weights(spans, span);
                for t in [0.125, 0.5, 0.875] {
                    let basis = QuinticBasis::at(spans, (span as f64 + t) / spans as f64);
                    assert_eq!(basis.first, MULTIPLICITY * span);
                    for j in 0..LOCAL {
                        let found = value(weights.map(|row| row[j]), t);
                        let miss = (found - basis.derivatives[0][j]).abs();
                        assert!(miss < 1e-12, "{spans} spans, {span}, function {j} at {t}: {miss}");
                    }
                }
            }
        }
    }

    #[test]
    fn halves_are_the_same_polynomial() {
        let net: BezierNet = std::array::from_fn(|a| {
            std::array::from_fn(|b| [a as f64, (7 * a + 3 * b) as f64 % 5.0, (a * b) as f64])
        });
        let at = |net: &BezierNet, x: usize, [s, t]: [f64; 2]| {
            value(std::array::from_fn(|a| value(std::array::from_fn(|b| net[a][b][x]), t)), s)
        };
        let [first, second] = halves(&net);
        for (x, [s, t]) in (0..3).flat_map(|x| [[0.2, 0.7], [1.0, 0.4]].map(|st| (x, st))) {
            assert!((at(&first, x, [s, t]) - at(&net, x, [0.5 * s, t])).abs() < 1e-12);
            assert!((at(&second, x, [s, t]) - at(&net, x, [0.5 + 0.5 * s, t])).abs() < 1e-12);
            assert!((at(&transposed(&net), x, [t, s]) - at(&net, x, [s, t])).abs() < 1e-12);
        }
    }
}
