//! One round of refinement where the gap is largest.

use super::elements::Degree;
use super::finer::BisectedSurface;
use crate::control::Control;
use crate::error::Result;
use crate::mesh::{EdgeId, FaceId, PerFace};

/// Share of the gap that stays in unmarked faces.
const UNMARKED: f64 = 0.25;

/// Marks the faces with the largest shares, until the others have together at most [`UNMARKED`] of all, or `enough`. A marked face gets
/// quadratic terms on its sides if it has none on one of them and `degree` allows them, else its longest side is halved. Then the edges are
/// made Delaunay. Returns the number of vertices that were added.
///
/// # Errors
/// [`crate::Error::Connectivity`] where flips do not end; [`crate::Error::Cancelled`].
pub(super) fn refine(
    surface: &mut BisectedSurface,
    shares: &PerFace<f64>,
    enough: f64,
    degree: Degree,
    control: &Control,
) -> Result<usize> {
    let mut order: Vec<u32> = (0..shares.len() as u32).collect();
    order.sort_by(|&f, &g| shares[FaceId(g)].total_cmp(&shares[FaceId(f)]).then(f.cmp(&g)));
    let total: f64 = shares.iter().sum();
    let limit = (UNMARKED * total).max(enough.min(0.75 * total));
    let mut left = total;
    let mut halved: Vec<EdgeId> = Vec::new();
    let mut curved: Vec<EdgeId> = Vec::new();
    for f in order.into_iter().map(FaceId) {
        if left <= limit {
            break;
        }
        left -= shares[f];
        let sides = surface.mesh.opposite_edges(f);
        if degree == Degree::Quadratic && sides.iter().any(|&e| !surface.is_curved[e]) {
            curved.extend(sides);
        } else {
            halved.push(longest_side(surface, f));
        }
    }
    curved.into_iter().for_each(|e| surface.is_curved[e] = true);
    halved.sort_unstable();
    halved.dedup();
    let before = surface.mesh.n_vertices();
    for e in halved {
        // An edge with the same face on both sides keeps its face, whose third side is halved instead.
        if !surface.halve(e)
            && let Some(f) = surface.mesh.face(e.halfedge())
        {
            let other = surface.mesh.opposite_edges(f).into_iter().find(|&other| other != e);
            other.map(|other| surface.halve(other));
        }
    }
    if surface.mesh.n_vertices() > before {
        surface.make_delaunay(control)?;
    }
    Ok(surface.mesh.n_vertices() - before)
}

/// The longest side of a face; of sides that are equal up to rounding the one with the least number.
fn longest_side(surface: &BisectedSurface, f: FaceId) -> EdgeId {
    // Relative lengths are compared on a grid, so that the choice does not hang on rounding, and never runs in circles.
    let rank = |e: EdgeId| (-(surface.lengths[e].nearest().ln() * 1e9).round(), e);
    let sides = surface.mesh.opposite_edges(f);
    let smaller = |a: EdgeId, b: EdgeId| {
        let ((x, e), (y, g)) = (rank(a), rank(b));
        if x.total_cmp(&y).then(e.cmp(&g)).is_le() { a } else { b }
    };
    smaller(smaller(sides[0], sides[1]), sides[2])
}
