//! Edge paths and words in their form for C: 1-based numbers, negative for an edge that is run backwards or an inverse generator.

use crate::arrays::{CallerBuffer, array, copy_counted, copy_rows};
use crate::failure::{Failure, FailureElement, Outcome};
use ricci::mesh::{EdgeId, HalfedgeId, Mesh, VertexId};
use ricci::topology::SurfaceGroup;
use ricci::topology::word::{Letter, Word};

/// The 1-based number of a half-edge's edge, negative if the half-edge runs against the edge.
pub fn signed_edge(h: HalfedgeId) -> i32 {
    let number = h.edge().0 as i32 + 1;
    if h == h.edge().halfedge() { number } else { -number }
}

/// The failure of a call whose array has, at entry `i`, a number outside ±1 to ±`count`.
fn not_numbered(what: &str, i: usize, number: i32, elements: &str, count: usize) -> Failure {
    let message =
        format!("{what}[{i}] is {number}: {elements} are numbered 1 to {count}, -1 to -{count} backwards");
    Failure::argument(message).at(FailureElement::Entry, i)
}

/// The half-edges of a caller's array of signed edge numbers.
pub fn halfedges(mesh: &Mesh, data: *const i32, n: usize) -> Outcome<Vec<HalfedgeId>> {
    halfedges_of(mesh, "path", &array("path", data, n)?, 0)
}

/// The half-edges of signed edge numbers, which are the entries of the array `what` from index `first` on.
pub fn halfedges_of(mesh: &Mesh, what: &str, edges: &[i32], first: usize) -> Outcome<Vec<HalfedgeId>> {
    let known = |(i, &number): (usize, &i32)| {
        let e = number.unsigned_abs().checked_sub(1).filter(|&e| (e as usize) < mesh.n_edges());
        let e = e.ok_or_else(|| not_numbered(what, first + i, number, "edges", mesh.n_edges()))?;
        let h = EdgeId(e).halfedge();
        Ok(if number > 0 { h } else { h.twin() })
    };
    edges.iter().enumerate().map(known).collect()
}

/// Copies edge paths one after the other, and the offsets at which each starts and the last one ends.
pub fn copy_paths<'a>(
    paths: impl IntoIterator<Item = &'a Vec<HalfedgeId>>,
    edges: CallerBuffer<i32>,
    starts: CallerBuffer<usize>,
) -> Outcome {
    let rows = paths.into_iter().map(|path| path.iter().map(|&h| signed_edge(h)));
    copy_rows("edges", rows, edges, starts)
}

/// The letters of a word: k for generator k (1-based), -k for its inverse.
pub fn letters(word: &Word) -> impl Iterator<Item = i32> + '_ {
    word.letters().iter().map(|letter| {
        let number = letter.index() as i32 + 1;
        if letter.is_inverse() { -number } else { number }
    })
}

/// A caller's word, which is freely reduced.
pub fn read_word(group: &SurfaceGroup, what: &str, data: *const i32, n: usize) -> Outcome<Word> {
    word_of(group, what, &array(what, data, n)?, 0)
}

/// The word of signed letters, which are the entries of the array `what` from index `first` on.
pub fn word_of(group: &SurfaceGroup, what: &str, letters: &[i32], first: usize) -> Outcome<Word> {
    let count = group.n_generators();
    let letter = |(i, &number): (usize, &i32)| {
        let k = (number.unsigned_abs() as usize).checked_sub(1).filter(|&k| k < count);
        let k = k.ok_or_else(|| not_numbered(what, first + i, number, "generators", count))?;
        let letter = Letter::generator(k);
        Ok(if number < 0 { letter.inverse() } else { letter })
    };
    letters.iter().enumerate().map(letter).collect()
}

/// Copies the letters of a word to the caller.
pub fn copy_word(word: &Word, buffer: *mut i32, capacity: usize, n_letters: *mut usize) -> Outcome {
    copy_counted("letters", &letters(word).collect::<Vec<_>>(), buffer, capacity, n_letters)
}

/// A caller's vertex; NULL leaves the choice to the library.
pub fn vertex_or_none(vertex: *const u32) -> Outcome<Option<VertexId>> {
    Ok(crate::arrays::one(vertex)?.map(VertexId))
}
