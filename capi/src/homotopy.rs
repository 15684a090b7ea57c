//! Canonical homotopy bases.

use crate::arrays::{copy_counted, copy_out, copy_rows};
use crate::control::{self, ricci_control};
use crate::edges::{copy_paths, signed_edge};
use crate::failure::{Failure, Outcome};
use crate::guard::{self, Poison, handle};
use crate::letters;
use crate::mesh::ricci_mesh;
use crate::sized::{self, sized};
use crate::status::ricci_status;
use ricci::mesh::{Mesh, VertexId};
use ricci::topology::{HomotopyBasis, homotopy_basis, intersection_matrix};
use std::sync::Arc;

/// Generators of the fundamental group of a surface: loops a1, b1, ..., ag, bg, c1, ..., cb through one base vertex with the one relation
/// a1 b1 a1^-1 b1^-1 ... ag bg ag^-1 bg^-1 c1 ... cb = 1.
///
/// Generators are numbered from 1 in this order, and a word is an array of letters: k for generator k, -k for its inverse, from left to
/// right as paths are run. b_i crosses a_i once, from right to left; c_j goes around a boundary loop with the surface on its left.
pub struct ricci_homotopy {
    poison: Poison,
    pub(crate) mesh: Arc<Mesh>,
    pub(crate) basis: HomotopyBasis,
}

handle!(ricci_homotopy, "homotopy");

impl ricci_homotopy {
    pub(crate) fn new(mesh: Arc<Mesh>, basis: HomotopyBasis) -> ricci_homotopy {
        ricci_homotopy { poison: Poison::default(), mesh, basis }
    }
}

/// Figures of a homotopy basis.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_homotopy_summary {
    /// Bytes of this struct that are filled.
    pub size: usize,
    /// The base vertex.
    pub base: usize,
    /// g.
    pub genus: usize,
    /// b.
    pub n_boundary_loops: usize,
    /// 2 g + b.
    pub n_generators: usize,
    /// Letters of the relation, 4 g + b.
    pub n_relator: usize,
    /// Number of edges of all loops.
    pub n_loop_edges: usize,
}

// SAFETY: integers of 8 bytes, size first.
sized!(ricci_homotopy_summary, "summary");

/// A vertex that may be left to the library: -1.
pub(crate) fn vertex_or_none(what: &str, vertex: i64) -> Outcome<Option<VertexId>> {
    match u32::try_from(vertex) {
        Ok(v) => Ok(Some(VertexId(v))),
        Err(_) if vertex == -1 => Ok(None),
        Err(_) => {
            Err(Failure::argument(format!("{what} is {vertex}: give a vertex, or -1 to have one chosen")))
        }
    }
}

/// A canonical homotopy basis of a mesh, with short loops. The surface may have boundary.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT (no such vertex), RICCI_EDGE_LENGTH, RICCI_CANCELLED.
///
/// @param mesh      the mesh; loops are short in its lengths.
/// @param base      the base vertex; -1 for one from which the loops are short.
/// @param control   progress and cancellation; NULL for neither.
/// @param homotopy  out: the new handle, to be released by ricci_homotopy_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_homotopy_new(
    mesh: *const ricci_mesh,
    base: i64,
    control: *const ricci_control,
    homotopy: *mut *mut ricci_homotopy,
) -> ricci_status {
    guard::make("homotopy", homotopy, |door| {
        let mesh = door.shared(mesh)?;
        let surface = mesh.surface()?;
        let lengths = surface.lengths();
        let base = vertex_or_none("base", base)?;
        let mesh = mesh.connectivity.clone();
        let basis = homotopy_basis(&mesh, lengths, base, &control::of(control))?;
        Ok(ricci_homotopy::new(mesh, basis))
    })
}

/// Release a homotopy basis.
///
/// @param homotopy  the handle, or NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_homotopy_free(homotopy: *mut ricci_homotopy) {
    guard::free(homotopy);
}

/// The figures of a homotopy basis.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE.
///
/// @param homotopy  the basis.
/// @param summary   out: the figures.
/// @param size      sizeof *summary.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_homotopy_summarise(
    homotopy: *const ricci_homotopy,
    summary: *mut ricci_homotopy_summary,
    size: usize,
) -> ricci_status {
    guard::call(|door| {
        let basis = &door.shared(homotopy)?.basis;
        let figures = ricci_homotopy_summary {
            size,
            base: basis.base.index(),
            genus: basis.group.genus,
            n_boundary_loops: basis.group.boundaries,
            n_generators: basis.group.n_generators(),
            n_relator: basis.group.relator().len(),
            n_loop_edges: basis.loops.iter().map(Vec::len).sum(),
        };
        sized::write(figures, summary, size)
    })
}

