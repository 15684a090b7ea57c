//! A conformal class (ε, η, u) on one edge and one triangle: lengths, half-perimeter differences, derivative of the angles.
//!
//! With `e_i = e^{u_i}` and `d_i = 1 + λ ε_i e_i²`
//!
//! ```text
//! N_ij = 2 η_ij e_i e_j + ε_i e_i² + ε_j e_j²
//! E²: l² = N          H²: sinh²(l/2) = N/(d_i d_j)          S²: sin²(l/2) = N/(d_i d_j)
//! ```
//!
//! (the length formulas of notation.md §2 solved for the half length, free of the cancellation in `cosh l − 1`).
//!
//! Circles of very different sizes nearly fill their triangle. What decides its angles is then not the lengths but what the
//! radii leave of them, formed from `g((l − γ_i − γ_j)/2) g((l + γ_i + γ_j)/2) = 2 (η − 1) e_i e_j / (d_i d_j)` with
//! `g = sinh, sin` (E²: `gap (l + γ_i + γ_j) = 2 (η − 1) e_i e_j`):
//!
//! ```text
//! gap_k = l_k − γ_i − γ_j          r_k = s − l_k = γ_k + (gap_i + gap_j − gap_k)/2
//! ```

use super::Space;
use super::triangle::half_differences;
use super::twofold::{self, Twofold, two_product, two_sum};
use std::f64::consts::PI;

/// A vertex at its current u.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Vertex {
    /// ε.
    pub epsilon: f64,
    /// e^u.
    pub scale: f64,
    /// What `scale` misses of e^u, relative to it: where [`is_precise`]; there the part of u that its double loses is kept apart.
    pub low: f64,
    /// d = 1 + λ ε e^{2u}; NaN outside the metric's domain (d ≤ 0).
    pub d: f64,
    /// γ where ε = 1, else 0.
    pub radius: f64,
}

/// An edge at the current u of its ends.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Edge {
    /// l − γ_i − γ_j with the radii of [`Vertex::radius`].
    pub gap: f64,
    /// What the double `gap` loses, as far as it is known: where both ends are [`is_precise`].
    pub low: f64,
    /// Squared half chord: l²/4, sinh²(l/2), sin²(l/2) in E², H², S².
    pub q2: f64,
}

/// Squared half chords are refused above this: hyperbolic lengths then stay below 300, and no product of them overflows.
const MAX_HYPERBOLIC_CHORD: f64 = 1e129;
/// Above this u, e^u is so near 1 that `2 artanh e^u = −log tanh(−u/2)` needs its second form.
const NEAR_HOROCYCLE: f64 = -1.0;

/// Radius γ of a vertex of type ε with variable u: `u = log γ` in E²; where λε = −1 (circles in H², imaginary ones in S²)
/// `u = log tanh(γ/2)`; where λε = 1 `u = log tan(γ/2)`. ε = 0: e^u.
pub fn radius(space: Space, epsilon: i8, u: f64) -> f64 {
    match space.curvature() * f64::from(epsilon) {
        0.0 => u.exp(),
        x if x > 0.0 => 2.0 * u.exp().atan(),
        _ if u > NEAR_HOROCYCLE => -(-0.5 * u).tanh().ln(),
        _ => 2.0 * u.exp().atanh(),
    }
}

/// Whether lengths between vertices of type ε are formed to twice the digits: in E², and in H² where ε = 0.
pub fn is_precise(space: Space, epsilon: i8) -> bool {
    space == Space::E2 || (space == Space::H2 && epsilon == 0)
}

impl Vertex {
    /// The quantities of a vertex of type ε with variable `u + low`, where `low` is what the double u loses (half an ulp of it at
    /// most): e^u has 16 digits also where u is large.
    pub fn precise(space: Space, epsilon: i8, u: f64, low: f64) -> Vertex {
        let rounded = Vertex::new(space, epsilon, u);
        if is_precise(space, epsilon) {
            let (scale, lost) = twofold::exp(u);
            let radius = if epsilon == 1 { scale } else { 0.0 };
            return Vertex { scale, low: lost + low, radius, ..rounded };
        }
        let lambda = space.curvature() * f64::from(epsilon);
        // dγ/du = γ, sinh γ, sin γ
        let slope = match epsilon {
            1 => super::triangle::sine(space, rounded.radius),
            _ => 0.0,
        };
        Vertex {
            scale: rounded.scale + rounded.scale * low,
            d: rounded.d + 2.0 * lambda * rounded.scale * rounded.scale * low,
            radius: rounded.radius + slope * low,
            ..rounded
        }
    }

