//! Text made of many numbers, formatted in blocks side by side.
//!
//! ```
//! use ricci::mesh::io::text::{Text, write_blocks};
//! let mut file = Vec::new();
//! write_blocks(&mut file, 3, |text, k| {
//!     text.count(k as u64);
//!     text.text(" ");
//!     text.number(0.1);
//!     text.text("\n");
//! })?;
//! assert_eq!(file, b"0 0.1\n1 0.1\n2 0.1\n");
//! # Ok::<(), std::io::Error>(())
//! ```

use crate::parallel;
use std::io::{self, Write};

/// Items that are formatted in one piece of work.
const ITEMS: usize = 4096;
/// Blocks that are held before they are written: what is in memory at a time.
const BLOCKS: usize = 16;
/// Bytes for which a block has room at first; most items have up to three numbers.
const BYTES_PER_ITEM: usize = 64;
/// Most digits of a whole number.
const MOST_DIGITS: usize = 20;

/// Text in the making.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Text {
    bytes: Vec<u8>,
}

impl Text {
    /// Append words.
    #[inline]
    pub fn text(&mut self, words: &str) {
        self.bytes.extend_from_slice(words.as_bytes());
    }

    /// Append a finite number with the fewest digits that read back to the same double.
    #[inline]
    pub fn number(&mut self, x: f64) {
        self.text(zmij::Buffer::new().format_finite(x));
    }

    /// Append a whole number.
    #[inline]
    pub fn count(&mut self, mut n: u64) {
        let mut digits = [0; MOST_DIGITS];
        let mut at = MOST_DIGITS;
        loop {
            at -= 1;
            digits[at] = b'0' + (n % 10) as u8;
            n /= 10;
            if n == 0 {
                break;
            }
        }
        self.bytes.extend_from_slice(&digits[at..]);
    }

    /// What there is so far.
    pub fn as_bytes(&self) -> &[u8] {
        &self.bytes
    }
}

/// What is formatted by `format!` and its like is appended.
impl std::fmt::Write for Text {
    fn write_str(&mut self, words: &str) -> std::fmt::Result {
        self.text(words);
        Ok(())
    }
}

/// Writes the text of items 0 to n − 1, one after the other. Inside a pool they are formatted side by side.
///
/// # Errors
/// Those of writing.
pub fn write_blocks(
    out: &mut impl Write,
    n: usize,
    item: impl Fn(&mut Text, usize) + Sync,
) -> io::Result<()> {
    let block = |b: usize| {
        let items = b * ITEMS..((b + 1) * ITEMS).min(n);
        // A file is seldom what others wait for.
        parallel::give_way();
        let mut text = Text { bytes: Vec::with_capacity(BYTES_PER_ITEM * items.len()) };
        items.for_each(|k| item(&mut text, k));
        text
    };
    let all = n.div_ceil(ITEMS);
    for first in (0..all).step_by(BLOCKS) {
        let texts = parallel::map(BLOCKS.min(all - first), |b| block(first + b));
        texts.iter().try_for_each(|text| out.write_all(&text.bytes))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parallel::Pool;

    #[test]
    fn whole_numbers_are_written_as_format_does() {
        for n in [0, 7, 10, 99, 100, 4_294_967_295, u64::MAX] {
            let mut text = Text::default();
            text.count(n);
            assert_eq!(text.as_bytes(), n.to_string().as_bytes());
        }
    }

    #[test]
    fn blocks_follow_one_another_for_any_number_of_threads() {
        let n = 20 * ITEMS + 5;
        let expected: String = (0..n).map(|k| format!("{k};")).collect();
        for threads in [1, 2, 8] {
            let mut written = Vec::new();
            let item = |text: &mut Text, k: usize| {
                text.count(k as u64);
                text.text(";");
            };
            Pool::new(threads).unwrap().run(|| write_blocks(&mut written, n, item)).unwrap();
            assert!(written == expected.as_bytes(), "{threads} threads");
        }
    }
}
