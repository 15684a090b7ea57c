//! Edges of a conformal class (ε, η, u): their lengths, and the half-perimeter differences of triangles.
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
//! Circles of very different sizes nearly fill their triangle. Its angles then depend on the differences between lengths and radii, which
//! are formed from `g((l − γ_i − γ_j)/2) g((l + γ_i + γ_j)/2) = 2 (η − 1) e_i e_j / (d_i d_j)` with `g = sinh, sin` (E²: `gap (l + γ_i +
//! γ_j) = 2 (η − 1) e_i e_j`):
//!
//! ```text
//! gap_k = l_k − γ_i − γ_j          r_k = s − l_k = γ_k + (gap_i + gap_j − gap_k)/2
//! ```
//!
//! In E² all formulas are homogeneous, and only ratios within one triangle matter. A vertex or an edge whose size is far from 1 has a
//! unit of its own, a power of two ([`Vertex::exponent`], [`Edge::exponent`]), and [`in_one_unit`] brings those of a triangle to a common
//! unit: so the lengths of one metric may range over e^±5e5. Powers of two are exact: where nothing over- or underflows, the digits are
//! those without units. H² and S² are not homogeneous and have no such units: lengths in H² lie between [`MIN_HYPERBOLIC_CHORD`] and
//! [`MAX_HYPERBOLIC_CHORD`].
//!
//! ```
//! use ricci::geometry::Space;
//! use ricci::geometry::conformal::{Vertex, edge};
//! // Circles of radius 1 and 2 that touch (ε = 1, η = 1).
//! let [a, b] = [1.0f64, 2.0].map(|radius| Vertex::new(Space::E2, 1, radius.ln()));
//! let touching = edge(Space::E2, a, b, 1.0).unwrap();
//! assert_eq!(touching.gap, 0.0);
//! assert!((touching.length(Space::E2) - 3.0).abs() < 1e-15);
//! ```

use super::Space;
use super::double_double::{self, DoubleDouble, two_product, two_sum};
use super::lanes::Lanes;
use super::scaled::{exponent, scaled};
use super::triangle::half_differences;
pub use super::vertex::{Vertex, is_precise, radius};
use std::f64::consts::PI;

/// An edge at the current u of its ends. Lengths are in units of 2^`exponent`, squares in units of 4^`exponent`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Edge {
    /// l − γ_i − γ_j with the radii of [`Vertex::radius`].
    pub gap: f64,
    /// The part that `gap` misses: known where both ends are [`is_precise`], else 0.
    pub low: f64,
    /// Squared half chord: l²/4, sinh²(l/2), sin²(l/2) in E², H², S².
    pub q2: f64,
    /// The exponent of the unit; 0 in H² and S².
    pub exponent: i32,
}

/// Largest squared half chord of an edge in H²: its length is below 300, and no product of such lengths overflows.
pub const MAX_HYPERBOLIC_CHORD: f64 = 1e129;
/// Smallest squared half chord of an edge in H²: its length is above 2e-140, and the rounding error of its square (2^-106 of it) is still
/// a normal number.
pub const MIN_HYPERBOLIC_CHORD: f64 = 1e-280;
/// The range of squared half chords of edges in H².
const HYPERBOLIC_CHORDS: std::ops::RangeInclusive<f64> = MIN_HYPERBOLIC_CHORD..=MAX_HYPERBOLIC_CHORD;
/// Binary exponents of squared lengths that need no unit of their own: their rounding errors, and products of two of them, are normal
/// numbers.
const PLAIN_SQUARES: std::ops::RangeInclusive<i32> = -500..=500;
/// Squared lengths of edges that have plain chords, 2^−500 to 2^500: their exponents are in [`PLAIN_SQUARES`].
const PLAIN_LENGTHS: std::ops::RangeInclusive<f64> = 3.054_936_363_499_605e-151..=3.273_390_607_896_142e150;
/// e^u of the ends of edges that have plain chords, 2^−480 to 2^480: rounding errors of products are normal numbers too.
const PLAIN_SCALES: std::ops::RangeInclusive<f64> = 3.203_333_952_292_962e-145..=3.121_748_550_315_992e144;
/// Largest η of such an edge, 2^900: its parts do not overflow when a product with it is split.
const MOST_PLAIN_ETA: f64 = 8.452_712_498_170_644e270;

