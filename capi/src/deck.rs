//! Deck transformations: elements of the deck group as words with their isometries.

use crate::arrays::{
    CallerBuffer, ambient, array, check_buffer, copy_counted, copy_each, copy_out, copy_rows,
};
use crate::choice::choices;
use crate::control::{self, ricci_control};
use crate::dirichlet::ricci_dirichlet;
use crate::failure::{Failure, FailureElement, Outcome, no_such};
use crate::guard::{self, handle, shared};
use crate::memory;
use crate::mesh::SPACES;
use crate::paths::{letters, word_of};
use crate::status::ricci_status;
use crate::structs::{self, sized};
use crate::uniformize::ricci_uniform;
use ricci::canonical::Quotient;
use ricci::embed::cover::{elements_to_depth, elements_within, moved};
use ricci::embed::{DeckElement, DeckGroup};
use ricci::geometry::{Motion, Space};
use ricci::moduli::{SpectrumOptions, geodesics_on_surface, length_spectrum};
use ricci::parallel::within;
use ricci::topology::Letter;
use std::sync::Arc;

/// Most elements that memory is reserved for: the caller's limit only says where to stop, and is rarely reached.
pub(crate) const MOST_RESERVED: usize = 1 << 16;

choices!(enum DeckKind, KINDS = "kind", [
    RICCI_DECK_GENERATORS => Generators,
    RICCI_DECK_SIDES => Sides,
    RICCI_DECK_WORDS => Words,
    RICCI_DECK_DEPTH => Depth,
    RICCI_DECK_WITHIN => Within,
    RICCI_DECK_DIRICHLET_SIDES => DirichletSides,
    RICCI_DECK_GEODESICS => Geodesics,
]);

choices!(enum DeckValues, VALUES = "which", [
    RICCI_DECK_MOBIUS => Mobius,
    RICCI_DECK_MATRIX => Matrices,
    RICCI_DECK_TRACE => Traces,
    RICCI_DECK_LENGTH => Lengths,
    RICCI_DECK_POWER => Powers,
]);

pub struct ricci_deck {
    space: Space,
    pub(crate) quotient: Arc<Quotient>,
    pub(crate) elements: Vec<DeckElement>,
    /// How often each closed geodesic runs around, where they are asked for.
    powers: Option<Vec<f64>>,
}
handle!(ricci_deck, "deck");

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_deck_spec {
    pub size: usize,
    pub kind: u32,
    pub reserved: u32,
    pub letters: *const i32,
    pub n_letters: usize,
    pub starts: *const usize,
    pub n_words: usize,
    pub dirichlet: *const ricci_dirichlet,
    pub radius: f64,
    pub depth: usize,
    pub limit: usize,
}
// SAFETY: numbers and raw pointers; 8-byte alignment, size first.
sized!(ricci_deck_spec, "deck", reserved);

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_deck_summary {
    pub size: usize,
    pub space: u32,
    pub longest: u32,
    pub n_elements: usize,
    pub n_letters: usize,
}
// SAFETY: numbers; 8-byte alignment, size first.
sized!(ricci_deck_summary, "summary");

/// The elements of the caller's words, whose letters come one after the other with the offset at which each word starts.
fn of_words(group: &DeckGroup, spec: &ricci_deck_spec) -> Outcome<Vec<DeckElement>> {
    let &ricci_deck_spec { n_letters, starts, n_words, .. } = spec;
    let starts = array("starts", starts, n_words.saturating_add(1))?;
    let ascending = starts.windows(2).all(|pair| pair[0] <= pair[1]);
    if !ascending || starts.first() != Some(&0) || starts.last() != Some(&n_letters) {
        return Err(Failure::argument(format!("starts must ascend from 0 to n_letters, {n_letters}")));
    }
    let all = array("letters", spec.letters, n_letters)?;
    let element = |row: &[usize]| {
        let word = word_of(&group.group, "letters", &all[row[0]..row[1]], row[0])?;
        let word = group.group.reduce(&word);
        Ok(DeckElement { motion: group.motion(&word)?, word })
    };
    starts.windows(2).map(element).collect()
}

