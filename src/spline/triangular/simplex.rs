//! Simplex splines by Micchelli's recurrence, one at a time [Mic80].
//!
//! This is the definition in a few lines; the shared recurrence of [`super::plan`] is tested and measured against it.

use crate::geometry::complex::doubled_area;

/// The simplex spline M(u | V) of degree `V.len() − 3`, normalised to `∫ M = n!/(n+2)!`.
///
/// M(u | V) is n!/(n+2)! times the density at u of the projection of a uniformly filled simplex whose corners project to V. It vanishes if
/// all knots lie on one line. A point on a side of triangles belongs to the one on the side of (1, ε) from it, which matters for degree 0.
///
/// # Panics
/// With fewer than three knots.
pub fn simplex_spline(knots: &[[f64; 2]], u: [f64; 2]) -> f64 {
    assert!(knots.len() >= 3, "a simplex spline has at least three knots");
    let Some(split) = widest(knots, 0..knots.len()) else { return 0.0 };
    let corners = split.knots.map(|k| knots[k]);
    if knots.len() == 3 {
        return if contains(corners, u) { 1.0 / split.doubled_area.abs() } else { 0.0 };
    }
    let part = |k: usize| {
        let lambda = doubled_area([u, corners[(k + 1) % 3], corners[(k + 2) % 3]]) / split.doubled_area;
        lambda * simplex_spline(&without(knots, split.knots[k]), u)
    };
    part(0) + part(1) + part(2)
}

/// The gradient of M(u | V): of degree n − 1, so 0 for three knots.
///
/// # Panics
/// With fewer than three knots.
pub fn simplex_spline_gradient(knots: &[[f64; 2]], u: [f64; 2]) -> [f64; 2] {
    assert!(knots.len() >= 3, "a simplex spline has at least three knots");
    let degree = (knots.len() - 3) as f64;
    let Some(split) = widest(knots, 0..knots.len()).filter(|_| knots.len() > 3) else { return [0.0; 2] };
    let corners = split.knots.map(|k| knots[k]);
    (0..3).fold([0.0; 2], |sum, k| {
        let ([bx, by], [cx, cy]) = (corners[(k + 1) % 3], corners[(k + 2) % 3]);
        let part = degree * simplex_spline(&without(knots, split.knots[k]), u) / split.doubled_area;
        [sum[0] + part * (by - cy), sum[1] + part * (cx - bx)]
    })
}

fn without(knots: &[[f64; 2]], at: usize) -> Vec<[f64; 2]> {
    [&knots[..at], &knots[at + 1..]].concat()
}

/// Three of some knots.
#[derive(Debug, Clone, Copy)]
pub(super) struct KnotTriple {
    pub knots: [usize; 3],
    /// Twice the signed area of their triangle.
    pub doubled_area: f64,
}

/// The three of the knots with numbers `among` that have the largest triangle; none if all lie on a line.
pub(super) fn widest(
    knots: &[[f64; 2]],
    mut among: impl Iterator<Item = usize> + Clone,
) -> Option<KnotTriple> {
    let mut best = KnotTriple { knots: [0; 3], doubled_area: 0.0 };
    while let Some(a) = among.next() {
        let mut second = among.clone();
        while let Some(b) = second.next() {
            for c in second.clone() {
                let area = doubled_area([knots[a], knots[b], knots[c]]);
                if area.abs() > best.doubled_area.abs() {
                    best = KnotTriple { knots: [a, b, c], doubled_area: area };
                }
            }
        }
    }
    (best.doubled_area != 0.0).then_some(best)
}

/// True if a triangle of either orientation contains u; points on its sides belong to the triangle on the side of (1, ε).
fn contains(corners: [[f64; 2]; 3], u: [f64; 2]) -> bool {
    let left = |k: usize| {
        let (a, b) = (corners[k], corners[(k + 1) % 3]);
        is_left(doubled_area([u, a, b]), a, b)
    };
    left(0) == left(1) && left(1) == left(2)
}

/// True if u lies to the left of the line from a to b, where `cross` is (a − u) × (b − u); on the line the direction (1, ε) decides.
pub(super) fn is_left(cross: f64, a: [f64; 2], b: [f64; 2]) -> bool {
    // (a − u − d) × (b − u − d) grows by d × (a − b).
    cross > 0.0 || (cross == 0.0 && (a[1] > b[1] || (a[1] == b[1] && a[0] < b[0])))
}
