//! Numbers with a bound of their error: a double-double centre and a radius, so that the number is certainly within the radius of the centre.
//!
//! ```
//! use ricci::geometry::Enclosure;
//! let third = Enclosure::from(1.0) / 3.0.into();
//! assert!(third.radius() < 1e-28 && third.lower() <= 1.0 / 3.0 && third.upper() >= 1.0 / 3.0);
//! ```

use super::DoubleDouble;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A real number that is known to lie within `radius` of a double-double `centre`. Every operation returns an enclosure that contains the exact
/// result for all numbers of its arguments; where there is none, as for a quotient by an enclosure around 0, the radius is infinite.
///
/// Sums and products of double-double numbers have a relative error of at most 7·2^−106 while nothing under- or overflows \[JMP17\]; quotients
/// and square roots are an f64 and the f64 quotient of an exact remainder, which leaves at most 12·2^−106. [`Enclosure::ROUNDING`] is 64·2^−106.
/// Numbers between 1e-140 and 1e140 in size, and 0, are safe.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Enclosure {
    centre: DoubleDouble,
    radius: f64,
}

/// Factor that covers the rounding of the few f64 operations by which a radius is formed.
const OUTWARD: f64 = 1.0 + 1e-12;

impl Enclosure {
    /// Bound of the relative error of one operation on double-double numbers: 2^−100.
    pub const ROUNDING: f64 = 7.888_609_052_210_118e-31;

    /// The enclosure around a number with this radius (at least 0).
    pub fn new(centre: DoubleDouble, radius: f64) -> Enclosure {
        Enclosure { centre, radius }
    }

    /// The centre.
    pub fn centre(self) -> DoubleDouble {
        self.centre
    }

    /// The radius: infinite or NaN where nothing is known.
    pub fn radius(self) -> f64 {
        self.radius
    }

    /// The f64 nearest to the centre.
    pub fn nearest(self) -> f64 {
        self.centre.high
    }

    /// An f64 that is not below any number of the enclosure.
    pub fn upper(self) -> f64 {
        (self.centre.high + (self.centre.low + self.radius * OUTWARD).next_up()).next_up()
    }

    /// An f64 that is not above any number of the enclosure.
    pub fn lower(self) -> f64 {
        -(-self).upper()
    }

    /// True if every number of the enclosure is greater than 0.
    pub fn is_positive(self) -> bool {
        self.lower() > 0.0
    }

    /// The product with ±2^k, which is exact.
    pub fn times_power(self, power: f64) -> Enclosure {
        let DoubleDouble { high, low } = self.centre;
        Enclosure {
            centre: DoubleDouble { high: high * power, low: low * power },
            radius: self.radius * power.abs(),
        }
    }

    /// The square root of an enclosure of positive numbers.
    pub fn sqrt(self) -> Enclosure {
        if !self.is_positive() {
            return Enclosure { centre: self.centre.sqrt(), radius: f64::INFINITY };
        }
        // |√x − √c| = |x − c|/(√x + √c) is at most |x − c|/√c.
        let centre = self.centre.sqrt();
        Enclosure { centre, radius: outward(self.radius / centre.high, centre) }
    }

    fn size(self) -> f64 {
        self.centre.high.abs()
    }
}

/// A radius that covers a propagated error and the rounding of the new centre.
fn outward(propagated: f64, centre: DoubleDouble) -> f64 {
    (propagated + centre.high.abs() * Enclosure::ROUNDING) * OUTWARD
}

impl From<f64> for Enclosure {
    fn from(x: f64) -> Enclosure {
        Enclosure { centre: x.into(), radius: 0.0 }
    }
}

impl Neg for Enclosure {
    type Output = Enclosure;
    fn neg(self) -> Enclosure {
        Enclosure { centre: -self.centre, ..self }
    }
}

impl Add for Enclosure {
    type Output = Enclosure;
    fn add(self, other: Enclosure) -> Enclosure {
        let centre = self.centre + other.centre;
        Enclosure { centre, radius: outward(self.radius + other.radius, centre) }
    }
}

impl Sub for Enclosure {
    type Output = Enclosure;
    fn sub(self, other: Enclosure) -> Enclosure {
        self + -other
    }
}

impl Mul for Enclosure {
    type Output = Enclosure;
    fn mul(self, other: Enclosure) -> Enclosure {
        let centre = self.centre * other.centre;
        let spread = self.size() * other.radius + self.radius * (other.size() + other.radius);
        Enclosure { centre, radius: outward(spread, centre) }
    }
}

impl Div for Enclosure {
    type Output = Enclosure;
    fn div(self, other: Enclosure) -> Enclosure {
        let centre = self.centre / other.centre;
        // x/y − c/d = ((x − c) − (c/d)(y − d))/y.
        let least = (other.size() - other.radius) / OUTWARD;
        if least.is_nan() || least <= 0.0 {
            return Enclosure { centre, radius: f64::INFINITY };
        }
        let spread = (self.radius + centre.high.abs() * OUTWARD * other.radius) / least;
        Enclosure { centre, radius: outward(spread, centre) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The square of the root of every n, and (a/b) b = a, contain the integers they stand for and hardly more.
    #[test]
    fn enclosures_contain_the_exact_results() {
        for n in 1..500 {
            let (n, third) = (f64::from(n), Enclosure::from(1.0) / 3.0.into());
            let root = Enclosure::from(n).sqrt();
            for x in [root * root, Enclosure::from(n) / 7.0.into() * 7.0.into(), third * (n * 3.0).into()] {
                let off = x - n.into();
                assert!(off.lower() <= 0.0 && off.upper() >= 0.0, "{n}: {x:?}");
                assert!(x.radius() < 1e-28 * n && x.radius() > 0.0, "{n}: {x:?}");
            }
        }
    }

    #[test]
    fn radii_are_carried_through_operations() {
        let wide = |centre: f64, radius: f64| Enclosure::new(centre.into(), radius);
        let (x, y) = (wide(2.0, 0.5), wide(3.0, 1.0));
        for (enclosure, least, most) in [
            (x + y, 3.5, 6.5),
            (x - y, -2.5, 0.5),
            (x * y, 3.0, 10.0),
            (x / y, 0.375, 1.25),
            (x.sqrt(), 1.5f64.sqrt(), 2.5f64.sqrt()),
        ] {
            assert!(enclosure.lower() <= least && enclosure.upper() >= most, "{enclosure:?} {least} {most}");
        }
        assert!((x / wide(0.5, 0.5)).radius().is_infinite() && wide(0.5, 0.5).sqrt().radius().is_infinite());
        assert!(!wide(1.0, f64::NAN).is_positive());
    }
}
