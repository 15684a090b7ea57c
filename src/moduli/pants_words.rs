//! Decompositions into pairs of pants that are named by words: lengths, and twists modulo half of the length.

use super::fenchel_nielsen::{MinkowskiVector, PantsCurve, determinant, foot, normal, product};
use crate::canonical::Quotient;
use crate::control::Control;
use crate::embed::cover::elements_within;
use crate::embed::{DeckElement, DirichletDomain, dirichlet_domain};
use crate::error::{Error, Result};
use crate::geometry::{DoubleDouble, Motion, Space};
use crate::topology::{Letter, Word};

/// Largest difference of the product of unit normals from 1 for which two lines may be one, and of the entries of normals that are one.
const ONE_LINE: f64 = 1e-7;
/// Distance by which a search is widened until it finds the neighbours of every curve.
const WIDENING: f64 = 0.75;
/// Most lifts of a curve that come near the base.
const MOST_LIFTS: usize = 100_000;

/// A closed geodesic with its lifts that come as near to the base as a corner of the Dirichlet domain.
struct CurveLifts {
    name: String,
    length: f64,
    /// The translation along the first lift.
    along: Motion<DoubleDouble>,
    /// The motions that bring the first lift to each, with the unit normals.
    lifts: Vec<(Motion<DoubleDouble>, MinkowskiVector)>,
}

/// Curves that cut a hyperbolic surface into pairs of pants, as words in the generators of its deck group: their lengths and twists. A curve has two
/// seams on each side, half of its length apart, so without further loops a twist is known modulo half of the length: it is that between
/// −1/4 and 1/4 of it. At most `limit` deck transformations are formed in the search.
///
/// Points where closed geodesics cross, and feet of seams, have lifts in the Dirichlet domain, of radius R. So all crossings are seen between lifts that meet
/// it, and a lift at the distance s from one is brought there by an element that moves the base by at most 2 R + s.
///
/// # Errors
/// [`Error::Layout`] for a surface that is not hyperbolic, a word that is no simple closed curve, that runs along a boundary loop, or can be
/// contracted, two that cross or are one curve; [`Error::Size`] for another number of words than 3g − 3 + b; [`Error::TooLarge`];
/// [`Error::Cancelled`].
pub fn pants_of_words(
    quotient: &Quotient,
    words: &[Word],
    limit: usize,
    control: &Control,
) -> Result<Vec<PantsCurve>> {
    let deck = &quotient.deck;
    let (g, b) = (deck.group.genus, deck.group.boundaries);
    if deck.space != Space::H2 {
        return Err(Error::Layout("only hyperbolic surfaces are cut into pairs of pants".into()));
    }
    let needed = (3 * g + b).saturating_sub(3);
    crate::error::check_size("curves of a decomposition into pairs of pants", words.len(), needed)?;
    let domain = dirichlet_domain(deck, [0.0, 0.0, 1.0], quotient.layout.area, &control.part(0.0, 0.2))?;
    let boundary = (2 * g..2 * g + b).map(|k| Word::from_iter([Letter::generator(k)]));
    let all: Vec<Word> = words.iter().cloned().chain(boundary).collect();
    let curve = |word: &Word| CurveLifts::new(quotient, &domain, word);
    let curves: Vec<CurveLifts> = all.iter().map(curve).collect::<Result<_>>()?;
    check_disjoint(&curves)?;
    let mut beyond = WIDENING;
    loop {
        let reach = 2.0 * domain.radius + beyond;
        let elements = elements_within(deck, &domain, reach, limit, &control.part(0.2, 0.6))?;
        let near = |i: usize| neighbours(&curves, i, &elements, beyond, &control.part(0.6, 0.9));
        let nearest: Vec<[Option<MinkowskiVector>; 2]> = (0..words.len()).map(near).collect::<Result<_>>()?;
        if nearest.iter().flatten().all(Option::is_some) {
            let of = |(i, word): (usize, &Word)| coordinates(&curves[i], word, &nearest[i]);
            return Ok(words.iter().enumerate().filter_map(of).collect());
        }
        beyond += WIDENING;
    }
}

impl CurveLifts {
    fn new(quotient: &Quotient, domain: &DirichletDomain, word: &Word) -> Result<CurveLifts> {
        let group = quotient.deck.group;
        let name = group.text(word);
        let reduced = group.reduce(word);
        let mut motion = quotient.deck.motion(&reduced)?;
        let length = motion.translation_length();
        if reduced.is_empty() || length <= 0.0 {
            return Err(no_pants(&format!("{name} can be contracted")));
        }
        while let Some(nearer) = domain.neighbours().map(|g| motion.conjugated_by(&g.motion.inverse())).find(
            // Moves that shorten by rounding alone would run in circles.
            |m| height(&normal(m)) < height(&normal(&motion)) * (1.0 - 1e-9) - 1e-12,
        ) {
            motion = nearer.normalised();
        }
        let lifts = vec![(Motion::identity(Space::H2), normal(&motion))];
        let mut curve = CurveLifts { name, length, along: motion, lifts };
        curve.find_lifts(domain)?;
        Ok(curve)
    }

    /// Finds the lifts from that of the word. A geodesic leads from copy to copy of the domain, so those that meet it are connected over its
    /// sides.
    fn find_lifts(&mut self, domain: &DirichletDomain) -> Result<()> {
        let most = domain.radius.sinh() * (1.0 + ONE_LINE) + ONE_LINE;
        let first = self.lifts[0].1;
        let mut next = 0;
        while next < self.lifts.len() {
            for side in domain.neighbours() {
                let moved = side.motion.compose(&self.lifts[next].0).normalised();
                let line = moved.apply(first);
                if height(&line) > most {
                    continue;
                }
                let Some((known, _)) = self.lifts.iter().find(|(_, n)| is_one(n, &line)) else {
                    self.lifts.push((moved, line));
                    continue;
                };
                let along = known.inverse().compose(&moved).translation_length();
                if along > ONE_LINE && along < self.length * (1.0 - ONE_LINE) {
                    return Err(no_pants(&format!("{} runs around another loop several times", self.name)));
                }
            }
            next += 1;
            if next > MOST_LIFTS {
                return Err(Error::TooLarge { what: "lifts of a closed geodesic", count: next });
            }
        }
        Ok(())
    }
}

