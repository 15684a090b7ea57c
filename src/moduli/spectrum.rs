//! The length spectrum of a hyperbolic surface or a flat torus: its closed geodesics up to a length.
//!
//! ```
//! use ricci::canonical::{QuotientOptions, uniformize_quotient};
//! use ricci::moduli::{SpectrumOptions, length_spectrum};
//! use ricci::{Control, Surface, mesh::shapes};
//! # fn main() -> ricci::Result<()> {
//! let bolza = shapes::bolza(1)?;
//! let (mesh, lengths) = bolza.build()?;
//! let surface = Surface::intrinsic(mesh, lengths, bolza.geometry)?;
//! let control = Control::new();
//! let quotient = uniformize_quotient(&surface, &QuotientOptions::default(), &control)?;
//! let spectrum = length_spectrum(&quotient, &SpectrumOptions { longest: 3.1, ..Default::default() }, &control)?;
//! // The shortest closed geodesics of the Bolza surface: twelve of length 2 arcosh(1 + √2).
//! assert_eq!(spectrum.classes.len(), 12);
//! assert!(spectrum.classes.iter().all(|c| (c.length - 2.0 * (1.0 + 2f64.sqrt()).acosh()).abs() < 1e-10));
//! # Ok(())
//! # }
//! ```

use crate::canonical::Quotient;
use crate::control::{Control, Stage};
use crate::embed::cover::elements_within;
use crate::embed::{DeckElement, DeckGroup, dirichlet_domain};
use crate::error::{Error, Result};
use crate::geometry::{DoubleDouble, Motion, Space};
use crate::mesh::union_find::UnionFind;
use crate::parallel;
use crate::topology::{SurfaceGroup, Word};
use std::collections::HashMap;

/// The options of [`length_spectrum`].
#[derive(Debug, Clone, Copy)]
pub struct SpectrumOptions {
    /// The largest length, above 0.
    pub longest: f64,
    /// Most deck transformations that are formed. Default: a million.
    pub limit: usize,
}

impl Default for SpectrumOptions {
    fn default() -> Self {
        SpectrumOptions { longest: 5.0, limit: 1_000_000 }
    }
}

/// A closed geodesic, without an orientation: a conjugacy class of the deck group together with that of the inverses.
#[derive(Debug, Clone)]
pub struct GeodesicClass {
    /// An element of the class, the shortest word of those that were found.
    pub element: DeckElement,
    /// The length of the geodesic.
    pub length: f64,
    /// How often it runs around the primitive geodesic on the same line; 1 for that itself.
    pub power: usize,
}

/// All closed geodesics of a surface up to a length.
#[derive(Debug, Clone)]
pub struct LengthSpectrum {
    /// The closed geodesics by length, each once; a boundary loop is one of them.
    pub classes: Vec<GeodesicClass>,
    /// The largest length that was asked for.
    pub longest: f64,
    /// The distance up to which deck transformations were searched.
    pub reach: f64,
    /// Number of deck transformations that were found.
    pub n_elements: usize,
}

/// Amount by which lengths and distances are raised against rounding: relative in E², a length in H².
const ROUNDING: f64 = 1e-9;
/// Largest difference of displacements, in H² a length and in E² relative to the largest, for which two elements are compared as words.
const SAME: f64 = 1e-6;

impl LengthSpectrum {
    /// The lengths with their multiplicities, ascending: neighbours that differ by at most `tolerance` are one length, their mean.
    pub fn multiplicities(&self, tolerance: f64) -> Vec<(f64, usize)> {
        let close = |a: &GeodesicClass, b: &GeodesicClass| b.length - a.length <= tolerance;
        let mean = |of: &[GeodesicClass]| of.iter().map(|c| c.length).sum::<f64>() / of.len() as f64;
        self.classes.chunk_by(close).map(|of| (mean(of), of.len())).collect()
    }
}

