//! Formulas for one triangle, edge or vertex, or for several at a time in the vectors of the processor: the same operations in the same
//! order, so that each has the same bits either way.

use super::complex::Number;
use pulp::{Arch, Simd, WithSimd};
use std::ops::{Add, Div, Mul, Neg, RangeInclusive, Sub};

/// Triangles, edges or vertices that are worked on together: a multiple of the doubles in a vector of any processor.
const BLOCK: usize = 64;

/// A double, or several.
pub trait Lanes: Number + Div<Output = Self> {
    /// This number, as often as `self` has numbers.
    fn constant(self, x: f64) -> Self;
    /// The square root.
    fn root(self) -> Self;
    /// `then` where `self ≥ bound`, else `other`, also where one of them is no number.
    fn where_at_least(self, bound: Self, then: Self, other: Self) -> Self;
    /// What `product`, the rounded product with `other`, loses: exact where nothing over- or underflows.
    fn lost_of_product(self, other: Self, product: Self) -> Self;
    /// The entry of a table at this index, a whole number.
    fn look_up(self, table: &[[f64; 2]]) -> [Self; 2];

    /// `then` where `self` lies in a range, else 0, also where it is no number.
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

/// A double as the sum of two with half as many digits.
#[inline]
fn split(x: f64) -> [f64; 2] {
    let high = 134_217_729.0 * x;
    let high = high - (high - x);
    [high, x - high]
}

/// As many doubles as a vector of the processor holds.
#[derive(Clone, Copy)]
struct Wide<S: Simd> {
    simd: S,
    at: S::f64s,
}

impl<S: Simd> Wide<S> {
    #[inline(always)]
    fn new(simd: S, at: S::f64s) -> Wide<S> {
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

    #[inline(always)]
    fn lost_of_product(self, other: Wide<S>, product: Wide<S>) -> Wide<S> {
        self.by(self.simd.mul_add_f64s(self.at, other.at, self.simd.neg_f64s(product.at)))
    }

    #[inline(always)]
    fn look_up(self, table: &[[f64; 2]]) -> [Wide<S>; 2] {
        let [mut high, mut low] = [[0.0; BLOCK]; 2];
        S::as_mut_simd_f64s(&mut high).0[0] = self.at;
        for k in 0..S::F64_LANES {
            [high[k], low[k]] = table[high[k] as usize];
        }
        [self.by(S::as_simd_f64s(&high).0[0]), self.by(S::as_simd_f64s(&low).0[0])]
    }
}

/// A formula with `IN` numbers given and `OUT` found. What it calls must be `#[inline(always)]`, and a closure in it no longer than a line:
/// else the compiler makes calls of single operations on vectors.
pub(crate) trait Formula<const IN: usize, const OUT: usize>: Copy {
    fn of<L: Lanes>(self, given: [L; IN]) -> [L; OUT];
}

/// Work out a formula n times, several at a time: `given(i)` is given, and `take(i, found)` has what is found.
pub(crate) fn work_out<const IN: usize, const OUT: usize>(
    formula: impl Formula<IN, OUT>,
    n: usize,
    given: impl Fn(usize) -> [f64; IN],
    take: impl FnMut(usize, [f64; OUT]),
) {
    Arch::new().dispatch(Blocks { formula, n, given, take });
}

/// The work of [`work_out`].
struct Blocks<F, G, T, const IN: usize, const OUT: usize> {
    formula: F,
    n: usize,
    given: G,
    take: T,
}

impl<F, G, T, const IN: usize, const OUT: usize> WithSimd for Blocks<F, G, T, IN, OUT>
where
    F: Formula<IN, OUT>,
    G: Fn(usize) -> [f64; IN],
    T: FnMut(usize, [f64; OUT]),
{
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Blocks { formula, n, given, mut take } = self;
        // One row per number given, and one per number found. Places that a short last block leaves free keep older numbers, which nobody
        // reads.
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
                let mut given = [Wide::new(simd, simd.splat_f64s(0.0)); IN];
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
