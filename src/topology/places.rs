//! The words between places on the boundary of a polygon, composed on demand.

use super::brahana::Prefix;
use super::word::{Letter, Word};
use crate::archive::stored;

/// The data from which the word of the boundary of a polygon from one place to another is composed.
///
/// There are 4g + b places, and a word has as many letters (twice as many between two places). Only one number per handle is stored for
/// each place, so that the memory is O(g (g + b)).
#[derive(Debug, Clone)]
pub(super) struct PlaceWords {
    /// The prefix at each place of the polygon.
    pub prefixes: Vec<Prefix>,
    /// For each handle the first k letters of `a b a⁻¹ b⁻¹`, k = 0 … 4, as words in the generators.
    pub products: Vec<[Word; 5]>,
}
stored!(sections PlaceWords { prefixes, products });

impl PlaceWords {
    /// The word of the boundary between two places: `P(from)⁻¹ P(to)`, without the factors that the two have in common.
    pub fn between(&self, from: u32, to: u32) -> impl Iterator<Item = Letter> + '_ {
        let [from, to] = [from, to].map(|place| &self.prefixes[place as usize]);
        let common = from.digits.iter().zip(&to.digits).take_while(|(k, l)| k == l).count();
        let n_common_ends = if common == self.products.len() { from.n_ends.min(to.n_ends) } else { 0 };
        let letters = move |prefix: &'_ Prefix| {
            let n_ends = prefix.n_ends;
            let handles = prefix.digits.iter().zip(&self.products).skip(common);
            let ends = (n_common_ends..n_ends).map(|j| Letter::generator(2 * self.products.len() + j));
            handles
                .flat_map(|(&k, products)| products[usize::from(k)].letters())
                .copied()
                .chain(ends)
                .collect()
        };
        let (back, there): (Vec<_>, Vec<_>) = (letters(from), letters(to));
        back.into_iter().rev().map(Letter::inverse).chain(there)
    }
}
