//! Orientation-preserving isometries of the three spaces by their Cayley–Klein parameters.
//!
//! With κ = λ = 0, −1, +1 and complex a, b, `|a|² + κ |b|² = 1`, the isometry is, in the stereographic coordinate z (E²: half the
//! plane's; H²: the Poincaré disk; S²: projection from the south pole, the north pole at 0),
//!
//! ```text
//! z ↦ (a z + b) / (−κ b̄ z + ā)        ±(a, b) are the same map       (a, b)(c, d) = (a c − κ b d̄, a d + b c̄)
//! translation by l along the x axis: a = cos, cosh, 1 of l/2,  b = sin, sinh, identity of l/2       rotation by θ: a = e^{iθ/2}
//! ```
//!
//! These are the unit quaternions SU(2) in S² and SU(1,1) in H². The same formulas serve the three spaces, and the entries keep their
//! *relative* accuracy far from the origin, where coordinates in the disk run out of digits.
//!
//! ```
//! use ricci::geometry::{Motion, Space};
//! let there = Motion::<f64>::translation(3.0, Space::H2);
//! assert_eq!(there.compose(&there.inverse()).apply([0.0, 0.0, 1.0])[..2], [0.0, 0.0]);
//! assert!((there.precise().displacement() - 3.0).abs() < 1e-14);
//! ```

use super::complex::{Complex, add, conj, mul, norm2, scale};
pub use super::real::Real;
use super::real::product;
use super::{DoubleDouble, Space};

/// An orientation-preserving isometry of E², H² or S².
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Motion<T = f64> {
    /// The space that it moves.
    pub space: Space,
    /// a, as `[Re, Im]`.
    pub a: Complex<T>,
    /// b, as `[Re, Im]`. The origin moves by a distance whose half chord (its half, or hyperbolic sine or sine of its half) is |b|.
    pub b: Complex<T>,
}

impl<T: Real> Motion<T> {
    /// The identity.
    pub fn identity(space: Space) -> Self {
        let zero = T::from(0.0);
        Motion { space, a: [T::from(1.0), zero], b: [zero; 2] }
    }

    /// Rotation about the origin, counterclockwise, from `[cos, sin]` of *half* its angle.
    pub fn rotation(half_angle: [T; 2], space: Space) -> Self {
        Motion { a: half_angle, ..Motion::identity(space) }
    }

    /// Translation along the x axis by the length with this half chord: l/2, sinh(l/2), sin(l/2) (below π) in E², H², S².
    pub fn translation_of_chord(chord: T, space: Space) -> Self {
        let (zero, one) = (T::from(0.0), T::from(1.0));
        let a = (one - T::from(space.curvature()) * chord * chord).root();
        Motion { space, a: [a, zero], b: [chord, zero] }
    }

    /// Translation by `length` along the x axis. Lengths in H² beyond 1400 overflow.
    pub fn translation(length: f64, space: Space) -> Self {
        let half = 0.5 * length;
        let (a, b) = match space {
            Space::E2 => (1.0, half),
            Space::H2 => (half.cosh(), half.sinh()),
            Space::S2 => (half.cos(), half.sin()),
        };
        let zero = T::from(0.0);
        Motion { space, a: [a.into(), zero], b: [b.into(), zero] }
    }

    /// The composition `self ∘ first`, which applies `first` first.
    pub fn compose(&self, first: &Self) -> Self {
        let sign = self.sign();
        let a = add(mul(self.a, first.a), scale(-sign, mul(self.b, conj(first.b))));
        let b = add(mul(self.a, first.b), mul(self.b, conj(first.a)));
        Motion { space: self.space, a, b }
    }

    /// `self` after the rotation about the origin whose half angle has this `[cos, sin]`. It costs a quarter of composing with
    /// [`Motion::rotation`].
    pub fn after_rotation(&self, half_angle: [T; 2]) -> Self {
        Motion { space: self.space, a: product(self.a, half_angle), b: product(self.b, conj(half_angle)) }
    }

    /// `self` after the translation along the x axis with these a and b. It costs a quarter of composing with
    /// [`Motion::translation_of_chord`].
    pub fn after_translation(&self, [cos, chord]: [T; 2]) -> Self {
        let bent = match self.space {
            Space::E2 => T::from(0.0),
            Space::H2 => chord,
            Space::S2 => -chord,
        };
        let (a, b) = (self.a, self.b);
        let part = |k: usize| T::two_products(cos, a[k], bent, b[k]);
        let moved = |k: usize| T::two_products(chord, a[k], cos, b[k]);
        Motion { space: self.space, a: [part(0), part(1)], b: [moved(0), moved(1)] }
    }

