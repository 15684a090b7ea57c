//! Points and vectors of the plane, which are also complex numbers: `[x, y]` is x + iy.
//!
//! They are plain arrays like all positions and coordinates of the library, of f64 or of another [`Number`] such as
//! [`super::DoubleDouble`].
//!
//! ```
//! use ricci::geometry::complex::{conj, cross, mul, unit};
//! let i = [0.0, 1.0];
//! assert_eq!(mul(i, [3.0, 4.0]), [-4.0, 3.0]); // a quarter turn, counterclockwise
//! assert_eq!(mul(i, conj(i)), [1.0, 0.0]);
//! assert_eq!(unit([3.0, 4.0]), [0.6, 0.8]);
//! assert_eq!(cross([1.0, 0.0], i), 1.0); // positive: i lies counterclockwise of 1
//! ```

use std::ops::{Add, Mul, Neg, Sub};

/// A complex number, a point or a vector of the plane: `[Re, Im]`.
pub type Complex<T = f64> = [T; 2];

/// The type of real and imaginary parts: any type with addition, subtraction, multiplication and negation.
pub trait Number:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Neg<Output = Self>
{
}

impl<T> Number for T where
    T: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Neg<Output = Self>
{
}

/// `z + w`.
pub fn add<T: Number>([a, b]: Complex<T>, [c, d]: Complex<T>) -> Complex<T> {
    [a + c, b + d]
}

/// `z − w`: the vector from `w` to `z`.
pub fn sub<T: Number>([a, b]: Complex<T>, [c, d]: Complex<T>) -> Complex<T> {
    [a - c, b - d]
}

/// `−z`.
pub fn neg<T: Number>([a, b]: Complex<T>) -> Complex<T> {
    [-a, -b]
}

/// `s z` for a real number `s`.
pub fn scale<T: Number>(s: T, [a, b]: Complex<T>) -> Complex<T> {
    [s * a, s * b]
}

/// The product `z w` of complex numbers: with a unit `w`, `z` rotated by the angle of `w`.
pub fn mul<T: Number>([a, b]: Complex<T>, [c, d]: Complex<T>) -> Complex<T> {
    [a * c - b * d, a * d + b * c]
}

/// The complex conjugate `z̄`.
pub fn conj<T: Number>([a, b]: Complex<T>) -> Complex<T> {
    [a, -b]
}

/// The inner product of two vectors, `Re z w̄`.
pub fn dot<T: Number>([a, b]: Complex<T>, [c, d]: Complex<T>) -> T {
    a * c + b * d
}

/// The signed area of the parallelogram of two vectors, `Im z̄ w`: positive if `w` lies counterclockwise of `z`.
pub fn cross<T: Number>([a, b]: Complex<T>, [c, d]: Complex<T>) -> T {
    a * d - b * c
}

/// The squared length `|z|²`.
pub fn norm2<T: Number>(z: Complex<T>) -> T {
    dot(z, z)
}

/// Twice the signed area of a triangle: positive if its corners run counterclockwise.
pub fn doubled_area<T: Number>([a, b, c]: [Complex<T>; 3]) -> T {
    cross(sub(b, a), sub(c, a))
}

/// The length `|z|`, without overflow on the way.
pub fn norm([a, b]: Complex) -> f64 {
    a.hypot(b)
}

/// Range of squares that lost nothing to under- or overflow.
const SURE_SQUARES: [f64; 2] = [1e-280, 1e280];

/// [`norm`] with an error of at most two roundings, at a third of the cost.
#[inline]
pub(crate) fn quick_norm(z: Complex) -> f64 {
    let square = norm2(z);
    if square > SURE_SQUARES[0] && square < SURE_SQUARES[1] { square.sqrt() } else { norm(z) }
}

/// The distance of two points.
pub fn distance(z: Complex, w: Complex) -> f64 {
    norm(sub(z, w))
}

/// The number of length 1 in the direction of `z`; NaN for 0.
pub fn unit(z: Complex) -> Complex {
    let length = norm(z);
    z.map(|x| x / length)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::DoubleDouble;
    use num_complex::Complex64;

    /// Compares with an independent implementation of complex numbers, on points whose products are exact in f64.
    #[test]
    fn products_are_those_of_complex_numbers() {
        let numbers = [[3.0, -1.5], [-0.25, 7.0], [0.0, 2.0]];
        for (z, w) in numbers.iter().flat_map(|&z| numbers.map(|w| (z, w))) {
            let [p, q] = [z, w].map(|[re, im]| Complex64::new(re, im));
            let same = |got: Complex, expected: Complex64| assert_eq!(got, [expected.re, expected.im]);
            same(mul(z, w), p * q);
            same(conj(z), p.conj());
            same([dot(z, w), -cross(z, w)], p * q.conj());
            same(add(z, neg(w)), p - q);
            same(sub(z, w), p - q);
            same(scale(0.5, z), 0.5 * p);
            assert_eq!((norm2(z), norm(z)), (p.norm_sqr(), p.norm()));
            assert_eq!(mul(z.map(DoubleDouble::from), w.map(DoubleDouble::from)).map(f64::from), mul(z, w));
        }
        assert_eq!(doubled_area([[1.0, 1.0], [4.0, 1.0], [1.0, 3.0]]), 6.0);
        assert_eq!(distance([1.0, 1.0], [4.0, 5.0]), 5.0);
    }
}
