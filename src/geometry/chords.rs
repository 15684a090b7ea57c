//! Angles, their derivatives and the area of a triangle in H², from the half chords `q = sinh(l/2)` of its sides.
//!
//! With `c = cosh(l/2)`, half the perimeter s, `r_k = s − l_k` and `d_k = sinh((l_i + l_j)/2) − q_k`
//!
//! ```text
//! d_k = q_i c_j + q_j c_i − q_k        sinh s sinh r_k = d_k (d_k + 2 q_k)        sinh s = (d_k + q_k) c_k + (c_i c_j + q_i q_j) q_k
//! ```
//!
//! With these products P_k and `h = √(P_i P_j P_k)` the half-angle law reads `tan(θ_k/2) = h / (P_k sinh s)`, and the derivatives
//! ([`super::weights::weights`] with ε = 0) are `w_k = (q_i² + q_j² − q_k²) sinh s / (2 h c_k²)`.

use super::DoubleDouble;
use super::arctangent::angle;
use super::complex::Number;
use super::conformal::differences_of;
use super::lanes::Lanes;
use super::triangle::{Angles, is_finite};
use std::ops::RangeInclusive;

/// Half chords for which products of twelve are normal numbers.
const USUAL: RangeInclusive<f64> = 1e-25..=1e25;
/// d is the sum of its value in the plane and a term of the curvature. The first is negative where a long triangle is nearly flat, and
/// the sum then loses digits. This is the smallest quotient of the two that is accepted.
const LEAST_FLAT: f64 = -0.5;

/// `sinh s sinh r_k` for each corner, and `sinh s`.
#[inline(always)]
pub(crate) fn products<R: Number>(q: [R; 3], c: [R; 3], d: [R; 3]) -> ([R; 3], R) {
    let mut each = d;
    for k in 0..3 {
        each[k] = d[k] * (d[k] + q[k] + q[k]);
    }
    (each, (d[2] + q[2]) * c[2] + (c[0] * c[1] + q[0] * q[1]) * q[2])
}

/// The intermediate values from which angles, derivatives and area are computed.
struct AngleParts<L> {
    /// q²
    square: [L; 3],
    /// P
    product: [L; 3],
    /// sinh s
    whole: L,
    /// h
    root: L,
    /// 1 for a triangle that is valid and not too thin for its size to be computed in f64; 0 for others, whose values are meaningless.
    is_sound: L,
}

impl<L: Lanes> AngleParts<L> {
    /// The intermediate values of one triangle or several, from half chords in double-double precision.
    #[inline(always)]
    fn of([q, low]: [[L; 3]; 2]) -> AngleParts<L> {
        let of = |x: f64| q[0].constant(x);
        let (zero, one) = (of(0.0), of(1.0));
        let mut is_sound = one;
        for q in q {
            is_sound = q.where_within(&USUAL, is_sound);
        }
        let flat = differences_of(q, low);
        // `more` is c − 1.
        let [mut square, mut c, mut more, mut d] = [[zero; 3]; 4];
        for k in 0..3 {
            square[k] = q[k] * q[k];
            c[k] = (one + square[k]).root();
            more[k] = square[k] / (one + c[k]);
        }
        for k in 0..3 {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            let in_plane = of(2.0) * flat[k];
            let by_curvature = q[i] * more[j] + q[j] * more[i];
            is_sound = (of(LEAST_FLAT) * by_curvature).where_at_least(in_plane, zero, is_sound);
            d[k] = in_plane + by_curvature;
        }
        let (product, whole) = products(q, c, d);
        let root = (product[0] * product[1] * product[2]).root();
        // Where the root is 0, quotients are not finite.
        let is_sound = root.where_at_least(of(f64::MIN_POSITIVE), is_sound, zero);
        AngleParts { square, product, whole, root, is_sound }
    }
}

/// Angles and derivatives of a triangle from the half chords opposite its corners, in double-double precision. `None` for a triangle that
/// is broken or too thin for its size to be computed in f64.
#[inline]
pub fn angles_with_weights(chords: [DoubleDouble; 3]) -> Option<(Angles, [f64; 3])> {
    match sound_angles_with_weights([chords.map(|q| q.high), chords.map(|q| q.low)]) {
        (at, weights, 1.0) => Some((Angles { at }, weights)),
        _ => None,
    }
}

