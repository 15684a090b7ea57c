//! The homotopy class of a map that is named by pairs of loops: the images of the letters of the source's fundamental group.
//!
//! The loops generate the groups of both surfaces, and the map brings the first of each pair to the second. So each letter of the source
//! has to be written as a product of its loops. Products are compared by the distance by which they move the base in the source's own
//! metric: first the generators are made short, then products of few of them are collected, and a letter is reduced by these to the
//! identity. The result is checked exactly in the groups.

use super::generators::Generators;
use crate::error::{Error, Result};
use crate::geometry::{DoubleDouble, Motion};
use crate::mesh::{HalfedgeId, Mesh};
use crate::topology::spanning::Key;
use crate::topology::{HomotopyBasis, Letter, SurfaceGroup, Word, check_path, intersection_matrix};
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Share of a length by which a product has to be shorter to take the place of another one: rounding.
const SHORTER: f64 = 1e-9;
/// Most replacements of a generator by a shorter product; each loop needs about as many as it winds around others.
const MOST_REPLACED: usize = 10_000;
/// Most products that are collected, those first that move the base least: more than the neighbours of a fundamental domain of a surface of
/// small genus.
const MOST_PRODUCTS: usize = 800;
/// Most factors of a product that equals a letter of the group.
const MOST_LETTERS: usize = 10_000;

/// A surface with the loops that name the class.
pub(super) struct SurfaceWithLoops<'a> {
    pub mesh: &'a Mesh,
    pub basis: &'a HomotopyBasis,
    pub generators: &'a Generators,
    /// The frame at the base.
    pub at_base: Motion<DoubleDouble>,
    /// The loops, as closed edge paths.
    pub loops: Vec<&'a [HalfedgeId]>,
}

/// The images of the letters.
#[derive(Debug)]
pub(super) struct LetterImages {
    /// Per letter a1, b1, … of the source a word of the target.
    pub handles: Vec<Word>,
    /// Per letter c1, … of the source the number of the target's c and the word u for which it goes to `u c u⁻¹`.
    pub rims: Vec<(usize, Word)>,
}

/// The images of the source's letters in the class in which each loop goes to its partner.
///
/// # Errors
/// [`Error::Matching`] for paths that are not closed, loops that do not start at one vertex (but on a torus), that cross differently on the
/// two surfaces, that do not generate the fundamental group, or that no homeomorphism brings to each other; [`Error::Argument`] for
/// half-edges that are no path.
pub(super) fn letter_images(sides: [&SurfaceWithLoops; 2]) -> Result<LetterImages> {
    let mut words = [Vec::new(), Vec::new()];
    for (s, side) in sides.iter().enumerate() {
        words[s] = loop_words(side, NAMES[s])?;
    }
    check_crossings(sides)?;
    let groups = sides.map(|side| side.basis.group);
    let [handles, _] = [images(sides, [&words[0], &words[1]], 0)?, images(sides, [&words[1], &words[0]], 1)?];
    let image = |word: &Word| groups[1].reduce(&word.substitute(|k| handles[k].clone()));
    for (k, word) in words[0].iter().enumerate() {
        if !groups[1].equal(&image(word), &words[1][k]) {
            return Err(unlike(&format!(
                "where the others go, loop {k} of the source does not go to its partner"
            )));
        }
    }
    if !groups[1].is_trivial(&image(&groups[0].relator())) {
        return Err(unlike(
            "a product of loops of the source can be contracted, that of their partners cannot",
        ));
    }
    let g = 2 * groups[0].genus;
    let mut rims = Vec::with_capacity(groups[0].boundaries);
    for (j, word) in handles[g..].iter().enumerate() {
        let around = |k: usize| Some((k, conjugator(&groups[1], word, g + k)?));
        let rim = (0..groups[1].boundaries).find_map(around);
        rims.push(rim.ok_or_else(|| {
            unlike(&format!(
                "what goes around boundary c{} of the source goes around none of the target",
                j + 1
            ))
        })?);
    }
    Ok(LetterImages { handles: handles[..g].to_vec(), rims })
}

const NAMES: [&str; 2] = ["source", "target"];

/// The error of loops that no homeomorphism brings to each other.
fn unlike(why: &str) -> Error {
    Error::Matching(format!("no map brings the loops of the basis to each other: {why}"))
}