/// Binary exponent of a unit of length in which `2 η e_a e_b`, `ε e_a²` and `ε e_b²` are in the middle of the range of f64. `e` holds e^u
/// of two vertices with these ε, each as a number and an exponent.
pub(super) fn unit_of_products(e: [(f64, i32); 2], epsilon: [f64; 2], eta: f64) -> i32 {
    let [x, y] = e.map(|(scale, power)| power + exponent(scale));
    let own = [x, y].into_iter().zip(epsilon).filter(|(_, epsilon)| *epsilon != 0.0).map(|(x, _)| x);
    // With half of η's exponent taken off, neither η nor the product leaves the range of f64.
    let cross = if eta == 0.0 { i32::MIN } else { (x + y).div_euclid(2) + exponent(eta).div_euclid(4) };
    own.fold(cross, i32::max)
}

/// An edge; `None` when (ε, η, u) give no real positive finite length (in H² none in the range of lengths).
#[inline]
pub fn edge(space: Space, a: Vertex, b: Vertex, eta: impl Into<DoubleDouble>) -> Option<Edge> {
    let eta = eta.into();
    if space == Space::E2 {
        return plane_edge(a, b, eta);
    }
    let q2 = squared_chord(a, b, eta.high) / (a.d * b.d);
    let range = if space == Space::H2 { HYPERBOLIC_CHORDS } else { f64::MIN_POSITIVE..=f64::MAX };
    if !range.contains(&q2) {
        return None;
    }
    let circles = a.epsilon > 0.0 && b.epsilon > 0.0;
    if circles && eta == 1.0.into() {
        // sin²(l/2) > 1: the circles together reach around the sphere.
        return (space != Space::S2 || q2 <= 1.0).then_some(Edge { gap: 0.0, low: 0.0, q2, exponent: 0 });
    }
    let length = length(space, q2);
    let sum = a.radius + b.radius;
    let gap = if circles { circle_gap(space, [a, b], eta, length + sum) } else { length - sum };
    let precise = space == Space::H2 && a.epsilon == 0.0 && b.epsilon == 0.0;
    let low = if precise { lost_length(a, b, eta, gap) } else { 0.0 };
    (gap.is_finite() && low.is_finite()).then_some(Edge { gap, low, q2, exponent: 0 })
}

/// An edge in E², in a unit in which its length is neither tiny nor huge.
fn plane_edge(a: Vertex, b: Vertex, eta: DoubleDouble) -> Option<Edge> {
    let plain = if a.exponent | b.exponent == 0 { squared_chord(a, b, eta.high) } else { f64::NAN };
    let ([a, b], n) = if PLAIN_SQUARES.contains(&exponent(plain)) {
        ([a, b], plain)
    } else {
        let ends = in_unit_of_edge(a, b, eta.high);
        (ends, squared_chord(ends[0], ends[1], eta.high))
    };
    if !(n > 0.0 && n < f64::INFINITY) {
        return None;
    }
    let (q2, exponent) = (0.25 * n, a.exponent);
    let circles = a.epsilon > 0.0 && b.epsilon > 0.0;
    if circles && eta == 1.0.into() {
        // The circles touch: l is the sum of their radii, and its low part is the sum of theirs.
        let low = a.radius * a.low + b.radius * b.low;
        return Some(Edge { gap: 0.0, low, q2, exponent });
    }
    let length = 2.0 * q2.sqrt();
    let sum = a.radius + b.radius;
    let gap = if circles { circle_gap(Space::E2, [a, b], eta, length + sum) } else { length - sum };
    let low = lost_gap(a, b, eta, gap);
    (gap.is_finite() && low.is_finite()).then_some(Edge { gap, low, q2, exponent })
}

/// The ends of an edge in E² in a common unit in which its length is neither tiny nor huge.
fn in_unit_of_edge(a: Vertex, b: Vertex, eta: f64) -> [Vertex; 2] {
    let unit = unit_of_products([a, b].map(|v| (v.scale, v.exponent)), [a.epsilon, b.epsilon], eta);
    [a, b].map(|v| v.in_unit(unit))
}

/// Brings the corners of a triangle and the edges opposite them to one unit of length, and returns its exponent: 0 in H² and S², and
/// where no size is far from 1.
///
/// Otherwise the longest edge is about 1, and sizes below 2^-500 of it may become 0.
#[inline]
pub fn in_one_unit(corners: &mut [Vertex; 3], edges: &mut [Edge; 3]) -> i32 {
    let plain = |k: usize| corners[k].exponent | edges[k].exponent == 0;
    if plain(0) && plain(1) && plain(2) {
        return 0;
    }
    let size = |e: &Edge| e.exponent + exponent(e.q2).div_euclid(2);
    let unit = size(&edges[0]).max(size(&edges[1])).max(size(&edges[2]));
    *corners = corners.map(|v| v.in_unit(unit));
    *edges = edges.map(|e| {
        let by = e.exponent - unit;
        Edge { gap: scaled(e.gap, by), low: scaled(e.low, by), q2: scaled(e.q2, 2 * by), exponent: unit }
    });
    unit
}