/// [`angles_with_weights`] for one triangle or several at a time. The last number is 1 for triangles that have them, and 0 for others.
#[inline(always)]
pub(crate) fn sound_angles_with_weights<L: Lanes>(chords: [[L; 3]; 2]) -> ([L; 3], [L; 3], L) {
    let AngleParts { square, product, whole, root, is_sound } = AngleParts::of(chords);
    let of = |x: f64| root.constant(x);
    let two = of(2.0);
    let angles = [
        two * angle(root, whole * product[0]),
        two * angle(root, whole * product[1]),
        two * angle(root, whole * product[2]),
    ];
    let scale = of(0.5) * whole / root;
    let mut weights = [scale; 3];
    for k in 0..3 {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        weights[k] = scale * ((square[i] - square[k]) + square[j]) / (of(1.0) + square[k]);
    }
    (angles, weights, is_finite(weights, is_sound))
}

/// Area of a triangle, by `tan(area/2) = 2 h / (sinh s (1 + Σ cosh l))`; `None` where [`angles_with_weights`] is `None`.
pub fn area(chords: [DoubleDouble; 3]) -> Option<f64> {
    let AngleParts { square, whole, root, is_sound, .. } =
        AngleParts::of([chords.map(|q| q.high), chords.map(|q| q.low)]);
    let cosh: f64 = square.iter().map(|x| 1.0 + 2.0 * x).sum();
    (is_sound == 1.0).then(|| 2.0 * (2.0 * root).atan2(whole * (1.0 + cosh)))
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::geometry::Space;
    use crate::geometry::conformal::{Vertex, differences, edge, plain_chord};
    use crate::geometry::triangle::{angles_from, area_from, half_angles_of_chords};
    use crate::geometry::weights::weights;

    /// Triangles with these u and η, by their chords and by the formulas for all classes.
    #[test]
    fn angles_and_derivatives_are_those_of_the_formulas_for_all_spaces() {
        let mut found = 0;
        for u in
            [[0.0, 0.1, -0.2], [-3.0, -3.1, -2.9], [2.0, 2.5, 1.8], [-20.0, -19.0, -19.5], [4.0, -4.0, -4.0]]
        {
            for eta in [[1.0, 1.1, 0.9], [1.0, 1.0, 1.9], [0.3, 0.25, 0.26], [1.0, 1.0, 3.99]] {
                let corners = u.map(|u| Vertex::precise(Space::H2, 0, u, 0.0));
                let ends = |k: usize| [corners[(k + 1) % 3], corners[(k + 2) % 3]];
                let edges = [0, 1, 2].map(|k| edge(Space::H2, ends(k)[0], ends(k)[1], eta[k]).unwrap());
                let chords = [0, 1, 2].map(|k| {
                    let [a, b] = ends(k);
                    plain_chord(Space::H2, a, b, eta[k].into())
                });
                let r = differences(corners, edges);
                let Some((angles, derived)) = angles_with_weights(chords) else { continue };
                found += 1;
                let exact = area_from(Space::H2, r);
                assert!((area(chords).unwrap() / exact - 1.0).abs() < 1e-13, "{u:?} {eta:?}: {exact}");
                let known = half_angles_of_chords(Space::H2, chords);
                let rough = angles_from(Space::H2, r).at;
                let known_weights = weights(Space::H2, r, edges.map(|e| e.q2), corners, eta);
                let most = known_weights.iter().fold(1.0, |most: f64, w| most.max(w.abs()));
                for k in 0..3 {
                    let exact = 2.0 * known[k][1].high.atan2(known[k][0].high);
                    assert!(
                        (angles.at[k] - exact).abs() < 2e-15 * exact,
                        "{u:?} {eta:?}: {exact} {angles:?}"
                    );
                    assert!((angles.at[k] - rough[k]).abs() < 1e-14, "{u:?} {eta:?}: {rough:?} {angles:?}");
                    let off = (derived[k] - known_weights[k]).abs();
                    assert!(off < 1e-13 * most, "{u:?} {eta:?}: {known_weights:?} {derived:?}");
                }
            }
        }
        assert!(found >= 10, "{found}");
    }

    #[test]
    fn thin_and_broken_triangles_are_left_to_others() {
        let of =
            |lengths: [f64; 3]| angles_with_weights(lengths.map(|l| DoubleDouble::from((0.5 * l).sinh())));
        assert!(of([1.0, 0.3, 0.4]).is_none() && of([20.0, 10.0, 10.000_001]).is_none());
        assert!(of([1e-60, 1e-60, 1e-60]).is_none() && of([600.0, 600.0, 600.0]).is_none());
        // A thin but small triangle is as precise as in the plane.
        let (thin, _) = of([1e-3, 1.0, 1.0]).unwrap();
        assert!(thin.at[0] > 0.0);
    }
}
