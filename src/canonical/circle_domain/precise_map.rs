//! Möbius transformations of the plane in double-double precision.
//!
//! Seen from a vertex half way along a tube, the loops at its ends lie in clusters of size e^(−π m), m the modulus of the tube. Their
//! coordinates have lost that many digits in f64, and a transformation that spreads the cluster shows it.

use crate::geometry::complex::{Complex, add, conj, mul, neg, norm2, scale, sub};
use crate::geometry::mobius::PlaneCircle;
use crate::geometry::{DoubleDouble, Mobius};

/// A point of the plane in double-double precision.
pub(super) type PrecisePlanePoint = Complex<DoubleDouble>;

/// A circle in double-double precision.
#[derive(Debug, Clone, Copy)]
pub(super) struct PreciseCircle {
    pub centre: PrecisePlanePoint,
    pub radius: DoubleDouble,
}

impl PreciseCircle {
    pub fn rounded(&self) -> PlaneCircle {
        PlaneCircle { centre: rounded(self.centre), radius: self.radius.into() }
    }
}

/// A Möbius transformation, `z ↦ (a z + b)/(c z + d)`.
#[derive(Debug, Clone, Copy)]
pub(super) struct PreciseMap {
    matrix: [[PrecisePlanePoint; 2]; 2],
}

pub(super) fn rounded(z: PrecisePlanePoint) -> Complex {
    z.map(f64::from)
}

pub(super) fn precise(z: Complex) -> PrecisePlanePoint {
    z.map(DoubleDouble::from)
}

/// |z|; z is scaled, so that its square neither under- nor overflows.
pub(super) fn size(z: PrecisePlanePoint) -> DoubleDouble {
    let k = exponent(z);
    norm2(z.map(|x| x.scaled(-k))).sqrt().scaled(k)
}

/// The power of two just below the larger part of a number; 0 where it has none.
fn exponent(z: PrecisePlanePoint) -> i32 {
    let largest = z.iter().fold(0.0, |m: f64, x| m.max(x.high.abs()));
    if largest > 0.0 && largest.is_finite() { largest.log2().floor() as i32 } else { 0 }
}

/// z/w; w is scaled, so that its square neither under- nor overflows.
fn quotient(z: PrecisePlanePoint, w: PrecisePlanePoint) -> PrecisePlanePoint {
    let k = exponent(w);
    let unit = w.map(|x| x.scaled(-k));
    let square = norm2(unit);
    mul(z, conj(unit)).map(|x| (x / square).scaled(-k))
}

impl From<&Mobius> for PreciseMap {
    fn from(map: &Mobius) -> Self {
        PreciseMap { matrix: map.matrix.map(|row| row.map(precise)) }
    }
}

impl PreciseMap {
    /// The map that takes the outside of a circle to the inside of the unit circle: [`Mobius::outside`].
    pub fn outside(circle: PreciseCircle) -> PreciseMap {
        let [zero, one] = [0.0, 1.0].map(|x| precise([x, 0.0]));
        PreciseMap { matrix: [[zero, [circle.radius, 0.0.into()]], [one, neg(circle.centre)]] }
    }

    /// This map after another one.
    pub fn after(&self, first: &PreciseMap) -> PreciseMap {
        let ([[a, b], [c, d]], [[e, f], [g, h]]) = (self.matrix, first.matrix);
        let matrix = [
            [add(mul(a, e), mul(b, g)), add(mul(a, f), mul(b, h))],
            [add(mul(c, e), mul(d, g)), add(mul(c, f), mul(d, h))],
        ];
        let largest = matrix.as_flattened().iter().map(|&z| exponent(z)).max().unwrap_or(0);
        PreciseMap { matrix: matrix.map(|row| row.map(|z| z.map(|x| x.scaled(-largest)))) }
    }

    pub fn inverse(&self) -> PreciseMap {
        let [[a, b], [c, d]] = self.matrix;
        PreciseMap { matrix: [[d, neg(b)], [neg(c), a]] }
    }

    pub fn apply(&self, z: PrecisePlanePoint) -> PrecisePlanePoint {
        let [[a, b], [c, d]] = self.matrix;
        quotient(add(mul(a, z), b), add(mul(c, z), d))
    }

    pub fn at_infinity(&self) -> PrecisePlanePoint {
        let [[a, _], [c, _]] = self.matrix;
        quotient(a, c)
    }

    /// log of the factor by which lengths grow at z.
    pub fn log_scale(&self, z: PrecisePlanePoint) -> f64 {
        let [_, [c, d]] = self.matrix;
        self.log_determinant() - 2.0 * size(add(mul(c, z), d)).high.ln()
    }

    /// [`Mobius::log_scale_at_infinity`].
    pub fn log_scale_at_infinity(&self) -> f64 {
        let [_, [c, _]] = self.matrix;
        self.log_determinant() - 2.0 * size(c).high.ln()
    }

    fn determinant(&self) -> PrecisePlanePoint {
        let [[a, b], [c, d]] = self.matrix;
        sub(mul(a, d), mul(b, c))
    }

    fn log_determinant(&self) -> f64 {
        size(self.determinant()).high.ln()
    }

    /// The image of a circle that the pole is not on: [`Mobius::apply_to_circle`].
    pub fn apply_to_circle(&self, circle: PreciseCircle) -> PreciseCircle {
        let [[a, b], [c, d]] = self.matrix;
        let PreciseCircle { centre: p, radius: r } = circle;
        let s = add(mul(c, p), d);
        let (far, near) = (size(s), r * size(c));
        let power = (far - near) * (far + near);
        let top = sub(mul(conj(s), add(mul(a, p), b)), scale(r * r, mul(a, conj(c))));
        let turned = if power.high < 0.0 { -power } else { power };
        PreciseCircle { centre: top.map(|x| x / power), radius: r * size(self.determinant()) / turned }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clusters_far_below_the_rounding_of_f64_keep_their_shape() {
        // A circle of radius 1e-20 about 1 + 1e-19 i, moved to the origin and blown up.
        let small = DoubleDouble::from(1e-20);
        let centre = [DoubleDouble::from(1.0), small * 10.0.into()];
        let circle = PreciseCircle { centre, radius: small };
        let points = [[1.0, 0.0], [-0.6, 0.8], [0.0, -1.0]].map(|z| add(centre, scale(small, precise(z))));
        let map = PreciseMap::outside(PreciseCircle { centre: precise([1.0, 0.0]), radius: small });
        let image = map.apply_to_circle(circle);
        for z in points.map(|z| map.apply(z)) {
            let off = f64::from(size(sub(z, image.centre)) / image.radius) - 1.0;
            assert!(off.abs() < 1e-12, "{off:e}");
        }
        let back = map.inverse().after(&map).apply(points[1]);
        assert!(size(sub(back, points[1])).high < 1e-31);
    }
}
