//! The numbers that a factor is held in.

use faer::traits::ComplexField;
use pulp::Simd;
use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

/// Doubles, or single precision: half the memory and little more than half the time, for preconditioners.
pub trait Number:
    Copy
    + Default
    + Send
    + Sync
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
    + DivAssign
    + MulAssign
    + PartialOrd
    + ComplexField
    + vectors::Vectors
{
    /// 0.
    const ZERO: Self;

    /// 1.
    const ONE: Self;

    /// The nearest one to a double.
    fn nearest(x: f64) -> Self;

    /// As a double, which has the same value.
    fn double(self) -> f64;

    /// The square root.
    fn root(self) -> Self;
}

impl Number for f64 {
    const ZERO: f64 = 0.0;
    const ONE: f64 = 1.0;

    fn nearest(x: f64) -> f64 {
        x
    }

    fn double(self) -> f64 {
        self
    }

    fn root(self) -> f64 {
        self.sqrt()
    }
}

impl Number for f32 {
    const ZERO: f32 = 0.0;
    const ONE: f32 = 1.0;

    #[allow(clippy::cast_possible_truncation)]
    fn nearest(x: f64) -> f32 {
        x as f32
    }

    fn double(self) -> f64 {
        f64::from(self)
    }

    fn root(self) -> f32 {
        self.sqrt()
    }
}

mod vectors {
    use super::Simd;

    /// Several numbers at a time, in the vectors of the processor. No other numbers than those here have them.
    pub trait Vectors: Sized {
        type Vector<S: Simd>: Copy;

        /// As vectors, and what is left.
        fn vectors<S: Simd>(simd: S, x: &[Self]) -> (&[Self::Vector<S>], &[Self]);

        /// [`Vectors::vectors`] to write to.
        fn vectors_mut<S: Simd>(simd: S, x: &mut [Self]) -> (&mut [Self::Vector<S>], &mut [Self]);

        /// Fewer numbers than a vector has; 0 after them.
        fn some<S: Simd>(simd: S, x: &[Self]) -> Self::Vector<S>;

        /// The first numbers of a vector.
        fn store_some<S: Simd>(simd: S, x: Self::Vector<S>, out: &mut [Self]);

        /// The same number everywhere.
        fn everywhere<S: Simd>(simd: S, x: Self) -> Self::Vector<S>;

        /// `a b + c`, rounded once where the processor does so.
        fn multiply_add<S: Simd>(
            simd: S,
            a: Self::Vector<S>,
            b: Self::Vector<S>,
            c: Self::Vector<S>,
        ) -> Self::Vector<S>;

        /// The sum of the numbers of a vector.
        fn sum<S: Simd>(simd: S, x: Self::Vector<S>) -> Self;
    }

    macro_rules! vectors {
        ($number:ty, $vector:ident, $vectors:ident, $vectors_mut:ident, $some:ident, $store:ident, $splat:ident, $fma:ident, $sum:ident) => {
            impl Vectors for $number {
                type Vector<S: Simd> = S::$vector;

                #[inline(always)]
                fn vectors<S: Simd>(_: S, x: &[Self]) -> (&[Self::Vector<S>], &[Self]) {
                    S::$vectors(x)
                }

                #[inline(always)]
                fn vectors_mut<S: Simd>(_: S, x: &mut [Self]) -> (&mut [Self::Vector<S>], &mut [Self]) {
                    S::$vectors_mut(x)
                }

                #[inline(always)]
                fn some<S: Simd>(simd: S, x: &[Self]) -> Self::Vector<S> {
                    simd.$some(x)
                }

                #[inline(always)]
                fn store_some<S: Simd>(simd: S, x: Self::Vector<S>, out: &mut [Self]) {
                    simd.$store(out, x);
                }

                #[inline(always)]
                fn everywhere<S: Simd>(simd: S, x: Self) -> Self::Vector<S> {
                    simd.$splat(x)
                }

                #[inline(always)]
                fn multiply_add<S: Simd>(
                    simd: S,
                    a: Self::Vector<S>,
                    b: Self::Vector<S>,
                    c: Self::Vector<S>,
                ) -> Self::Vector<S> {
                    simd.$fma(a, b, c)
                }

                #[inline(always)]
                fn sum<S: Simd>(simd: S, x: Self::Vector<S>) -> Self {
                    simd.$sum(x)
                }
            }
        };
    }
    vectors!(
        f64,
        f64s,
        as_simd_f64s,
        as_mut_simd_f64s,
        partial_load_f64s,
        partial_store_f64s,
        splat_f64s,
        mul_add_e_f64s,
        reduce_sum_f64s
    );
    vectors!(
        f32,
        f32s,
        as_simd_f32s,
        as_mut_simd_f32s,
        partial_load_f32s,
        partial_store_f32s,
        splat_f32s,
        mul_add_e_f32s,
        reduce_sum_f32s
    );
}
