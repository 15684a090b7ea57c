//! Further terms of the energy of a flat map, beside those of its triangles: lengths of paths, pinned vertices, straight pieces of the
//! border, and sides of the border that come near each other.

use super::rest_triangle::TriangleModel;
use crate::geometry::complex::{cross, dot, norm, sub};

/// One term. Vertices are numbers; lengths are in the unit of the descent.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Term {
    /// `weight (|p − q|/length − 1)²` of the places p, q of two vertices.
    Length { ends: [u32; 2], length: f64, weight: f64 },
    /// A vertex whose place is given, with the multiplier of that condition.
    Pin { vertex: u32, at: [f64; 2], multiplier: [f64; 2] },
    /// A vertex (the first) that is to lie on the line through two others: the cross product of the ways to them, over a length, is 0.
    Straight { corners: [u32; 3], length: f64, multiplier: f64 },
    /// A vertex (the first) nearer than `reach` to a side of the border: `weight (reach/distance − 1)²` \[SS15\].
    Contact { corners: [u32; 3], reach: f64, weight: f64 },
}

/// The point of a side that is nearest to a point: the shares of the side's ends, the distance and the unit vector from there.
struct NearestOnSide {
    shares: [f64; 2],
    distance: f64,
    away: [f64; 2],
}

impl NearestOnSide {
    fn new([p, a, b]: [[f64; 2]; 3]) -> NearestOnSide {
        let (u, v) = (sub(p, a), sub(b, a));
        let share = (dot(u, v) / dot(v, v)).clamp(0.0, 1.0);
        let way = sub(u, v.map(|x| share * x));
        let distance = norm(way);
        NearestOnSide { shares: [1.0 - share, share], distance, away: way.map(|x| x / distance) }
    }
}

/// The distance of the first point from the side between the others.
pub(super) fn distance_to_side(corners: [[f64; 2]; 3]) -> f64 {
    NearestOnSide::new(corners).distance
}

impl Term {
    /// The vertices; the first again in places that a term does not need.
    pub fn corners(&self) -> [u32; 3] {
        match *self {
            Term::Length { ends: [a, b], .. } => [a, b, a],
            Term::Pin { vertex, .. } => [vertex; 3],
            Term::Straight { corners, .. } | Term::Contact { corners, .. } => corners,
        }
    }

    /// By how much a condition is missed; 0 for terms that are none.
    pub fn residual(&self, points: &[[f64; 2]]) -> [f64; 2] {
        let at = self.corners().map(|v| points[v as usize]);
        match *self {
            Term::Pin { at: place, .. } => sub(at[0], place),
            Term::Straight { length, .. } => [cross(sub(at[0], at[1]), sub(at[2], at[1])) / length, 0.0],
            Term::Length { .. } | Term::Contact { .. } => [0.0; 2],
        }
    }

    /// The value, with conditions as multiplier times residual and half the stiffness times its square.
    pub fn value(&self, points: &[[f64; 2]], stiffness: f64) -> f64 {
        let at = self.corners().map(|v| points[v as usize]);
        let missed = self.residual(points);
        match *self {
            Term::Length { length, weight, .. } => weight * (norm(sub(at[1], at[0])) / length - 1.0).powi(2),
            Term::Pin { multiplier, .. } => dot(multiplier, missed) + 0.5 * stiffness * dot(missed, missed),
            Term::Straight { multiplier, .. } => {
                multiplier * missed[0] + 0.5 * stiffness * missed[0] * missed[0]
            }
            Term::Contact { reach, weight, .. } => {
                weight * (reach / distance_to_side(at).min(reach) - 1.0).powi(2)
            }
        }
    }

    /// Adds what the stiffness makes of the residual to the multiplier, as the method of multipliers does [NW06, Section 17.3].
    pub fn raise(&mut self, points: &[[f64; 2]], stiffness: f64) {
        let missed = self.residual(points);
        match self {
            Term::Pin { multiplier, .. } => (0..2).for_each(|c| multiplier[c] += stiffness * missed[c]),
            Term::Straight { multiplier, .. } => *multiplier += stiffness * missed[0],
            Term::Length { .. } | Term::Contact { .. } => {}
        }
    }

    /// The gradient and the Hessian; where `clamped`, without the parts of the Hessian that can be negative.
    pub fn model(&self, points: &[[f64; 2]], stiffness: f64, clamped: bool) -> TriangleModel {
        let at = self.corners().map(|v| points[v as usize]);
        let mut model = TriangleModel { gradient: [0.0; 6], hessian: [0.0; 21] };
        let missed = self.residual(points);
        match *self {
            Term::Length { length, weight, .. } => {
                let way = sub(at[1], at[0]);
                let now = norm(way);
                let along = way.map(|x| x / now);
                let slope = 2.0 * weight * (now / length - 1.0) / length;
                model.add_slope(slope, ends_of(along));
                model.add_square(2.0 * weight / (length * length), ends_of(along));
                let across = if clamped { slope.max(0.0) } else { slope };
                model.add_square(across / now, ends_of([-along[1], along[0]]));
            }
            Term::Pin { multiplier, .. } => {
                for c in 0..2 {
                    let mut axis = [0.0; 6];
                    axis[c] = 1.0;
                    model.add_slope(multiplier[c] + stiffness * missed[c], axis);
                    model.add_square(stiffness, axis);
                }
            }
            Term::Straight { length, multiplier, .. } => {
                let ([x, y], [z, w]) = (sub(at[0], at[1]), sub(at[2], at[1]));
                let slopes = [w, -z, y - w, z - x, -y, x].map(|s| s / length);
                let force = multiplier + stiffness * missed[0];
                model.add_slope(force, slopes);
                model.add_square(stiffness, slopes);
                if !clamped {
                    model.add_crosses(force / length);
                }
            }
            Term::Contact { reach, weight, .. } => {
                let near = NearestOnSide::new(at);
                if near.distance < reach {
                    let ([first, second], d) = (near.shares, near.distance);
                    let [x, y] = near.away;
                    let slopes = [x, y, -first * x, -first * y, -second * x, -second * y];
                    let over = reach / d - 1.0;
                    model.add_slope(-2.0 * weight * over * reach / (d * d), slopes);
                    let bent = 2.0 * weight * reach / d.powi(3) * (reach / d + 2.0 * over);
                    model.add_square(bent, slopes);
                }
            }
        }
        model
    }
}

