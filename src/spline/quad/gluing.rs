//! The condition of a common tangent plane across an arc: `p_v + q_v = γ(u) p_u`, with γ a polynomial along the arc [Pet02] and derivatives by
//! parameters in one unit for all patches.

use super::layout::ArcEnd;
use super::quintic::{LOCAL, QUINTIC, QuinticBasis, basis_size};
use std::f64::consts::PI;

/// Places in every span at which the condition is asked for: more than the degree of either side, so that it holds all along.
const PLACES: usize = QUINTIC + 4;
/// Entries below this share of the largest are rounding.
const ROUNDING: f64 = 1e-11;

/// γ of an arc from its start u = 0 to its end u = 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Gluing {
    /// The coefficients of 1, u, u².
    coefficients: [f64; 3],
    pub lengths: GluingLengths,
}

/// A length in parameters with the number of spans on it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct GluingLength {
    pub length: f64,
    pub spans: usize,
}

/// The lengths of an arc and of the patches across it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct GluingLengths {
    pub along: GluingLength,
    pub left: GluingLength,
    pub right: GluingLength,
}

impl Gluing {
    /// γ with the values that the nodes at both ends ask for. Towards a regular node it vanishes to second order: where it vanished to first
    /// order only, the crossing arc's would have to be the same, or the tangents there would vanish.
    pub fn between([start, end]: [ArcEnd; 2], lengths: GluingLengths) -> Gluing {
        let value = |end| match end {
            ArcEnd::Irregular(c) => c,
            ArcEnd::Regular | ArcEnd::Across => 0.0,
        };
        let [a, b] = [value(start), value(end)];
        let coefficients = match [start, end] {
            [ArcEnd::Regular, ArcEnd::Irregular(_)] => [0.0, 0.0, -b],
            [ArcEnd::Irregular(_), ArcEnd::Regular] => [a, -2.0 * a, a],
            _ => [a, -a - b, 0.0],
        };
        Gluing { coefficients, lengths }
    }

    /// True if γ vanishes: then the derivatives across are opposite, and higher ones may be continuous too.
    pub fn is_flat(&self) -> bool {
        self.coefficients == [0.0; 3]
    }

    /// The value at a place.
    pub fn at(&self, u: f64) -> f64 {
        let [a, b, c] = self.coefficients;
        a + u * (b + u * c)
    }

    /// The bits of its numbers, by which equal ones are found.
    pub fn key(&self) -> [u64; 9] {
        let [a, b, c] = self.coefficients.map(f64::to_bits);
        let GluingLengths { along, left, right } = self.lengths;
        let [d, e, f] = [along, left, right].map(|on| on.length.to_bits());
        let [x, y, z] = [along, left, right].map(|on| on.spans as u64);
        [a, b, c, d, e, f, x, y, z]
    }

    /// Independent equations of the condition, each with a coefficient for the control points of three rows along the arc: the first row
    /// inside the left patch, that inside the right one, and the arc's own.
    pub fn equations(&self) -> Vec<Vec<f64>> {
        let GluingLengths { along: GluingLength { length: along, spans }, left, right } = self.lengths;
        let n = basis_size(spans);
        let [to_left, to_right] = [left, right].map(|across| (QUINTIC * across.spans) as f64 / across.length);
        let mut rows = Vec::with_capacity(PLACES * spans);
        for place in 0..PLACES * spans {
            let chebyshev = 0.5 - 0.5 * (PI * ((place % PLACES) as f64 + 0.5) / PLACES as f64).cos();
            let u = ((place / PLACES) as f64 + chebyshev) / spans as f64;
            let QuinticBasis { first, derivatives: [value, slope, ..] } = QuinticBasis::at(spans, u);
            let mut row = vec![0.0; 3 * n];
            for j in 0..LOCAL {
                row[first + j] = to_left * value[j];
                row[n + first + j] = to_right * value[j];
                row[2 * n + first + j] = -(to_left + to_right) * value[j] - self.at(u) * slope[j] / along;
            }
            rows.push(row);
        }
        echelon(rows, n)
    }
}

/// The reduced echelon form of equations, with pivots among the first columns as long as these have any, and zeros for rounding.
fn echelon(mut rows: Vec<Vec<f64>>, first: usize) -> Vec<Vec<f64>> {
    let scale = rows.iter().flatten().fold(0.0f64, |most, x| most.max(x.abs()));
    let mut free: Vec<usize> = (0..rows.first().map_or(0, Vec::len)).collect();
    for done in 0..rows.len() {
        let among = |&&c: &&usize| done >= first || c < first;
        let entries = (done..rows.len()).flat_map(|r| free.iter().filter(among).map(move |&c| (r, c)));
        let size = |&(r, c): &(usize, usize)| rows[r][c].abs();
        let largest = entries.max_by(|a, b| size(a).total_cmp(&size(b)));
        let Some((r, pivot)) = largest.filter(|at| size(at) > ROUNDING * scale) else {
            rows.truncate(done);
            break;
        };
        rows.swap(done, r);
        free.retain(|&c| c != pivot);
        let value = rows[done][pivot];
        rows[done].iter_mut().for_each(|x| *x /= value);
        let row = rows[done].clone();
        for other in rows.iter_mut().enumerate().filter(|(r, _)| *r != done).map(|(_, other)| other) {
            let weight = std::mem::take(&mut other[pivot]);
            other.iter_mut().zip(&row).for_each(|(x, y)| *x -= weight * y);
            other[pivot] = 0.0;
        }
    }
    rows.iter_mut().flatten().filter(|x| x.abs() <= ROUNDING).for_each(|x| *x = 0.0);
    rows
}
