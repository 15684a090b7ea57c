//! Formatting of numbers in text files.

use std::fmt::{Display, Formatter, Result};

/// A finite number, displayed with the fewest digits that read back to the same number.
pub(super) struct Shortest(pub f64);

impl Display for Shortest {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        f.write_str(zmij::Buffer::new().format_finite(self.0))
    }
}

#[cfg(test)]
mod tests {
    use super::Shortest;

    #[test]
    fn numbers_read_back_to_the_same_double_and_are_no_longer_than_needed() {
        let mut bits = 1u64;
        for _ in 0..20_000 {
            bits = bits.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let x = f64::from_bits(bits);
            if x.is_finite() {
                let text = Shortest(x).to_string();
                assert_eq!(text.parse::<f64>().map(f64::to_bits), Ok(bits));
                let digits = |text: &str| {
                    let number = text.split('e').next().unwrap_or_default().replace(['.', '-'], "");
                    number.trim_start_matches('0').trim_end_matches('0').len()
                };
                assert_eq!(digits(&text), digits(&format!("{x:e}")), "{text}");
            }
        }
        assert_eq!(
            [0.1, -0.0, 1e-7, 1e300].map(|x| Shortest(x).to_string()),
            ["0.1", "-0.0", "1e-7", "1e+300"]
        );
    }
}
