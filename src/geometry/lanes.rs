//! Formulas for one triangle, edge or vertex, or for several at a time in SIMD vectors: the same operations in the same order, so that
//! both give the same bits.

use super::complex::Number;
use pulp::{Arch, Simd, WithSimd};
use std::ops::{Add, Div, Mul, Neg, RangeInclusive, Sub};

/// Number of triangles, edges or vertices that are computed together: a multiple of the f64 in a vector of any processor.
const BLOCK: usize = 64;

/// An f64, or a vector of several.
pub trait Lanes: Number + Div<Output = Self> {
    /// A vector of the length of `self` whose entries are all `x`.
    fn constant(self, x: f64) -> Self;
    /// The square root.
    fn root(self) -> Self;
    /// `then` where `self ≥ bound`, else `other`, also where one of the two is NaN.
    fn where_at_least(self, bound: Self, then: Self, other: Self) -> Self;
    /// The rounding error of `product`, the rounded product with `other`: exact where nothing over- or underflows.
    fn lost_of_product(self, other: Self, product: Self) -> Self;
    /// The entries of a table at these indices, which are whole numbers.
    fn look_up(self, table: &[[f64; 2]]) -> [Self; 2];

    /// `then` where `self` lies in a range, else 0, also where it is NaN.
    #[inline(always)]
    fn where_within(self, range: &RangeInclusive<f64>, then: Self) -> Self {
        let [least, most] = [self.constant(*range.start()), self.constant(*range.end())];
        let zero = self.constant(0.0);
        self.where_at_least(least, most.where_at_least(self, then, zero), zero)
    }

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

    /// By Dekker's splitting.
    #[inline]
    fn lost_of_product(self, other: f64, product: f64) -> f64 {
        let ([a, a_low], [b, b_low]) = (split(self), split(other));
        ((a * b - product) + a * b_low + a_low * b) + a_low * b_low
    }

    #[inline(always)]
    fn look_up(self, table: &[[f64; 2]]) -> [f64; 2] {
        table[self as usize]
    }
}

/// An f64 as the sum of two with half as many digits.
#[inline]
fn split(x: f64) -> [f64; 2] {
    let high = 134_217_729.0 * x;
    let high = high - (high - x);
    [high, x - high]
}

/// A SIMD vector of f64, as long as the processor has.
#[derive(Clone, Copy)]
struct SimdNumbers<S: Simd> {
    simd: S,
    at: S::f64s,
}

impl<S: Simd> SimdNumbers<S> {
    #[inline(always)]
    fn new(simd: S, at: S::f64s) -> SimdNumbers<S> {
        SimdNumbers { simd, at }
    }

    #[inline(always)]
    fn by(self, at: S::f64s) -> SimdNumbers<S> {
        SimdNumbers { at, ..self }
    }
}

impl<S: Simd> Add for SimdNumbers<S> {
    type Output = SimdNumbers<S>;
    #[inline(always)]
    fn add(self, other: SimdNumbers<S>) -> SimdNumbers<S> {
        self.by(self.simd.add_f64s(self.at, other.at))
    }
}

impl<S: Simd> Sub for SimdNumbers<S> {
    type Output = SimdNumbers<S>;
    #[inline(always)]
    fn sub(self, other: SimdNumbers<S>) -> SimdNumbers<S> {
        self.by(self.simd.sub_f64s(self.at, other.at))
    }
}

impl<S: Simd> Mul for SimdNumbers<S> {
    type Output = SimdNumbers<S>;
    #[inline(always)]
    fn mul(self, other: SimdNumbers<S>) -> SimdNumbers<S> {
        self.by(self.simd.mul_f64s(self.at, other.at))
    }
}

impl<S: Simd> Div for SimdNumbers<S> {
    type Output = SimdNumbers<S>;
    #[inline(always)]
    fn div(self, other: SimdNumbers<S>) -> SimdNumbers<S> {
        self.by(self.simd.div_f64s(self.at, other.at))
    }
}

impl<S: Simd> Neg for SimdNumbers<S> {
    type Output = SimdNumbers<S>;
    #[inline(always)]
    fn neg(self) -> SimdNumbers<S> {
        self.by(self.simd.neg_f64s(self.at))
    }
}

