//! The two loops of a handle, and Dehn twists along them.

use super::shorten::{path_length, shorten};
use super::word::{Letter, Word};
use crate::control::Control;
use crate::error::Result;
use crate::mesh::{HalfedgeId, Mesh, PerEdge};

/// Most twists of a handle. A few are usual: they unwind the longer loop from the shorter one.
const MAX_TWISTS: usize = 32;

/// The loops a and b of a handle.
pub(super) type LoopPair = [Vec<HalfedgeId>; 2];

/// Loops a and b of a handle that are made shorter, and the words of the original loops in the present ones.
pub(super) struct HandleLoops {
    pub loops: LoopPair,
    /// The original loops a and b as words in the present ones (generators 0 and 1).
    first: [Word; 2],
}

impl HandleLoops {
    pub fn new(loops: LoopPair) -> HandleLoops {
        HandleLoops { loops, first: [0, 1].map(|k| Word::from_iter([Letter::generator(k)])) }
    }

    /// Replaces a by `a b^±1` or b by `b a^±1`, whichever saves more, as long as that makes a loop shorter.
    ///
    /// Both keep the commutator: `[a bᵏ, b] = a bᵏ b b⁻ᵏ a⁻¹ b⁻¹ = [a, b]` and `[a, b aᵏ] = a b aᵏ a⁻¹ a⁻ᵏ b⁻¹ = [a, b]`.
    pub fn twist(&mut self, mesh: &Mesh, lengths: &PerEdge<f64>, control: &Control) -> Result<()> {
        for _ in 0..MAX_TWISTS {
            let (mut best, mut saving) = (None, 0.0_f64);
            for k in 0..2 {
                let old = path_length(lengths, &self.loops[k]);
                for back in [false, true] {
                    let along = self.loops[k].iter().copied();
                    let other = &self.loops[1 - k];
                    let twisted = if back {
                        let inverse = other.iter().rev().map(|h| h.twin());
                        shorten(mesh, lengths, along.chain(inverse), control)?
                    } else {
                        shorten(mesh, lengths, along.chain(other.iter().copied()), control)?
                    };
                    let saved = old - path_length(lengths, &twisted);
                    if saved > saving.max(1e-12 * old) {
                        (best, saving) = (Some((k, back, twisted)), saved);
                    }
                }
            }
            let Some((k, back, twisted)) = best else { break };
            self.loops[k] = twisted;
            // The new loop is x y^±1, so the old one was (the new x) y^∓1.
            let (x, y) = (Letter::generator(k), Letter::generator(1 - k));
            let old = Word::from_iter([x, if back { y } else { y.inverse() }]);
            let image = |g: usize| if g == k { old.clone() } else { Word::from_iter([y]) };
            self.first = [0, 1].map(|j| self.first[j].substitute(image));
        }
        Ok(())
    }

    /// The prefixes 1, a, a b, a b a⁻¹, a b a⁻¹ b⁻¹ of the original loops' commutator, in the present loops as generators 2i and 2i + 1.
    pub fn prefixes(&self, i: usize) -> [Word; 5] {
        let [a, b] =
            [0, 1].map(|j| self.first[j].substitute(|g| Word::from_iter([Letter::generator(2 * i + g)])));
        let steps = [a.clone(), b.clone(), a.inverse(), b.inverse()];
        let mut word = Word::identity();
        let mut next = |k: usize| {
            if k > 0 {
                word = word.times(&steps[k - 1]);
            }
            word.clone()
        };
        [0, 1, 2, 3, 4].map(&mut next)
    }
}
