//! Flips inside a conformal class, and the weighted Delaunay condition.
//!
//! ```
//! use ricci::geometry::flip::Hinge;
//! // A unit square cut by a diagonal: its four corners lie on one circle, and the other diagonal is as long.
//! let (side, diagonal) = (0.5, 1.0); // η = l²/2 where ε = 0 and u = 0
//! let hinge = Hinge::new([0.0; 4], [1.0; 4], [diagonal, side, side, side, side]);
//! assert_eq!(hinge.flipped(), Some(1.0));
//! assert!(!hinge.wants_flip());
//! ```
//!
//! Vertices are vectors v of Lorentz space with `⟨v_i, v_i⟩ = ε_i`, `⟨v_i, v_j⟩ = −η_ij`, and `l_ij = |e^{u_i} v_i − e^{u_j} v_j|` in E²
//! \[BL23\]. A flip changes the triangles ijk, jil but not the vectors; it needs the product of v_k and v_l, which lie on different sides
//! of the plane through v_i and v_j.
//!
//! ```text
//!         k             G = [[ε_i, −η_ij], [−η_ij, ε_j]],  D = −det G = η_ij² − ε_i ε_j
//!       /   \           the part of v_k in span(v_i, v_j) and what is left of it across:
//!      i ——— j              a_k = ε_k + (ε_j η_ik² + 2 η_ij η_ik η_jk + ε_i η_jk²)/D
//!       \   /           η_kl = (ε_j η_ik η_il + η_ij (η_ik η_jl + η_jk η_il) + ε_i η_jk η_jl)/D + √(a_k a_l)
//!         l             For ε = 0: √η_kl √η_ij = √η_ik √η_jl + √η_jk √η_il, Ptolemy.
//! ```
//!
//! D > 0 needs a real circle orthogonal to those of i, j and k: the complement of an imaginary one (time-like) is Euclidean, where all ε
//! are 1 and |η| < 1. Edges of triangles around an imaginary circle are not flipped.
//!
//! All of this is invariant under multiplying each vector by a factor `w > 0`. The products are formed from `ε w²` and `η w w`, which are
//! of the size of squared lengths, whatever the size of η.

use super::conformal::{Vertex, unit_of_products};
use super::motion::Real;
use super::{DoubleDouble, Space};

/// Least `D/η_ij²` of an edge that can be flipped. Where it is smaller, the circles i and j touch within the rounding of η (1e-16; the
/// factor of 1000 leaves room), and no vector is perpendicular to the plane of their vectors.
const TANGENT: f64 = 1e-13;
/// An edge is flipped where the Delaunay condition fails by more than this share of its terms. The terms are rounded by about 1e-15;
/// shares from 0 to 1e-10 give the same results on the corpus.
pub const TOLERANCE: f64 = 1e-12;
/// Squared sine of an angle opposite the edge below which cosines may not show whether the edge is Delaunay: those of φ and π − φ' with
/// φ, φ' below 1e-6 add up to less than [`TOLERANCE`], though φ may be half of φ'. At this bound (sines of 0.01), cosines compare angles
/// to 1e-10.
const THIN: f64 = 1e-4;

/// The two triangles at an edge ij, with the opposite vertices k and l, in f64 or in double-double precision.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hinge<T = f64> {
    /// `ε w²` of i, j, k, l, over `unit`.
    square: [T; 4],
    /// `η w w` of ij, ik, jk, il, jl, over `unit`.
    product: [T; 5],
    /// The largest of these products, by which all are divided, so that products of three do not leave the range of f64.
    unit: f64,
}

/// The crossing of an edge ij and the line from k to l, as a vector of Lorentz space written in two ways: by the vectors of k and l, and
/// by those of i and j. All weights are positive where no ε is negative.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DiagonalCrossing {
    /// The weights of k and l.
    pub diagonal: [f64; 2],
    /// The weights of i and j.
    pub edge: [f64; 2],
}

/// `w` of a vertex, `value · 2^exponent`, which need not be in the range of f64.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Weight<T = f64> {
    /// w in the unit.
    pub value: T,
    /// The exponent of the unit: 0 except for vertices in E² whose size is far from 1.
    pub exponent: i32,
}

/// `w` of a vertex for the Delaunay condition: `e^u` in E², and `2 e^u/(1 − λ ε e^{2u})` elsewhere (for circles tanh γ, tan γ up to a
/// factor).
pub fn weight(space: Space, v: Vertex) -> Weight {
    let value = match space {
        Space::E2 => v.scale,
        _ => 2.0 * v.scale / (1.0 - space.curvature() * v.epsilon * v.scale * v.scale),
    };
    Weight { value, exponent: v.exponent }
}

