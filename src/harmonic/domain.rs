//! The domain of harmonic maps and forms: a triangulated surface with Euclidean lengths and cotangent weights.
//!
//! ```text
//!        k            w_ij = (cot α + cot β) / 2, on the boundary cot α / 2
//!       /α\
//!      /   \          α + β ≤ π on a Delaunay triangulation: w_ij ≥ 0
//!     i ─── j                on edges inside
//!      \   /
//!       \β/
//! ```
//!
//! ```
//! use ricci::{Control, Surface, harmonic::Domain, mesh::shapes};
//! let sphere = Surface::from_soup(&shapes::icosphere(4)?)?;
//! let domain = Domain::new(&sphere, &Control::new())?;
//! assert!(domain.weights().iter().all(|&w| w > 0.0));
//! # Ok::<(), ricci::Error>(())
//! ```

use crate::archive::stored;
use crate::control::Control;
use crate::error::{Error, Result, check_size};
use crate::flow::Solution;
use crate::geometry::Space;
use crate::geometry::triangle::{area_from, half_differences};
use crate::mesh::{FaceId, Mesh, PerEdge, PerFace, PerVertex};
use crate::metric::lengths::face_lengths;
use crate::metric::{Class, CommonSubdivision, Surface};
use std::sync::Arc;

/// A metric on a triangulation of its own, with the lengths, weights and areas that harmonic maps and forms need. Clones share the metric.
///
/// Triangles of curved spaces are replaced by the Euclidean triangles of their chords, 2 sinh(l/2) and 2 sin(l/2), which differ from the
/// lengths by O(l³). A triangulation that is Delaunay in its space is Delaunay in the chords, so the weights of its interior edges are at
/// least 0; the weight of a boundary edge is negative if the angle opposite the edge is obtuse.
#[derive(Debug, Clone)]
pub struct Domain {
    metric: Arc<Solution>,
    lengths: PerEdge<f64>,
    cotangents: PerFace<[f64; 3]>,
    weights: PerEdge<f64>,
    face_areas: PerFace<f64>,
    vertex_areas: PerVertex<f64>,
}
stored!(sections Domain { metric, lengths, cotangents, weights, face_areas, vertex_areas } check Domain::check_parts);

impl Domain {
    /// Checks that the parts of an archive fit each other.
    fn check_parts(&self) -> Result<()> {
        let mesh = self.metric.mesh();
        check_size("lengths", self.lengths.len(), mesh.n_edges())?;
        check_size("cotangents", self.cotangents.len(), mesh.n_faces())?;
        check_size("weights", self.weights.len(), mesh.n_edges())?;
        check_size("areas of faces", self.face_areas.len(), mesh.n_faces())?;
        check_size("areas of vertices", self.vertex_areas.len(), mesh.n_vertices())
    }

    /// The domain of a surface on its intrinsic Delaunay triangulation; [`Domain::common_subdivision`] is the common subdivision with the given one.
    ///
    /// # Errors
    /// Those of [`crate::metric::delaunay_start`] and [`Domain::of_metric`]; [`Error::Cancelled`].
    pub fn new(surface: &Surface, control: &Control) -> Result<Domain> {
        let class = Class::yamabe(surface.geometry());
        Domain::of_metric(Solution::delaunay(surface.clone(), class, &[], control)?)
    }

    /// The domain of a surface on its own triangulation; the weights of edges that are not Delaunay are negative.
    ///
    /// # Errors
    /// Those of [`Solution::initial_of`] and [`Domain::of_metric`].
    pub fn rigid(surface: &Surface) -> Result<Domain> {
        Domain::of_metric(Solution::initial_of(surface.clone(), Class::yamabe(surface.geometry()))?)
    }

    /// The domain of a flow's result, on the triangulation of the result, which after vertex scaling with flips is the intrinsic Delaunay
    /// one. For an open surface that was solved on its double, the domain is the double.
    ///
    /// # Errors
    /// Those of [`crate::metric::Metric::lengths`]; [`Error::TriangleInequality`] for a face without area.
    pub fn of_metric(metric: impl Into<Arc<Solution>>) -> Result<Domain> {
        let metric = metric.into();
        let (mesh, space) = (metric.mesh(), metric.metric().space);
        let lengths = metric.metric().lengths(mesh)?;
        let lengths = PerEdge::from_fn(mesh.n_edges(), |e| chord(space, lengths[e]));
        let mut weights = PerEdge::filled(mesh.n_edges(), 0.0);
        let mut vertex_areas = PerVertex::filled(mesh.n_vertices(), 0.0);
        let mut face_areas = PerFace::filled(mesh.n_faces(), 0.0);
        let mut all = PerFace::filled(mesh.n_faces(), [0.0; 3]);
        for f in mesh.faces() {
            let r = half_differences(face_lengths(mesh, &lengths, f));
            all[f] = cotangents(r).ok_or_else(|| no_triangle(r, f))?;
            face_areas[f] = area_from(Space::E2, r);
            mesh.opposite_edges(f).into_iter().zip(all[f]).for_each(|(e, cot)| weights[e] += 0.5 * cot);
            mesh.face_vertices(f).into_iter().for_each(|v| vertex_areas[v] += face_areas[f] / 3.0);
        }
        Ok(Domain { lengths, cotangents: all, weights, face_areas, vertex_areas, metric })
    }

