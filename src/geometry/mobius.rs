//! Möbius transformations of the plane.
//!
//! ```
//! use ricci::geometry::Mobius;
//! let cayley = Mobius::of_triples([[0.0, 0.0], [1.0, 0.0], [-1.0, 0.0]], [[-1.0, 0.0], [0.0, -1.0], [0.0, 1.0]]).unwrap();
//! let [x, y] = cayley.apply([0.0, 1.0]);
//! assert!(x.hypot(y) < 1e-15);
//! ```

use super::complex::{Complex, add, conj, mul, neg, norm, scale, sub};

/// `z ↦ (a z + b)/(c z + d)`, with `a d − b c ≠ 0`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mobius {
    /// `[[a, b], [c, d]]`.
    pub matrix: [[Complex; 2]; 2],
}

/// A circle of the plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlaneCircle {
    /// Its centre.
    pub centre: Complex,
    /// Its radius.
    pub radius: f64,
}

const ONE: Complex = [1.0, 0.0];
const ZERO: Complex = [0.0, 0.0];

fn quotient(z: Complex, w: Complex) -> Complex {
    // Scaled, so that |w|² neither under- nor overflows.
    let size = norm(w);
    let unit = w.map(|x| x / size);
    mul(z, conj(unit)).map(|x| x / size)
}

impl Mobius {
    /// The identity, `z ↦ z`.
    pub const IDENTITY: Mobius = Mobius { matrix: [[ONE, ZERO], [ZERO, ONE]] };

    /// The rotation about 0 by the angle of the unit vector `by`.
    pub fn rotation(by: Complex) -> Mobius {
        Mobius { matrix: [[by, ZERO], [ZERO, ONE]] }
    }

    /// `r/(z − p)`, which maps the outside of a circle to the inside of the unit circle, and ∞ to 0.
    pub fn outside(circle: PlaneCircle) -> Mobius {
        Mobius { matrix: [[ZERO, [circle.radius, 0.0]], [ONE, neg(circle.centre)]] }
    }

    /// `(z − p)/(1 − p̄ z)`, which maps the unit disk to itself and p, a point inside it, to 0.
    pub fn to_origin(p: Complex) -> Mobius {
        Mobius { matrix: [[ONE, neg(p)], [neg(conj(p)), ONE]] }
    }

    /// The transformation that maps three points to three others; `None` where two points of a triple coincide.
    pub fn of_triples(from: [Complex; 3], to: [Complex; 3]) -> Option<Mobius> {
        // The map to 0, 1, ∞: (z − z0)(z1 − z2) / ((z − z2)(z1 − z0)).
        let standard = |[p, q, r]: [Complex; 3]| {
            let [high, low] = [sub(q, r), sub(q, p)];
            Mobius { matrix: [[high, neg(mul(high, p))], [low, neg(mul(low, r))]] }
        };
        let distinct = |[p, q, r]: [Complex; 3]| p != q && q != r && r != p;
        (distinct(from) && distinct(to)).then(|| standard(to).inverse().after(&standard(from)))
    }

    /// `a d − b c`.
    pub fn determinant(&self) -> Complex {
        let [[a, b], [c, d]] = self.matrix;
        sub(mul(a, d), mul(b, c))
    }

    /// The composition that applies `first` and then this transformation.
    pub fn after(&self, first: &Mobius) -> Mobius {
        let ([[a, b], [c, d]], [[e, f], [g, h]]) = (self.matrix, first.matrix);
        let matrix = [
            [add(mul(a, e), mul(b, g)), add(mul(a, f), mul(b, h))],
            [add(mul(c, e), mul(d, g)), add(mul(c, f), mul(d, h))],
        ];
        // A matrix and its multiples are the same map: the largest entry is scaled to size 1.
        let size = matrix.iter().flatten().map(|&z| norm(z)).fold(0.0, f64::max);
        Mobius { matrix: matrix.map(|row| row.map(|z| z.map(|x| x / size))) }
    }

    /// The inverse.
    pub fn inverse(&self) -> Mobius {
        let [[a, b], [c, d]] = self.matrix;
        Mobius { matrix: [[d, neg(b)], [neg(c), a]] }
    }

    /// The image of a point.
    pub fn apply(&self, z: Complex) -> Complex {
        let [[a, b], [c, d]] = self.matrix;
        quotient(add(mul(a, z), b), add(mul(c, z), d))
    }

    /// The image of ∞.
    pub fn at_infinity(&self) -> Complex {
        let [[a, _], [c, _]] = self.matrix;
        quotient(a, c)
    }

    /// The logarithm of the factor by which lengths near z grow: `|a d − b c|/|c z + d|²`.
    pub fn log_scale(&self, z: Complex) -> f64 {
        let [_, [c, d]] = self.matrix;
        norm(self.determinant()).ln() - 2.0 * norm(add(mul(c, z), d)).ln()
    }

    /// The logarithm of the same factor at ∞, for lengths measured after `1/z`: `|a d − b c|/|c|²`.
    pub fn log_scale_at_infinity(&self) -> f64 {
        let [_, [c, _]] = self.matrix;
        norm(self.determinant()).ln() - 2.0 * norm(c).ln()
    }

    /// The image of a circle. Where the pole lies on the circle the image is a line, returned as a circle of infinite radius.
    ///
    /// With c p + d = s, the inside or the outside of the circle is mapped to a disk, whichever does not contain the pole. Its centre is
    /// `(s̄ (a p + b) − r² a c̄)/(|s|² − r² |c|²)`, its radius `r |a d − b c|/||s|² − r² |c|²|`.
    pub fn apply_to_circle(&self, circle: PlaneCircle) -> PlaneCircle {
        let [[a, b], [c, d]] = self.matrix;
        let PlaneCircle { centre: p, radius: r } = circle;
        let s = add(mul(c, p), d);
        // |s|² − r² |c|², as a product.
        let power = (norm(s) - r * norm(c)) * (norm(s) + r * norm(c));
        let top = sub(mul(conj(s), add(mul(a, p), b)), scale(r * r, mul(a, conj(c))));
        PlaneCircle { centre: top.map(|x| x / power), radius: r * norm(self.determinant()) / power.abs() }
    }
}

impl PlaneCircle {
    /// The transformation of the unit disk to itself that maps a circle inside it to one with centre 0.
    ///
    /// The ends of the diameter through 0 are mapped to opposite numbers: p is their hyperbolic midpoint.
    pub fn to_centre(&self) -> Mobius {
        let far = norm(self.centre);
        if far == 0.0 {
            return Mobius::IDENTITY;
        }
        let [low, high] = [far - self.radius, far + self.radius].map(f64::atanh);
        let at = (0.5 * (low + high)).tanh();
        Mobius::to_origin(self.centre.map(|x| x * at / far))
    }
}
