//! Canonical homotopy bases, and words in their generators.

use crate::arrays::{CallerBuffer, check_buffer, copy_counted, copy_out, text};
use crate::control::{self, ricci_control};
use crate::guard::{self, handle, shared};
use crate::memory;
use crate::mesh::ricci_mesh;
use crate::paths::{copy_paths, copy_word, halfedges, letters, read_word, signed_edge, vertex_or_none};
use crate::status::ricci_status;
use crate::structs::{self, sized};
use ricci::mesh::{Mesh, VertexId};
use ricci::topology::{HomotopyBasis, Lift, homotopy_basis, intersection_matrix};
use std::ffi::c_char;
use std::sync::Arc;

pub struct ricci_homotopy {
    pub(crate) mesh: Arc<Mesh>,
    pub(crate) basis: HomotopyBasis,
}
handle!(ricci_homotopy, "homotopy", |homotopy| homotopy.mesh.n_vertices());

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_homotopy_summary {
    pub size: usize,
    pub base: usize,
    pub genus: usize,
    pub n_boundary_loops: usize,
    pub n_generators: usize,
    pub n_relator: usize,
    pub n_loop_edges: usize,
}
// SAFETY: numbers; 8-byte alignment, size first.
sized!(ricci_homotopy_summary, "summary");

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_homotopy_new(
    mesh: *const ricci_mesh,
    base: *const u32,
    control: *const ricci_control,
    homotopy: *mut *mut ricci_homotopy,
) -> ricci_status {
    guard::make(homotopy, || {
        let mesh = shared(mesh)?;
        let _reserve = memory::work(mesh.connectivity.n_vertices(), memory::MESH)?;
        let (lengths, base) = (mesh.surface()?.lengths(), vertex_or_none(base)?);
        let mesh = mesh.connectivity.clone();
        let basis = homotopy_basis(&mesh, lengths, base, &control::of(control)?)?;
        Ok(ricci_homotopy { mesh, basis })
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_homotopy_free(homotopy: *mut ricci_homotopy) {
    guard::free(homotopy);
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_homotopy_summarise(
    homotopy: *const ricci_homotopy,
    summary: *mut ricci_homotopy_summary,
    size: usize,
) -> ricci_status {
    guard::with(homotopy, |ricci_homotopy { basis, .. }| {
        let figures = ricci_homotopy_summary {
            size,
            base: basis.base.index(),
            genus: basis.group.genus,
            n_boundary_loops: basis.group.boundaries,
            n_generators: basis.group.n_generators(),
            n_relator: basis.group.relator().len(),
            n_loop_edges: basis.loops.iter().map(Vec::len).sum(),
        };
        structs::write(figures, summary, size)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_homotopy_loops(
    homotopy: *const ricci_homotopy,
    edges: *mut i32,
    edges_capacity: usize,
    starts: *mut usize,
    starts_capacity: usize,
) -> ricci_status {
    guard::with(homotopy, |ricci_homotopy { basis, .. }| {
        copy_paths(&basis.loops, CallerBuffer(edges, edges_capacity), CallerBuffer(starts, starts_capacity))
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_homotopy_intersections(
    homotopy: *const ricci_homotopy,
    matrix: *mut i64,
    capacity: usize,
) -> ricci_status {
    guard::with(homotopy, |ricci_homotopy { mesh, basis }| {
        copy_out("matrix", &intersection_matrix(mesh, &basis.loops)?.concat(), matrix, capacity)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_homotopy_tree_path(
    homotopy: *const ricci_homotopy,
    vertex: u32,
    edges: *mut i32,
    capacity: usize,
    n_edges: *mut usize,
) -> ricci_status {
    guard::with(homotopy, |ricci_homotopy { mesh, basis }| {
        let path = basis.tree_path(mesh, VertexId(vertex))?;
        let numbers: Vec<i32> = path.into_iter().map(signed_edge).collect();
        copy_counted("edges", &numbers, edges, capacity, n_edges)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_homotopy_path_word(
    homotopy: *const ricci_homotopy,
    path: *const i32,
    n_path: usize,
    letters: *mut i32,
    capacity: usize,
    n_letters: *mut usize,
) -> ricci_status {
    guard::with(homotopy, |ricci_homotopy { mesh, basis }| {
        let word = basis.path_word(mesh, &halfedges(mesh, path, n_path)?)?;
        copy_word(&word, letters, capacity, n_letters)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_homotopy_reduce(
    homotopy: *const ricci_homotopy,
    word: *const i32,
    n_word: usize,
    letters: *mut i32,
    capacity: usize,
    n_letters: *mut usize,
) -> ricci_status {
    guard::with(homotopy, |ricci_homotopy { basis, .. }| {
        let word = read_word(&basis.group, "word", word, n_word)?;
        copy_word(&basis.group.reduce(&word), letters, capacity, n_letters)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_homotopy_homology(
    homotopy: *const ricci_homotopy,
    word: *const i32,
    n_word: usize,
    sums: *mut i64,
    capacity: usize,
) -> ricci_status {
    guard::with(homotopy, |ricci_homotopy { basis, .. }| {
        let word = read_word(&basis.group, "word", word, n_word)?;
        copy_out("sums", &basis.group.abelianisation(&word), sums, capacity)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_homotopy_word_text(
    homotopy: *const ricci_homotopy,
    word: *const i32,
    n_word: usize,
    text: *mut c_char,
    capacity: usize,
    n_bytes: *mut usize,
) -> ricci_status {
    guard::with(homotopy, |ricci_homotopy { basis, .. }| {
        let mut bytes = basis.group.text(&read_word(&basis.group, "word", word, n_word)?).into_bytes();
        bytes.push(0);
        copy_counted("text", &bytes, text.cast(), capacity, n_bytes)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_homotopy_word_parse(
    homotopy: *const ricci_homotopy,
    word: *const c_char,
    letters: *mut i32,
    capacity: usize,
    n_letters: *mut usize,
) -> ricci_status {
    guard::with(homotopy, |ricci_homotopy { basis, .. }| {
        copy_word(&basis.group.parse(text("word", word)?)?, letters, capacity, n_letters)
    })
}

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_lift {
    pub size: usize,
    pub element: *const i32,
    pub n_element: usize,
    pub path: *const i32,
    pub n_path: usize,
    pub vertex: u32,
    pub reserved: u32,
}
// SAFETY: numbers and raw pointers; 8-byte alignment, size first.
sized!(ricci_lift, "lift", reserved);

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_homotopy_lift(
    homotopy: *const ricci_homotopy,
    lift: *const ricci_lift,
    words: *mut i32,
    words_capacity: usize,
    starts: *mut usize,
    starts_capacity: usize,
) -> ricci_status {
    guard::with(homotopy, |ricci_homotopy { mesh, basis }| {
        let given = structs::read(lift)?;
        let element = read_word(&basis.group, "element", given.element, given.n_element)?;
        let start = Lift { vertex: VertexId(given.vertex), element };
        let path = halfedges(mesh, given.path, given.n_path)?;
        // The lift is computed twice: first for the lengths of the words, which may be too many to keep before the caller has room.
        let mut offsets = vec![0];
        for lift in basis.lift(mesh, &start, &path)? {
            offsets.push(offsets.last().copied().unwrap_or(0) + lift.element.len());
        }
        let total = offsets.last().copied().unwrap_or(0);
        if words.is_null() && words_capacity == 0 {
            return copy_out("starts", &offsets, starts, starts_capacity);
        }
        check_buffer("words", total, words, words_capacity)?;
        copy_out("starts", &offsets, starts, starts_capacity)?;
        let all: Vec<i32> = basis
            .lift(mesh, &start, &path)?
            .flat_map(|lift| letters(&lift.element).collect::<Vec<_>>())
            .collect();
        copy_out("words", &all, words, words_capacity)
    })
}
