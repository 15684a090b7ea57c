//! The derivative of a triangle's angles in its conformal class: the weights of the Jacobian of the curvature.
//!
//! ```
//! use ricci::geometry::Space;
//! use ricci::geometry::conformal::Vertex;
//! use ricci::geometry::weights::weights;
//! // An equilateral triangle of side 1 under vertex scaling (ε = 0, η = 1/2): half the cotangents of its angles.
//! let corners = [Vertex::new(Space::E2, 0, 0.0); 3];
//! let w = weights(Space::E2, [0.5; 3], [0.25; 3], corners, [0.5; 3]);
//! assert!(w.iter().all(|w| (w - 0.5 / 3f64.sqrt()).abs() < 1e-15));
//! ```

use super::Space;
use super::conformal::Vertex;
use super::triangle::{TriangleSines, plane_angles_with_weights};
use std::f64::consts::PI;

/// The weights `w_k = ∂θ_i/∂u_j = ∂θ_j/∂u_i` of the three edges (w_k belongs to edge ij, opposite corner k).
///
/// `r`: half-perimeter differences; `q2`, `eta`: of the edges opposite the corners. With `c_i = 1 − λ ε_i e_i²`
///
/// ```text
/// w_k = 8 e_i e_j [ e_i e_j c_k (ε_i ε_j − η_ij²) + e_j e_k c_i (ε_j η_ki + η_ij η_jk) + e_i e_k c_j (ε_i η_jk + η_ij η_ki) ]
///       / (d_i² d_j² d_k Δ f(l_k)²),          Δ² = f(s) f(r_i) f(r_j) f(r_k),   f(x) = x, sinh x, sin x  (E²: ½ in place of 8)
/// ∂θ_i/∂u_i = −w_k C(l_k) − w_j C(l_j),      C(l) = 1, cosh l, cos l
/// ```
///
/// which is \[ZGZLYG14\]'s matrix `σ/A · L Θ L⁻¹ D` multiplied out (notation.md derives it); for circle packings with η in
/// [0, 1] in E² and H² no term is negative. In E² it is `cot θ_k / 2` for ε = 0, and always (signed distance of the power
/// centre from edge ij) / l_k. A broken triangle has weights 0: its extended angles are constant.
#[inline]
pub fn weights(space: Space, r: [f64; 3], q2: [f64; 3], corners: [Vertex; 3], eta: [f64; 3]) -> [f64; 3] {
    weights_from_sines(&TriangleSines::new(space, r), q2, corners, eta)
}

/// [`weights`], from the sines of the half-perimeter differences.
#[inline]
pub fn weights_from_sines(
    sines: &TriangleSines,
    q2: [f64; 3],
    corners: [Vertex; 3],
    eta: [f64; 3],
) -> [f64; 3] {
    let TriangleSines { space, differences: r, whole, parts } = *sines;
    if r.iter().any(|&x| x <= 0.0) {
        return [0.0; 3];
    }
    if space == Space::E2 && corners.iter().all(|v| v.epsilon == 0.0) {
        return plane_angles_with_weights(r).1;
    }
    // Divided by the longest chord, so that no product under- or overflows.
    let unit = 0.5 / q2.into_iter().fold(0.0, f64::max).sqrt();
    let s = r[0] + r[1] + r[2];
    if space == Space::S2 && s >= PI {
        return [0.0; 3];
    }
    let [a, b, c] = parts.map(|x| unit * x);
    let delta = (unit * whole * a).sqrt() * (b * c).sqrt();
    let lambda = space.curvature();
    let c = corners.map(|v| 1.0 - lambda * v.epsilon * v.scale * v.scale);
    let e = corners.map(|v| v.scale * unit);
    let own = [0, 1, 2].map(|i| corners[i].epsilon * e[i] * e[i]);
    let cross = [0, 1, 2].map(|k| eta[k] * (e[(k + 1) % 3] * e[(k + 2) % 3]));
    let weight = |k: usize| {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        let first = if own[i] * own[j] > 0.0 {
            own[i] * own[j] * ((1.0 - eta[k]) * (1.0 + eta[k]))
        } else {
            own[i] * own[j] - cross[k] * cross[k]
        };
        let sum = c[k] * first
            + c[i] * (own[j] * cross[j] + cross[k] * cross[i])
            + c[j] * (own[i] * cross[i] + cross[k] * cross[j]);
        // f(l_k)² = 4 q² (1 − λ q²)
        let chord = (2.0 * unit) * (2.0 * unit) * q2[k] * (1.0 - lambda * q2[k]);
        let scale = match space {
            Space::E2 => 0.5,
            _ => 8.0 / (corners[i].d * corners[j].d).powi(2) / corners[k].d,
        };
        scale * sum / (delta * chord)
    };
    let w = [weight(0), weight(1), weight(2)];
    // Where a triangle is so thin that its area underflows, the quotients are not finite; it is treated as a broken one.
    if w.iter().all(|w| w.is_finite()) { w } else { [0.0; 3] }
}