/// The length of the closed geodesic that is freely homotopic to a word in the generators: 0 for a loop that can be contracted.
///
/// # Errors
/// Those of [`DeckGroup::motion`].
pub fn geodesic_length(deck: &DeckGroup, word: &Word) -> Result<f64> {
    let reduced = deck.group.reduce(word);
    Ok(if reduced.is_empty() { 0.0 } else { deck.motion(&reduced)?.translation_length() })
}

/// All closed geodesics up to a length, complete: with D the Dirichlet domain of the base, of radius R, every closed geodesic has a lift
/// that meets D. The element that translates along this by l moves the base, at a distance r ≤ R from the line, by d with
/// `sinh(d/2) = cosh r sinh(l/2)` in H², by l in E². So the elements that move it by at most `2 arsinh(cosh R sinh(L/2))` hold all classes.
/// Those of one class are related by the elements of sides of D, over which their lines lead from copy to copy of D.
///
/// # Errors
/// [`Error::Argument`] for a length that is not above 0; those of [`dirichlet_domain`] and [`elements_within`].
pub fn length_spectrum(
    quotient: &Quotient,
    options: &SpectrumOptions,
    control: &Control,
) -> Result<LengthSpectrum> {
    let longest = options.longest;
    if !(longest > 0.0 && longest.is_finite()) {
        return Err(Error::argument("largest length", longest, "a number above 0"));
    }
    let deck = &quotient.deck;
    control.step(Stage::Layout, 0.0)?;
    let domain = dirichlet_domain(deck, [0.0, 0.0, 1.0], quotient.layout.area, &control.part(0.0, 0.1))?;
    let radius = domain.radius + ROUNDING;
    let reach = match deck.space {
        Space::H2 => 2.0 * (radius.cosh() * (0.5 * longest).sinh()).asinh() + ROUNDING,
        _ => longest * (1.0 + ROUNDING),
    };
    let all = elements_within(deck, &domain, reach, options.limit, &control.part(0.1, 0.5))?;
    let n_elements = all.len();
    let most = longest * (1.0 + ROUNDING);
    let is_short = |g: &DeckElement| !g.word.is_empty() && g.motion.translation_length() <= most;
    let short: Vec<DeckElement> = all.into_iter().filter(is_short).collect();
    let index = ElementIndex::new(deck.group, &short);
    let sides: Vec<DeckElement> = domain.neighbours().cloned().collect();
    let mut classes = conjugacy_classes(&index, &sides, control)?;
    let found = numbered(&index, &mut classes);
    let powers = powers(&index, &found, longest, control)?;
    let mut classes: Vec<GeodesicClass> = found
        .members
        .iter()
        .zip(powers)
        .map(|(&k, power)| {
            let element = short[k as usize].clone();
            GeodesicClass { length: element.motion.translation_length(), element, power }
        })
        .collect();
    classes.sort_by(|a, b| {
        let by_word =
            || (a.element.word.len(), &a.element.word).cmp(&(b.element.word.len(), &b.element.word));
        a.length.total_cmp(&b.length).then_with(by_word)
    });
    control.step(Stage::Layout, 1.0)?;
    Ok(LengthSpectrum { classes, longest, reach, n_elements })
}

/// Elements that are found again by what equal elements have in common.
struct ElementIndex<'a> {
    group: SurfaceGroup,
    elements: &'a [DeckElement],
    /// Numbers of elements by their image in the abelianisation and their displacement in units of `same`.
    alike: HashMap<(Vec<i64>, i64), Vec<u32>>,
    same: f64,
}

