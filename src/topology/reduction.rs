//! Reduction of words in surface groups, letter by letter.
//!
//! ```
//! use ricci::topology::SurfaceGroup;
//! let group = SurfaceGroup { genus: 2, boundaries: 0 };
//! assert!(group.is_trivial(&group.relator()));
//! assert!(!group.equal(&group.parse("a1 b1")?, &group.parse("b1 a1")?));
//! # Ok::<(), ricci::Error>(())
//! ```

use super::group::SurfaceGroup;
use super::word::{Letter, Word, inverse};

/// The word problem.
impl SurfaceGroup {
    /// A word for the same element, on a closed surface never longer than the given one; empty exactly for the identity.
    ///
    /// On closed surfaces of genus ≥ 2 by Dehn's algorithm \[Deh12\]; an element can have several such words. In genus 1, `a1^p b1^q`.
    /// With boundary, the freely reduced word without `cb`, which the relator expresses by the others. The last two are normal forms:
    /// equal elements have equal words. O(g · length).
    pub fn reduce(&self, word: &Word) -> Word {
        let mut reduction = Reduction::new(*self);
        reduction.extend(word.letters().iter().copied());
        reduction.word()
    }

    /// True if a word is the identity of the group.
    pub fn is_trivial(&self, word: &Word) -> bool {
        self.reduce(word).is_empty()
    }

    /// True if two words are the same element of the group.
    pub fn equal(&self, u: &Word, v: &Word) -> bool {
        self.is_trivial(&u.inverse().times(v))
    }
}

/// A product of letters that is kept reduced while letters are multiplied to its right; see
/// [`SurfaceGroup::reduce`].
#[derive(Debug, Clone)]
pub struct Reduction {
    group: SurfaceGroup,
    /// The reduced word (empty in genus 1 without boundary, see `exponents`).
    stack: Vec<StackEntry>,
    /// The exponents of a1 and b1, in genus 1 without boundary.
    exponents: [i64; 2],
    /// Letters still to be pushed, last one first; empty between calls.
    ahead: Vec<Letter>,
}

/// A letter, and the lengths of the longest subwords of the cyclic relator and of its inverse that end with it.
#[derive(Debug, Clone, Copy)]
struct StackEntry {
    letter: Letter,
    along: usize,
    against: usize,
}

impl Reduction {
    /// The identity.
    pub fn new(group: SurfaceGroup) -> Reduction {
        Reduction { group, stack: Vec::new(), exponents: [0; 2], ahead: Vec::new() }
    }

    /// The reduced word.
    pub fn word(&self) -> Word {
        let power = |k: usize| {
            let letter = Letter::generator(k);
            let letter = if self.exponents[k] < 0 { letter.inverse() } else { letter };
            std::iter::repeat_n(letter, self.exponents[k].unsigned_abs() as usize)
        };
        self.stack.iter().map(|entry| entry.letter).chain((0..2).flat_map(power)).collect()
    }

    /// Multiplies by letters from the right, one after the other.
    pub fn extend(&mut self, letters: impl IntoIterator<Item = Letter>) {
        letters.into_iter().for_each(|letter| self.push(letter));
    }

    /// Multiplies by a letter from the right. A letter without a generator is the identity.
    pub fn push(&mut self, letter: Letter) {
        let SurfaceGroup { genus, boundaries } = self.group;
        if letter.index() >= self.group.n_generators() {
            return;
        }
        match (genus, boundaries) {
            (1, 0) => self.exponents[letter.index()] += if letter.is_inverse() { -1 } else { 1 },
            (_, 0) => self.push_closed(letter),
            _ if letter.index() + 1 == self.group.n_generators() => {
                // The relator is R cb, so cb is the inverse of R.
                let relator = self.group.relator();
                let rest = &relator.letters()[..relator.len() - 1];
                if letter.is_inverse() {
                    rest.iter().for_each(|&letter| self.push_free(letter))
                } else {
                    inverse(rest).for_each(|letter| self.push_free(letter))
                }
            }
            _ => self.push_free(letter),
        }
    }

    fn push_free(&mut self, letter: Letter) {
        match self.stack.last() {
            Some(top) if top.letter == letter.inverse() => drop(self.stack.pop()),
            _ => self.stack.push(StackEntry { letter, along: 1, against: 1 }),
        }
    }

    /// Dehn's algorithm. A non-empty freely reduced word that is the identity in a closed surface's group of genus ≥ 2 contains more than
    /// half of the cyclic relator or of its inverse \[Deh12\]. Every letter occurs once in either of them, so a subword of them is known
    /// by its last letter and its length. The stack contains no such subword of 2g + 1 letters, so that only its top is examined. Each
    /// replacement shortens the word by two letters: O(g) per letter.
    fn push_closed(&mut self, letter: Letter) {
        let half = 2 * self.group.genus;
        self.ahead.push(letter);
        while let Some(letter) = self.ahead.pop() {
            let (mut along, mut against) = (1, 1);
            if let Some(&top) = self.stack.last() {
                if top.letter == letter.inverse() {
                    self.stack.pop();
                    continue;
                }
                if self.after(top.letter) == letter {
                    along += top.along;
                }
                if self.after_against(top.letter) == letter {
                    against += top.against;
                }
            }
            self.stack.push(StackEntry { letter, along, against });
            if along.max(against) > half {
                // The relator is s t with the subword s, which is replaced by the inverse of t, last letter of t first.
                self.stack.truncate(self.stack.len() - (half + 1));
                let mut t = letter;
                for _ in 1..half {
                    t = if along > against { self.after(t) } else { self.after_against(t) };
                    self.ahead.push(t.inverse());
                }
            }
        }
    }

    /// The letter that follows a letter in the cyclic relator … a b a⁻¹ b⁻¹ a′ ….
    fn after(&self, letter: Letter) -> Letter {
        let (handle, is_b) = (letter.index() / 2, letter.index() % 2 == 1);
        match (is_b, letter.is_inverse()) {
            (false, false) => Letter::generator(2 * handle + 1),
            (true, false) => Letter::generator(2 * handle).inverse(),
            (false, true) => Letter::generator(2 * handle + 1).inverse(),
            (true, true) => Letter::generator(2 * ((handle + 1) % self.group.genus)),
        }
    }

    /// The letter that follows a letter in the inverse of the cyclic relator, … b a b⁻¹ a⁻¹ b′ …, where b′ is of the handle before.
    fn after_against(&self, letter: Letter) -> Letter {
        let (handle, is_b) = (letter.index() / 2, letter.index() % 2 == 1);
        let genus = self.group.genus;
        match (is_b, letter.is_inverse()) {
            (true, false) => Letter::generator(2 * handle),
            (false, false) => Letter::generator(2 * handle + 1).inverse(),
            (true, true) => Letter::generator(2 * handle).inverse(),
            (false, true) => Letter::generator(2 * ((handle + genus - 1) % genus) + 1),
        }
    }
}