impl<S: Simd> Lanes for SimdNumbers<S> {
    #[inline(always)]
    fn constant(self, x: f64) -> SimdNumbers<S> {
        self.by(self.simd.splat_f64s(x))
    }

    #[inline(always)]
    fn root(self) -> SimdNumbers<S> {
        self.by(self.simd.sqrt_f64s(self.at))
    }

    #[inline(always)]
    fn where_at_least(
        self,
        bound: SimdNumbers<S>,
        then: SimdNumbers<S>,
        other: SimdNumbers<S>,
    ) -> SimdNumbers<S> {
        let mask = self.simd.greater_than_or_equal_f64s(self.at, bound.at);
        self.by(self.simd.select_f64s(mask, then.at, other.at))
    }

    #[inline(always)]
    fn lost_of_product(self, other: SimdNumbers<S>, product: SimdNumbers<S>) -> SimdNumbers<S> {
        self.by(self.simd.mul_add_f64s(self.at, other.at, self.simd.neg_f64s(product.at)))
    }

    #[inline(always)]
    fn look_up(self, table: &[[f64; 2]]) -> [SimdNumbers<S>; 2] {
        let [mut high, mut low] = [[0.0; BLOCK]; 2];
        S::as_mut_simd_f64s(&mut high).0[0] = self.at;
        for k in 0..S::F64_LANES {
            [high[k], low[k]] = table[high[k] as usize];
        }
        [self.by(S::as_simd_f64s(&high).0[0]), self.by(S::as_simd_f64s(&low).0[0])]
    }
}

/// A formula from `IN` numbers to `OUT` numbers. Functions that it calls must be `#[inline(always)]`, and closures in it no longer than a
/// line; otherwise the compiler emits calls for single operations on vectors.
pub(crate) trait Formula<const IN: usize, const OUT: usize>: Copy {
    fn of<L: Lanes>(self, given: [L; IN]) -> [L; OUT];
}

/// Evaluates a formula n times, several at a time: `given(i)` returns its arguments, and `take(i, found)` receives its results.
pub(crate) fn work_out<const IN: usize, const OUT: usize>(
    formula: impl Formula<IN, OUT>,
    n: usize,
    given: impl Fn(usize) -> [f64; IN],
    take: impl FnMut(usize, [f64; OUT]),
) {
    Arch::new().dispatch(BlockLoop { formula, n, given, take });
}

/// The loop of [`work_out`], which pulp compiles for each instruction set.
struct BlockLoop<F, G, T, const IN: usize, const OUT: usize> {
    formula: F,
    n: usize,
    given: G,
    take: T,
}

impl<F, G, T, const IN: usize, const OUT: usize> WithSimd for BlockLoop<F, G, T, IN, OUT>
where
    F: Formula<IN, OUT>,
    G: Fn(usize) -> [f64; IN],
    T: FnMut(usize, [f64; OUT]),
{
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let BlockLoop { formula, n, given, mut take } = self;
        // One row per argument and one per result. The entries that a short last block leaves free keep older numbers, which are not
        // read.
        let (mut from, mut to) = ([[1.0; BLOCK]; IN], [[0.0; BLOCK]; OUT]);
        for start in (0..n).step_by(BLOCK) {
            let count = BLOCK.min(n - start);
            for i in 0..count {
                let given = given(start + i);
                for k in 0..IN {
                    from[k][i] = given[k];
                }
            }
            for i in 0..count.div_ceil(S::F64_LANES) {
                let mut given = [SimdNumbers::new(simd, simd.splat_f64s(0.0)); IN];
                for k in 0..IN {
                    given[k].at = S::as_simd_f64s(&from[k]).0[i];
                }
                let found = formula.of(given);
                for k in 0..OUT {
                    S::as_mut_simd_f64s(&mut to[k]).0[i] = found[k].at;
                }
            }
            for i in 0..count {
                let mut found = [0.0; OUT];
                for k in 0..OUT {
                    found[k] = to[k][i];
                }
                take(start + i, found);
            }
        }
    }
}
