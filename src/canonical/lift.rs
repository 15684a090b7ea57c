//! Lifts the punctured plane to the sphere: layout, centring, lift, and the test whether the lifted triangulation is convex.

use super::star::PuncturedSurface;
use crate::control::Control;
use crate::embed::unfold::{unfold_part, unfold_part_precisely};
use crate::error::{Error, Result};
use crate::geometry::barycentre::conformal_barycentre;
use crate::geometry::double_double::two_sum;
use crate::geometry::sphere::{SOUTH, Similarity, lift, log_density};
use crate::geometry::vector::{add, cross, dot, norm, scale, sub};
use crate::geometry::{DoubleDouble, Space, worse};
use crate::mesh::{Mesh, PerEdge, PerHalfedge, PerVertex, Point, VertexId};
use crate::metric::Metric;
use std::f64::consts::FRAC_2_PI;
use std::sync::Arc;

/// Span of u from which on a failure is put down to the length of the surface: squares of lengths have factors e^(2u), down to e^−708 in f64.
/// Seen from its middle, a sheet spans π/2 times its length over its width.
const WIDEST_SPAN: f64 = 354.0;

/// The span of u, if it is so large that f64s hardly hold the squares of all lengths: then a part of the surface is about 2/π times that span as
/// long as wide.
pub(super) fn span_beyond_range(u: impl Iterator<Item = f64>) -> Option<f64> {
    let [least, most] =
        u.fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], u| [least.min(u), most.max(u)]);
    (most - least > WIDEST_SPAN).then_some(most - least)
}

impl PuncturedSurface {
    /// The vertices in the plane, the smallest triangle at the origin; the puncture at (∞, ∞).
    ///
    /// # Errors
    ///
    /// [`Error::Layout`] where vertices lie in no triangle of the plane; [`Error::Cancelled`].
    pub fn unfold(&self, control: &Control) -> Result<PerVertex<[f64; 2]>> {
        let (mesh, is_cut) = (Arc::new(self.mesh.clone()), self.link_edges());
        self.placed(&unfold_part(&mesh, &self.closed(), &is_cut, control)?, |x| x)
    }

    /// [`PuncturedSurface::unfold`] in double-double precision.
    ///
    /// # Errors
    ///
    /// As there.
    pub fn unfold_precisely(&self, control: &Control) -> Result<PerVertex<[DoubleDouble; 2]>> {
        let (mesh, is_cut) = (Arc::new(self.mesh.clone()), self.link_edges());
        self.placed(&unfold_part_precisely(&mesh, &self.closed(), &is_cut, control)?, f64::from)
    }

    /// True at the edges of the link, which bound the planar part.
    fn link_edges(&self) -> PerEdge<bool> {
        let mut is_link = PerEdge::filled(self.mesh.n_edges(), false);
        self.star().into_iter().for_each(|arc| is_link[self.link(arc).edge()] = true);
        is_link
    }

    /// The places of the vertices from those of the corners of the planar part.
    fn placed<T: Copy + From<f64>>(
        &self,
        corners: &PerHalfedge<[T; 2]>,
        rounded: fn(T) -> f64,
    ) -> Result<PerVertex<[T; 2]>> {
        let mut plane = PerVertex::filled(self.mesh.n_vertices(), [T::from(f64::INFINITY); 2]);
        for h in self.mesh.halfedges().filter(|&h| !self.in_star(h)) {
            plane[self.mesh.origin(h)] = corners[h];
        }
        let outside = |v: &VertexId| *v != self.at && plane[*v].iter().any(|&x| !rounded(x).is_finite());
        match self.mesh.vertices().find(outside) {
            Some(v) => Err(self.unplaced(v)),
            None => Ok(plane),
        }
    }

    /// The error at a vertex without a place in the plane.
    fn unplaced(&self, v: VertexId) -> Error {
        let others = self.mesh.vertices().filter(|&w| w != self.at).map(|w| self.metric.u[w]);
        let at = self.at;
        Error::Layout(if let Some(span) = span_beyond_range(others) {
            format!(
                "seen from vertex {at} lengths near vertex {v} are e^{span:.0} times smaller than others: a part of the surface is about {:.0} \
                 times as long as wide, or more, too long for f64s in one disk. `ricci flow` lays such a sheet out with the lengths of its outline; cut \
                 across, its parts become disks",
                span * FRAC_2_PI
            )
        } else {
            format!(
                "seen from vertex {at} vertex {v} lies in no triangle: cut each triangle into four, `ricci refine --levels 1`"
            )
        })
    }