    /// `self` after the rotation about the origin by π, which only permutes entries and changes signs.
    pub(crate) fn after_half_turn(&self) -> Self {
        let ([a, b], [c, d]) = (self.a, self.b);
        Motion { space: self.space, a: [-b, a], b: [d, -c] }
    }

    /// x and y of [`Motion::origin`].
    pub(crate) fn place(&self) -> Complex<T> {
        product(self.a, self.b).map(|x| x + x)
    }

    /// The inverse.
    pub fn inverse(&self) -> Self {
        Motion { space: self.space, a: conj(self.a), b: self.b.map(|x| -x) }
    }

    /// The conjugate `to ∘ self ∘ to⁻¹`: this motion as it appears after `to` has moved the space.
    pub fn conjugated_by(&self, to: &Self) -> Self {
        to.compose(self).compose(&to.inverse())
    }

    /// The image of a point, in ambient coordinates `[x, y, w]`: of the plane `w = 1`, of the hyperboloid `w² = 1 + x² + y²`, of the unit
    /// sphere.
    pub fn apply(&self, [x, y, w]: [T; 3]) -> [T; 3] {
        let (a, b, sign) = (self.a, self.b, self.sign());
        let p = [x, y];
        // X ↦ a² X − κ b² X̄ + 2ab w,   w ↦ (|a|² − κ|b|²) w − 2κ Re(a b̄ X)
        let moved = add(mul(mul(a, a), p), scale(-sign, mul(mul(b, b), conj(p))));
        let from_w = mul(a, b);
        let two = T::from(2.0);
        let height = (norm2(a) - sign * norm2(b)) * w - two * sign * mul(mul(a, conj(b)), p)[0];
        [moved[0] + two * from_w[0] * w, moved[1] + two * from_w[1] * w, height]
    }

    /// The image of the origin (the plane's origin, the hyperboloid's and the sphere's pole), in ambient coordinates.
    pub fn origin(&self) -> [T; 3] {
        let ([x, y], sign) = (self.place(), self.sign());
        let square = |[x, y]: Complex<T>| T::two_products(x, x, y, y);
        [x, y, square(self.a) - sign * square(self.b)]
    }

    /// The matrix of [`Motion::apply`], by rows: in SE(2) (homogeneous), SO⁺(2,1) or SO(3).
    pub fn matrix(&self) -> [[T; 3]; 3] {
        let (zero, one) = (T::from(0.0), T::from(1.0));
        let columns = [[one, zero, zero], [zero, one, zero], [zero, zero, one]].map(|e| self.apply(e));
        [0, 1, 2].map(|row| columns.map(|column| column[row]))
    }

    /// Half the trace, Re a, of either sign. For a translation of H² by the length L its absolute value is cosh(L/2), above 1.
    pub fn half_trace(&self) -> T {
        self.a[0]
    }

    /// The same map, with `|a|² + κ|b|² = 1` to the last digit. b is kept (in S² its direction), which determines how far the origin
    /// moves.
    pub fn normalised(&self) -> Self {
        let (square, moved) = (norm2(self.a), norm2(self.b));
        let one = T::from(1.0);
        let (a, b) = match self.space {
            Space::S2 => {
                let shrink = one / (square + moved).root();
                (scale(shrink, self.a), scale(shrink, self.b))
            }
            Space::E2 => (scale(one / square.root(), self.a), self.b),
            Space::H2 => (scale(((one + moved) / square).root(), self.a), self.b),
        };
        Motion { space: self.space, a, b }
    }

    fn sign(&self) -> T {
        self.space.curvature().into()
    }
}

impl Motion<f64> {
    /// The motion in double-double precision, scaled so that `|a|² + κ|b|² = 1` holds to that precision.
    pub fn precise(&self) -> Motion<DoubleDouble> {
        Motion { space: self.space, a: self.a.map(DoubleDouble::from), b: self.b.map(DoubleDouble::from) }
            .normalised()
    }
}