/// [`weight`] in double-double precision, for a vertex with that precision ([`super::conformal::is_precise`]): there it is `e^u` or `2
/// e^u`.
pub fn precise_weight(space: Space, v: Vertex) -> Weight<DoubleDouble> {
    let Weight { value, exponent } = weight(space, v);
    Weight { value: DoubleDouble::from(value) + (value * v.low).into(), exponent }
}

/// The absolute value as an f64.
fn size<T: Real>(x: T) -> f64 {
    let x: f64 = x.into();
    x.abs()
}

impl<T: Real> Hinge<T> {
    /// The hinge with ε and w of the vertices i, j, k, l and η of the edges ij, ik, jk, il, jl.
    pub fn new(epsilon: [f64; 4], w: [T; 4], eta: [T; 5]) -> Hinge<T> {
        let [i, j, k, l] = w;
        let ends = [i * j, i * k, j * k, i * l, j * l];
        Hinge::from_products(
            std::array::from_fn(|v| T::from(epsilon[v]) * w[v] * w[v]),
            std::array::from_fn(|e| eta[e] * ends[e]),
        )
    }

    /// The hinge with weights that need not be in the range of f64, and `w_k w_l` in its unit: η of the other diagonal is the quotient of
    /// [`Hinge::flipped`] by it.
    pub fn of_weights(epsilon: [f64; 4], w: [Weight<T>; 4], eta: [T; 5]) -> (Hinge<T>, T) {
        let mut values = w.map(|w| w.value);
        if w.iter().any(|w| w.exponent != 0) {
            let unit = |(e, [a, b]): (usize, [usize; 2])| {
                let ends = [a, b].map(|v| (w[v].value.into(), w[v].exponent));
                unit_of_products(ends, [epsilon[a], epsilon[b]], eta[e].into())
            };
            let edges = [[0, 1], [0, 2], [1, 2], [0, 3], [1, 3]].into_iter().enumerate();
            let unit = edges.map(unit).fold(i32::MIN, i32::max);
            values = w.map(|w| w.value.times_two_to(w.exponent - unit));
        }
        (Hinge::new(epsilon, values, eta), values[2] * values[3])
    }

    /// The hinge with `ε w²` of the vertices i, j, k, l and `η w w` of the edges ij, ik, jk, il, jl.
    pub fn from_products(square: [T; 4], product: [T; 5]) -> Hinge<T> {
        let unit = square.into_iter().chain(product).map(size).fold(0.0, f64::max);
        let scaled = |x: T| x / T::from(unit);
        Hinge { square: square.map(scaled), product: product.map(scaled), unit }
    }

    /// D, and a_k and a_l; `None` where the edge cannot be flipped.
    fn across(&self) -> Option<(T, [T; 2])> {
        let [i, j, k, l] = self.square;
        let [ij, ik, jk, il, jl] = self.product;
        let d = if (i * j).into() > 0.0 {
            // Both circles are real or both imaginary: D as a product of differences.
            let mean = (i * j).root();
            (ij - mean) * (ij + mean)
        } else {
            ij * ij - i * j
        };
        let two = T::from(2.0);
        let part = |own: T, ik: T, jk: T| own + (j * ik * ik + two * ij * ik * jk + i * jk * jk) / d;
        let across = [part(k, ik, jk), part(l, il, jl)];
        let is_positive = |a: &T| (*a).into() > 0.0 && (*a).into() < f64::INFINITY;
        let has_direction = ij.into() > 0.0 && d.into() > TANGENT * ij.into() * ij.into();
        (has_direction && across.iter().all(is_positive)).then_some((d, across))
    }

    /// `η w w` of the other diagonal kl. `None` where there is none: the circles i and j are tangent, or the vector of k or l is not
    /// space-like across their plane.
    pub fn flipped(&self) -> Option<T> {
        let (d, [across_k, across_l]) = self.across()?;
        let [i, j, ..] = self.square;
        let [ij, ik, jk, il, jl] = self.product;
        let within = (j * ik * il + ij * (ik * jl + jk * il) + i * jk * jl) / d;
        let kl = (within + across_k.root() * across_l.root()) * self.unit.into();
        kl.into().is_finite().then_some(kl)
    }