fn generators(group: &DeckGroup) -> Vec<DeckElement> {
    let element = |(k, &motion)| DeckElement { word: [Letter::generator(k)].into_iter().collect(), motion };
    group.generators.iter().enumerate().map(element).collect()
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_deck_new(
    uniform: *const ricci_uniform,
    spec: *const ricci_deck_spec,
    control: *const ricci_control,
    deck: *mut *mut ricci_deck,
) -> ricci_status {
    guard::make(deck, || {
        let threads = control::threads(control);
        let (spec, control) = (structs::read(spec)?, control::of(control)?);
        let quotient = shared(uniform)?.quotient()?;
        let group = &quotient.deck;
        let kind = KINDS.choose(spec.kind)?;
        let is_search = matches!(kind, DeckKind::Depth | DeckKind::Within | DeckKind::Geodesics);
        let looked_at = if is_search { spec.limit } else { 0 };
        let mut powers = None;
        let _reserve = memory::work(looked_at.min(MOST_RESERVED), memory::ELEMENT)?;
        let elements = match kind {
            DeckKind::Generators => generators(group),
            DeckKind::Sides => group.sides.clone(),
            DeckKind::Words => of_words(group, &spec)?,
            DeckKind::Depth => elements_to_depth(group, spec.depth, spec.limit, &control)?,
            DeckKind::Within if spec.radius.is_nan() => {
                return Err(Failure::argument("radius is not a number"));
            }
            DeckKind::Within => {
                elements_within(group, shared(spec.dirichlet)?.of(group)?, spec.radius, spec.limit, &control)?
            }
            DeckKind::DirichletSides => shared(spec.dirichlet)?.of(group)?.sides.clone(),
            DeckKind::Geodesics => {
                let options = SpectrumOptions { longest: spec.radius, limit: spec.limit };
                let found = within(threads, || length_spectrum(quotient, &options, &control))?.classes;
                powers = Some(found.iter().map(|class| class.power as f64).collect());
                found.into_iter().map(|class| class.element).collect()
            }
        };
        Ok(ricci_deck { space: group.space, quotient: quotient.clone(), elements, powers })
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_deck_free(deck: *mut ricci_deck) {
    guard::free(deck);
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_deck_summarise(
    deck: *const ricci_deck,
    summary: *mut ricci_deck_summary,
    size: usize,
) -> ricci_status {
    guard::with(deck, |deck| {
        let lengths = || deck.elements.iter().map(|g| g.word.len());
        let figures = ricci_deck_summary {
            size,
            space: SPACES.number(deck.space)?,
            longest: lengths().max().unwrap_or(0) as u32,
            n_elements: deck.elements.len(),
            n_letters: lengths().sum(),
        };
        structs::write(figures, summary, size)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_deck_words(
    deck: *const ricci_deck,
    words: *mut i32,
    words_capacity: usize,
    starts: *mut usize,
    starts_capacity: usize,
) -> ricci_status {
    guard::with(deck, |deck| {
        let rows = deck.elements.iter().map(|g| letters(&g.word));
        copy_rows("words", rows, CallerBuffer(words, words_capacity), CallerBuffer(starts, starts_capacity))
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_deck_values(
    deck: *const ricci_deck,
    which: u32,
    values: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(deck, |deck| {
        let (n, motions) = (deck.elements.len(), deck.elements.iter().map(|g| &g.motion));
        match VALUES.choose(which)? {
            DeckValues::Mobius => copy_each("values", n, motions.map(|g| g.mobius()), values, capacity),
            DeckValues::Matrices => {
                let rows = motions.map(|g| g.matrix().map(|row| row.map(f64::from)));
                copy_each("values", n, rows, values, capacity)
            }
            DeckValues::Traces => {
                let traces = motions.map(|g| 2.0 * f64::from(g.half_trace()).abs());
                copy_each("values", n, traces, values, capacity)
            }
            DeckValues::Lengths => {
                copy_each("values", n, motions.map(Motion::translation_length), values, capacity)
            }
            DeckValues::Powers => match &deck.powers {
                Some(powers) => copy_out("values", powers, values, capacity),
                None => Err(Failure::argument("powers are known of RICCI_DECK_GEODESICS alone")),
            },
        }
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_deck_apply(
    deck: *const ricci_deck,
    element: usize,
    points: *const f64,
    n_points: usize,
    moved: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(deck, |deck| {
        let count = deck.elements.len();
        let g = deck.elements.get(element);
        let g = g.ok_or_else(|| no_such(FailureElement::Entry, "element", element, count))?;
        copy_out("moved", &self::moved(&ambient("points", points, n_points)?, &g.motion), moved, capacity)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_deck_geodesic(
    deck: *const ricci_deck,
    element: usize,
    control: *const ricci_control,
    faces: *mut u32,
    faces_capacity: usize,
    weights: *mut f64,
    weights_capacity: usize,
    n_points: *mut usize,
) -> ricci_status {
    guard::with(deck, |deck| {
        let (quotient, control) = (&deck.quotient, control::of(control)?);
        let count = deck.elements.len();
        let g = deck.elements.get(element);
        let g = g.ok_or_else(|| no_such(FailureElement::Entry, "element", element, count))?;
        let _reserve = memory::work(quotient.metric.mesh().n_vertices(), memory::LAYOUT)?;
        let line = geodesics_on_surface(quotient, [&g.motion], &control)?.concat();
        let of_faces: Vec<u32> = line.iter().map(|place| place.face.0).collect();
        if faces_capacity > 0 {
            check_buffer("weights", 3 * line.len(), weights, weights_capacity)?;
        }
        copy_counted("faces", &of_faces, faces, faces_capacity, n_points)?;
        if faces_capacity == 0 {
            return Ok(());
        }
        let rows: Vec<[f64; 3]> = line.iter().map(|place| place.weights).collect();
        copy_out("weights", &rows, weights, weights_capacity)
    })
}