/// The words of the loops; the path along the tree from the base to their start, and back, belongs to each.
fn loop_words(side: &SurfaceWithLoops, name: &str) -> Result<Vec<Word>> {
    let is_torus = side.mesh.euler() == 0;
    let mut first = None;
    let mut words = Vec::with_capacity(side.loops.len());
    for (k, path) in side.loops.iter().enumerate() {
        check_path(side.mesh, path)?;
        let (Some(&start), Some(&end)) = (path.first(), path.last()) else {
            return Err(Error::Matching(format!("loop {k} of the basis is empty on the {name}")));
        };
        let v = side.mesh.origin(start);
        if side.mesh.tip(end) != v {
            return Err(Error::Matching(format!("loop {k} of the basis is not closed on the {name}")));
        }
        let base = *first.get_or_insert(v);
        if base != v && !is_torus {
            return Err(Error::Matching(format!(
                "loops of the basis have to start at one vertex: on the {name} loop 0 starts at vertex {base}, loop {k} at vertex {v}"
            )));
        }
        words.push(side.basis.path_word(side.mesh, path)?);
    }
    Ok(words)
}

/// Checks that the loops have the same intersection numbers on both surfaces.
fn check_crossings(sides: [&SurfaceWithLoops; 2]) -> Result<()> {
    let matrix = |side: &SurfaceWithLoops| {
        let loops: Vec<Vec<HalfedgeId>> = side.loops.iter().map(|path| path.to_vec()).collect();
        intersection_matrix(side.mesh, &loops)
    };
    let [first, second] = [matrix(sides[0])?, matrix(sides[1])?];
    for (i, (row, other)) in first.iter().zip(&second).enumerate() {
        if let Some(j) = (0..row.len()).find(|&j| row[j] != other[j]) {
            return Err(Error::Matching(format!(
                "loops {i} and {j} of the basis have the intersection number {} on the source and {} on the target",
                row[j], other[j]
            )));
        }
    }
    Ok(())
}

/// An element of the group of one surface, as a word and as a motion, with its image in the group of the other one.
#[derive(Debug, Clone)]
struct MappedElement {
    word: Word,
    image: Word,
    motion: Motion<DoubleDouble>,
    /// The distance by which it moves the base.
    far: f64,
}

/// The groups of the surface whose elements are mapped and of the other one.
struct GroupPair<'a> {
    own: SurfaceGroup,
    other: SurfaceGroup,
    at_base: &'a Motion<DoubleDouble>,
}

impl GroupPair<'_> {
    fn element(&self, word: Word, image: Word, motion: Motion<DoubleDouble>) -> MappedElement {
        let motion = motion.normalised();
        let far = motion.conjugated_by(&self.at_base.inverse()).displacement();
        MappedElement { word: self.own.reduce(&word), image: self.other.reduce(&image), motion, far }
    }

    fn product(&self, a: &MappedElement, b: &MappedElement) -> MappedElement {
        self.element(a.word.times(&b.word), a.image.times(&b.image), a.motion.compose(&b.motion))
    }

    fn inverse(&self, a: &MappedElement) -> MappedElement {
        self.element(a.word.inverse(), a.image.inverse(), a.motion.inverse())
    }

    /// The generators, replaced one after the other by products with others as long as these move the base less.
    fn shortened(&self, mut all: Vec<MappedElement>) -> Vec<MappedElement> {
        let mut replaced = 0;
        'again: while replaced < MOST_REPLACED {
            for i in 0..all.len() {
                for j in (0..all.len()).filter(|&j| j != i) {
                    let (a, b) = (&all[i], &all[j]);
                    let back = self.inverse(b);
                    let others = [
                        self.product(a, b),
                        self.product(a, &back),
                        self.product(b, a),
                        self.product(&back, a),
                    ];
                    let Some(best) = others.into_iter().min_by(|p, q| p.far.total_cmp(&q.far)) else {
                        continue;
                    };
                    if best.far < (1.0 - SHORTER) * all[i].far {
                        all[i] = best;
                        replaced += 1;
                        continue 'again;
                    }
                }
            }
            break;
        }
        all
    }

    /// Products of the generators in the order of the distance by which they move the base.
    fn products(&self, of: &[MappedElement]) -> Vec<MappedElement> {
        let generators: Vec<MappedElement> = of.iter().flat_map(|g| [g.clone(), self.inverse(g)]).collect();
        let identity = Motion::identity(self.at_base.space);
        let mut found = vec![self.element(Word::identity(), Word::identity(), identity)];
        let mut waiting = BinaryHeap::from([Reverse((Key(0.0), 0))]);
        while let Some(Reverse((_, k))) = waiting.pop().filter(|_| found.len() < MOST_PRODUCTS) {
            for g in &generators {
                let next = self.product(&found[k], g);
                let is_same = |e: &MappedElement| {
                    (e.far - next.far).abs() <= SHORTER * (1.0 + next.far)
                        && self.own.equal(&e.word, &next.word)
                };
                if !found.iter().any(is_same) {
                    waiting.push(Reverse((Key(next.far), found.len())));
                    found.push(next);
                }
            }
        }
        found
    }

    /// The image of an element of the group, from the images of these products; `None` if it is not found to be a product of them.
    fn image(&self, products: &[MappedElement], mut rest: MappedElement) -> Option<Word> {
        let mut image = Word::identity();
        for _ in 0..MOST_LETTERS {
            if rest.word.is_empty() {
                return Some(self.other.reduce(&image));
            }
            let shorter = |g: &MappedElement| g.motion.inverse().compose(&rest.motion);
            let far = |g: &MappedElement| shorter(g).conjugated_by(&self.at_base.inverse()).displacement();
            let (best, g) = products.iter().map(|g| (far(g), g)).min_by(|a, b| a.0.total_cmp(&b.0))?;
            if best >= (1.0 - SHORTER) * rest.far {
                return None;
            }
            image = image.times(&g.image);
            rest = self.element(g.word.inverse().times(&rest.word), Word::identity(), shorter(g));
        }
        None
    }
}

