//! In which triangle of a placed surface the vertices of another one lie: by walks from neighbour to neighbour in the universal cover.

use super::cover::{Placed, Precise, determinant};
use super::place::Place;
use crate::control::{Control, Stage};
use crate::error::{Error, Result};
use crate::geometry::{Motion, Twofold};
use crate::mesh::{HalfedgeId, VertexId};
use std::collections::VecDeque;

/// Share of a triangle by which a point may lie outside it and still be taken to lie in it: rounding of positions at its sides.
const OUTSIDE: f64 = 1e-13;
/// Vertices located between two looks at the control.
const VERTICES_PER_LOOK: usize = 1024;

/// Where the search starts: a vertex of the points, and a half-edge of a face of the domain near which its own corner lies, in the opened domain.
#[derive(Debug, Clone, Copy)]
pub(super) struct Seed {
    pub vertex: VertexId,
    pub near: HalfedgeId,
}

/// Per vertex of `points` its place in `domain`, and the largest distance by which one lies outside the domain, as a share of the triangle that
/// is nearest. Both lie in the same space over one surface, with the same deck group.
///
/// # Errors
/// [`Error::Matching`] for a walk that does not end; [`Error::Cancelled`].
pub(super) fn locate(
    points: &Placed,
    domain: &Placed,
    seed: Seed,
    control: &Control,
) -> Result<(Vec<Place>, f64)> {
    let mesh = &points.cover.mesh;
    let walker = Walker { domain, most: 16 * domain.cover.mesh.n_faces() + 64 };
    let mut found: Vec<Option<Found>> = vec![None; mesh.n_vertices()];
    let mut waiting = VecDeque::new();
    let identity = Motion::identity(points.cover.space);
    found[seed.vertex.index()] = Some(walker.walk(seed.near, identity, points.at[seed.vertex].origin())?);
    waiting.push_back(seed.vertex);
    let (mut worst, mut count) = (0.0, 0);
    while let Some(v) = waiting.pop_front() {
        count += 1;
        if count % VERTICES_PER_LOOK == 0 {
            control.step(Stage::Layout, count as f64 / mesh.n_vertices() as f64)?;
        }
        let Some(from) = found[v.index()] else { continue };
        worst = crate::geometry::worse(worst, from.outside);
        for h in mesh.outgoing(v) {
            let to = mesh.tip(h);
            if found[to.index()].is_none() {
                let copy =
                    points.cover.along(h).map_or(from.copy, |along| from.copy.compose(&along).normalised());
                let point = copy.apply(points.at[to].origin());
                found[to.index()] = Some(walker.walk(from.near, copy, point)?);
                waiting.push_back(to);
            }
        }
    }
    let places = found.into_iter().map(|found| found.map(|found| found.place));
    let places: Option<Vec<Place>> = places.collect();
    let places = places.ok_or_else(|| Error::Matching("the surface has several components".into()))?;
    Ok((places, worst))
}

#[derive(Debug, Clone, Copy)]
struct Found {
    place: Place,
    /// A half-edge of the face.
    near: HalfedgeId,
    /// The transformation that carries the vertex's own position into the opened domain.
    copy: Motion<Twofold>,
    outside: f64,
}

struct Walker<'a> {
    domain: &'a Placed,
    /// Most steps of a walk.
    most: usize,
}

impl Walker<'_> {
    /// From the face of a half-edge to the face that a point lies in; of a point beyond the boundary, to one at the boundary.
    fn walk(&self, near: HalfedgeId, mut copy: Motion<Twofold>, mut point: Precise) -> Result<Found> {
        let Placed { cover, .. } = self.domain;
        let mesh = &cover.mesh;
        let mut face = mesh.face(near);
        for step in 0..self.most {
            let Some(f) = face else { break };
            let (sides, corners) = (mesh.face_halfedges(f), self.domain.face(f));
            let opposite =
                |k: usize| f64::from(determinant([point, corners[(k + 1) % 3], corners[(k + 2) % 3]]));
            let parts = [0, 1, 2].map(opposite);
            let size = parts.iter().map(|x| x.abs()).fold(f64::MIN_POSITIVE, f64::max);
            let total = parts.iter().sum::<f64>();
            let is_out = |k: &usize| parts[*k] < -OUTSIDE * size || total <= 0.0;
            // Turning the order of the sides keeps walks from going in circles.
            let order = [0, 1, 2].map(|k| (k + step) % 3);
            let mut out: Vec<usize> = order.into_iter().filter(is_out).filter(|&k| parts[k] < 0.0).collect();
            out.sort_by(|&i, &j| parts[i].total_cmp(&parts[j]));
            if step % 7 == 6 {
                out.reverse();
            }
            let leave = out.iter().map(|&k| sides[(k + 1) % 3]).find(|h| !mesh.is_outside(h.twin()));
            let Some(h) = leave else {
                let inside = parts.map(|x| x.max(0.0));
                let sum: f64 = inside.iter().sum();
                let weights = if sum > 0.0 { inside.map(|x| x / sum) } else { [1.0 / 3.0; 3] };
                let outside = parts.iter().fold(0.0, |far: f64, &x| far.max(-x / size));
                return Ok(Found { place: Place { face: f, weights }, near: sides[0], copy, outside });
            };
            if let Some(across) = cover.across(h) {
                let back = across.inverse();
                (copy, point) = (back.compose(&copy), back.apply(point));
            }
            face = mesh.face(h.twin());
        }
        Err(Error::Matching(format!(
            "no triangle of the target holds a point: the walk from half-edge {near} does not end"
        )))
    }
}
