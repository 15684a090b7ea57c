//! Words in the generators of a surface's group: letters are signed generator numbers.

use crate::arrays::{check_buffer, copy_counted, copy_out, copy_rows};
use crate::edges::halfedges;
use crate::failure::Failure;
use crate::guard::{self, output};
use crate::homotopy::ricci_homotopy;
use crate::letters::{self, copy_word, read};
use crate::status::ricci_status;
use ricci::mesh::VertexId;
use ricci::topology::Lift;
use std::ffi::{CStr, c_char};

/// The element of an edge path: of the loop along the tree to its start, along the path, and back from its end; for a loop at the base,
/// of the loop itself. Reduced: empty if and only if the loop can be contracted.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT (no such edges, or they do not follow each other).
///
/// @param homotopy   the basis.
/// @param path       n_path edges: 1-based, negative where the path runs against the edge's direction.
/// @param n_path     number of edges.
/// @param letters    out: the word; NULL with capacity 0 to ask for its length.
/// @param capacity   entries of `letters`.
/// @param n_letters  out: number of letters.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_homotopy_path_word(
    homotopy: *const ricci_homotopy,
    path: *const i32,
    n_path: usize,
    letters: *mut i32,
    capacity: usize,
    n_letters: *mut usize,
) -> ricci_status {
    guard::with(homotopy, |ricci_homotopy { mesh, basis, .. }| {
        let word = basis.path_word(mesh, &halfedges("path", mesh, path, n_path)?)?;
        copy_word(&word, letters, capacity, n_letters)
    })
}

/// A shorter word of the same element, empty if and only if it is the identity.
///
/// On a torus a1^p b1^q, with boundary a freely reduced word without the last c: equal elements, equal words. On closed surfaces of
/// genus 2 and more (Dehn's algorithm) equal elements may keep different words: ricci_homotopy_equal.
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT (no such letter).
///
/// @param homotopy   the basis.
/// @param word       n_word letters: k for generator k (1-based), -k for its inverse.
/// @param n_word     number of letters.
/// @param letters    out: the reduced word; NULL with capacity 0 to ask for its length.
/// @param capacity   entries of `letters`.
/// @param n_letters  out: number of letters.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_homotopy_reduce(
    homotopy: *const ricci_homotopy,
    word: *const i32,
    n_word: usize,
    letters: *mut i32,
    capacity: usize,
    n_letters: *mut usize,
) -> ricci_status {
    guard::call(|door| {
        let group = &door.shared(homotopy)?.basis.group;
        copy_word(&group.reduce(&read(group, "word", word, n_word)?), letters, capacity, n_letters)
    })
}

/// Whether two words are the same element of the surface's group.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT (no such letter).
///
/// @param homotopy  the basis.
/// @param u         n_u letters.
/// @param n_u       number of letters.
/// @param v         n_v letters.
/// @param n_v       number of letters.
/// @param equal     out: 1 if they are, else 0.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_homotopy_equal(
    homotopy: *const ricci_homotopy,
    u: *const i32,
    n_u: usize,
    v: *const i32,
    n_v: usize,
    equal: *mut i32,
) -> ricci_status {
    guard::call(|door| {
        let equal = output("equal", equal)?;
        let group = &door.shared(homotopy)?.basis.group;
        let same = group.equal(&read(group, "u", u, n_u)?, &read(group, "v", v, n_v)?);
        equal.set(same.into());
        Ok(())
    })
}

/// The homology class of a word: the sum of each generator's exponents; with boundary the last c counts as minus the sum of the others.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT (no such letter).
///
/// @param homotopy  the basis.
/// @param word      n_word letters.
/// @param n_word    number of letters.
/// @param sums      out: n_generators sums, one less with boundary.
/// @param capacity  entries of `sums`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_homotopy_homology(
    homotopy: *const ricci_homotopy,
    word: *const i32,
    n_word: usize,
    sums: *mut i64,
    capacity: usize,
) -> ricci_status {
    guard::call(|door| {
        let group = &door.shared(homotopy)?.basis.group;
        copy_out("sums", &group.abelianisation(&read(group, "word", word, n_word)?), sums, capacity)
    })
}

