//! The trait of the numbers that motions and hinges are made of: f64 and double-double.

use super::DoubleDouble;
use super::complex::{Complex, Number};
use super::scaled::scaled;
use std::ops::Div;

/// The type of the entries of a [`super::Motion`] and of a [`super::flip::Hinge`]: f64, or [`super::DoubleDouble`].
pub trait Real: Number + From<f64> + Into<f64> + Div<Output = Self> {
    /// The square root of a number that is not negative.
    fn root(self) -> Self;
    /// This number times 2^k: exact while the result is a normal number.
    fn times_two_to(self, k: i32) -> Self;
    /// `a b + c d`, rounded once.
    fn two_products(a: Self, b: Self, c: Self, d: Self) -> Self;
}

impl Real for f64 {
    fn root(self) -> f64 {
        self.sqrt()
    }

    fn times_two_to(self, k: i32) -> f64 {
        scaled(self, k)
    }

    #[inline]
    fn two_products(a: f64, b: f64, c: f64, d: f64) -> f64 {
        a * b + c * d
    }
}

impl Real for DoubleDouble {
    fn root(self) -> DoubleDouble {
        self.sqrt()
    }

    fn times_two_to(self, k: i32) -> DoubleDouble {
        self.scaled(k)
    }

    #[inline]
    fn two_products(a: DoubleDouble, b: DoubleDouble, c: DoubleDouble, d: DoubleDouble) -> DoubleDouble {
        DoubleDouble::two_products(a, b, c, d)
    }
}

/// The product of complex numbers, like [`super::complex::mul`], with each part rounded once.
#[inline]
pub(super) fn product<T: Real>([a, b]: Complex<T>, [c, d]: Complex<T>) -> Complex<T> {
    [T::two_products(a, c, -b, d), T::two_products(a, d, b, c)]
}