    /// The similarity of the plane after which the weighted mean of the lifted vertices is the centre of the sphere.
    ///
    /// # Errors
    ///
    /// [`Error::Layout`] where half of the weight lies at one place.
    pub fn centre(&self, plane: &PerVertex<[f64; 2]>, weights: &PerVertex<f64>) -> Result<Similarity> {
        let others = || self.mesh.vertices().filter(|&v| v != self.at);
        let points: Vec<[f64; 2]> = others().map(|v| plane[v]).collect();
        let masses: Vec<f64> = others().map(|v| weights[v]).collect();
        conformal_barycentre(&points, &masses, weights[self.at])
            .map_err(|error| Error::Layout(error.to_string()))
    }

    /// The metric of the class whose chords are those of the lifted vertices, with `plane` after the similarity of that scale:
    /// `u_i − log t − log(1 + |z_i|²)`, and log t at the puncture.
    pub fn spherical(&self, plane: &PerVertex<[f64; 2]>, log_scale: f64) -> Metric {
        let n = self.mesh.n_vertices();
        let [mut u, mut u_low] = [(); 2].map(|()| PerVertex::filled(n, 0.0));
        for v in self.mesh.vertices() {
            let (density, lost) = if v == self.at { (0.0, 0.0) } else { log_density(plane[v]) };
            let seen = if v == self.at { 2.0 * log_scale } else { self.metric.u[v] };
            let (sum, first) = two_sum(seen, -log_scale);
            let (sum, second) = two_sum(sum, -density);
            (u[v], u_low[v]) = two_sum(sum, self.metric.u_low[v] + (first + second - lost));
        }
        Metric { space: Space::S2, u, u_low, ..self.metric.clone() }
    }

    /// Largest excess over π of the angles opposite an edge of the planar part: 0 if every edge is Delaunay.
    pub fn delaunay_violation(&self) -> Result<f64> {
        Ok(self.excess()?.iter().copied().fold(0.0, worse))
    }
}

/// Points of the plane, (∞, ∞) among them, on the unit sphere.
pub(super) fn lifted(plane: &PerVertex<[f64; 2]>) -> PerVertex<Point> {
    PerVertex::from_fn(plane.len(), |v| if plane[v][0].is_finite() { lift(plane[v]) } else { SOUTH })
}

/// The largest signed distance of a face's corner over the plane of a neighbouring face: not positive where every edge is convex.
/// Faces whose area is 0 in f64 have no plane and are left out.
pub(super) fn nonconvexity(mesh: &Mesh, positions: &PerVertex<Point>) -> f64 {
    let over = |h| {
        let [a, b, c] = [h, mesh.next(h), mesh.prev(h)].map(|h| positions[mesh.origin(h)]);
        let normal = cross(sub(b, a), sub(c, a));
        let size = norm(normal);
        let top = positions[mesh.origin(mesh.prev(h.twin()))];
        if size == 0.0 { f64::NEG_INFINITY } else { dot(normal, sub(top, a)) / size }
    };
    mesh.halfedges().map(over).fold(f64::NEG_INFINITY, worse)
}

/// `|Σ w x| / Σ w`.
pub(super) fn off_centre(positions: &PerVertex<Point>, weights: &PerVertex<f64>) -> f64 {
    let sum = positions.iter().zip(weights.iter()).fold([0.0; 3], |sum, (x, w)| add(sum, scale(*w, *x)));
    worse(norm(sum) / weights.iter().sum::<f64>(), 0.0)
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn what_cannot_be_measured_is_no_pass() {
        let mesh = Mesh::from_faces(4, &[[0, 1, 2], [0, 3, 1], [1, 3, 2], [2, 3, 0]]).unwrap();
        let corners = [[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]];
        let mut positions: PerVertex<Point> = corners.to_vec().into();
        let weights = PerVertex::filled(4, 1.0);
        assert!(nonconvexity(&mesh, &positions) < -1.0 && off_centre(&positions, &weights) == 0.0);
        for v in 0..4 {
            let sound = std::mem::replace(&mut positions[VertexId(v)][0], f64::NAN);
            assert_eq!(nonconvexity(&mesh, &positions), f64::INFINITY);
            assert_eq!(off_centre(&positions, &weights), f64::INFINITY);
            positions[VertexId(v)][0] = sound;
        }
    }
}
