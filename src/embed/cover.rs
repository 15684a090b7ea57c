//! Finite parts of the universal cover: lists of deck elements, and points moved by them.
//!
//! ```
//! use ricci::embed::cover::elements_to_depth;
//! use ricci::canonical::{QuotientOptions, uniformize_quotient};
//! use ricci::{Control, Surface, mesh::shapes};
//! # fn main() -> ricci::Result<()> {
//! let torus = Surface::from_soup(&shapes::torus(2.0, 1.0, 8, 8)?)?;
//! let flat = uniformize_quotient(&torus, &QuotientOptions::default(), &Control::new())?;
//! // The identity, and one step along each of the two generators in either direction.
//! assert_eq!(elements_to_depth(&flat.deck, 1, 100, &Control::new())?.len(), 5);
//! # Ok(())
//! # }
//! ```

use super::deck::DeckGroup;
use super::domain::DirichletDomain;
use super::element::DeckElement;
use crate::control::Control;
use crate::error::{Error, Result};
use crate::geometry::motion::precise_point;
use crate::geometry::{DoubleDouble, Motion, Space};
use crate::parallel;
use crate::topology::SurfaceGroup;
use crate::topology::word::Letter;
use std::collections::HashMap;

/// Number of elements after which the control is asked again whether to stop.
const ELEMENTS_PER_STEP: usize = 64;
/// Largest difference of displacements, in H² a length and in E² in units of the longest generator, for which two elements are compared as
/// words. One element by two words differs by far less; a larger value would only cost comparisons.
const SAME: f64 = 1e-6;

/// All deck elements of word length at most `depth` in the canonical generators, each once, shortest first, the identity to begin with.
///
/// The group decides if two words are the same element ([`SurfaceGroup::equal`]), not their coordinates.
///
/// # Errors
/// [`Error::TooLarge`] for more than `limit` elements; [`Error::Cancelled`].
pub fn elements_to_depth(
    deck: &DeckGroup,
    depth: usize,
    limit: usize,
    control: &Control,
) -> Result<Vec<DeckElement>> {
    let letters = (0..deck.group.n_generators())
        .flat_map(|k| [Letter::generator(k), Letter::generator(k).inverse()])
        .map(|letter| deck.element(letter))
        .collect::<Result<Vec<_>>>()?;
    let mut found = ElementSearch::new(deck, limit);
    let mut level = 0..1;
    for _ in 0..depth {
        for k in level.clone() {
            found.grow(k, &letters, |_| true, control)?;
        }
        level = level.end..found.elements.len();
    }
    Ok(found.elements)
}

/// All deck elements that move the centre of a Dirichlet domain by at most `radius`, each once, nearest first.
///
/// The segment from the centre to such an image runs through neighbouring copies of the domain that all meet the disk of that radius. So
/// all are reached by steps over sides, and steps to copies outside the disk are not taken.
///
/// # Errors
/// Those of [`elements_to_depth`].
pub fn elements_within(
    deck: &DeckGroup,
    domain: &DirichletDomain,
    radius: f64,
    limit: usize,
    control: &Control,
) -> Result<Vec<DeckElement>> {
    let home = Motion::to_origin(deck.space, precise_point(deck.space, domain.centre));
    let moved = |g: &Motion<DoubleDouble>| g.conjugated_by(&home).displacement();
    // The centre is as far from γ D as γ⁻¹ of the centre is from D.
    let lines = domain.lines();
    let meets = |g: &Motion<DoubleDouble>| {
        let centre = g.inverse().conjugated_by(&home).origin();
        !lines.keep_off(deck.space, centre, radius)
    };
    let sides: Vec<DeckElement> = domain.neighbours().cloned().collect();
    let found = elements_reached(deck, &sides, meets, limit, control)?;
    let mut near: Vec<(f64, DeckElement)> =
        found.into_iter().map(|g| (moved(&g.motion), g)).filter(|(d, _)| *d <= radius).collect();
    near.sort_by(|(a, g), (b, h)| {
        a.total_cmp(b).then_with(|| g.word.len().cmp(&h.word.len())).then_with(|| g.word.cmp(&h.word))
    });
    Ok(near.into_iter().map(|(_, g)| g).collect())
}