/// The edges of every generator's loop, in order, from the base to the base.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
///
/// @param homotopy         the basis.
/// @param edges            out: n_loop_edges edge numbers, 1-based, negative where the loop runs against the edge's direction; loop after
///                         loop.
/// @param edges_capacity   entries of `edges`.
/// @param starts           out: n_generators + 1 offsets: loop i is edges[starts[i] .. starts[i + 1]).
/// @param starts_capacity  entries of `starts`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_homotopy_loops(
    homotopy: *const ricci_homotopy,
    edges: *mut i32,
    edges_capacity: usize,
    starts: *mut usize,
    starts_capacity: usize,
) -> ricci_status {
    guard::call(|door| {
        let loops = &door.shared(homotopy)?.basis.loops;
        copy_paths(loops, (edges, edges_capacity), (starts, starts_capacity))
    })
}

/// The vertices of every generator's loop: where each of its edges starts.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
///
/// @param homotopy           the basis.
/// @param vertices           out: n_loop_edges vertices, loop after loop; the first of each is the base.
/// @param vertices_capacity  entries of `vertices`.
/// @param starts             out: n_generators + 1 offsets: loop i is vertices[starts[i] .. starts[i + 1]).
/// @param starts_capacity    entries of `starts`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_homotopy_loop_vertices(
    homotopy: *const ricci_homotopy,
    vertices: *mut u32,
    vertices_capacity: usize,
    starts: *mut usize,
    starts_capacity: usize,
) -> ricci_status {
    guard::with(homotopy, |ricci_homotopy { mesh, basis, .. }| {
        let rows = basis.loops.iter().map(|path| path.iter().map(|&h| mesh.origin(h).0));
        copy_rows("vertices", rows, (vertices, vertices_capacity), (starts, starts_capacity))
    })
}

/// The relation, a word that is the identity: 1, 2, -1, -2, 3, 4, ... and the boundary loops.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
///
/// @param homotopy  the basis.
/// @param letters   out: n_relator letters.
/// @param capacity  entries of `letters`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_homotopy_relator(
    homotopy: *const ricci_homotopy,
    letters: *mut i32,
    capacity: usize,
) -> ricci_status {
    guard::call(|door| {
        let relator: Vec<i32> = letters::letters(&door.shared(homotopy)?.basis.group.relator()).collect();
        copy_out("letters", &relator, letters, capacity)
    })
}

/// The intersection numbers of the generators' loops, measured on the mesh: in row i and column j how often loop j crosses loop i from
/// right to left, minus how often from left to right. a_i and b_i have 1, b_i and a_i -1, all others 0.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
///
/// @param homotopy  the basis.
/// @param matrix    out: n_generators x n_generators.
/// @param capacity  entries of `matrix`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_homotopy_intersections(
    homotopy: *const ricci_homotopy,
    matrix: *mut i64,
    capacity: usize,
) -> ricci_status {
    guard::with(homotopy, |ricci_homotopy { mesh, basis, .. }| {
        copy_out("matrix", &intersection_matrix(mesh, &basis.loops)?.concat(), matrix, capacity)
    })
}

/// The tree path from the base to a vertex, along which lifts are named (ricci_homotopy_lift).
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT (no such vertex).
///
/// @param homotopy  the basis.
/// @param vertex    where the path ends.
/// @param edges     out: its edges, 1-based, negative against the edge's direction; NULL with capacity 0 to ask for their number.
/// @param capacity  entries of `edges`.
/// @param n_edges   out: number of edges.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_homotopy_tree_path(
    homotopy: *const ricci_homotopy,
    vertex: u32,
    edges: *mut i32,
    capacity: usize,
    n_edges: *mut usize,
) -> ricci_status {
    guard::with(homotopy, |ricci_homotopy { mesh, basis, .. }| {
        let path = basis.tree_path(mesh, VertexId(vertex))?;
        let numbers: Vec<i32> = path.into_iter().map(signed_edge).collect();
        copy_counted("edges", &numbers, edges, capacity, n_edges)
    })
}
