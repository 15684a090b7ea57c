//! One geodesic triangle from its three lengths: angles, area, and how the angles move with the lengths' ends.
//!
//! ```text
//!              k                 side i is opposite corner i: l_i = |jk|, l_j = |ki|, l_k = |ij|
//!            /   \               s = (l_i + l_j + l_k)/2,  r_i = s − l_i
//!       l_j /     \ l_i          f(x) = x, sinh x, sin x        in E², H², S²
//!          /       \             q = l/2, sinh(l/2), sin(l/2)   half the chord
//!         i ─────── j            Δ = sqrt(f(s) f(r_i) f(r_j) f(r_k))
//!             l_k
//! ```
//!
//! Everything is written in `f(s)`, `f(r)` and `q`, so one text serves the three geometries and no difference of
//! nearly equal numbers is formed.

use super::Space;

/// Angles and validity of a triangle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Angles {
    /// The angle at each corner, radians, opposite the length of the same index.
    pub at: [f64; 3],
    /// Whether the lengths break the triangle inequality (or, in S², have a perimeter of 2π or more): the angles
    /// are then the continuous extension (π, 0, 0), or (π, π, π) for the perimeter.
    pub broken: bool,
}

/// Half perimeter s and the differences r_i = s − l_i.
///
/// The differences are formed from the sorted lengths, largest first (Kahan, "Miscalculating area and angles of
/// a needle-like triangle"): each is accurate to a few ulp however thin the triangle.
#[inline]
pub fn half_differences(l: [f64; 3]) -> (f64, [f64; 3]) {
    let mut order = [0, 1, 2];
    if l[order[0]] < l[order[1]] {
        order.swap(0, 1);
    }
    if l[order[1]] < l[order[2]] {
        order.swap(1, 2);
    }
    if l[order[0]] < l[order[1]] {
        order.swap(0, 1);
    }
    let [a, b, c] = order.map(|i| l[i]);
    let mut r = [0.0; 3];
    r[order[0]] = 0.5 * (c - (a - b));
    r[order[1]] = 0.5 * (c + (a - b));
    r[order[2]] = 0.5 * (a + (b - c));
    (0.5 * (a + (b + c)), r)
}

#[inline]
fn s_function(space: Space, x: f64) -> f64 {
    match space {
        Space::E2 => x,
        Space::H2 => x.sinh(),
        Space::S2 => x.sin(),
    }
}

/// `f(s)` and `f(r_i)`, or the corner whose angle is π (3: all of them) when the triangle is broken.
#[inline]
fn products(space: Space, l: [f64; 3]) -> Result<(f64, [f64; 3]), usize> {
    let (s, r) = half_differences(l);
    if let Some(i) = (0..3).find(|&i| r[i] <= 0.0) {
        return Err(i);
    }
    if space == Space::S2 && s >= std::f64::consts::PI {
        return Err(3);
    }
    Ok((s_function(space, s), r.map(|x| s_function(space, x))))
}

/// The angles by the half-angle law `tan²(θ_k/2) = f(r_i) f(r_j) / (f(s) f(r_k))` [JKLLG08, Eqn 12].
///
/// Lengths must be positive and finite.
#[inline]
pub fn angles(space: Space, l: [f64; 3]) -> Angles {
    match products(space, l) {
        Ok((s, r)) => {
            let angle = |k: usize| {
                let (i, j) = ((k + 1) % 3, (k + 2) % 3);
                2.0 * f64::atan2((r[i] * r[j]).sqrt(), (s * r[k]).sqrt())
            };
            Angles { at: [angle(0), angle(1), angle(2)], broken: false }
        }
        Err(corner) => {
            let at = |k| if corner == k || corner == 3 { std::f64::consts::PI } else { 0.0 };
            Angles { at: [at(0), at(1), at(2)], broken: true }
        }
    }
}

/// Area: Heron in E²; in H² and S² by l'Huilier's formula
/// `tan(area/4) = sqrt(t(s/2) t(r_i/2) t(r_j/2) t(r_k/2))`, t = tanh, tan: no angle sum, no cancellation.
///
/// A broken triangle has area 0; one whose perimeter reaches 2π in S² has 2π.
pub fn area(space: Space, l: [f64; 3]) -> f64 {
    let (s, r) = half_differences(l);
    if r.iter().any(|&x| x <= 0.0) {
        return 0.0;
    }
    let quarter = |t: fn(f64) -> f64| (t(0.5 * s) * t(0.5 * r[0]) * t(0.5 * r[1]) * t(0.5 * r[2])).sqrt();
    match space {
        Space::E2 => (s * r[0]).sqrt() * (r[1] * r[2]).sqrt(),
        Space::H2 => 4.0 * quarter(f64::tanh).atan(),
        Space::S2 if s >= std::f64::consts::PI => 2.0 * std::f64::consts::PI,
        Space::S2 => 4.0 * quarter(f64::tan).atan(),
    }
}