/// The hyperbolic sine of the distance of a line from the base.
fn height(normal: &MinkowskiVector) -> f64 {
    normal[2].high.abs()
}

/// True for two normals that are equal but for rounding.
fn is_one(n: &MinkowskiVector, m: &MinkowskiVector) -> bool {
    (0..3).all(|k| (n[k] - m[k]).high.abs() <= ONE_LINE * (1.0 + n[2].high.abs()))
}

fn no_pants(why: &str) -> Error {
    Error::Layout(format!("the words name no decomposition into pairs of pants: {why}"))
}

/// Checks that curves neither cross nor are one.
fn check_disjoint(curves: &[CurveLifts]) -> Result<()> {
    for (i, mine) in curves.iter().enumerate() {
        for (j, other) in curves.iter().enumerate().take(i + 1) {
            for (k, (_, n)) in mine.lifts.iter().enumerate() {
                for (l, (_, m)) in other.lifts.iter().enumerate() {
                    let cosh = product(n, m).high.abs();
                    let is_line = is_one(n, m) || is_one(n, &m.map(|x| -x));
                    if i != j && is_line {
                        return Err(no_pants(&format!("{} and {} are one curve", other.name, mine.name)));
                    }
                    if i == j && k != l && cosh < 1.0 && !is_line {
                        return Err(no_pants(&format!("{} crosses itself", mine.name)));
                    }
                    if i != j && cosh < 1.0 {
                        return Err(no_pants(&format!("{} and {} cross", other.name, mine.name)));
                    }
                }
            }
        }
    }
    Ok(())
}

/// A line beside the first lift of a curve.
struct Candidate {
    /// The hyperbolic cosine of the distance.
    cosh: f64,
    normal: MinkowskiVector,
    /// True if it cannot bound the same pair of pants on another cuff: a lift of the same curve with its same side turned to this one.
    is_own: bool,
}

/// The feet on the first lift of curve i of the shortest seams on its left and on its right, within a distance.
///
/// The seams of a pair of pants lead to the nearest lifts of other cuffs that no lift separates from the first. A curve that is two cuffs of
/// it turns different sides to it.
fn neighbours(
    curves: &[CurveLifts],
    i: usize,
    elements: &[DeckElement],
    beyond: f64,
    control: &Control,
) -> Result<[Option<MinkowskiVector>; 2]> {
    let (mut found, mut steps, most) = ([Vec::new(), Vec::new()], 0, beyond.cosh());
    for g in elements {
        control.check_every(16, &mut steps)?;
        for (j, curve) in curves.iter().enumerate() {
            for line in curve.lifts.iter().map(|(_, n)| g.motion.apply(*n)) {
                for (motion, n) in &curves[i].lifts {
                    let cosh = product(n, &line).high.abs();
                    let is_line = cosh < 1.0 + ONE_LINE && (is_one(n, &line) || is_one(n, &line.map(|x| -x)));
                    if is_line || cosh <= 1.0 || cosh > most {
                        continue;
                    }
                    let (Some(at), Some(own)) = (is_right(n, &line), is_right(&line, n)) else { continue };
                    let normal = motion.inverse().apply(line);
                    found[usize::from(at)].push(Candidate { cosh, normal, is_own: i == j && at == own });
                }
            }
        }
    }
    let first = &curves[i].lifts[0].1;
    Ok(found.map(|mut side| {
        side.sort_by(|a, b| a.cosh.total_cmp(&b.cosh));
        let k = (0..side.len()).find(|&k| !side[k].is_own && !is_hidden(&curves[i], &side[..k], &side[k]))?;
        foot(first, &side[k].normal)
    }))
}

/// True if the second of two disjoint lines lies to the right of the first; `None` for lines that meet.
fn is_right(n: &MinkowskiVector, line: &MinkowskiVector) -> Option<bool> {
    Some(product(n, &foot(line, n)?).high > 0.0)
}

/// True if one of some nearer lines, or its image under the translation along the curve, separates a line from the curve's first lift.
fn is_hidden(curve: &CurveLifts, nearer: &[Candidate], line: &Candidate) -> bool {
    let n = &curve.lifts[0].1;
    let images = |p: &MinkowskiVector| [*p, curve.along.apply(*p), curve.along.inverse().apply(*p)];
    let separates = |p: MinkowskiVector| {
        let sides = (is_right(&p, n), is_right(&p, &line.normal));
        matches!(sides, (Some(a), Some(b)) if a != b) && !is_one(&p, &line.normal)
    };
    nearer.iter().flat_map(|p| images(&p.normal)).any(separates)
}

/// The coordinates of a curve, once its neighbours on both sides are known.
fn coordinates(
    curve: &CurveLifts,
    word: &Word,
    nearest: &[Option<MinkowskiVector>; 2],
) -> Option<PantsCurve> {
    let [Some(left), Some(right)] = nearest else { return None };
    // As in the twists of canonical decompositions, after the normal the feet are ordered along the curve.
    let raw = -determinant([&curve.lifts[0].1, right, left]).high.asinh();
    let half = 0.5 * curve.length;
    let twist = raw - (raw / half).round() * half;
    Some(PantsCurve { name: curve.name.clone(), word: word.clone(), length: curve.length, twist })
}
