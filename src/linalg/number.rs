//! The types of the numbers of a factor: f64 and f32.

use faer::traits::ComplexField;
use pulp::Simd;
use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

/// The type of the numbers of a factor: f64, or f32 for preconditioners, with half the memory and little more than half the time.
pub trait FactorNumber:
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

    /// The nearest number to an f64.
    fn nearest(x: f64) -> Self;

    /// The same number as an f64.
    fn to_f64(self) -> f64;

    /// The square root.
    fn root(self) -> Self;
}

impl FactorNumber for f64 {
    const ZERO: f64 = 0.0;
    const ONE: f64 = 1.0;

    fn nearest(x: f64) -> f64 {
        x
    }

    fn to_f64(self) -> f64 {
        self
    }

    fn root(self) -> f64 {
        self.sqrt()
    }
}

impl FactorNumber for f32 {
    const ZERO: f32 = 0.0;
    const ONE: f32 = 1.0;

    #[allow(clippy::cast_possible_truncation)]
    fn nearest(x: f64) -> f32 {
        x as f32
    }

    fn to_f64(self) -> f64 {
        f64::from(self)
    }

    fn root(self) -> f32 {
        self.sqrt()
    }
}

mod vectors {
    use super::Simd;

    /// SIMD vectors of a type of numbers. The trait is private, so that f64 and f32 are the only types that implement it.
    pub trait Vectors: Sized {
        type Vector<S: Simd>: Copy;

        /// A slice as vectors, and the rest.
        fn vectors<S: Simd>(simd: S, x: &[Self]) -> (&[Self::Vector<S>], &[Self]);

        /// [`Vectors::vectors`] to write to.
        fn vectors_mut<S: Simd>(simd: S, x: &mut [Self]) -> (&mut [Self::Vector<S>], &mut [Self]);

        /// Fewer numbers than a vector has, followed by 0.
        fn load_partial<S: Simd>(simd: S, x: &[Self]) -> Self::Vector<S>;

        /// Writes the first numbers of a vector to `out`.
        fn store_partial<S: Simd>(simd: S, x: Self::Vector<S>, out: &mut [Self]);

        /// A vector all of whose numbers are x.
        fn splat<S: Simd>(simd: S, x: Self) -> Self::Vector<S>;

        /// `a b + c`, with one rounding where the processor has such an instruction.
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
                fn load_partial<S: Simd>(simd: S, x: &[Self]) -> Self::Vector<S> {
                    simd.$some(x)
                }

                #[inline(always)]
                fn store_partial<S: Simd>(simd: S, x: Self::Vector<S>, out: &mut [Self]) {
                    simd.$store(out, x);
                }

                #[inline(always)]
                fn splat<S: Simd>(simd: S, x: Self) -> Self::Vector<S> {
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