    /// The quantities of a vertex of type ε with variable u.
    pub fn new(space: Space, epsilon: i8, u: f64) -> Vertex {
        let d = match space.curvature() * f64::from(epsilon) {
            0.0 => 1.0,
            x if x < 0.0 => -(2.0 * u).exp_m1(),
            _ => 1.0 + (2.0 * u).exp(),
        };
        Vertex {
            epsilon: f64::from(epsilon),
            scale: u.exp(),
            low: 0.0,
            d: if d > 0.0 { d } else { f64::NAN },
            radius: if epsilon == 1 { radius(space, epsilon, u) } else { 0.0 },
        }
    }
}

/// An edge; `None` when (ε, η, u) give no real positive finite length.
#[inline]
pub fn edge(space: Space, a: Vertex, b: Vertex, eta: f64) -> Option<Edge> {
    let q2 = match space {
        Space::E2 => 0.25 * squared_chord(a, b, eta),
        _ => squared_chord(a, b, eta) / (a.d * b.d),
    };
    if !(q2 > 0.0 && q2 < f64::INFINITY) || (space == Space::H2 && q2 > MAX_HYPERBOLIC_CHORD) {
        return None;
    }
    let circles = a.epsilon > 0.0 && b.epsilon > 0.0;
    if circles && eta == 1.0 {
        // sin²(l/2) > 1: the circles together reach around the sphere.
        return (space != Space::S2 || q2 <= 1.0).then_some(Edge { gap: 0.0, low: 0.0, q2 });
    }
    let length = length(space, q2);
    let sum = a.radius + b.radius;
    let gap = if circles { circle_gap(space, a, b, eta, length + sum) } else { length - sum };
    let low = match space {
        Space::E2 => lost_gap(a, b, eta, gap),
        Space::H2 if a.epsilon == 0.0 && b.epsilon == 0.0 => lost_length(a, b, eta, gap),
        _ => 0.0,
    };
    gap.is_finite().then_some(Edge { gap, low: if low.is_finite() { low } else { 0.0 }, q2 })
}

/// `l − γ_a − γ_b − gap` in E², to twice the digits: the angles of needles and of triangles in metrics of wide range turn on it.
fn lost_gap(a: Vertex, b: Vertex, eta: f64, gap: f64) -> f64 {
    let (x, y) = (a.scale, b.scale);
    let (xy, xy_low) = two_product(x, y);
    let (mut n, mut n_low) = two_product(2.0 * eta, xy);
    n_low += 2.0 * eta * xy_low + n * (a.low + b.low);
    for v in [a, b].into_iter().filter(|v| v.epsilon != 0.0) {
        let (square, square_low) = two_product(v.scale, v.scale);
        let (sum, lost) = two_sum(n, v.epsilon * square);
        (n, n_low) = (sum, n_low + lost + v.epsilon * (square_low + 2.0 * square * v.low));
    }
    let length = n.sqrt();
    let (square, square_low) = two_product(length, length);
    let length_low = ((n - square) - square_low + n_low) / (2.0 * length);
    let (rest, first) = two_sum(length, -a.radius);
    let (rest, second) = two_sum(rest, -b.radius);
    (rest - gap) + (first + second + length_low)
}

/// The half chord of an edge (l/2, sinh(l/2), sin(l/2) in E², H², S²) with twice the digits, as far as its ends have them
/// ([`is_precise`]); 0 for an edge without a real length.
pub fn half_chord(space: Space, a: Vertex, b: Vertex, eta: f64) -> Twofold {
    let [x, y] = [a, b].map(|v| Twofold::from(v.scale) + (v.scale * v.low).into());
    let square = |v: Vertex, x: Twofold| x * x * v.epsilon.into();
    let n = x * y * (2.0 * eta).into() + square(a, x) + square(b, y);
    match space {
        Space::E2 => n.sqrt() * 0.5.into(),
        _ => (n / (Twofold::from(a.d) * b.d.into())).sqrt(),
    }
}