    /// The triangulation.
    pub fn mesh(&self) -> &Arc<Mesh> {
        self.metric.mesh()
    }

    /// The metric, with the surface as it was given.
    pub fn metric(&self) -> &Arc<Solution> {
        &self.metric
    }

    /// The Euclidean lengths of the edges (E entries): those of the metric in E², its chords elsewhere.
    pub fn lengths(&self) -> &PerEdge<f64> {
        &self.lengths
    }

    /// The cotangents of the angles at the corners of each face (F entries, in corner order).
    pub fn cotangents(&self) -> &PerFace<[f64; 3]> {
        &self.cotangents
    }

    /// The cotangent weights `(cot α + cot β)/2` of the edges (E entries), α and β opposite the edge.
    pub fn weights(&self) -> &PerEdge<f64> {
        &self.weights
    }

    /// The areas of the faces (F entries).
    pub fn face_areas(&self) -> &PerFace<f64> {
        &self.face_areas
    }

    /// The areas of the vertices (V entries): a third of the areas of the faces around each.
    pub fn vertex_areas(&self) -> &PerVertex<f64> {
        &self.vertex_areas
    }

    /// The common subdivision with the triangulation of the surface as it was given; `None` if both are the same.
    ///
    /// # Errors
    /// Those of [`Solution::common_subdivision`].
    pub fn common_subdivision(&self, control: &Control) -> Result<Option<CommonSubdivision>> {
        if self.metric.is_unflipped() { Ok(None) } else { self.metric.common_subdivision(control).map(Some) }
    }

    /// `L u` for a function of the vertices (V entries): at each vertex i the sum `Σ w_ij (u_i − u_j)` over its edges.
    ///
    /// # Panics
    /// If `u` has fewer entries.
    pub fn apply_laplacian(&self, u: &[f64]) -> Vec<f64> {
        let mut image = vec![0.0; u.len()];
        for e in self.mesh().edges() {
            let [i, j] = self.mesh().ends(e).map(|v| v.index());
            let flux = self.weights[e] * (u[i] - u[j]);
            image[i] += flux;
            image[j] -= flux;
        }
        image
    }

    /// The Dirichlet energy `½ Σ w_e (u_j − u_i)²` of a function that is linear on the faces (V entries).
    ///
    /// # Errors
    /// [`Error::Size`].
    pub fn energy(&self, u: &[f64]) -> Result<f64> {
        check_size("function", u.len(), self.mesh().n_vertices())?;
        let square = |[i, j]: [usize; 2]| (u[j] - u[i]) * (u[j] - u[i]);
        let ends = |e| self.mesh().ends(e).map(|v| v.index());
        Ok(self.mesh().edges().map(|e| 0.5 * self.weights[e] * square(ends(e))).sum())
    }
}

/// The length of the chord of an edge, in the plane or in the space around the hyperboloid or the sphere.
fn chord(space: Space, length: f64) -> f64 {
    match space {
        Space::E2 => length,
        Space::H2 => 2.0 * (0.5 * length).sinh(),
        Space::S2 => 2.0 * (0.5 * length).sin(),
    }
}

/// The cotangents of a triangle's angles from its half-perimeter differences, `cot θ_k = (1/t − t)/2` with
/// `t = tan(θ_k/2) = √(r_i r_j / (s r_k))`; `None` if the triangle has no area in f64.
fn cotangents(r: [f64; 3]) -> Option<[f64; 3]> {
    let s = r[0] + r[1] + r[2];
    // Ratios are formed first, since products of lengths may under- or overflow.
    let q = r.map(|x| (x / s).sqrt());
    let cot = [0, 1, 2].map(|k| {
        let t = q[(k + 1) % 3] * q[(k + 2) % 3] / q[k];
        0.5 * (1.0 / t - t)
    });
    let is_triangle = r.iter().all(|&x| x > 0.0) && cot.iter().all(|x| x.is_finite());
    is_triangle.then_some(cot)
}

fn no_triangle(r: [f64; 3], face: FaceId) -> Error {
    let least = r.into_iter().fold(f64::INFINITY, f64::min);
    let longest = r.iter().sum::<f64>() - least;
    Error::TriangleInequality { face: face.index(), excess: (-2.0 * least / longest).max(0.0) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cotangents_are_those_of_the_angles() {
        let r = half_differences([3.0, 4.0, 5.0]);
        let cot = cotangents(r).unwrap();
        assert!((cot[0] - 4.0 / 3.0).abs() < 1e-15 && (cot[1] - 0.75).abs() < 1e-15 && cot[2].abs() < 1e-15);
        let needle = cotangents(half_differences([1e-9, 1.0, 1.0])).unwrap();
        assert!((needle[0] * 1e-9 - 1.0).abs() < 1e-15 && (needle[1] - 0.5e-9).abs() < 1e-16);
        assert!(cotangents(half_differences([2.0, 1.0, 1.0])).is_none());
    }
}
