//! Soft landmarks: landmarks that need not be met, but draw the map near their partners.
//!
//! The map without them stands for the minimum of an energy ½ r² of the distance r that each is moved from there, and the landmark adds ½ w
//! s² of the distance s to its partner. Both distances are taken along a shortest path of edges on the target, so that the sum is least at
//! the share w/(1 + w) of the path. The landmark is met exactly at this point, by a map without folds.
//!
//! A spring in the energy of the map itself would not do that. A point has no capacity in the Dirichlet energy: the spring moves its vertex
//! and little around it, and a vertex that is pulled is no mean of its neighbours, so that nothing keeps faces from folding. In a plane
//! disk of 4, 8, 16 and 32 rings whose middle is pulled, faces fold once it has moved by 0.44, 0.27, 0.16 and 0.09 of the radius
//! (`tests/library/matching/landmarks.rs`): the finer the mesh, the less a spring could do before it had to be weakened.

use crate::control::Control;
use crate::error::{Error, Result};
use crate::matching::options::{MatchOptions, SoftLandmark};
use crate::matching::result::Matching;
use crate::mesh::{HalfedgeId, Place, VertexId};
use crate::metric::Surface;
use crate::topology::{check_vertex, shortest_paths};

/// Number of times that the paths of soft landmarks are halved if they are in conflict.
const MOST_HALVINGS: usize = 4;

/// The map that brings the soft landmarks of these options near their partners. `matching` finds maps by options without soft landmarks.
///
/// # Errors
/// [`Error::Argument`] for a vertex that does not exist and a weight that is negative or not finite; [`Error::Matching`] for a landmark on
/// a boundary; those of `matching`.
pub(crate) fn match_near(
    surfaces: [&Surface; 2],
    options: &MatchOptions,
    control: &Control,
    matching: impl Fn(&MatchOptions) -> Result<Matching>,
) -> Result<Matching> {
    check(surfaces, &options.soft)?;
    let target = surfaces[1];
    let hard = MatchOptions { soft: Vec::new(), ..options.clone() };
    let first = matching(&hard)?;
    let path =
        |s: &SoftLandmark| SoftPath::new(target, first.forward.places[s.pair[0].index()], s.pair[1], control);
    let paths: Vec<SoftPath> = options.soft.iter().map(path).collect::<Result<_>>()?;
    let mut part = 1.0;
    for halvings_left in (0..=MOST_HALVINGS).rev() {
        let shares = options.soft.iter().map(|soft| part * soft.weight / (1.0 + soft.weight));
        let shares: Vec<f64> = shares.collect();
        let goal = |(k, soft): (usize, &SoftLandmark)| {
            Ok([Place::at_vertex(surfaces[0].mesh(), soft.pair[0])?, paths[k].at(target, shares[k])?])
        };
        let goals: Vec<[Place; 2]> = options.soft.iter().enumerate().map(goal).collect::<Result<_>>()?;
        let points = options.points.iter().copied().chain(goals).collect();
        match matching(&MatchOptions { points, ..hard.clone() }) {
            Ok(mut matching) => {
                let soft = options.points.len()..options.points.len() + paths.len();
                matching.points.drain(soft);
                let left = paths.iter().zip(&shares).map(|(path, share)| (1.0 - share) * path.length);
                matching.soft_left = left.collect();
                return Ok(matching);
            }
            Err(why @ Error::Matching(_)) if halvings_left == 0 => return Err(why),
            Err(Error::Matching(_)) => part *= 0.5,
            Err(other) => return Err(other),
        }
    }
    Ok(first)
}

fn check(surfaces: [&Surface; 2], all: &[SoftLandmark]) -> Result<()> {
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

/// The path on the target from the image of a soft landmark to its partner.
struct SoftPath {
    start: Place,
    /// Length of the first part, from the start to a corner of its face.
    first: f64,
    corner: VertexId,
    /// The edges from the corner on.
    edges: Vec<HalfedgeId>,
    length: f64,
}

impl SoftPath {
    /// The shortest path from a place to a vertex.
    ///
    /// # Errors
    /// [`Error::Matching`] if there is none inside the surface; those of [`shortest_paths`].
    fn new(target: &Surface, start: Place, to: VertexId, control: &Control) -> Result<SoftPath> {
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
        let (mut edges, mut v) = (Vec::new(), corners[k]);
        // From vertex to vertex in the direction of descending distance, never along the boundary.
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
                    "a soft landmark has no way inside the target to vertex {to}: refine the target (`ricci refine --edge L`)"
                )));
            };
            edges.push(h);
            v = mesh.tip(h);
        }
        let length = inside(k) + edges.iter().map(|h| lengths[h.edge()]).sum::<f64>();
        Ok(SoftPath { start, first: inside(k), corner: corners[k], edges, length })
    }

    /// The place at a share of the length.
    ///
    /// # Errors
    /// Those of [`Place::at_vertex`].
    fn at(&self, target: &Surface, share: f64) -> Result<Place> {
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
        for &h in &self.edges {
            let length = target.lengths()[h.edge()];
            if let Some((face, k)) = mesh.corner(h).filter(|_| far < length) {
                let mut weights = [0.0; 3];
                (weights[k], weights[(k + 1) % 3]) = (1.0 - far / length, far / length);
                return Ok(Place { face, weights });
            }
            far -= length;
        }
        Place::at_vertex(mesh, self.edges.last().map_or(self.corner, |h| mesh.tip(*h)))
    }
}