/// A direction at the second of two ends and its opposite at the first.
fn ends_of([x, y]: [f64; 2]) -> [f64; 6] {
    [-x, -y, x, y, 0.0, 0.0]
}

impl TriangleModel {
    fn add_slope(&mut self, value: f64, direction: [f64; 6]) {
        self.gradient.iter_mut().zip(direction).for_each(|(g, d)| *g += value * d);
    }

    /// Adds force times the second derivatives of the cross product of the ways from the second corner to the first and to the third.
    fn add_crosses(&mut self, force: f64) {
        let mut add = |i: usize, j: usize, sign: f64| {
            let (i, j) = (i.max(j), i.min(j));
            self.hessian[i * (i + 1) / 2 + j] += sign * force;
        };
        // p × b − p × a − a × b for the corners p, a, b.
        for (u, v, sign) in [(0, 2, 1.0), (0, 1, -1.0), (1, 2, -1.0)] {
            add(2 * u, 2 * v + 1, sign);
            add(2 * u + 1, 2 * v, -sign);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STIFFNESS: f64 = 3.0;

    fn terms() -> Vec<Term> {
        vec![
            Term::Length { ends: [0, 1], length: 1.3, weight: 0.7 },
            Term::Length { ends: [0, 1], length: 0.4, weight: 0.7 },
            Term::Pin { vertex: 2, at: [0.2, -0.4], multiplier: [0.3, -0.2] },
            Term::Straight { corners: [2, 0, 1], length: 1.7, multiplier: -0.6 },
            Term::Contact { corners: [2, 0, 1], reach: 0.9, weight: 0.5 },
            Term::Contact { corners: [0, 1, 2], reach: 2.0, weight: 0.5 },
            Term::Contact { corners: [2, 0, 1], reach: 0.1, weight: 0.5 },
        ]
    }

    fn points() -> Vec<[f64; 2]> {
        vec![[0.1, 0.2], [1.2, 0.1], [0.5, 0.7]]
    }

    fn moved(k: usize, by: f64) -> Vec<[f64; 2]> {
        let mut all = points();
        all.as_flattened_mut()[k] += by;
        all
    }

    /// The gradient in the coordinates of all three vertices.
    fn gathered(term: &Term, at: &[[f64; 2]]) -> [f64; 6] {
        let mut all = [0.0; 6];
        let model = term.model(at, STIFFNESS, false);
        for (k, v) in term.corners().into_iter().enumerate() {
            (0..2).for_each(|c| all[2 * v as usize + c] += model.gradient[2 * k + c]);
        }
        all
    }

    #[test]
    fn gradients_are_those_of_differences_and_so_are_the_hessians_of_lengths_and_conditions() {
        let h = 1e-6;
        for term in terms() {
            let gradient = gathered(&term, &points());
            for (k, g) in gradient.into_iter().enumerate() {
                let [up, down] = [h, -h].map(|by| term.value(&moved(k, by), STIFFNESS));
                assert!(((up - down) / (2.0 * h) - g).abs() < 1e-8, "{term:?} {k}: {g}");
            }
            if matches!(term, Term::Contact { .. }) {
                continue;
            }
            let model = term.model(&points(), STIFFNESS, false);
            let mut known = [[0.0; 6]; 6];
            let unknown = |i: usize| 2 * term.corners()[i / 2] as usize + i % 2;
            for i in 0..6 {
                for j in 0..6 {
                    let (low, high) = (i.min(j), i.max(j));
                    known[unknown(i)][unknown(j)] += model.hessian[high * (high + 1) / 2 + low];
                }
            }
            for (k, row) in known.iter().enumerate() {
                let [up, down] = [h, -h].map(|by| gathered(&term, &moved(k, by)));
                for c in 0..6 {
                    assert!(((up[c] - down[c]) / (2.0 * h) - row[c]).abs() < 1e-7, "{term:?} {k} {c}");
                }
            }
        }
    }

    #[test]
    fn a_multiplier_grows_by_what_is_missed() {
        let mut pin = Term::Pin { vertex: 0, at: [0.0, 0.0], multiplier: [1.0, 1.0] };
        pin.raise(&points(), 10.0);
        assert_eq!(pin, Term::Pin { vertex: 0, at: [0.0, 0.0], multiplier: [2.0, 3.0] });
    }
}
