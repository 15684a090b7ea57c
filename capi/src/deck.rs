//! Deck transformations: words with their isometries.

use crate::arrays::{ambient, array, copy_out, copy_rows};
use crate::choice::name;
use crate::control::{self, ricci_control};
use crate::failure::{Failure, Outcome};
use crate::guard::{self, Poison, handle};
use crate::letters;
use crate::quotient::ricci_quotient;
use crate::sized::{self, sized};
use crate::space::ricci_space;
use crate::status::ricci_status;
use ricci::embed::cover::{elements_to_depth, moved};
use ricci::embed::{DeckElement, DeckGroup};
use ricci::geometry::{Motion, Space, Twofold};

/// Deck transformations of a quotient, each as a word in the generators and as an isometry: its generators, the pairings of a polygon's
/// sides, the copies of a domain in the universal cover. They act from the left: M(g h) = M(g) M(h).
///
/// Isometries are kept to twice the digits of doubles; ricci_deck_apply uses them.
pub struct ricci_deck {
    poison: Poison,
    space: Space,
    elements: Vec<DeckElement>,
}

handle!(ricci_deck, "deck");

impl ricci_deck {
    pub(crate) fn new(group: &DeckGroup, elements: Vec<DeckElement>) -> ricci_deck {
        ricci_deck { poison: Poison::default(), space: group.space, elements }
    }

    pub(crate) fn generators(group: &DeckGroup) -> ricci_deck {
        let element = |(k, motion): (usize, &Motion<Twofold>)| DeckElement {
            word: [ricci::topology::Letter::generator(k)].into_iter().collect(),
            motion: *motion,
        };
        ricci_deck::new(group, group.generators.iter().enumerate().map(element).collect())
    }

    fn per_element(&self, value: impl Fn(&Motion<Twofold>) -> f64) -> Vec<f64> {
        self.elements.iter().map(|g| value(&g.motion)).collect()
    }
}

/// Figures of deck transformations.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_deck_summary {
    /// Bytes of this struct that are filled.
    pub size: usize,
    /// The space they act on.
    pub space: ricci_space,
    /// Most letters of a word.
    pub longest: u32,
    /// Number of elements.
    pub n_elements: usize,
    /// Number of letters of all words.
    pub n_letters: usize,
}

// SAFETY: only ever written by the library; 8-byte alignment, size first.
sized!(ricci_deck_summary, "summary");

/// The deck transformations of words.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT (no such letter; starts that do not ascend from 0 to n_letters).
///
/// @param quotient   the quotient.
/// @param letters    n_letters letters, word after word: k for generator k (1-based), -k for its inverse.
/// @param n_letters  number of letters of all words.
/// @param starts     n_words + 1 offsets: word i is letters[starts[i] .. starts[i + 1]).
/// @param n_words    number of words.
/// @param deck       out: the new handle, n_words elements with reduced words, to be released by ricci_deck_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_deck_of_words(
    quotient: *const ricci_quotient,
    letters: *const i32,
    n_letters: usize,
    starts: *const usize,
    n_words: usize,
    deck: *mut *mut ricci_deck,
) -> ricci_status {
    guard::make("deck", deck, |door| {
        let group = &door.shared(quotient)?.quotient.deck;
        let starts = array("starts", starts, n_words.saturating_add(1))?;
        let ascending = starts.windows(2).all(|pair| pair[0] <= pair[1]);
        if !ascending || starts.first() != Some(&0) || starts.last() != Some(&n_letters) {
            return Err(Failure::argument(format!("starts must ascend from 0 to n_letters, {n_letters}")));
        }
        let letters = array("letters", letters, n_letters)?;
        let element = |row: &[usize]| {
            let letters = &letters[row[0]..row[1]];
            let word = group.group.reduce(&letters::word_of(&group.group, "letters", letters, row[0])?);
            Ok(DeckElement { motion: group.motion(&word)?, word })
        };
        let elements: Outcome<Vec<_>> = starts.windows(2).map(element).collect();
        Ok(ricci_deck::new(group, elements?))
    })
}

/// All deck transformations of at most `depth` letters, each once, shortest first, the identity to begin with: the copies of a domain in
/// a piece of the universal cover.
///
/// Whether two words are the same element is decided in the group, not by coordinates.
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_TOO_LARGE (more than `limit`), RICCI_CANCELLED.
///
/// @param quotient  the quotient.
/// @param depth     most letters of a word in the generators.
/// @param limit     most elements.
/// @param control   cancellation; NULL for none.
/// @param deck      out: the new handle, to be released by ricci_deck_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_cover_to_depth(
    quotient: *const ricci_quotient,
    depth: usize,
    limit: usize,
    control: *const ricci_control,
    deck: *mut *mut ricci_deck,
) -> ricci_status {
    guard::make("deck", deck, |door| {
        let group = &door.shared(quotient)?.quotient.deck;
        let elements = elements_to_depth(group, depth, limit, &control::of(control))?;
        Ok(ricci_deck::new(group, elements))
    })
}

