//! The modulus of a flat torus: the shape of its lattice, independent of the basis and of the scale.
//!
//! ```
//! use ricci::geometry::modulus::modulus;
//! // Another basis of the square lattice of side 2.
//! assert_eq!(modulus([[2.0, 0.0], [6.0, 2.0]]), Some([0.0, 1.0]));
//! ```

use super::complex::{cross, dot, norm2, scale, sub};

/// Relative error that the periods may have: periods with an angle of a smaller sine count as parallel, and a modulus within this
/// distance of the border of the fundamental domain counts as on it. Periods developed over thousands of triangles have about this error.
const ROUNDING: f64 = 1e-12;

/// The modulus `τ = ω₂/ω₁` `[Re τ, Im τ]` of the lattice spanned by two periods, reduced under SL(2, ℤ).
///
/// `|Re τ| ≤ 1/2`, `|τ| ≥ 1`, `Im τ > 0`. On the border of that domain, where two values are equivalent, the one
/// with `Re τ ≥ 0` is returned. Orientation counts: a torus and its mirror image have moduli τ and −τ̄.
///
/// `periods`: any two vectors that generate the lattice, in any order and with any signs. `None` when they are parallel
/// (or not finite): they span no lattice.
///
/// Reduction by Lagrange and Gauss: the longer vector is shortened by multiples of the shorter one. Each round at least
/// halves the squared length of the longer one until it is within a factor √3 of the shorter, so rounds are few; it ends
/// when a round shortens nothing.
pub fn modulus(periods: [[f64; 2]; 2]) -> Option<[f64; 2]> {
    let [mut a, mut b] = periods;
    let largest = periods.iter().flatten().fold(0.0f64, |m, x| m.max(x.abs()));
    if !(largest > 0.0 && largest.is_finite()) {
        return None;
    }
    (a, b) = (a.map(|x| x / largest), b.map(|x| x / largest));
    let sine = cross(a, b).abs() / (norm2(a) * norm2(b)).sqrt();
    if sine.is_nan() || sine <= ROUNDING {
        return None;
    }
    for _ in 0..MAX_ROUNDS {
        if norm2(a) > norm2(b) {
            (a, b) = (b, a);
        }
        let times = (dot(a, b) / norm2(a)).round();
        if times == 0.0 {
            break;
        }
        let shorter = sub(b, scale(times, a));
        if norm2(shorter) >= norm2(b) {
            break; // Re τ = ±½: neither vector can be made shorter.
        }
        b = shorter;
    }
    if norm2(a) > norm2(b) {
        (a, b) = (b, a);
    }
    // A clockwise basis becomes counterclockwise by reversing b.
    let area = cross(a, b);
    let [re, im] = [dot(a, b) / norm2(a), area.abs() / norm2(a)];
    let re = if area < 0.0 { -re } else { re };
    let on_border = re.abs() >= 0.5 - ROUNDING || re.hypot(im) <= 1.0 + ROUNDING;
    Some([if on_border { re.abs() } else { re }, im])
}

/// Bound on the rounds of the reduction, which no lattice reaches: squared lengths halve in each round, and those in f64 span a ratio of
/// 2²⁰⁹⁸ at most.
const MAX_ROUNDS: usize = 4096;

#[cfg(test)]
mod tests {
    use super::*;

    fn combine(m: [[i32; 2]; 2], [a, b]: [[f64; 2]; 2]) -> [[f64; 2]; 2] {
        m.map(|[p, q]| {
            let (p, q) = (f64::from(p), f64::from(q));
            [p * a[0] + q * b[0], p * a[1] + q * b[1]]
        })
    }

    #[test]
    fn every_basis_of_a_lattice_has_the_same_modulus() {
        let periods = [[1.3, 0.2], [0.4, 1.9]];
        let tau = modulus(periods).unwrap();
        assert!(tau[0].abs() <= 0.5 && tau[0].hypot(tau[1]) >= 1.0 && tau[1] > 0.0);
        for m in
            [[[2, 1], [1, 1]], [[0, -1], [1, 0]], [[1, 0], [37, 1]], [[-5, 2], [3, -1]], [[0, 1], [1, 0]]]
        {
            let other = modulus(combine(m, periods)).unwrap();
            assert!(
                (other[0] - tau[0]).abs() < 1e-12 && (other[1] - tau[1]).abs() < 1e-12,
                "{m:?}: {other:?}"
            );
        }
    }

    #[test]
    fn rotation_and_scale_leave_the_modulus_and_a_mirror_reflects_it() {
        let periods = [[1.0, 0.0], [0.3, 1.4]];
        let tau = modulus(periods).unwrap();
        assert!((tau[0] - 0.3).abs() < 1e-15 && (tau[1] - 1.4).abs() < 1e-15);
        let (s, c) = (2.0f64.sin() * 1e-3, 2.0f64.cos() * 1e-3);
        let turned = modulus(periods.map(|[x, y]| [c * x - s * y, s * x + c * y])).unwrap();
        assert!((turned[0] - 0.3).abs() < 1e-14 && (turned[1] - 1.4).abs() < 1e-14);
        let mirrored = modulus(periods.map(|[x, y]| [-x, y])).unwrap();
        assert!((mirrored[0] + 0.3).abs() < 1e-15 && (mirrored[1] - 1.4).abs() < 1e-15);
    }

    #[test]
    fn square_and_hexagonal_lattices_are_the_corners_of_the_domain() {
        let h = 0.75f64.sqrt();
        assert_eq!(modulus([[0.0, 2.0], [-2.0, 0.0]]).unwrap(), [0.0, 1.0]);
        for sign in [1.0, -1.0] {
            let tau = modulus([[1.0, 0.0], [0.5 * sign, h]]).unwrap();
            assert!((tau[0] - 0.5).abs() < 1e-15 && (tau[1] - h).abs() < 1e-15);
        }
    }

    #[test]
    fn parallel_periods_span_no_lattice() {
        for periods in [[[1.0, 2.0], [2.0, 4.0]], [[0.0, 0.0], [1.0, 0.0]], [[f64::NAN, 0.0], [1.0, 0.0]]] {
            assert_eq!(modulus(periods), None);
        }
    }
}