/// A word as text, `a1 b1 a1^-1`; the empty word is `1`. A word of one letter gives the generator's name.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT (no such letter).
///
/// @param homotopy  the basis.
/// @param word      n_word letters; they are reduced freely.
/// @param n_word    number of letters.
/// @param text      out: the text, NUL-terminated; NULL with capacity 0 to ask for its length.
/// @param capacity  bytes of `text`.
/// @param n_bytes   out: number of bytes with the NUL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_homotopy_word_text(
    homotopy: *const ricci_homotopy,
    word: *const i32,
    n_word: usize,
    text: *mut c_char,
    capacity: usize,
    n_bytes: *mut usize,
) -> ricci_status {
    guard::call(|door| {
        let group = &door.shared(homotopy)?.basis.group;
        let mut bytes = group.text(&read(group, "word", word, n_word)?).into_bytes();
        bytes.push(0);
        copy_counted("text", &bytes, text.cast(), capacity, n_bytes)
    })
}

/// The word that a text like `a1 b1 a1^-1` means, freely reduced; `1` stands for the identity.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT (what is no letter).
///
/// @param homotopy   the basis.
/// @param text       the text, NUL-terminated.
/// @param letters    out: the word; NULL with capacity 0 to ask for its length.
/// @param capacity   entries of `letters`.
/// @param n_letters  out: number of letters.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_homotopy_word_parse(
    homotopy: *const ricci_homotopy,
    text: *const c_char,
    letters: *mut i32,
    capacity: usize,
    n_letters: *mut usize,
) -> ricci_status {
    guard::call(|door| {
        let group = &door.shared(homotopy)?.basis.group;
        if text.is_null() {
            return Err(Failure::null("text"));
        }
        // SAFETY: NUL-terminated (contract of the header).
        let text = unsafe { CStr::from_ptr(text) };
        copy_word(&group.parse(&text.to_string_lossy())?, letters, capacity, n_letters)
    })
}

/// The lift of an edge path to the universal cover, vertex by vertex: the start, then the end of each edge.
///
/// The lift (v, w) of vertex v is where the deck transformation w carries the end of the lifted tree path to v. A loop's lift closes if
/// and only if the loop can be contracted; that of a loop at the base, from (base, 1), ends at (base, its word). Words are reduced.
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT (no such vertex, letters or edges; the path does not
/// start there).
///
/// @param homotopy          the basis.
/// @param vertex            the vertex where the path starts.
/// @param element           n_element letters: the deck transformation of the lift that it starts at.
/// @param n_element         number of letters, 0 for the identity.
/// @param path              n_path edges: 1-based, negative where the path runs against the edge's direction.
/// @param n_path            number of edges.
/// @param letters           out: the words of the n_path + 1 lifts, one after the other; NULL with capacity 0 to ask for `starts`.
/// @param letters_capacity  entries of `letters`.
/// @param starts            out: n_path + 2 offsets: word i is letters[starts[i] .. starts[i + 1]).
/// @param starts_capacity   entries of `starts`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_homotopy_lift(
    homotopy: *const ricci_homotopy,
    vertex: u32,
    element: *const i32,
    n_element: usize,
    path: *const i32,
    n_path: usize,
    letters: *mut i32,
    letters_capacity: usize,
    starts: *mut usize,
    starts_capacity: usize,
) -> ricci_status {
    guard::with(homotopy, |ricci_homotopy { mesh, basis, .. }| {
        let element = read(&basis.group, "element", element, n_element)?;
        let start = Lift { vertex: VertexId(vertex), element };
        let path = halfedges("path", mesh, path, n_path)?;
        // Twice over, so that the words are only kept where the caller has room for them.
        let mut offsets = vec![0];
        for lift in basis.lift(mesh, &start, &path)? {
            offsets.push(offsets.last().copied().unwrap_or(0) + lift.element.len());
        }
        let total = offsets.last().copied().unwrap_or(0);
        if letters.is_null() && letters_capacity == 0 {
            return copy_out("starts", &offsets, starts, starts_capacity);
        }
        check_buffer("letters", total, letters, letters_capacity)?;
        let words = basis.lift(mesh, &start, &path)?;
        let rows = words.map(|lift| letters::letters(&lift.element).collect::<Vec<_>>());
        copy_rows("letters", rows, (letters, letters_capacity), (starts, starts_capacity))
    })
}