    /// The heights that the Delaunay condition compares, where the edge can be flipped.
    fn heights(&self) -> Option<Heights<T>> {
        let (d, across) = self.across()?;
        let [i, j, ..] = self.square;
        let [ij, ik, jk, il, jl] = self.product;
        let (mut sum, mut size_of_terms) = (T::from(0.0), 0.0);
        let heights = [(ik, jk, across[0]), (il, jl, across[1])].map(|(near_i, near_j, across)| {
            let x = ((j + ij) * near_i + (i + ij) * near_j) / d;
            let height = (x - T::from(1.0)) / across.root();
            sum = sum + height;
            size_of_terms += (size(x) + 1.0) / across.into().sqrt();
            height
        });
        // √D over the length of ij, in units of w.
        let unit = (d / (i + j + T::from(2.0) * ij)).root();
        let sound = sum.into().is_finite() && size_of_terms.is_finite();
        let cosines = heights.map(|height| height * unit);
        sound.then_some(Heights { sum: sum.into(), size: size_of_terms, cosines })
    }

    /// `t_k + t_l`, up to a positive factor: positive for a Delaunay edge, 0 where the four circles have a common orthogonal circle;
    /// `None` where the edge cannot be flipped.
    pub fn height(&self) -> Option<f64> {
        self.heights().map(|heights| heights.sum)
    }
}

/// The heights t_k, t_l of the centres of the two face circles over an edge, up to a common positive factor. The edge is weighted
/// Delaunay where `t_k + t_l ≥ 0`. The heights are defined also where the triangle inequality breaks.
struct Heights<T> {
    /// `t_k + t_l`.
    sum: f64,
    /// The size of the terms of the sum.
    size: f64,
    /// In E², the cosines of the angles at which the face circles meet the edge; without vertex circles these are the angles opposite it.
    /// They lie beyond ±1 in a broken triangle.
    cosines: [T; 2],
}

impl Hinge {
    /// The crossing of the edge ij and the line from k to l; `None` where the edge cannot be flipped.
    ///
    /// With `v_k = p_k + √a_k n`, `v_l = p_l − √a_l n` and p in span(v_i, v_j): `√a_l v_k + √a_k v_l = √a_l p_k + √a_k p_l`.
    pub fn meeting(&self) -> Option<DiagonalCrossing> {
        let (d, across) = self.across()?;
        let [k, l] = across.map(f64::sqrt);
        let [i, j, ..] = self.square;
        let [ij, ik, jk, il, jl] = self.product;
        let edge = [
            l * (j * ik + ij * jk) + k * (j * il + ij * jl),
            l * (ij * ik + i * jk) + k * (ij * il + i * jl),
        ];
        let meeting = DiagonalCrossing { diagonal: [l, k], edge: edge.map(|x| x / d) };
        let sound = meeting.diagonal.iter().chain(&meeting.edge).all(|&x| x > 0.0 && x < f64::INFINITY);
        sound.then_some(meeting)
    }

    /// True if the edge fails the weighted Delaunay condition by more than [`TOLERANCE`] and can be flipped.
    pub fn wants_flip(&self) -> bool {
        self.verdict() == Some(true)
    }

    /// [`Hinge::wants_flip`], or `None` where f64 does not decide: the terms of the condition cancel to less than [`TOLERANCE`] of their
    /// size because the triangles are needles, not because the angles add up to π.
    pub fn verdict(&self) -> Option<bool> {
        let Some(Heights { sum, size, cosines: [k, l] }) = self.heights() else { return Some(false) };
        let is_thin = |cosine: f64| (1.0 - cosine * cosine).abs() < THIN;
        let is_needle = (k + l).abs() > TOLERANCE || is_thin(k) || is_thin(l);
        let unclear = sum.abs() <= TOLERANCE * size && is_needle;
        (!unclear).then_some(sum < -TOLERANCE * size)
    }
}

impl Hinge<DoubleDouble> {
    /// True if the edge fails the weighted Delaunay condition and can be flipped, for edges where [`Hinge::verdict`] is `None`: the
    /// angles α, β that the condition compares add up to more than π, `sin(α + β) < 0`, by more than [`TOLERANCE`] of `sin α + sin β`.
    pub fn wants_flip(&self) -> bool {
        let Some(Heights { cosines: [k, l], .. }) = self.heights() else { return false };
        // 0 in a broken triangle, whose angles are 0 and π.
        let [sin_k, sin_l] = [k, l].map(|cosine| (DoubleDouble::from(1.0) - cosine * cosine).sqrt());
        let sines = (sin_k + sin_l).high;
        if sines == 0.0 { (k + l).high < 0.0 } else { (sin_k * l + k * sin_l).high < -TOLERANCE * sines }
    }
}

