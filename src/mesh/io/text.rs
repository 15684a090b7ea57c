//! Text that consists of many numbers, formatted in blocks by several threads.
//!
//! ```
//! use ricci::mesh::io::text::{TextBuilder, write_blocks};
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

/// Items that one thread formats at a time.
const ITEMS: usize = 4096;
/// Blocks that are held before they are written; this bounds the memory.
const BLOCKS: usize = 16;
/// Bytes for which a block has room at first; most items have up to three numbers.
const BYTES_PER_ITEM: usize = 64;
/// Most digits of a whole number.
const MOST_DIGITS: usize = 20;

/// Half of the bytes in which every f64 has room, which needs 24 at most. Most numbers need more than half.
const HALF: usize = 16;

/// A text while it is written.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct TextBuilder {
    bytes: Vec<u8>,
}

impl TextBuilder {
    /// Appends words.
    #[inline]
    pub fn text(&mut self, words: &str) {
        self.bytes.extend_from_slice(words.as_bytes());
    }

    /// Appends one character.
    #[inline]
    pub fn character(&mut self, c: char) {
        match u8::try_from(c) {
            Ok(byte) if byte.is_ascii() => self.bytes.push(byte),
            _ => self.text(c.encode_utf8(&mut [0; 4])),
        }
    }

    /// Appends a finite number with the fewest digits that read back to the same number.
    #[inline]
    pub fn number(&mut self, x: f64) {
        let mut buffer = zmij::Buffer::new();
        let digits = buffer.format_finite(x).as_bytes();
        let (Some(first), Some(last)) = (digits.first_chunk::<HALF>(), digits.last_chunk::<HALF>()) else {
            self.bytes.extend_from_slice(digits);
            return;
        };
        // Two halves of a fixed size, which overlap, are copied without a call.
        let (begin, end) = (self.bytes.len(), self.bytes.len() + digits.len());
        self.bytes.extend_from_slice(&[0; 2 * HALF]);
        self.bytes[begin..begin + HALF].copy_from_slice(first);
        self.bytes[end - HALF..end].copy_from_slice(last);
        self.bytes.truncate(end);
    }

    /// Appends a whole number.
    #[inline]
    pub fn count(&mut self, mut n: u64) {
        let (begin, digits) = (self.bytes.len(), n.checked_ilog10().unwrap_or(0) as usize + 1);
        self.bytes.extend_from_slice(&[0; MOST_DIGITS]);
        self.bytes.truncate(begin + digits);
        for digit in self.bytes[begin..].iter_mut().rev() {
            *digit = b'0' + (n % 10) as u8;
            n /= 10;
        }
    }

    /// The bytes so far.
    pub fn as_bytes(&self) -> &[u8] {
        &self.bytes
    }
}

/// The text of `format!` and the like is appended.
impl std::fmt::Write for TextBuilder {
    fn write_str(&mut self, words: &str) -> std::fmt::Result {
        self.text(words);
        Ok(())
    }
}

/// Writes the text of items 0 to n − 1, one after the other. Inside a pool they are formatted in parallel.
///
/// # Errors
/// Those of writing.
pub fn write_blocks(
    out: &mut impl Write,
    n: usize,
    item: impl Fn(&mut TextBuilder, usize) + Sync,
) -> io::Result<()> {
    let block = |b: usize| {
        let items = b * ITEMS..((b + 1) * ITEMS).min(n);
        // Other tasks seldom wait for a file.
        parallel::give_way();
        let mut text = TextBuilder { bytes: Vec::with_capacity(BYTES_PER_ITEM * items.len()) };
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
    fn numbers_and_characters_are_written_as_display_does() {
        let mut random = crate::mesh::shapes::SplitMix64::new(3);
        let mut numbers = vec![0.0, -0.0, 1.0, -2.5, 0.1, -f64::MIN_POSITIVE, f64::MAX, 5e-324, 1.0 / 3.0];
        numbers.extend((0..2000).map(|_| f64::from_bits(random.bits())).filter(|x| x.is_finite()));
        for x in numbers {
            let mut text = TextBuilder::default();
            text.character('[');
            text.number(x);
            text.character('²');
            let written = std::str::from_utf8(text.as_bytes()).unwrap();
            let digits = written.strip_prefix('[').and_then(|rest| rest.strip_suffix('²')).unwrap();
            assert_eq!(digits, zmij::Buffer::new().format_finite(x));
            assert_eq!(digits.parse::<f64>().unwrap().to_bits(), x.to_bits());
        }
    }

    #[test]
    fn whole_numbers_are_written_as_format_does() {
        for n in [0, 7, 10, 99, 100, 4_294_967_295, u64::MAX] {
            let mut text = TextBuilder::default();
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
            let item = |text: &mut TextBuilder, k: usize| {
                text.count(k as u64);
                text.text(";");
            };
            Pool::new(threads).unwrap().run(|| write_blocks(&mut written, n, item)).unwrap();
            assert!(written == expected.as_bytes(), "{threads} threads");
        }
    }
}
