//! The checksum of an archive.

/// The checksum of a content: it finds damage, not malice.
pub(super) fn checksum(content: &[u8]) -> u64 {
    let word = |part: &[u8]| part.iter().rev().fold(0, |word, &byte| word << 8 | u64::from(byte));
    let mix = |sum: u64, word: u64| (sum ^ word).wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(29);
    let words = content.chunks_exact(8);
    let last = word(words.remainder());
    let sum = words.fold(content.len() as u64, |sum, part| mix(sum, word(part)));
    mix(mix(sum, last), 0)
}
