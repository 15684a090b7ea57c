//! Formulas for one triangle, or for several at a time in the vectors of the processor: the same operations in the same order, so that a
//! triangle has the same bits either way.

use super::complex::Number;
use pulp::Simd;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A double, or several.
pub trait Lanes: Number + Div<Output = Self> {
    /// This number, as often as `self` has numbers.
    fn constant(self, x: f64) -> Self;
    /// The square root.
    fn root(self) -> Self;
    /// `then` where `self ≥ bound`, else `other`, also where one of them is no number.
    fn where_at_least(self, bound: Self, then: Self, other: Self) -> Self;

    /// The larger one of two numbers.
    #[inline(always)]
    fn larger(self, other: Self) -> Self {
        self.where_at_least(other, self, other)
    }

    /// The smaller one of two numbers.
    #[inline(always)]
    fn smaller(self, other: Self) -> Self {
        self.where_at_least(other, other, self)
    }
}

impl Lanes for f64 {
    #[inline(always)]
    fn constant(self, x: f64) -> f64 {
        x
    }

    #[inline(always)]
    fn root(self) -> f64 {
        self.sqrt()
    }

    #[inline(always)]
    fn where_at_least(self, bound: f64, then: f64, other: f64) -> f64 {
        if self >= bound { then } else { other }
    }
}

/// As many doubles as a vector of the processor holds.
#[derive(Clone, Copy)]
pub(crate) struct Wide<S: Simd> {
    simd: S,
    pub at: S::f64s,
}

impl<S: Simd> Wide<S> {
    #[inline(always)]
    pub fn new(simd: S, at: S::f64s) -> Wide<S> {
        Wide { simd, at }
    }

    #[inline(always)]
    fn by(self, at: S::f64s) -> Wide<S> {
        Wide { at, ..self }
    }
}

impl<S: Simd> Add for Wide<S> {
    type Output = Wide<S>;
    #[inline(always)]
    fn add(self, other: Wide<S>) -> Wide<S> {
        self.by(self.simd.add_f64s(self.at, other.at))
    }
}

impl<S: Simd> Sub for Wide<S> {
    type Output = Wide<S>;
    #[inline(always)]
    fn sub(self, other: Wide<S>) -> Wide<S> {
        self.by(self.simd.sub_f64s(self.at, other.at))
    }
}

impl<S: Simd> Mul for Wide<S> {
    type Output = Wide<S>;
    #[inline(always)]
    fn mul(self, other: Wide<S>) -> Wide<S> {
        self.by(self.simd.mul_f64s(self.at, other.at))
    }
}

impl<S: Simd> Div for Wide<S> {
    type Output = Wide<S>;
    #[inline(always)]
    fn div(self, other: Wide<S>) -> Wide<S> {
        self.by(self.simd.div_f64s(self.at, other.at))
    }
}

impl<S: Simd> Neg for Wide<S> {
    type Output = Wide<S>;
    #[inline(always)]
    fn neg(self) -> Wide<S> {
        self.by(self.simd.neg_f64s(self.at))
    }
}

impl<S: Simd> Lanes for Wide<S> {
    #[inline(always)]
    fn constant(self, x: f64) -> Wide<S> {
        self.by(self.simd.splat_f64s(x))
    }

    #[inline(always)]
    fn root(self) -> Wide<S> {
        self.by(self.simd.sqrt_f64s(self.at))
    }

    #[inline(always)]
    fn where_at_least(self, bound: Wide<S>, then: Wide<S>, other: Wide<S>) -> Wide<S> {
        let mask = self.simd.greater_than_or_equal_f64s(self.at, bound.at);
        self.by(self.simd.select_f64s(mask, then.at, other.at))
    }
}