/// `ε w²` of a real circle of this radius with `w = γ, tanh γ, tan γ` in E², H², S².
pub fn circle_square(space: Space, radius: f64) -> f64 {
    match space {
        Space::E2 => radius * radius,
        Space::H2 => radius.tanh().powi(2),
        Space::S2 => radius.tan().powi(2),
    }
}

/// `η w w` of two real circles with these radii at this distance, with the w of [`circle_square`].
///
/// `(l² − γ_i² − γ_j²)/2` in E²; `(cosh l − cosh γ_i cosh γ_j)/(cosh γ_i cosh γ_j)` in H² and `(cos γ_i cos γ_j − cos l)/(cos γ_i cos
/// γ_j)` in S², written with squared sines of half arguments: a difference of two numbers near 1 would lose all digits of short lengths.
pub fn circle_product(space: Space, length: f64, radii: [f64; 2]) -> f64 {
    let half: fn(f64) -> f64 = match space {
        Space::E2 => {
            let [a, b] = radii;
            return 0.5 * (length * length - a * a - b * b);
        }
        Space::H2 => |x: f64| (0.5 * x).sinh().powi(2),
        Space::S2 => |x: f64| (0.5 * x).sin().powi(2),
    };
    // λ = ∓1: C(x) = 1 − 2 λ s² with s² = half(x), and C(a) C(b) − C(l) = 2 λ (s_l² − s_a² − s_b² + 2 λ s_a² s_b²).
    let curvature = space.curvature();
    let [l, a, b] = [length, radii[0], radii[1]].map(half);
    let cosines = (1.0 - 2.0 * curvature * a) * (1.0 - 2.0 * curvature * b);
    2.0 * (l - a - b + 2.0 * curvature * a * b) / cosines
}

/// Sum of two hyperbolic lengths above which [`diagonal`] works with logarithms: e^sum overflows at 710.
const FAR: f64 = 700.0;

/// Length of the other diagonal of two triangles that lie side by side along a common edge: from the two sides a, b that meet at one of
/// its ends, and the angle θ between them.
///
/// `q² = f((a − b)/2)² + f(a) f(b) sin²(θ/2)` with f = identity/2, sinh, sin, where q is the half chord l/2, sinh(l/2), sin(l/2). No
/// nearly equal numbers are subtracted, so short and long lengths keep their relative accuracy.
pub fn diagonal(space: Space, a: f64, b: f64, angle: f64) -> f64 {
    let (sine, cosine) = (0.5 * angle).sin_cos();
    match space {
        Space::E2 => ((a - b) * (a - b) + 4.0 * a * b * sine * sine).sqrt(),
        Space::H2 if a + b > FAR => far_diagonal(a, b, sine),
        Space::H2 => {
            let q2 = (0.5 * (a - b)).sinh().powi(2) + a.sinh() * b.sinh() * sine * sine;
            2.0 * q2.sqrt().asinh()
        }
        Space::S2 => {
            let q2 = (0.5 * (a - b)).sin().powi(2) + a.sin() * b.sin() * sine * sine;
            // 1 − q²: without it, q near 1 would leave half the digits of lengths near π.
            let p2 = (0.5 * (a + b)).cos().powi(2) + a.sin() * b.sin() * cosine * cosine;
            2.0 * q2.sqrt().atan2(p2.sqrt())
        }
    }
}

/// [`diagonal`] in H² for long sides, from the logarithms of the two parts of `2 q`, which may leave the range of f64 (`2 sinh x = e^x (1
/// − e^{−2x})`).
fn far_diagonal(a: f64, b: f64, sine: f64) -> f64 {
    let difference = (a - b).abs();
    let apart = 0.5 * difference + (-(-difference).exp_m1()).ln();
    let turned = 0.5 * (a + b + ((-2.0 * a).exp_m1() * (-2.0 * b).exp_m1()).ln()) + sine.ln();
    let (less, more) = (apart.min(turned), apart.max(turned));
    let log = more + 0.5 * (2.0 * (less - more)).exp().ln_1p();
    // 2 asinh q is 2 log(2 q) in f64 from q = 1e8 on.
    if log > 20.0 { 2.0 * log } else { 2.0 * (0.5 * log.exp()).asinh() }
}
