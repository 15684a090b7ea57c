//! Embeddings by Tutte's theorem: every vertex at the mean of its neighbours, the outer loop on a circle.

use crate::control::Control;
use crate::error::{Error, Result};
use crate::linalg::{Cholesky, Pattern, Symmetric};
use crate::mesh::caps::{Cap, CappedMesh};
use crate::mesh::{HalfedgeId, Mesh, VertexId};
use crate::metric::Surface;
use crate::metric::target::longest_loop;
use std::f64::consts::TAU;

/// The row number of a vertex whose place is held.
const HELD: u32 = u32::MAX;

/// The places of the vertices of a surface of genus 0 with boundary in the unit disk: its longest loop by its length on the circle, a hub in
/// every other loop, and each vertex inside at the mean of its neighbours. No triangle is turned over as long as no two edges have the same
/// ends \[Flo03\], up to rounding.
///
/// # Errors
/// [`Error::Factorisation`] for a surface of several components; those of [`CappedMesh::new`]; [`Error::Cancelled`].
pub(super) fn tutte(surface: &Surface, control: &Control) -> Result<Vec<[f64; 2]>> {
    let (given, outer) = (surface.mesh(), longest_loop(surface));
    let loops = given.boundary_loops();
    let caps = (0..loops.len()).map(|k| if k == outer { Cap::Open } else { Cap::Hub }).collect();
    let mesh = CappedMesh::new(given, caps)?.mesh;
    let mut points = vec![[0.0; 2]; mesh.n_vertices()];
    place_loop(surface, &loops[outer], &mut points);
    control.check()?;
    let mut row = vec![HELD; mesh.n_vertices()];
    let free: Vec<VertexId> = mesh.vertices().filter(|&v| !mesh.is_boundary_vertex(v)).collect();
    (0..).zip(&free).for_each(|(k, v)| row[v.index()] = k);
    fill_inside(&mesh, &row, &free, &mut points)?;
    control.check()?;
    points.truncate(given.n_vertices());
    Ok(points)
}

/// Places a loop on the unit circle. Its half-edges are outside, so that they have the surface on the right.
fn place_loop(surface: &Surface, rim: &[HalfedgeId], points: &mut [[f64; 2]]) {
    let length = |h: &HalfedgeId| surface.lengths()[h.edge()];
    let total: f64 = rim.iter().map(length).sum();
    let mut before = 0.0;
    for h in rim {
        let (sin, cos) = (-TAU * before / total).sin_cos();
        points[surface.mesh().origin(*h).index()] = [cos, sin];
        before += length(h);
    }
}

/// Solves for the vertices that are not held.
fn fill_inside(mesh: &Mesh, row: &[u32], free: &[VertexId], points: &mut [[f64; 2]]) -> Result<()> {
    let rows = |h: HalfedgeId| [mesh.origin(h), mesh.tip(h)].map(|v| row[v.index()]);
    let inside = |e: &[u32; 2]| e[0] != HELD && e[1] != HELD;
    let pairs: Vec<_> =
        mesh.edges().map(|e| rows(e.halfedge())).filter(inside).map(|[a, b]| (a, b)).collect();
    let pattern = Pattern::new(free.len(), &pairs)?;
    let mut values = vec![0.0; pattern.entries()];
    let mut sides = [vec![0.0; free.len()], vec![0.0; free.len()]];
    for h in mesh.halfedges() {
        let [a, b] = rows(h);
        if a == HELD || mesh.origin(h) == mesh.tip(h) {
            continue;
        }
        values[pattern.diagonal(a as usize)] += 1.0;
        if b == HELD {
            let at = points[mesh.tip(h).index()];
            (0..2).for_each(|c| sides[c][a as usize] += at[c]);
        } else if let Some(place) = pattern.position(a as usize, b as usize) {
            // Both half-edges of the edge come here.
            values[place] -= 0.5;
        }
    }
    let mut cholesky = Cholesky::analyse(&pattern)?;
    let lost = |_| Error::Factorisation {
        size: free.len(),
        message: "a part of the surface does not hang together with its outer loop: flatten each alone"
            .into(),
    };
    cholesky.factor(Symmetric { pattern: &pattern, values: &values }).map_err(lost)?;
    sides.iter_mut().for_each(|side| cholesky.solve(side));
    for (k, v) in free.iter().enumerate() {
        points[v.index()] = [sides[0][k], sides[1][k]];
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::predicates::orientation;
    use crate::mesh::shapes;
    use std::cmp::Ordering;

    #[test]
    fn no_triangle_is_turned_over_holes_or_not_and_vertices_are_at_the_means_of_their_neighbours() {
        for soup in [shapes::disk(7).unwrap(), shapes::annulus(0.5, 1.0, 6, 30).unwrap()] {
            let surface = Surface::from_soup(&soup).unwrap();
            let mesh = surface.mesh();
            let points = tutte(&surface, &Control::new()).unwrap();
            for f in mesh.faces() {
                let [a, b, c] = mesh.face_vertices(f).map(|v| points[v.index()]);
                assert_eq!(orientation(a, b, c), Ordering::Greater);
            }
            for v in mesh.vertices().filter(|&v| !mesh.is_boundary_vertex(v)) {
                let around: Vec<_> = mesh.outgoing(v).map(|h| points[mesh.tip(h).index()]).collect();
                for c in 0..2 {
                    let mean = around.iter().map(|p| p[c]).sum::<f64>() / around.len() as f64;
                    assert!((points[v.index()][c] - mean).abs() < 1e-14);
                }
            }
        }
    }
}
