//! Algebraic intersection numbers of closed edge paths.
//!
//! ```
//! use ricci::topology::{homology_generators, intersection_number};
//! use ricci::{Control, mesh::shapes};
//! let (mesh, lengths) = shapes::flat_torus([0.0, 1.0], 4, 4)?.build()?;
//! let loops = homology_generators(&mesh, &lengths, &Control::new())?;
//! assert_eq!(intersection_number(&mesh, &loops[0], &loops[1])?.abs(), 1);
//! # Ok::<(), ricci::Error>(())
//! ```

use super::check_loop;
use crate::error::Result;
use crate::mesh::{HalfedgeId, Mesh, PerHalfedge};

/// The intersection number a · b of two closed edge paths: the number of times that b crosses a from right to left, minus the number of
/// times that it crosses from left to right.
///
/// It is antisymmetric and depends on the homology classes alone; loops that bound (also those around a boundary loop of the surface)
/// have 0 with every other. `a · b = +1` where the directions of a and b, in this order, are a positively oriented frame. The paths may
/// share vertices and edges, and repeat them.
///
/// # Errors
///
/// [`crate::Error::Argument`] for half-edges that do not form a closed path.
pub fn intersection_number(mesh: &Mesh, a: &[HalfedgeId], b: &[HalfedgeId]) -> Result<i64> {
    check_loop(mesh, a)?;
    check_loop(mesh, b)?;
    let mut crossing = PerHalfedge::filled(mesh.n_halfedges(), 0);
    push_left(mesh, a, 1, &mut crossing);
    Ok(total(b, &crossing))
}

/// The matrix of [`intersection_number`]`(loops[i], loops[j])`: row i, column j. O(E + n · total length).
///
/// For a [`crate::topology::HomotopyBasis`] it has blocks `(0, 1; −1, 0)` for each pair a_i, b_i, and 0
/// elsewhere.
///
/// # Errors
///
/// As [`intersection_number`].
pub fn intersection_matrix(mesh: &Mesh, loops: &[Vec<HalfedgeId>]) -> Result<Vec<Vec<i64>>> {
    loops.iter().try_for_each(|path| check_loop(mesh, path))?;
    let mut crossing = PerHalfedge::filled(mesh.n_halfedges(), 0);
    let row = |a: &Vec<HalfedgeId>| {
        push_left(mesh, a, 1, &mut crossing);
        let row = loops.iter().map(|b| total(b, &crossing)).collect();
        push_left(mesh, a, -1, &mut crossing);
        row
    };
    Ok(loops.iter().map(row).collect())
}

fn total(path: &[HalfedgeId], crossing: &PerHalfedge<i64>) -> i64 {
    path.iter().map(|&h| crossing[h]).sum()
}

/// Adds `sign` to each half-edge that crosses the loop, pushed a little to its left, from right to left, once per crossing, and subtracts
/// it from its twin: the Poincaré dual cochain of the loop.
///
/// The pushed loop crosses the half-edges that leave its vertices in the wedge on its left, turning clockwise from the edge after the one
/// by which it enters to the one by which it leaves. Outside the surface the wedge continues as if the boundary loop were filled by a
/// disk.
fn push_left(mesh: &Mesh, path: &[HalfedgeId], sign: i64, crossing: &mut PerHalfedge<i64>) {
    for (k, &enter) in path.iter().enumerate() {
        let leave = path[(k + 1) % path.len()];
        let mut h = mesh.next(enter);
        while h != leave {
            crossing[h] += sign;
            crossing[h.twin()] -= sign;
            h = mesh.next(h.twin());
        }
    }
}
