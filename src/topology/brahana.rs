//! Brahana's normal form of the boundary word of a polygon: first one commutator per handle, then boundary letters.

use super::word::{Letter, Word, inverse};
use crate::archive::stored;

/// The two loops of one handle, as words in the polygon's letters.
pub(super) struct HandleWords {
    /// The word of the loop a.
    pub a: Word,
    pub b: Word,
}

/// The word W of a polygon, read from one of its places, as a product of commutators and boundary letters in the free group of its
/// letters.
pub(super) struct NormalForm {
    /// `W = [a1, b1] … [ag, bg] z1 … zb`.
    pub handles: Vec<HandleWords>,
    /// The boundary letters z1, …, zb.
    pub ends: Vec<Letter>,
    /// For each place of the polygon (before letter k): the letters of W up to there are the product over the handles of the first
    /// `digits` letters of `a b a⁻¹ b⁻¹`, times `z1 … zr`.
    pub prefixes: Vec<Prefix>,
}

/// A prefix of the word, see [`NormalForm::prefixes`].
#[derive(Debug, Clone)]
pub(super) struct Prefix {
    pub digits: Vec<u8>,
    pub n_ends: usize,
}
stored!(row Prefix { digits: Vec<u8>, n_ends: usize });

/// Most places from which the word is read. A surface of genus 32 has 128 places, so that up to this genus all are tried.
const MAX_STARTS: usize = 128;

/// The places from which to read a polygon's word, those with the shortest handles first. The length of a handle is that of the loops of
/// all letters of its words. O(g²) per place in general, O(g³) at worst.
pub(super) fn best_starts(word: &[Letter], cost: &[f64]) -> Vec<usize> {
    let length = |start: usize| {
        let handles = normal_form(word, cost, start).handles;
        let words = handles.iter().flat_map(|handle| [&handle.a, &handle.b]);
        words.flat_map(Word::letters).fold(0.0, |sum, letter| sum + cost[letter.index()])
    };
    let starts = (0..word.len().max(1)).step_by(word.len().div_ceil(MAX_STARTS).max(1));
    let mut starts: Vec<(f64, usize)> = starts.map(|start| (length(start), start)).collect();
    starts.sort_by(|a, b| a.0.total_cmp(&b.0));
    starts.into_iter().map(|(_, start)| start).collect()
}

/// The normal form of a polygon's word, read from the place `start`. `word`: of a polygon that is glued to an oriented connected surface.
/// `cost`: the length of each letter's loop.
pub(super) fn normal_form(word: &[Letter], cost: &[f64], start: usize) -> NormalForm {
    let mut turned = word.to_vec();
    turned.rotate_left(start);
    let mut form = normalise(&turned, cost);
    form.prefixes.rotate_right(start);
    form
}

/// Brahana's normalisation \[Bra21\], \[Sti93\], exact in the free group.
///
/// Two letters whose occurrences are linked, `W = U x A y B x⁻¹ C y⁻¹ D`, make a handle:
///
/// ```text
///     a = U x B⁻¹ C⁻¹ U⁻¹,    b = U C B A y C⁻¹ U⁻¹,    W = [a, b] · U C B A D.
/// ```
///
/// The rest is a word in the same letters, so words do not grow. A prefix of W is the product of a prefix of `a b a⁻¹ b⁻¹` and a prefix
/// of the rest (primed letters are prefixes; these are the equations above, multiplied out):
///
/// ```text
///     U′                                  = 1 · U′
///     U x A′                              = a · U C B A′
///     U x A y B′                          = a b · U C B′
///     U x A y B x⁻¹ C′                    = a b a⁻¹ · U C′
///     U x A y B x⁻¹ C y⁻¹ D′              = a b a⁻¹ b⁻¹ · U C B A D′
/// ```
///
/// so by induction every prefix of W has at most four letters of each handle and one of each boundary loop.
///
/// The pair whose handle has the shortest words is taken first. At the end no letter occurs twice: the edges left over by the two trees
/// are 2g interior edges; each handle uses two of them and lowers the genus by one; and letters of which no two are linked glue a polygon
/// to a surface of genus 0.
fn normalise(word: &[Letter], cost: &[f64]) -> NormalForm {
    let mut word = word.to_vec();
    let mut place: Vec<usize> = (0..word.len().max(1)).collect();
    let mut digits = vec![Vec::new(); place.len()];
    let mut handles = Vec::new();
    while let Some([i, j, k, l]) = cheapest_pair(&word, cost) {
        let (u, x, a, y) = (&word[..i], word[i], &word[i + 1..j], word[j]);
        let (b, c, d) = (&word[j + 1..k], &word[k + 1..l], &word[l + 1..]);
        let back = || inverse(c).chain(inverse(u));
        let there = || [u, c, b, a].into_iter().flatten().copied();
        let first = u.iter().copied().chain([x]).chain(inverse(b)).chain(back());
        handles.push(HandleWords { a: first.collect(), b: there().chain([y]).chain(back()).collect() });
        for (place, digits) in place.iter_mut().zip(&mut digits) {
            let (digit, before) = match *place {
                q if q <= i => (0, q),
                q if q <= j => (1, i + c.len() + b.len() + q - (i + 1)),
                q if q <= k => (2, i + c.len() + q - (j + 1)),
                q if q <= l => (3, i + q - (k + 1)),
                q => (4, q - 4),
            };
            digits.push(digit);
            *place = before;
        }
        word = there().chain(d.iter().copied()).collect();
    }
    let prefixes = place.into_iter().zip(digits).map(|(n_ends, digits)| Prefix { digits, n_ends }).collect();
    NormalForm { handles, ends: word, prefixes }
}

/// The positions of x, y, x⁻¹, y⁻¹ of the linked pair with the shortest words a and b, counted in the lengths
/// of the letters' loops: `4 U + x + y + A + 2 B + 3 C`.
fn cheapest_pair(word: &[Letter], cost: &[f64]) -> Option<[usize; 4]> {
    let mut second = vec![None; word.len()];
    let mut seen = vec![None; cost.len()];
    for (i, letter) in word.iter().enumerate() {
        match seen[letter.index()] {
            None => seen[letter.index()] = Some(i),
            Some(first) => second[first] = Some(i),
        }
    }
    let mut sum = vec![0.0];
    for letter in word {
        sum.push(sum[sum.len() - 1] + cost[letter.index()]);
    }
    let between = |from: usize, to: usize| sum[to] - sum[from];
    let (mut best, mut least) = (None, f64::INFINITY);
    for i in 0..word.len() {
        let Some(k) = second[i] else { continue };
        let before = 4.0 * sum[i] + cost[word[i].index()];
        if before >= least {
            break;
        }
        for j in i + 1..k {
            let Some(l) = second[j].filter(|&l| l > k) else { continue };
            let total = before + between(i + 1, j + 1) + 2.0 * between(j + 1, k) + 3.0 * between(k + 1, l);
            if total < least {
                (best, least) = (Some([i, j, k, l]), total);
            }
        }
    }
    best
}