impl ElementIndex<'_> {
    fn new(group: SurfaceGroup, elements: &[DeckElement]) -> ElementIndex<'_> {
        let farthest = elements.iter().map(|g| g.motion.displacement()).fold(0.0, f64::max);
        let is_flat = elements.first().is_some_and(|g| g.motion.space == Space::E2);
        let same = if is_flat { SAME * farthest } else { SAME };
        let mut index = ElementIndex { group, elements, alike: HashMap::new(), same };
        for (k, g) in elements.iter().enumerate() {
            let key = index.key(g);
            index.alike.entry(key).or_default().push(k as u32);
        }
        index
    }

    fn key(&self, g: &DeckElement) -> (Vec<i64>, i64) {
        (self.group.abelianisation(&g.word), (g.motion.displacement() / self.same).floor() as i64)
    }

    /// The number of an element, if it is one of them.
    fn find(&self, g: &DeckElement) -> Option<u32> {
        let (homology, step) = self.key(g);
        [0, -1, 1].iter().find_map(|near| {
            let all = self.alike.get(&(homology.clone(), step + near))?;
            all.iter().copied().find(|&k| self.group.equal(&self.elements[k as usize].word, &g.word))
        })
    }
}

/// Elements of one set are conjugate to each other or to the inverses.
fn conjugacy_classes(index: &ElementIndex, sides: &[DeckElement], control: &Control) -> Result<UnionFind> {
    let neighbours = parallel::map(index.elements.len(), |k| {
        if control.check().is_err() {
            return Vec::new();
        }
        let g = &index.elements[k];
        let conjugates = sides.iter().map(|side| {
            let word = side.word.inverse().times(&g.word).times(&side.word);
            let motion: Motion<DoubleDouble> = side.motion.inverse().compose(&g.motion).compose(&side.motion);
            DeckElement { word: index.group.reduce(&word), motion }
        });
        conjugates.chain([g.inverse()]).filter_map(|h| index.find(&h)).collect()
    });
    control.step(Stage::Layout, 0.9)?;
    let mut classes = UnionFind::new(index.elements.len());
    for (k, found) in neighbours.into_iter().enumerate() {
        found.into_iter().for_each(|h| {
            classes.join(k as u32, h);
        });
    }
    Ok(classes)
}

/// Classes with a member of each.
struct NumberedClasses {
    /// Per class its member with the shortest word.
    members: Vec<u32>,
    /// Per element its class.
    of: Vec<u32>,
}

fn numbered(index: &ElementIndex, classes: &mut UnionFind) -> NumberedClasses {
    let mut number: HashMap<u32, u32> = HashMap::new();
    let (mut members, mut of) = (Vec::<u32>::new(), Vec::new());
    let rank = |k: u32| {
        let word = &index.elements[k as usize].word;
        (word.len(), word)
    };
    for k in 0..index.elements.len() as u32 {
        let root = classes.root(k);
        let class = *number.entry(root).or_insert_with(|| {
            members.push(k);
            members.len() as u32 - 1
        });
        let best = &mut members[class as usize];
        if rank(k) < rank(*best) {
            *best = k;
        }
        of.push(class);
    }
    NumberedClasses { members, of }
}

/// Per class the largest k for which its elements are k-th powers.
fn powers(
    index: &ElementIndex,
    found: &NumberedClasses,
    longest: f64,
    control: &Control,
) -> Result<Vec<usize>> {
    let mut powers = vec![1; found.members.len()];
    let mut steps = 0;
    // The line of the power of an element is the line of the element, so that powers of elements that were found are among them: those of
    // any element of a class will do.
    for (k, g) in index.elements.iter().enumerate() {
        control.check_every(256, &mut steps)?;
        let length = g.motion.translation_length();
        let (mut power, mut times) = (g.clone(), 1);
        while (times + 1) as f64 * length <= longest * (1.0 + ROUNDING) {
            times += 1;
            let word = index.group.reduce(&power.word.times(&g.word));
            power = DeckElement { word, motion: power.motion.compose(&g.motion) };
            if let Some(h) = index.find(&power) {
                let class = found.of[h as usize] as usize;
                if class != found.of[k] as usize {
                    powers[class] = powers[class].max(times);
                }
            }
        }
    }
    Ok(powers)
}