/// The images of the letters of surface `s`, whose loops have these words, and their partners those.
fn images(sides: [&SurfaceWithLoops; 2], [words, partners]: [&[Word]; 2], s: usize) -> Result<Vec<Word>> {
    let side = sides[s];
    let group = GroupPair { own: side.basis.group, other: sides[1 - s].basis.group, at_base: &side.at_base };
    let element = |(word, image): (&Word, &Word)| {
        Ok(group.element(word.clone(), image.clone(), side.generators.motion(word)?))
    };
    let given: Vec<MappedElement> = words.iter().zip(partners).map(element).collect::<Result<_>>()?;
    let products = group.products(&group.shortened(given));
    let letter = |k: usize| {
        let letter = Word::from_iter([Letter::generator(k)]);
        let rest = group.element(letter, Word::identity(), side.generators.motions[k]);
        group.image(&products, rest).ok_or_else(|| {
            Error::Matching(format!(
                "the {} loops of the basis do not generate the fundamental group of the {}: {} is no product of them that was found",
                words.len(),
                NAMES[s],
                group.own.name(k)
            ))
        })
    };
    (0..group.own.n_generators()).map(letter).collect()
}

/// The word u with which an element of the group of a surface with boundary is `u c u⁻¹`; `None` if it is not conjugate to this letter c.
fn conjugator(group: &SurfaceGroup, word: &Word, letter: usize) -> Option<Word> {
    let around = group.reduce(&Word::from_iter([Letter::generator(letter)]));
    let word = group.reduce(word);
    let (letters, n) = (word.letters(), around.len());
    // The number of letters before and after the cyclically reduced rest.
    let mut ends = 0;
    while letters.len() > 2 * ends + 1 && letters[ends] == letters[letters.len() - 1 - ends].inverse() {
        ends += 1;
    }
    let rest = &letters[ends..letters.len() - ends];
    let turn = (0..n).find(|&k| {
        let turned = around.letters()[k..].iter().chain(&around.letters()[..k]);
        rest.len() == n && turned.eq(rest)
    })?;
    // The reduced letter is x y and the rest is y x.
    let x: Word = around.letters()[..turn].iter().copied().collect();
    let before: Word = letters[..ends].iter().copied().collect();
    Some(before.times(&x.inverse()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_conjugator_of_a_boundary_letter_is_found() {
        let group = SurfaceGroup { genus: 1, boundaries: 2 };
        for (letter, name) in [(2, "c1"), (3, "c2")] {
            for by in ["1", "a1", "b1 a1^-1 c1", "c1 c1 b1 a1"] {
                let u = group.parse(by).unwrap();
                let word = group.parse(name).unwrap();
                let word = u.times(&word).times(&u.inverse());
                let found = conjugator(&group, &word, letter).unwrap();
                let again = found.times(&group.parse(name).unwrap()).times(&found.inverse());
                assert!(group.equal(&word, &again), "{name} {by}");
            }
        }
        assert_eq!(conjugator(&group, &group.parse("c1^-1").unwrap(), 2), None);
        assert_eq!(conjugator(&group, &group.parse("a1").unwrap(), 2), None);
    }
}
