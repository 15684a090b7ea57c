//! The elements of deck groups, each with its word and its isometry.

use crate::archive::stored;
use crate::geometry::{DoubleDouble, Motion, Space};
use crate::topology::word::Word;

/// An element of the deck group.
#[derive(Debug, Clone, PartialEq)]
pub struct DeckElement {
    /// The element as a word in the canonical generators.
    pub word: Word,
    /// The element as an isometry.
    pub motion: Motion<DoubleDouble>,
}
stored!(sections DeckElement { word, motion });

impl DeckElement {
    /// The identity.
    pub fn identity(space: Space) -> DeckElement {
        DeckElement { word: Word::identity(), motion: Motion::identity(space) }
    }

    /// The inverse.
    pub fn inverse(&self) -> DeckElement {
        DeckElement { word: self.word.inverse(), motion: self.motion.inverse() }
    }

    /// The element with the isometry `to ∘ self ∘ to⁻¹` and the same word.
    pub(super) fn conjugated_by(&self, to: &Motion<DoubleDouble>) -> DeckElement {
        DeckElement { word: self.word.clone(), motion: self.motion.conjugated_by(to) }
    }
}
