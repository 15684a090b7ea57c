//! Fundamental groups of oriented surfaces: one relator, names of the generators, the word problem.
//!
//! ```
//! use ricci::topology::SurfaceGroup;
//! let group = SurfaceGroup { genus: 2, boundaries: 0 };
//! let word = group.parse("a1 b1 a1^-1 b1^-1 a2 b2 a2^-1")?;
//! assert_eq!(group.text(&group.reduce(&word)), "b2");
//! # Ok::<(), ricci::Error>(())
//! ```

use super::word::{Letter, Word};
use crate::archive::stored;
use crate::error::{Error, Result};

/// The fundamental group of the surface of genus g with b boundary loops,
///
/// ```text
///     ⟨ a1, b1, …, ag, bg, c1, …, cb | a1 b1 a1⁻¹ b1⁻¹ … ag bg ag⁻¹ bg⁻¹ c1 … cb ⟩.
/// ```
///
/// Generators are numbered in this order: `a_i` is `2i − 2`, `b_i` is `2i − 1`, `c_j` is `2g + j − 1`. Methods treat letters with other
/// numbers as the identity.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SurfaceGroup {
    /// Genus g.
    pub genus: usize,
    /// Number b of boundary loops.
    pub boundaries: usize,
}
stored!(sections SurfaceGroup { genus, boundaries });

impl SurfaceGroup {
    /// Number of generators, 2g + b.
    pub fn n_generators(&self) -> usize {
        2 * self.genus + self.boundaries
    }

    /// The name of generator `k`, counted from 0: `a1`, `b1`, `a2`, …, `c1`, ….
    pub fn name(&self, k: usize) -> String {
        match k.checked_sub(2 * self.genus) {
            Some(j) => format!("c{}", j + 1),
            None => format!("{}{}", if k.is_multiple_of(2) { 'a' } else { 'b' }, k / 2 + 1),
        }
    }

    /// The names of all generators.
    pub fn names(&self) -> Vec<String> {
        (0..self.n_generators()).map(|k| self.name(k)).collect()
    }

    /// A word as text: letters with spaces between them, inverses marked `^-1`; the empty word is `1`.
    pub fn text(&self, word: &Word) -> String {
        let letter = |l: &Letter| self.name(l.index()) + if l.is_inverse() { "^-1" } else { "" };
        if word.is_empty() {
            "1".into()
        } else {
            word.letters().iter().map(letter).collect::<Vec<_>>().join(" ")
        }
    }

    /// The word that a text like `a1 b1 a1^-1` means, freely reduced; `1` stands for the identity.
    ///
    /// # Errors
    ///
    /// [`Error::Argument`] for a token that is not a letter.
    pub fn parse(&self, text: &str) -> Result<Word> {
        let mut word = Word::identity();
        for token in text.split_whitespace().filter(|&token| token != "1") {
            let (name, inverse) = token.strip_suffix("^-1").map_or((token, false), |name| (name, true));
            let need =
                "write generators of the surface's group as a1, b1, c1, inverses as a1^-1, spaced apart";
            let letter = self.number(name).map(Letter::generator);
            let letter = letter.ok_or_else(|| Error::argument("letter", token, need))?;
            word.push(if inverse { letter.inverse() } else { letter });
        }
        Ok(word)
    }

    /// The number of the generator with this name.
    fn number(&self, name: &str) -> Option<usize> {
        let kind = name.chars().next().filter(char::is_ascii)?;
        let digits = &name[1..];
        let i = digits.parse::<usize>().ok()?.checked_sub(1)?;
        let (k, count) = match kind {
            'a' => (i.checked_mul(2)?, self.genus),
            'b' => (i.checked_mul(2)?.checked_add(1)?, self.genus),
            'c' => (i.checked_add(2 * self.genus)?, self.boundaries),
            _ => return None,
        };
        (i < count && !digits.starts_with(['0', '+'])).then_some(k)
    }

    /// The relator `a1 b1 a1⁻¹ b1⁻¹ … ag bg ag⁻¹ bg⁻¹ c1 … cb`.
    pub fn relator(&self) -> Word {
        let handle = |i: usize| {
            let (a, b) = (Letter::generator(2 * i), Letter::generator(2 * i + 1));
            [a, b, a.inverse(), b.inverse()]
        };
        let ends = (2 * self.genus..self.n_generators()).map(Letter::generator);
        (0..self.genus).flat_map(handle).chain(ends).collect()
    }

    /// The image in the first homology ℤ^{2g + max(b − 1, 0)}: the sum of each generator's exponents, where
    /// `cb` counts as `−c1 − … − c(b−1)`.
    pub fn abelianisation(&self, word: &Word) -> Vec<i64> {
        let mut sums = vec![0; self.n_generators()];
        for letter in word.letters() {
            if let Some(sum) = sums.get_mut(letter.index()) {
                *sum += if letter.is_inverse() { -1 } else { 1 };
            }
        }
        if self.boundaries > 0
            && let Some(last) = sums.pop()
        {
            sums[2 * self.genus..].iter_mut().for_each(|sum| *sum -= last);
        }
        sums
    }
}
