//! Corresponding curves as pairs of points at equal shares of their lengths.

use crate::error::{Error, Result};
use crate::mesh::{HalfedgeId, Place, VertexId};
use crate::metric::Surface;
use crate::topology::check_vertex;
use std::collections::HashSet;

/// Share of an edge within which a point on it counts as its end.
const AT_END: f64 = 1e-9;

/// For each vertex of the source's curves that is no landmark, the pair of the vertex and the point of the target's curve at the same share
/// of the length.
///
/// # Errors
/// [`Error::Matching`] for a curve of fewer than two vertices, for consecutive vertices without an edge between them, and for a closed
/// curve whose partner is open; [`Error::Argument`] for a vertex that does not exist.
pub(crate) fn points(
    surfaces: [&Surface; 2],
    curves: &[[Vec<VertexId>; 2]],
    landmarks: &[[VertexId; 2]],
) -> Result<Vec<[Place; 2]>> {
    let mut known: HashSet<VertexId> = landmarks.iter().map(|pair| pair[0]).collect();
    let mut all = Vec::new();
    for (number, curve) in curves.iter().enumerate() {
        let [from, to] = [path(surfaces, curve, number, 0)?, path(surfaces, curve, number, 1)?];
        let closes = |s: usize| curve[s].first() == curve[s].last();
        if closes(0) != closes(1) {
            return Err(Error::Matching(format!(
                "curve {number} closes on one surface and not on the other"
            )));
        }
        let shares = [shares(surfaces[0], &from), shares(surfaces[1], &to)];
        for (&v, &share) in curve[0].iter().zip(&shares[0]) {
            if known.insert(v) {
                all.push([
                    Place::at_vertex(surfaces[0].mesh(), v)?,
                    at_share(surfaces[1], &to, &shares[1], share)?,
                ]);
            }
        }
    }
    Ok(all)
}

/// The half-edges of the curve of this number on surface s.
fn path(
    surfaces: [&Surface; 2],
    curve: &[Vec<VertexId>; 2],
    number: usize,
    s: usize,
) -> Result<Vec<HalfedgeId>> {
    let (mesh, vertices) = (surfaces[s].mesh(), &curve[s]);
    let name = ["source", "target"][s];
    if vertices.len() < 2 {
        return Err(Error::Matching(format!("curve {number} has fewer than two vertices on the {name}")));
    }
    vertices.iter().try_for_each(|&v| check_vertex(mesh, v))?;
    let along = |pair: &[VertexId]| {
        let edge = mesh.outgoing(pair[0]).find(|&h| mesh.tip(h) == pair[1]);
        edge.ok_or_else(|| {
            Error::Matching(format!(
                "curve {number} goes from vertex {} of the {name} to vertex {}, without an edge between them",
                pair[0], pair[1]
            ))
        })
    };
    vertices.windows(2).map(along).collect()
}

/// The share of the length before each vertex of a path, the last one 1.
fn shares(surface: &Surface, path: &[HalfedgeId]) -> Vec<f64> {
    let total: f64 = path.iter().map(|h| surface.lengths()[h.edge()]).sum();
    let mut before = 0.0;
    let mut all = vec![0.0];
    for h in path {
        before += surface.lengths()[h.edge()];
        all.push(before / total);
    }
    if let Some(last) = all.last_mut() {
        *last = 1.0;
    }
    all
}

/// The place on a path at a share of its length; `shares`: those of its vertices.
fn at_share(surface: &Surface, path: &[HalfedgeId], shares: &[f64], share: f64) -> Result<Place> {
    let mesh = surface.mesh();
    let k = shares.partition_point(|&s| s <= share).clamp(1, path.len()) - 1;
    let part = ((share - shares[k]) / (shares[k + 1] - shares[k])).clamp(0.0, 1.0);
    let h = path[k];
    if part < AT_END {
        return Place::at_vertex(mesh, mesh.origin(h));
    }
    if part > 1.0 - AT_END {
        return Place::at_vertex(mesh, mesh.tip(h));
    }
    let (inside, part) = if mesh.is_outside(h) { (h.twin(), 1.0 - part) } else { (h, part) };
    let mut weights = [0.0; 3];
    let Some((face, corner)) = mesh.corner(inside) else { return Place::at_vertex(mesh, mesh.origin(h)) };
    (weights[corner], weights[(corner + 1) % 3]) = (1.0 - part, part);
    Ok(Place { face, weights })
}
