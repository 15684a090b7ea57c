//! Words in generators and their inverses: elements of a free group.
//!
//! ```
//! use ricci::topology::{Letter, Word};
//! let [a, b] = [0, 1].map(Letter::generator);
//! let word = Word::from_iter([a, b, b.inverse()]);
//! assert_eq!(word.letters(), [a]);
//! assert!(word.times(&word.inverse()).is_empty());
//! ```

use crate::archive::stored;

/// A generator or its inverse: generator k is letter `2k`, its inverse `2k + 1` (like edges and half-edges).
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Letter(pub u32);

stored!(id Letter);

impl Letter {
    /// Generator `k` (below 2³¹), counted from 0.
    #[inline]
    pub fn generator(k: usize) -> Letter {
        Letter((k as u32) << 1)
    }

    /// The number of its generator.
    #[inline]
    pub fn index(self) -> usize {
        (self.0 >> 1) as usize
    }

    /// True for the inverse of a generator.
    #[inline]
    pub fn is_inverse(self) -> bool {
        self.0 & 1 == 1
    }

    /// Its inverse.
    #[inline]
    pub fn inverse(self) -> Letter {
        Letter(self.0 ^ 1)
    }
}

/// A freely reduced word: no letter follows its inverse. The empty word is the identity; equality, order and
/// hash are those of the free group. Letters compose left to right, as paths do.
#[derive(Debug, Clone, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Word(Vec<Letter>);
stored!(id Word);

impl Word {
    /// The empty word.
    pub fn identity() -> Word {
        Word::default()
    }

    /// Its letters, first to last.
    pub fn letters(&self) -> &[Letter] {
        &self.0
    }

    /// Number of letters.
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// True for the empty word.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Multiplies by a letter from the right.
    pub fn push(&mut self, letter: Letter) {
        if self.0.last() == Some(&letter.inverse()) {
            self.0.pop();
        } else {
            self.0.push(letter);
        }
    }

    /// Multiplies by letters from the right, one after the other.
    pub fn extend(&mut self, letters: impl IntoIterator<Item = Letter>) {
        letters.into_iter().for_each(|letter| self.push(letter));
    }

    /// The inverse word.
    pub fn inverse(&self) -> Word {
        Word(inverse(&self.0).collect())
    }

    /// The product `self · other`.
    pub fn times(&self, other: &Word) -> Word {
        let mut product = self.clone();
        product.extend(other.0.iter().copied());
        product
    }

    /// `[self, other] = self · other · self⁻¹ · other⁻¹`.
    pub fn commutator(&self, other: &Word) -> Word {
        self.times(other).times(&self.inverse()).times(&other.inverse())
    }

    /// The image under the homomorphism that maps each generator to a word.
    pub fn substitute(&self, image: impl Fn(usize) -> Word) -> Word {
        let mut word = Word::identity();
        for letter in &self.0 {
            let image = image(letter.index());
            if letter.is_inverse() { word.extend(inverse(&image.0)) } else { word.extend(image.0) }
        }
        word
    }
}

impl FromIterator<Letter> for Word {
    fn from_iter<I: IntoIterator<Item = Letter>>(letters: I) -> Word {
        let mut word = Word::identity();
        word.extend(letters);
        word
    }
}

/// The letters of the inverse of a word.
pub(super) fn inverse(letters: &[Letter]) -> impl Iterator<Item = Letter> + '_ {
    letters.iter().rev().map(|letter| letter.inverse())
}
