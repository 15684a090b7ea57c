//! The largest of many errors, where NaN counts as infinite. [`f64::max`] ignores NaN, and would hide an error that could not be
//! computed.
//!
//! ```
//! use ricci::geometry::largest;
//! assert_eq!(largest(&[1.0, -3.0]), 3.0);
//! assert_eq!(largest(&[1.0, f64::NAN]), f64::INFINITY);
//! ```

/// The larger of two numbers; ∞ where one is NaN.
pub fn worse(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() { f64::INFINITY } else { a.max(b) }
}

/// The largest absolute value, 0 without values; ∞ where one is NaN.
pub fn largest<'a>(values: impl IntoIterator<Item = &'a f64>) -> f64 {
    values.into_iter().fold(0.0, |worst, x| worse(worst, x.abs()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_nan_is_worst_of_all_wherever_it_stands() {
        assert_eq!(largest(&[1.0, -3.0, 2.0]), 3.0);
        assert_eq!(largest(&[]), 0.0);
        let empty = f64::NAN;
        for values in [[empty, 1.0, 2.0], [1.0, empty, 2.0], [1.0, 2.0, -empty], [empty; 3]] {
            assert_eq!(largest(&values), f64::INFINITY);
        }
        assert_eq!([-2.0, -5.0].into_iter().fold(f64::NEG_INFINITY, worse), -2.0);
        assert_eq!([empty, -5.0].into_iter().fold(f64::NEG_INFINITY, worse), f64::INFINITY);
    }
}