/// The wanted deck elements that are reached from the identity over `sides`, by way of wanted elements alone, each once.
///
/// # Errors
/// Those of [`elements_to_depth`].
pub fn elements_reached(
    deck: &DeckGroup,
    sides: &[DeckElement],
    wanted: impl Fn(&Motion<DoubleDouble>) -> bool,
    limit: usize,
    control: &Control,
) -> Result<Vec<DeckElement>> {
    let mut found = ElementSearch::new(deck, limit);
    let mut next = 0;
    while next < found.elements.len() {
        found.grow(next, sides, &wanted, control)?;
        next += 1;
    }
    Ok(found.elements)
}

/// A search for deck elements, with those that were found arranged by two properties in which equal elements agree.
struct ElementSearch {
    group: SurfaceGroup,
    elements: Vec<DeckElement>,
    /// The elements by their image in the abelianisation and their displacement in units of `same`.
    alike: HashMap<(Vec<i64>, i64), Vec<u32>>,
    limit: usize,
    /// [`SAME`] as a length: in E² in units of the longest generator.
    same: f64,
}

impl ElementSearch {
    fn new(deck: &DeckGroup, limit: usize) -> ElementSearch {
        let longest = deck.generators.iter().map(Motion::displacement).fold(0.0, f64::max);
        let mut found = ElementSearch {
            group: deck.group,
            elements: Vec::new(),
            alike: HashMap::new(),
            limit: limit.max(1),
            same: if deck.space == Space::E2 && longest > 0.0 { SAME * longest } else { SAME },
        };
        let identity = DeckElement::identity(deck.space);
        let key = found.key(&identity);
        found.insert(identity, key);
        found
    }

    /// Multiplies element `k` by the factors from the right, and keeps the products that are new and wanted.
    fn grow(
        &mut self,
        k: usize,
        factors: &[DeckElement],
        wanted: impl Fn(&Motion<DoubleDouble>) -> bool,
        control: &Control,
    ) -> Result<()> {
        if k.is_multiple_of(ELEMENTS_PER_STEP) {
            control.check()?;
        }
        for factor in factors {
            let from = &self.elements[k];
            let motion = from.motion.compose(&factor.motion);
            if !wanted(&motion) {
                continue;
            }
            let word = self.group.reduce(&from.word.times(&factor.word));
            let next = DeckElement { word, motion };
            let key = self.key(&next);
            if self.contains(&next, &key) {
                continue;
            }
            if self.elements.len() >= self.limit {
                return Err(Error::TooLarge {
                    what: "copies of the fundamental domain",
                    count: self.limit + 1,
                });
            }
            self.insert(next, key);
        }
        Ok(())
    }

    fn key(&self, g: &DeckElement) -> (Vec<i64>, i64) {
        (self.group.abelianisation(&g.word), (g.motion.displacement() / self.same).floor() as i64)
    }

    fn contains(&self, g: &DeckElement, key: &(Vec<i64>, i64)) -> bool {
        [-1, 0, 1].iter().any(|step| {
            let near = self.alike.get(&(key.0.clone(), key.1 + step));
            near.is_some_and(|all| {
                all.iter().any(|&k| self.group.equal(&self.elements[k as usize].word, &g.word))
            })
        })
    }

    fn insert(&mut self, g: DeckElement, key: (Vec<i64>, i64)) {
        self.alike.entry(key).or_default().push(self.elements.len() as u32);
        self.elements.push(g);
    }
}

/// The images of points in ambient coordinates under an isometry, computed in double-double precision, in parallel inside a pool.
pub fn moved(points: &[[f64; 3]], motion: &Motion<DoubleDouble>) -> Vec<[f64; 3]> {
    let mut out = vec![[0.0; 3]; points.len()];
    parallel::fill(&mut out, |k| motion.apply(precise_point(motion.space, points[k])).map(f64::from));
    out
}