/// `l − length` in H² where ε = 0, from `sinh²(l/2) = 2 η e^{u_a + u_b}` to twice the digits: `2 (q − sinh(length/2))/cosh(length/2)`.
fn lost_length(a: Vertex, b: Vertex, eta: f64, length: f64) -> f64 {
    let (up, lost) = twofold::exp(0.5 * length);
    let up = Twofold::from(up) + (up * lost).into();
    let down = Twofold::from(1.0) / up;
    let rest = half_chord(Space::H2, a, b, eta) - (up - down) * 0.5.into();
    4.0 * rest.high / (up.high + down.high)
}

impl Edge {
    /// What a double `length` of the edge from `a` to `b` loses: `γ_a + γ_b + gap + low − length`, to twice the digits.
    pub fn remainder(self, a: Vertex, b: Vertex, length: f64) -> f64 {
        let (sum, lost) = two_sum(a.radius, b.radius);
        let (sum, more) = two_sum(sum, self.gap);
        (sum - length) + (lost + more + self.low)
    }
}

/// The length of a squared half chord; NaN in S² where q² > 1.
#[inline]
pub fn length(space: Space, q2: f64) -> f64 {
    match space {
        Space::E2 => 2.0 * q2.sqrt(),
        Space::H2 => 2.0 * q2.sqrt().asinh(),
        Space::S2 => 2.0 * q2.sqrt().asin(),
    }
}

/// `N`, with squares completed where signs differ.
#[inline]
fn squared_chord(a: Vertex, b: Vertex, eta: f64) -> f64 {
    let (x, y) = (a.scale, b.scale);
    let cross = 2.0 * eta * (x * y);
    match (a.epsilon as i8, b.epsilon as i8) {
        (0, 0) => cross,
        (1, 1) if eta < 0.0 => (x - y) * (x - y) + 2.0 * (eta + 1.0) * (x * y),
        (1, 1) => cross + (x * x + y * y),
        (1, -1) => (x - y) * (x + y) + cross,
        (-1, 1) => (y - x) * (y + x) + cross,
        (-1, -1) => 2.0 * (eta - 1.0) * (x * y) - (x - y) * (x - y),
        (p, 0) => x * (2.0 * eta * y + f64::from(p) * x),
        (_, p) => y * (2.0 * eta * x + f64::from(p) * y),
    }
}

/// `l − γ_a − γ_b`, given `l + γ_a + γ_b`.
#[inline]
fn circle_gap(space: Space, a: Vertex, b: Vertex, eta: f64, total: f64) -> f64 {
    let product = 2.0 * (eta - 1.0) * (a.scale * b.scale);
    match space {
        Space::E2 => product / total,
        Space::H2 => 2.0 * (product / (a.d * b.d * (0.5 * total).sinh())).asinh(),
        Space::S2 if total < PI => 2.0 * (product / (a.d * b.d * (0.5 * total).sin())).asin(),
        // Circles about as large as the sphere: nothing small is left over.
        Space::S2 => total - 2.0 * (a.radius + b.radius),
    }
}

/// Half-perimeter differences `r_k` of a triangle, given its corners and the edges opposite them.
#[inline]
pub fn differences(corners: [Vertex; 3], edges: [Edge; 3]) -> [f64; 3] {
    let rest = half_differences(edges.map(|e| e.gap));
    let low = edges.map(|e| 0.5 * e.low);
    [0, 1, 2].map(|k| corners[k].radius + (rest[k] + (low[(k + 1) % 3] + low[(k + 2) % 3] - low[k])))
}

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
    if r.iter().any(|&x| x <= 0.0) {
        return [0.0; 3];
    }
    // In units of the longest chord no product under- or overflows.
    let unit = 0.5 / q2.into_iter().fold(0.0, f64::max).sqrt();
    let f = |x: f64| unit * super::triangle::sine(space, x);
    let s = r[0] + r[1] + r[2];
    if space == Space::S2 && s >= PI {
        return [0.0; 3];
    }
    let delta = (f(s) * f(r[0])).sqrt() * (f(r[1]) * f(r[2])).sqrt();
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
    // Of a triangle so thin that its area underflows doubles cannot say how it would move.
    if w.iter().all(|w| w.is_finite()) { w } else { [0.0; 3] }
}
