//! Simplex splines by Micchelli's recurrence, one at a time [Mic80].
//!
//! This is the definition in a few lines, against which the shared recurrence of [`super::plan`] is tested and measured.

use crate::geometry::complex::doubled_area;

/// The simplex spline M(u | V) of degree `V.len() − 3`, normalised to `∫ M = n!/(n+2)!`.
///
/// M(u | V) is n!/(n+2)! times the density at u of the projection of a uniformly filled simplex whose corners project to V. It vanishes
/// where the knots lie on one line. On the sides of triangles M of degree 0 belongs to one of the two, which a small motion of u in the
/// direction (1, ε) decides.
///
/// # Panics
/// With fewer than three knots.
pub fn simplex_spline(knots: &[[f64; 2]], u: [f64; 2]) -> f64 {
    assert!(knots.len() >= 3, "a simplex spline has at least three knots");
    let Some((triple, twice_area)) = widest(knots) else { return 0.0 };
    let corners = triple.map(|k| knots[k]);
    if knots.len() == 3 {
        return if contains(corners, u) { 1.0 / twice_area.abs() } else { 0.0 };
    }
    let part = |k: usize| {
        let lambda = doubled_area([u, corners[(k + 1) % 3], corners[(k + 2) % 3]]) / twice_area;
        lambda * simplex_spline(&without(knots, triple[k]), u)
    };
    part(0) + part(1) + part(2)
}

/// Gradient of M(u | V): of degree n − 1, so 0 for three knots.
///
/// # Panics
/// With fewer than three knots.
pub fn simplex_spline_gradient(knots: &[[f64; 2]], u: [f64; 2]) -> [f64; 2] {
    assert!(knots.len() >= 3, "a simplex spline has at least three knots");
    let degree = (knots.len() - 3) as f64;
    let (Some((triple, twice_area)), true) = (widest(knots), knots.len() > 3) else { return [0.0; 2] };
    let corners = triple.map(|k| knots[k]);
    (0..3).fold([0.0; 2], |sum, k| {
        let ([bx, by], [cx, cy]) = (corners[(k + 1) % 3], corners[(k + 2) % 3]);
        let part = degree * simplex_spline(&without(knots, triple[k]), u) / twice_area;
        [sum[0] + part * (by - cy), sum[1] + part * (cx - bx)]
    })
}

fn without(knots: &[[f64; 2]], at: usize) -> Vec<[f64; 2]> {
    [&knots[..at], &knots[at + 1..]].concat()
}

/// The three knots with the largest triangle, and twice its signed area; none where all lie on a line.
fn widest(knots: &[[f64; 2]]) -> Option<([usize; 3], f64)> {
    let mut best = ([0; 3], 0.0f64);
    for i in 0..knots.len() {
        for j in i + 1..knots.len() {
            for k in j + 1..knots.len() {
                let area = doubled_area([knots[i], knots[j], knots[k]]);
                if area.abs() > best.1.abs() {
                    best = ([i, j, k], area);
                }
            }
        }
    }
    (best.1 != 0.0).then_some(best)
}

/// Whether a triangle of either orientation contains u, its sides belonging to the triangle on the side of (1, ε).
fn contains(corners: [[f64; 2]; 3], u: [f64; 2]) -> bool {
    let left = |k: usize| {
        let (a, b) = (corners[k], corners[(k + 1) % 3]);
        is_left(doubled_area([u, a, b]), a, b)
    };
    left(0) == left(1) && left(1) == left(2)
}

/// Whether u lies to the left of the line from a to b, `cross` being (a − u) × (b − u); on the line the direction (1, ε) decides.
pub(super) fn is_left(cross: f64, a: [f64; 2], b: [f64; 2]) -> bool {
    // (a − u − d) × (b − u − d) grows by d × (a − b).
    cross > 0.0 || (cross == 0.0 && (a[1] > b[1] || (a[1] == b[1] && a[0] < b[0])))
}
