//! The numbers that a factor is held in.

use std::ops::{Add, AddAssign, Div, DivAssign, Mul, Neg, Sub, SubAssign};

/// Doubles, or single precision: half the memory and half the time of a solution, for preconditioners.
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
    + sealed::Sealed
{
    /// 0.
    const ZERO: Self;

    /// The nearest one to a double.
    fn nearest(x: f64) -> Self;

    /// As a double, which has the same value.
    fn double(self) -> f64;
}

impl Number for f64 {
    const ZERO: f64 = 0.0;

    fn nearest(x: f64) -> f64 {
        x
    }

    fn double(self) -> f64 {
        self
    }
}

impl Number for f32 {
    const ZERO: f32 = 0.0;

    #[allow(clippy::cast_possible_truncation)]
    fn nearest(x: f64) -> f32 {
        x as f32
    }

    fn double(self) -> f64 {
        f64::from(self)
    }
}

mod sealed {
    /// No other numbers.
    pub trait Sealed {}
    impl Sealed for f64 {}
    impl Sealed for f32 {}
}