/// Release deck transformations.
///
/// @param deck  the handle, or NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_deck_free(deck: *mut ricci_deck) {
    guard::free(deck);
}

/// The figures of deck transformations.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE.
///
/// @param deck     the elements.
/// @param summary  out: the figures.
/// @param size     sizeof *summary.
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
            space: name(deck.space)?,
            longest: lengths().max().unwrap_or(0) as u32,
            n_elements: deck.elements.len(),
            n_letters: lengths().sum(),
        };
        sized::write(figures, summary, size)
    })
}

/// The words of the elements, reduced.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
///
/// @param deck              the elements.
/// @param letters           out: n_letters letters, word after word: k for generator k (1-based), -k for its inverse.
/// @param letters_capacity  entries of `letters`.
/// @param starts            out: n_elements + 1 offsets: word i is letters[starts[i] .. starts[i + 1]).
/// @param starts_capacity   entries of `starts`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_deck_words(
    deck: *const ricci_deck,
    letters: *mut i32,
    letters_capacity: usize,
    starts: *mut usize,
    starts_capacity: usize,
) -> ricci_status {
    guard::call(|door| {
        let elements = &door.shared(deck)?.elements;
        let rows = elements.iter().map(|g| letters::letters(&g.word));
        copy_rows("letters", rows, (letters, letters_capacity), (starts, starts_capacity))
    })
}

/// The elements as Moebius transformations z -> (a z + b)/(c z + d): in the Poincare disk matrices of SU(1, 1), up to sign; in the plane
/// ((e^(i theta), t), (0, 1)).
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
///
/// @param deck      the elements.
/// @param mobius    out: n_elements x 2 x 2 x 2: a, b, c, d, each real and imaginary part.
/// @param capacity  entries of `mobius`, at least 8 n_elements.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_deck_mobius(
    deck: *const ricci_deck,
    mobius: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::call(|door| {
        let rows: Vec<_> = door.shared(deck)?.elements.iter().map(|g| g.motion.mobius()).collect();
        copy_out("mobius", &rows, mobius, capacity)
    })
}

/// The elements as real matrices that act on ambient coordinates (x, y, w): of SO+(2, 1) on the hyperboloid, of SE(2) in the plane w = 1.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
///
/// @param deck      the elements.
/// @param matrices  out: n_elements x 3 x 3, row by row.
/// @param capacity  entries of `matrices`, at least 9 n_elements.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_deck_matrices(
    deck: *const ricci_deck,
    matrices: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::call(|door| {
        let elements = &door.shared(deck)?.elements;
        let rows: Vec<_> = elements.iter().map(|g| g.motion.matrix().map(|row| row.map(f64::from))).collect();
        copy_out("matrices", &rows, matrices, capacity)
    })
}

/// |trace| of the elements' 2 x 2 matrices of determinant 1: 2 cosh(L/2) for a translation of length L in the hyperbolic plane.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
///
/// @param deck      the elements.
/// @param traces    out: n_elements values.
/// @param capacity  entries of `traces`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_deck_traces(
    deck: *const ricci_deck,
    traces: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::call(|door| {
        let values = door.shared(deck)?.per_element(|g| 2.0 * f64::from(g.half_trace()).abs());
        copy_out("traces", &values, traces, capacity)
    })
}

/// How far the elements move along their axes: lengths of the closed geodesics in their free homotopy classes.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
///
/// @param deck      the elements.
/// @param lengths   out: n_elements lengths.
/// @param capacity  entries of `lengths`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_deck_translation_lengths(
    deck: *const ricci_deck,
    lengths: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(deck, |deck| {
        copy_out("lengths", &deck.per_element(Motion::translation_length), lengths, capacity)
    })
}

/// Move points by an element, with twice the digits of doubles on the way: one copy of a layout in the universal cover.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT (no such element, a row is not finite).
///
/// @param deck      the elements.
/// @param element   the number of the element, 0-based.
/// @param points    n_points x 3, ambient coordinates: ricci_quotient_points, ricci_model_to_hyperboloid.
/// @param n_points  number of points.
/// @param moved     out: n_points x 3. May be `points`.
/// @param capacity  entries of `moved`, at least 3 n_points.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_deck_apply(
    deck: *const ricci_deck,
    element: usize,
    points: *const f64,
    n_points: usize,
    moved: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::call(|door| {
        let elements = &door.shared(deck)?.elements;
        let g = elements.get(element).ok_or_else(|| {
            Failure::argument(format!("element {element} does not exist: there are {}", elements.len()))
        })?;
        let points = ambient("points", points, n_points)?;
        copy_out("moved", &self::moved(&points, &g.motion), moved, capacity)
    })
}
