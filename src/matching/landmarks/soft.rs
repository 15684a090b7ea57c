//! Landmarks that draw the map near their partners: where they go instead.
//!
//! The map without them stands for the minimum of an energy ½ r² of the distance r that each is moved from there, and the landmark adds ½ w
//! s² of the distance s to its partner. Both distances are taken along a shortest path of edges on the target, so that the sum is least at
//! the share w/(1 + w) of the way. There the landmark is met exactly, by a map without folds.
//!
//! A spring in the energy of the map itself would not do that. A point has no capacity in the Dirichlet energy: the spring moves its vertex
//! and little around it, and a vertex that is pulled is no mean of its neighbours, so that nothing keeps faces from folding. In a plane
//! disk of 4, 8, 16 and 32 rings whose middle is pulled, faces fold once it has moved by 0.44, 0.27, 0.16 and 0.09 of the radius
//! (`tests/matching/landmarks.rs`): the finer the mesh, the less a spring could do before it had to be weakened.

use crate::control::Control;
use crate::error::{Error, Result};
use crate::mesh::{HalfedgeId, Place, VertexId};
use crate::metric::Surface;
use crate::topology::{check_vertex, shortest_paths};

/// A landmark that draws the map near its partner.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SoftLandmark {
    /// A vertex of the source and one of the target, both inside the surfaces.
    pub pair: [VertexId; 2],
    /// Its weight w ≥ 0: the landmark goes to the share w/(1 + w) of the way from where the map without it brings it.
    pub weight: f64,
}

/// Checks soft landmarks.
///
/// # Errors
/// [`Error::Argument`] for a vertex that does not exist and a weight that is negative or not finite; [`Error::Matching`] for a landmark on
/// a boundary.
pub(super) fn check(surfaces: [&Surface; 2], all: &[SoftLandmark]) -> Result<()> {
    for (k, soft) in all.iter().enumerate() {
        if !(soft.weight >= 0.0 && soft.weight.is_finite()) {
            return Err(Error::argument(
                "weight of a landmark",
                soft.weight,
                "a number that is not negative",
            ));
        }
        for (surface, v) in surfaces.iter().zip(soft.pair) {
            check_vertex(surface.mesh(), v)?;
            if surface.mesh().is_boundary_vertex(v) {
                return Err(Error::Matching(format!(
                    "soft landmark {k} lies on the boundary, at vertex {v}: only those inside can be soft"
                )));
            }
        }
    }
    Ok(())
}

/// A soft landmark's way on the target from where the map brings it to its partner.
pub(super) struct Approach {
    start: Place,
    /// From the start to a corner of its face.
    first: f64,
    corner: VertexId,
    path: Vec<HalfedgeId>,
    /// The length of the way.
    pub length: f64,
}

impl Approach {
    /// From a place to a vertex.
    ///
    /// # Errors
    /// Those of [`shortest_paths`].
    pub fn new(target: &Surface, start: Place, to: VertexId, control: &Control) -> Result<Approach> {
        let (mesh, lengths) = (target.mesh(), target.lengths());
        let forest = shortest_paths(mesh, lengths, vec![to], control)?;
        let corners = mesh.face_vertices(start.face);
        let sides = mesh.face_halfedges(start.face).map(|h| lengths[h.edge()]);
        // Distance to a corner inside the face, by the lengths of its sides: |Σ w (p − corner)|² with the scalar products of the sides.
        let inside = |k: usize| {
            let [p, q] = [1, 2].map(|j| start.weights[(k + j) % 3]);
            let [a, b, c] = [sides[k], sides[(k + 1) % 3], sides[(k + 2) % 3]];
            let product = 0.5 * (a * a + c * c - b * b);
            (p * p * a * a + q * q * c * c + 2.0 * p * q * product).max(0.0).sqrt()
        };
        let total = |k: &usize| inside(*k) + forest.distance[corners[*k]];
        let k = (0..3).min_by(|i, j| total(i).total_cmp(&total(j))).unwrap_or(0);
        let (mut path, mut v) = (Vec::new(), corners[k]);
        // Down the distances.
        while v != to {
            let down = |h: &HalfedgeId| forest.distance[mesh.tip(*h)] + lengths[h.edge()];
            let is_free = |h: &HalfedgeId| mesh.tip(*h) == to || !mesh.is_boundary_vertex(mesh.tip(*h));
            let closer = |h: &HalfedgeId| forest.distance[mesh.tip(*h)] < forest.distance[v];
            let next = mesh
                .outgoing(v)
                .filter(|h| is_free(h) && closer(h))
                .min_by(|g, h| down(g).total_cmp(&down(h)));
            let Some(h) = next else {
                return Err(Error::Matching(format!(
                    "a soft landmark has no way inside the target to vertex {to}: refine it there"
                )));
            };
            path.push(h);
            v = mesh.tip(h);
        }
        let length = inside(k) + path.iter().map(|h| lengths[h.edge()]).sum::<f64>();
        Ok(Approach { start, first: inside(k), corner: corners[k], path, length })
    }

    /// The place at a share of the way.
    ///
    /// # Errors
    /// Those of [`Place::at_vertex`].
    pub fn at(&self, target: &Surface, share: f64) -> Result<Place> {
        let mesh = target.mesh();
        let mut far = share * self.length;
        if far < self.first {
            let part = far / self.first;
            let corners = mesh.face_vertices(self.start.face);
            let weight = |k: usize| {
                (1.0 - part) * self.start.weights[k] + if corners[k] == self.corner { part } else { 0.0 }
            };
            return Ok(Place { face: self.start.face, weights: std::array::from_fn(weight) });
        }
        far -= self.first;
        for &h in &self.path {
            let length = target.lengths()[h.edge()];
            if let Some((face, k)) = mesh.corner(h).filter(|_| far < length) {
                let mut weights = [0.0; 3];
                (weights[k], weights[(k + 1) % 3]) = (1.0 - far / length, far / length);
                return Ok(Place { face, weights });
            }
            far -= length;
        }
        Place::at_vertex(mesh, self.path.last().map_or(self.corner, |h| mesh.tip(*h)))
    }
}