impl Motion<DoubleDouble> {
    /// The isometry `z ↦ direction · z + place` of the plane; `direction` has length 1.
    pub fn in_plane(direction: [DoubleDouble; 2], place: [DoubleDouble; 2]) -> Self {
        let ([cos, sin], one) = (direction, DoubleDouble::from(1.0));
        // Half the angle, from the larger of 1 ± cos.
        let half = match (cos.high >= 0.0, sin.high >= 0.0) {
            (true, _) => [one + cos, sin],
            (false, true) => [sin, one - cos],
            (false, false) => [-sin, cos - one],
        };
        let a = scale(one / norm2(half).sqrt(), half);
        Motion { space: Space::E2, a, b: scale(0.5.into(), mul(place, conj(a))) }
    }

    /// The translation that moves the point with these ambient coordinates to the origin.
    pub fn to_origin(space: Space, [x, y, w]: [DoubleDouble; 3]) -> Self {
        let (one, two) = (DoubleDouble::from(1.0), DoubleDouble::from(2.0));
        // 2ab is x + iy, with b in that direction and a real: 2a² = 1 + w.
        let a = if space == Space::E2 { one } else { ((w + one) / two).sqrt() };
        let b = [x, y].map(|x| x / (two * a));
        Motion { space, a: [a, DoubleDouble::from(0.0)], b }.normalised().inverse()
    }

    /// The motion rounded to f64.
    pub fn rounded(&self) -> Motion {
        Motion { space: self.space, a: self.a.map(f64::from), b: self.b.map(f64::from) }
    }

    /// The distance by which the origin moves.
    pub fn displacement(&self) -> f64 {
        let moved = f64::from(norm2(self.b).root());
        2.0 * match self.space {
            Space::E2 => moved,
            Space::H2 => moved.asinh(),
            Space::S2 => moved.min(1.0).asin(),
        }
    }

    /// The angle θ ∈ [0, π] of the rotation that it is or contains: 2 acos |Re a|, and 0 for a translation of H².
    pub fn rotation_angle(&self) -> f64 {
        let imaginary = f64::from(self.a[1]).abs();
        let real = f64::from(self.a[0]).abs();
        match self.space {
            Space::E2 => 2.0 * imaginary.atan2(real),
            // sin²(θ/2) = 1 − (Re a)² = (Im a)² + κ|b|²
            _ => {
                let square = self.a[1] * self.a[1] + self.sign() * norm2(self.b);
                2.0 * f64::from(square.sqrt()).atan2(real)
            }
        }
    }

    /// The distance by which a translation moves points of its axis: L with `cosh(L/2) = |Re a|` in H², 0 for other motions; |t| in E²
    /// (where [`Motion::rotation_angle`] is 0); 0 in S².
    pub fn translation_length(&self) -> f64 {
        match self.space {
            Space::E2 => self.displacement(),
            // sinh²(L/2) = (Re a)² − 1 = |b|² − (Im a)²
            Space::H2 => 2.0 * f64::from((norm2(self.b) - self.a[1] * self.a[1]).sqrt()).asinh(),
            Space::S2 => 0.0,
        }
    }

    /// The one of the two equal motions ±(a, b) whose Re a is not negative.
    pub fn positive(&self) -> Self {
        let negative = f64::from(self.a[0]) < 0.0;
        if negative { Motion { a: self.a.map(|x| -x), b: self.b.map(|x| -x), ..*self } } else { *self }
    }

    /// The distance from the identity: the Frobenius norm of `±M − I` for the 2×2 matrix M, with the sign that makes it smaller.
    pub fn distance_from_identity(&self) -> f64 {
        let near = self.positive();
        let rest = near.a[0] - 1.0.into();
        let square = rest * rest + near.a[1] * near.a[1] + norm2(near.b);
        f64::from((DoubleDouble::from(2.0) * square).sqrt())
    }

    /// The square of the Frobenius norm of its 2×2 matrix, `2(|a|² + |b|²)`.
    pub fn norm_square(&self) -> f64 {
        2.0 * f64::from(norm2(self.a) + norm2(self.b))
    }

    /// The 2×2 complex matrix of the Möbius transformation in the plane (E²: `[[e^{iθ}, t], [0, 1]]`), the Poincaré disk or the
    /// stereographic plane of the sphere: determinant 1 (E²: e^{iθ}).
    pub fn mobius(&self) -> [[[f64; 2]; 2]; 2] {
        self.mobius_double_double().map(|row| row.map(|z| z.map(f64::from)))
    }