/// `l − γ_a − γ_b − gap` in E², in double-double precision. The angles of needles, and of triangles in metrics of wide range, depend on
/// it.
fn lost_gap(a: Vertex, b: Vertex, eta: DoubleDouble, gap: f64) -> f64 {
    let (mut n, mut n_low) = doubled_product([a.scale, a.low], [b.scale, b.low], [eta.high, eta.low]);
    for v in [a, b].into_iter().filter(|v| v.epsilon != 0.0) {
        let (square, square_low) = two_product(v.scale, v.scale);
        let (sum, lost) = two_sum(n, v.epsilon * square);
        (n, n_low) = (sum, n_low + lost + v.epsilon * (square_low + 2.0 * square * v.low));
    }
    let length = root(n, n_low);
    let (rest, first) = two_sum(length.high, -a.radius);
    let (rest, second) = two_sum(rest, -b.radius);
    (rest - gap) + (first + second + length.low)
}

/// `2 η e_a e_b` and its rounding error, from e with relative errors and η with its low part.
#[inline(always)]
fn doubled_product<L: Lanes>([a, a_low]: [L; 2], [b, b_low]: [L; 2], [eta, eta_low]: [L; 2]) -> (L, L) {
    let (xy, xy_low) = two_product(a, b);
    let (n, n_low) = two_product(eta + eta, xy);
    let half = eta * xy_low + eta_low * xy;
    (n, n_low + ((half + half) + n * (a_low + b_low)))
}

/// The square root of `n + low`.
#[inline(always)]
fn root<L: Lanes>(n: L, low: L) -> DoubleDouble<L> {
    let root = n.root();
    let (square, square_low) = two_product(root, root);
    DoubleDouble { high: root, low: ((n - square) - square_low + low) / (root + root) }
}

/// [`half_chord`] with ε = 0 at both ends, in E² and H², for an edge without a unit of its own; 0 for other edges.
#[inline]
pub fn plain_chord(space: Space, a: Vertex, b: Vertex, eta: DoubleDouble) -> DoubleDouble {
    if a.exponent | b.exponent != 0 {
        return DoubleDouble::default();
    }
    plain_chord_of(space, [a.scale, a.low], [b.scale, b.low], [eta.high, eta.low])
}

/// [`plain_chord`] for one edge or several, from the arguments of [`doubled_product`].
#[inline(always)]
pub(super) fn plain_chord_of<L: Lanes>(space: Space, a: [L; 2], b: [L; 2], eta: [L; 2]) -> DoubleDouble<L> {
    let (n, low) = doubled_product(a, b, eta);
    let (range, share) = match space {
        // l² = n
        Space::E2 => (&PLAIN_LENGTHS, 0.25),
        _ => (&HYPERBOLIC_CHORDS, 1.0),
    };
    let (zero, one, share) = (n.constant(0.0), n.constant(1.0), n.constant(share));
    let DoubleDouble { high, low } = root(share * n, share * low);
    let is_small = n.constant(MOST_PLAIN_ETA).where_at_least(eta[0], one, zero);
    let is_plain = a[0].where_within(&PLAIN_SCALES, b[0].where_within(&PLAIN_SCALES, is_small));
    let is_plain = n.where_within(range, is_plain);
    DoubleDouble {
        high: is_plain.where_at_least(one, high, zero),
        low: is_plain.where_at_least(one, low, zero),
    }
}

/// [`half_chord`], by [`plain_chord`] where that is not 0.
#[inline]
pub(crate) fn precise_chord(space: Space, a: Vertex, b: Vertex, eta: DoubleDouble) -> (DoubleDouble, i32) {
    if a.epsilon == 0.0 && b.epsilon == 0.0 && space != Space::S2 {
        let plain = plain_chord(space, a, b, eta);
        if plain.high > 0.0 {
            // The low part of u may be more than half an ulp of the chord.
            return (DoubleDouble::renormalised(plain.high, plain.low), 0);
        }
    }
    half_chord(space, a, b, eta)
}

/// The half chord of an edge (l/2, sinh(l/2), sin(l/2) in E², H², S²) in double-double precision as far as its ends have it
/// ([`is_precise`]), and the exponent of its unit; 0 for an edge without a real length.
pub fn half_chord(space: Space, a: Vertex, b: Vertex, eta: DoubleDouble) -> (DoubleDouble, i32) {
    let [a, b] = if space == Space::E2 { in_unit_of_edge(a, b, eta.high) } else { [a, b] };
    let [x, y] = [a, b].map(Vertex::precise_scale);
    let mut n = (x * y * eta).scaled(1);
    for (v, x) in [(a, x), (b, y)] {
        if v.epsilon != 0.0 {
            n = n + x * x * v.epsilon.into();
        }
    }
    let q = match space {
        Space::E2 => n.sqrt().scaled(-1),
        _ if a.d == 1.0 && b.d == 1.0 => n.sqrt(),
        _ => (n / (DoubleDouble::from(a.d) * b.d.into())).sqrt(),
    };
    (q, a.exponent)
}