/// The weights `w_k = ∂θ_i/∂u_j = ∂θ_j/∂u_i` of the three edges (w_k belongs to edge ij, opposite corner k).
///
/// `l`: lengths; `q2`: squared half chords; `power`: per corner `P = ε e^{2u}/(1 + λ ε e^{2u})`, in E² `ε e^{2u}/4`
/// (zero for vertex scaling). With λ the curvature of the space
///
/// ```text
/// w_k = [ (q_i² + q_j² − q_k²)/(1 − λ q_k²)
///         + 2 (P_i (f(s)f(r_j) − f(r_i)f(r_k)) + P_j (f(s)f(r_i) − f(r_j)f(r_k)) − P_k f(l_k)²)/f(l_k)² ] / (2Δ)
/// ∂θ_i/∂u_i = −w_k c(l_k) − w_j c(l_j),   c(l) = 1, cosh l, cos l
/// ```
///
/// which is \[ZGZLYG14\]'s matrix `σ/A · L Θ L⁻¹ D` multiplied out (notation.md derives it). In E² it is
/// `cot θ_k / 2` for ε = 0, and always (signed distance of the power centre from edge ij) / l_k.
/// A broken triangle has weights 0: its extended angles are constant.
#[inline]
pub fn weights(space: Space, l: [f64; 3], q2: [f64; 3], power: [f64; 3]) -> [f64; 3] {
    let Ok((s, r)) = products(space, l) else { return [0.0; 3] };
    let delta = (s * r[0]).sqrt() * (r[1] * r[2]).sqrt();
    if delta <= f64::MIN_POSITIVE {
        return [0.0; 3];
    }
    let lambda = space.curvature();
    let scaling = power == [0.0; 3];
    let weight = |k: usize| {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        let chord = (q2[i] + q2[j] - q2[k]) / (1.0 - lambda * q2[k]);
        if scaling {
            return chord / (2.0 * delta);
        }
        // f(l_k)² = 4 q_k² (1 − λ q_k²)
        let f2 = 4.0 * q2[k] * (1.0 - lambda * q2[k]);
        let circles =
            (power[i] * (s * r[j] - r[i] * r[k]) + power[j] * (s * r[i] - r[j] * r[k])) / f2 - power[k];
        (chord + 2.0 * circles) / (2.0 * delta)
    };
    [weight(0), weight(1), weight(2)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    const SPACES: [Space; 3] = [Space::E2, Space::H2, Space::S2];

    #[test]
    fn angles_obey_the_cosine_law() {
        for (i, l) in [[1.0, 1.1, 0.7], [0.3, 0.4, 0.5], [1.2, 0.9, 1.0]].into_iter().enumerate() {
            for space in SPACES {
                let at = angles(space, l).at;
                for k in 0..3 {
                    let (a, b, c) = (l[(k + 1) % 3], l[(k + 2) % 3], l[k]);
                    let cos = match space {
                        Space::E2 => (a * a + b * b - c * c) / (2.0 * a * b),
                        Space::H2 => (a.cosh() * b.cosh() - c.cosh()) / (a.sinh() * b.sinh()),
                        Space::S2 => (c.cos() - a.cos() * b.cos()) / (a.sin() * b.sin()),
                    };
                    assert!((at[k].cos() - cos).abs() < 1e-14, "{space} triangle {i} corner {k}");
                }
            }
        }
    }

    #[test]
    fn area_is_the_angle_defect() {
        let l = [1.1, 0.8, 0.9];
        for space in [Space::H2, Space::S2] {
            let sum: f64 = angles(space, l).at.iter().sum();
            assert!((area(space, l) - space.curvature() * (sum - PI)).abs() < 1e-14);
        }
        let sum: f64 = angles(Space::E2, l).at.iter().sum();
        assert!((sum - PI).abs() < 1e-15);
        assert!((area(Space::E2, [3.0, 4.0, 5.0]) - 6.0).abs() < 1e-14);
    }

    #[test]
    fn needles_keep_their_relative_accuracy() {
        // Right triangle with legs 1 and h: the small angle is atan(h).
        for h in [1e-3, 1e-6] {
            let l = [h, 1.0, f64::hypot(1.0, h)];
            let small = angles(Space::E2, l).at[0];
            // The hypotenuse is rounded to ulp(1) = 2e-16, which moves h² by as much.
            assert!((small / h.atan() - 1.0).abs() < 4e-16 / (h * h));
            assert!((area(Space::E2, l) / (0.5 * h) - 1.0).abs() < 4e-16 / (h * h));
        }
    }

    #[test]
    fn broken_triangles_have_the_extended_angles() {
        for space in SPACES {
            assert_eq!(angles(space, [1.0, 0.3, 0.4]), Angles { at: [PI, 0.0, 0.0], broken: true });
            assert_eq!(weights(space, [1.0, 0.3, 0.4], [0.1; 3], [0.0; 3]), [0.0; 3]);
        }
        assert_eq!(angles(Space::S2, [2.2, 2.2, 2.2]), Angles { at: [PI; 3], broken: true });
    }

    #[test]
    fn euclidean_vertex_scaling_weight_is_half_the_cotangent() {
        let l = [1.3, 1.0, 0.8];
        let w = weights(Space::E2, l, l.map(|x| 0.25 * x * x), [0.0; 3]);
        let at = angles(Space::E2, l).at;
        for k in 0..3 {
            assert!((w[k] - 0.5 / at[k].tan()).abs() < 1e-14);
        }
    }
}
