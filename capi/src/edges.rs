//! Edge paths as C has them: 1-based edge numbers, negative where a path runs against the edge's direction.

use crate::arrays::{array, copy_rows};
use crate::failure::{Failure, Outcome};
use ricci::mesh::{EdgeId, HalfedgeId, Mesh};

/// The 1-based number of an edge, negative against its direction.
pub fn signed_edge(h: HalfedgeId) -> i32 {
    let number = h.edge().0 as i32 + 1;
    if h == h.edge().halfedge() { number } else { -number }
}

/// The half-edge of such a number; none if there is no such edge.
fn halfedge(mesh: &Mesh, number: i32) -> Option<HalfedgeId> {
    let e = number.unsigned_abs().checked_sub(1).filter(|&e| (e as usize) < mesh.n_edges())?;
    let h = EdgeId(e).halfedge();
    Some(if number > 0 { h } else { h.twin() })
}

/// Half-edges as signed edge numbers of a mesh.
pub fn halfedges(what: &str, mesh: &Mesh, data: *const i32, n: usize) -> Outcome<Vec<HalfedgeId>> {
    let known = |(i, &number): (usize, &i32)| {
        halfedge(mesh, number).ok_or_else(|| {
            let n = mesh.n_edges();
            Failure::argument(format!(
                "{what}[{i}] is {number}: edges are numbered 1 to {n}, -1 to -{n} against them"
            ))
        })
    };
    array(what, data, n)?.iter().enumerate().map(known).collect()
}

/// Copy edge paths, one after the other, and where each starts and the last one ends.
pub fn copy_paths<'a>(
    paths: impl IntoIterator<Item = &'a Vec<HalfedgeId>>,
    edges: (*mut i32, usize),
    starts: (*mut usize, usize),
) -> Outcome {
    copy_rows("edges", paths.into_iter().map(|path| path.iter().map(|&h| signed_edge(h))), edges, starts)
}