    /// The parts that the entries of [`Motion::mobius`] miss; together they are in double-double precision. Far translations need this,
    /// since |a|² − |b|² = 1 is a difference of numbers of the size e^length.
    pub fn mobius_remainder(&self) -> [[[f64; 2]; 2]; 2] {
        self.mobius_double_double().map(|row| row.map(|z| z.map(|x| x.low)))
    }

    fn mobius_double_double(&self) -> [[Complex<DoubleDouble>; 2]; 2] {
        let near = self.positive();
        let (a, b) = (near.a, near.b);
        let real = |x: f64| [DoubleDouble::from(x), DoubleDouble::from(0.0)];
        match self.space {
            Space::E2 => [[mul(a, a), scale(DoubleDouble::from(2.0), mul(a, b))], [real(0.0), real(1.0)]],
            _ => [[a, b], [scale(-self.sign(), conj(b)), conj(a)]],
        }
    }
}

/// The point in double-double precision that ambient coordinates in f64 stand for. In the plane and on the hyperboloid w is recomputed
/// from x and y, since its rounding far out would move the point by e^{2d} ulp; in S² the vector gets length 1.
pub fn precise_point(space: Space, p: [f64; 3]) -> [DoubleDouble; 3] {
    let [x, y, w] = p.map(DoubleDouble::from);
    let one = DoubleDouble::from(1.0);
    match space {
        Space::E2 => [x, y, one],
        Space::H2 => [x, y, (one + x * x + y * y).sqrt()],
        Space::S2 => {
            let norm = (x * x + y * y + w * w).sqrt();
            [x / norm, y / norm, w / norm]
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    const SPACES: [Space; 3] = [Space::E2, Space::H2, Space::S2];

    fn turn(angle: f64, space: Space) -> Motion {
        let (s, c) = (0.5 * angle).sin_cos();
        Motion::rotation([c, s], space)
    }

    fn some(space: Space) -> Vec<Motion> {
        let one = |i: u32| {
            let (x, y) = (f64::from(i) * 0.7, f64::from(i * i % 7) * 0.4);
            turn(x, space).compose(&Motion::translation(y, space)).compose(&turn(x * y, space))
        };
        (1..8).map(one).collect()
    }

    /// The bilinear form that is invariant in each space's ambient coordinates: w = 1, x² + y² − w², x² + y² + w².
    fn form(space: Space, p: [f64; 3], q: [f64; 3]) -> f64 {
        let plane = p[0] * q[0] + p[1] * q[1];
        match space {
            Space::E2 => p[2] * q[2],
            Space::H2 => plane - p[2] * q[2],
            Space::S2 => plane + p[2] * q[2],
        }
    }

    #[test]
    fn motions_act_as_isometries_and_compose_as_maps() {
        for space in SPACES {
            let points = [[0.3, 0.4], [-1.2, 0.1], [0.0, 0.0]].map(|[x, y]| {
                let r2: f64 = x * x + y * y;
                match space {
                    Space::E2 => [x, y, 1.0],
                    Space::H2 => [x, y, (1.0 + r2).sqrt()],
                    Space::S2 => [x / 2.0, y / 2.0, (1.0 - r2 / 4.0).sqrt()],
                }
            });
            for (g, h) in some(space).iter().zip(some(space).iter().skip(1)) {
                for (p, q) in points.iter().zip(points.iter().cycle().skip(1)) {
                    let (gp, gq) = (g.apply(*p), g.apply(*q));
                    assert!((form(space, gp, gq) - form(space, *p, *q)).abs() < 1e-12, "{space}");
                    let (both, one) = (g.compose(h).apply(*p), g.apply(h.apply(*p)));
                    let back = g.inverse().apply(gp);
                    for k in 0..3 {
                        assert!(
                            (both[k] - one[k]).abs() < 1e-12 && (back[k] - p[k]).abs() < 1e-12,
                            "{space}"
                        );
                    }
                }
                assert_eq!(g.origin(), g.apply([0.0, 0.0, 1.0]));
                let ([c, s], step) = ([0.6, 0.8], Motion::translation(0.7, space));
                let turned = g.after_rotation([c, s]).after_translation([step.a[0], step.b[0]]);
                let composed = g.compose(&Motion::rotation([c, s], space)).compose(&step);
                let parts = |m: Motion| [m.a, m.b].concat();
                let same = |(x, y): (f64, f64)| (x - y).abs() < 1e-13;
                assert!(parts(turned).into_iter().zip(parts(composed)).all(same), "{space}");
            }
        }
    }

    /// Walking round a regular polygon leads back, turning by the exterior angles: angle sums of the three geometries.
    #[test]
    fn walking_round_an_equilateral_triangle_leads_back() {
        for space in SPACES {
            let length = 0.8;
            let half = match space {
                Space::E2 => PI / 6.0,
                Space::H2 => (0.5 / (0.5f64 * length).cosh()).asin(),
                Space::S2 => (0.5 / (0.5f64 * length).cos()).asin(),
            };
            let side = Motion::translation(length, space).compose(&turn(PI - 2.0 * half, space)).precise();
            let round = side.compose(&side).compose(&side);
            assert!(round.distance_from_identity() < 1e-15, "{space}: {:e}", round.distance_from_identity());
        }
    }

    #[test]
    fn translations_and_rotations_have_their_length_and_angle_wherever_they_act() {
        for space in SPACES {
            for (g, length) in some(space).iter().zip([1e-3, 0.7, 2.0, 0.1]) {
                let around = |x: Motion| g.compose(&x).compose(&g.inverse()).precise();
                let translation = around(Motion::translation(length, space));
                let rotation = around(turn(length, space));
                assert!((rotation.rotation_angle() - length).abs() < 1e-12, "{space}");
                match space {
                    Space::S2 => assert!((translation.rotation_angle() - length).abs() < 1e-12),
                    _ => {
                        assert!((translation.translation_length() - length).abs() < 1e-12, "{space}");
                        assert!(translation.rotation_angle() < 1e-12);
                    }
                }
            }
        }
        assert!((Motion::translation(3.0, Space::H2).precise().displacement() - 3.0).abs() < 1e-15);
    }

    /// Sixty steps there and sixty back: entries reach e^30, which f64 cannot resolve.
    #[test]
    fn double_double_motions_come_back_from_far_out() {
        let go = turn(0.3, Space::H2).compose(&Motion::translation(1.5, Space::H2)).precise();
        let mut there = Motion::<DoubleDouble>::identity(Space::H2);
        let mut back = there;
        let straight = Motion::<DoubleDouble>::translation(1.5, Space::H2);
        for _ in 0..40 {
            there = there.compose(&straight);
            back = straight.inverse().compose(&back);
        }
        assert!(there.displacement() > 59.0);
        assert!(there.compose(&back).distance_from_identity() < 1e-4);
        let near = there.compose(&go).compose(&go.inverse()).compose(&there.inverse());
        assert!(near.distance_from_identity() < 1e-3, "{:e}", near.distance_from_identity());
    }

    #[test]
    fn matrices_act_as_the_maps() {
        for space in SPACES {
            let g = some(space)[2];
            let p = [0.2, -0.1, 0.9];
            let image = g.matrix().map(|row| row[0] * p[0] + row[1] * p[1] + row[2] * p[2]);
            let expected = g.apply(p);
            assert!((0..3).all(|k| (image[k] - expected[k]).abs() < 1e-15));
            let [[a, b], [c, d]] = g.precise().mobius();
            // z ↦ (a z + b)/(c z + d) at 0 is the image of the origin.
            let at = |[x, y]: [f64; 2], [u, v]: [f64; 2]| {
                let n = u * u + v * v;
                [(x * u + y * v) / n, (y * u - x * v) / n]
            };
            let z = at(b, d);
            let [x, y, w] = g.origin();
            let expected = if space == Space::E2 { [x, y] } else { [x / (1.0 + w), y / (1.0 + w)] };
            assert!((z[0] - expected[0]).abs() < 1e-15 && (z[1] - expected[1]).abs() < 1e-15, "{space}");
            let det = |p: [f64; 2], q: [f64; 2]| [p[0] * q[0] - p[1] * q[1], p[0] * q[1] + p[1] * q[0]];
            let (ad, bc) = (det(a, d), det(b, c));
            assert!(((ad[0] - bc[0]).hypot(ad[1] - bc[1]) - 1.0).abs() < 1e-15);
        }
    }
}