/// `l − length` in H² where ε = 0, from `sinh²(l/2) = 2 η e^{u_a + u_b}` in double-double precision: `2 (q −
/// sinh(length/2))/cosh(length/2)`.
fn lost_length(a: Vertex, b: Vertex, eta: DoubleDouble, length: f64) -> f64 {
    let chord = precise_chord(Space::H2, a, b, eta).0;
    let half = 0.5 * length;
    if half <= double_double::MAX_SERIES {
        let sinh = double_double::sinh(half);
        return 2.0 * (chord - sinh).high / (1.0 + sinh.high * sinh.high).sqrt();
    }
    let (up, lost) = double_double::exp(half);
    let up = DoubleDouble::from(up) + (up * lost).into();
    let down = DoubleDouble::from(1.0) / up;
    let rest = chord - (up - down).scaled(-1);
    4.0 * rest.high / (up.high + down.high)
}

impl Edge {
    /// The length: 0 or infinite where it leaves the range of f64 (in E²), NaN in S² where q² > 1.
    pub fn length(self, space: Space) -> f64 {
        scaled(length(space, self.q2), self.exponent)
    }

    /// The part that `length`, an f64, misses for the edge from `a` to `b`: `γ_a + γ_b + gap + low − length` in double-double precision.
    pub fn remainder(self, a: Vertex, b: Vertex, length: f64) -> f64 {
        let [a, b] = [a, b].map(|v| v.in_unit(self.exponent));
        let (sum, lost) = two_sum(a.radius, b.radius);
        let (sum, more) = two_sum(sum, self.gap);
        scaled((sum - scaled(length, -self.exponent)) + (lost + more + self.low), self.exponent)
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

/// `N` of the head of this file. Where its terms have different signs the squares are completed, so that nothing cancels.
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

/// `l − γ_a − γ_b` of two circles, given `total = l + γ_a + γ_b`.
#[inline]
fn circle_gap(space: Space, [a, b]: [Vertex; 2], eta: DoubleDouble, total: f64) -> f64 {
    let product = 2.0 * ((eta.high - 1.0) + eta.low) * (a.scale * b.scale);
    match space {
        Space::E2 => product / total,
        Space::H2 => 2.0 * (product / (a.d * b.d * (0.5 * total).sinh())).asinh(),
        Space::S2 if total < PI => 2.0 * (product / (a.d * b.d * (0.5 * total).sin())).asin(),
        // The circles are about as large as the sphere, and the gap is not small: the plain difference loses no digits.
        Space::S2 => total - 2.0 * (a.radius + b.radius),
    }
}

/// [`half_differences`] of lengths in double-double precision.
#[inline]
pub fn differences_of_lengths(lengths: [DoubleDouble; 3]) -> [f64; 3] {
    differences_of(lengths.map(|l| l.high), lengths.map(|l| l.low))
}

/// [`differences_of_lengths`] for one triangle or several.
#[inline(always)]
pub(crate) fn differences_of<L: Lanes>(high: [L; 3], low: [L; 3]) -> [L; 3] {
    let (mut r, half) = (half_differences(high), low[0].constant(0.5));
    let low = [half * low[0], half * low[1], half * low[2]];
    for k in 0..3 {
        r[k] = r[k] + (low[(k + 1) % 3] + low[(k + 2) % 3] - low[k]);
    }
    r
}

/// Half-perimeter differences `r_k` of a triangle, given its corners and the edges opposite them, all in one unit ([`in_one_unit`]).
#[inline]
pub fn differences(corners: [Vertex; 3], edges: [Edge; 3]) -> [f64; 3] {
    if corners.iter().all(|v| v.radius == 0.0) {
        // Without circles the gaps are the lengths.
        return differences_of_lengths(edges.map(|e| DoubleDouble { high: e.gap, low: e.low }));
    }
    let gap = edges.map(|e| e.gap);
    // Near a broken triangle of circles 2γ_k and the gaps cancel: the rounding error of each sum is kept.
    [0, 1, 2].map(|k| {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        let (sum, first) = two_sum(gap[i], gap[j]);
        let (sum, second) = two_sum(sum, -gap[k]);
        let (sum, third) = two_sum(sum, 2.0 * corners[k].radius);
        let low = edges[i].low + edges[j].low - edges[k].low;
        0.5 * (sum + (first + second + third + low))
    })
}
