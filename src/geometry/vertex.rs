//! The quantities of one vertex that formulas need: e^u, the radius of its circle, and the factor d of its type.

use super::Space;
use super::double_double::{self, DoubleDouble, MAX_EXPONENT, SURELY_NORMAL, exp_parts};
use super::scaled::scaled;

/// Largest |u| in E² for which e^u is kept without an exponent, 256 log 2: its square is about 2^±512, which leaves as much of the range
/// of f64 for η.
const MAX_PLAIN_U: f64 = 177.0;
/// Largest u for which the radius is `2 artanh e^u`; above it e^u is so near 1 that this cancels, and `−log tanh(−u/2)` is used.
const NEAR_HOROCYCLE: f64 = -1.0;

/// A vertex at its current u.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Vertex {
    /// ε.
    pub epsilon: f64,
    /// e^u, in units of 2^`exponent`.
    pub scale: f64,
    /// The relative error of `scale` as e^u, where the vertex [`is_precise`]. Elsewhere 0, and `scale`, `d` and `radius` already contain
    /// the low part of u.
    pub low: f64,
    /// d = 1 + λ ε e^{2u}. NaN outside the metric's domain: where d ≤ 0; where |u| > 5e5 in E²; where e^u is not a normal number in H²
    /// with ε = 0.
    pub d: f64,
    /// γ where ε = 1, else 0; in units of 2^`exponent`.
    pub radius: f64,
    /// The unit of `scale` and `radius` is 2 to this power; 0 except in E² where |u| is above 177.
    pub exponent: i32,
}

/// Radius γ of a vertex of type ε with variable u: `u = log γ` in E², `u = log tanh(γ/2)` where λε = −1 (circles in H², imaginary ones in
/// S²), `u = log tan(γ/2)` where λε = 1. For ε = 0 it is e^u.
pub fn radius(space: Space, epsilon: i8, u: f64) -> f64 {
    match space.curvature() * f64::from(epsilon) {
        0.0 => u.exp(),
        x if x > 0.0 => 2.0 * u.exp().atan(),
        _ if u > NEAR_HOROCYCLE => -(-0.5 * u).tanh().ln(),
        _ => 2.0 * u.exp().atanh(),
    }
}

/// True if lengths between vertices of type ε are computed in double-double precision: in E², and in H² where ε = 0.
pub fn is_precise(space: Space, epsilon: i8) -> bool {
    space == Space::E2 || (space == Space::H2 && epsilon == 0)
}

/// True if e^u is a normal number with exponent 0 and all other quantities of the vertex follow from it.
#[inline]
pub(super) fn is_plain(space: Space, epsilon: i8, u: f64) -> bool {
    match space {
        Space::E2 => u.abs() <= MAX_PLAIN_U,
        Space::H2 => epsilon == 0 && u.abs() <= SURELY_NORMAL,
        Space::S2 => false,
    }
}

impl Vertex {
    /// The quantities of a vertex of type ε with variable `u + low`, where `low` is the part that u misses (at most half an ulp): e^u has
    /// 16 digits also where u is large.
    pub fn precise(space: Space, epsilon: i8, u: f64, low: f64) -> Vertex {
        if space == Space::E2 {
            return Vertex::in_plane(epsilon, u, low);
        }
        if is_precise(space, epsilon) {
            if is_plain(space, epsilon, u) {
                return Vertex::of_exponential(epsilon, exp_parts(u), low);
            }
            let (scale, lost) = double_double::exp(u);
            // A subnormal e^u has too few digits for this type.
            return if scale.is_normal() {
                Vertex { scale, low: lost + low, d: 1.0, ..Vertex::default() }
            } else {
                Vertex { scale: f64::NAN, d: f64::NAN, ..Vertex::default() }
            };
        }
        let rounded = Vertex::new(space, epsilon, u);
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

    fn in_plane(epsilon: i8, u: f64, low: f64) -> Vertex {
        if is_plain(Space::E2, epsilon, u) {
            return Vertex::of_exponential(epsilon, exp_parts(u), low);
        }
        let [scale, lost, exponent] =
            if u.abs() <= MAX_EXPONENT { exp_parts(u) } else { [f64::NAN, 0.0, 0.0] };
        let d = if scale.is_nan() { scale } else { 1.0 };
        let radius = if epsilon == 1 { scale } else { 0.0 };
        Vertex { epsilon: f64::from(epsilon), scale, low: lost + low, d, radius, exponent: exponent as i32 }
    }

    /// [`Vertex::precise`] from the [`exp_parts`] of u, where u [`is_plain`].
    #[inline]
    pub(super) fn of_exponential(epsilon: i8, [mantissa, lost, power]: [f64; 3], low: f64) -> Vertex {
        let scale = scaled(mantissa, power as i32);
        let radius = if epsilon == 1 { scale } else { 0.0 };
        Vertex { epsilon: f64::from(epsilon), scale, low: lost + low, d: 1.0, radius, exponent: 0 }
    }

    /// The quantities of a vertex of type ε with variable u.
    pub fn new(space: Space, epsilon: i8, u: f64) -> Vertex {
        if space == Space::E2 && u.abs() > MAX_PLAIN_U {
            return Vertex { low: 0.0, ..Vertex::in_plane(epsilon, u, 0.0) };
        }
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
            exponent: 0,
        }
    }

    /// e^u in the vertex's unit, including `low`.
    pub fn precise_scale(self) -> DoubleDouble {
        DoubleDouble::from(self.scale) + (self.scale * self.low).into()
    }

    /// The same vertex in units of 2^`unit`.
    pub(super) fn in_unit(self, unit: i32) -> Vertex {
        let by = self.exponent - unit;
        Vertex { scale: scaled(self.scale, by), radius: scaled(self.radius, by), exponent: unit, ..self }
    }
}
