//! Domains of spheres: a triangulated part of the plane, and a hole around the vertex at infinity.
//!
//! Around infinity the surface is a function of w = ρ/z, which fills the hole |w| < 1. The triangles of the plane end at a ring of
//! additional vertices, where the filling alone is the surface. Near the hole the spline is a polynomial of z, but the surface a smooth
//! function of w; triangles there must be small compared to their distance from infinity.

use super::coarse::{CoarseTriangulation, weights};
use super::domain::SurfaceDomain;
use super::flat::FlatMetric;
use super::infinity::InfinityHole;
use super::similarity::PlaneSimilarity;
use crate::error::{Error, Result};
use crate::geometry::complex::{Complex, conj, distance, mul, norm, norm2, scale, sub};
use crate::mesh::{FaceId, Mesh, PerEdge, PerVertex, Place, VertexId};
use crate::spline::Hole;
use crate::spline::triangular::INFINITE;
use spade::handles::FaceHandle;
use spade::{DelaunayTriangulation, HierarchyHintGenerator, Point2, PositionInTriangulation, Triangulation};
use std::collections::HashMap;
use std::f64::consts::TAU;

/// Number of vertices of the ring.
pub(super) const RING: usize = 8;
/// |w| of the ring. Its edges, and the knots of its vertices, have |w| < 0.7.
const RIM: f64 = 0.55;
/// |w| below which no vertex of the surface is taken into the triangulation.
const BARE: f64 = 0.85;
/// The hole is as large as that of a vertex with so many turns; around a smaller one triangles would be large compared to their distance
/// from infinity.
pub(super) const TURNS: f64 = 4.0;

/// The vertices of a sphere in the plane, and the radius of the disk outside of which the hole lies.
pub(super) struct PuncturedPlane<'a> {
    places: &'a PerVertex<Complex>,
    radius: f64,
}

type PlaneDelaunay = DelaunayTriangulation<Point2<f64>, (), (), (), HierarchyHintGenerator<f64>>;

impl<'a> PuncturedPlane<'a> {
    /// The plane with a number of vertices in its hole; none if the surface is not a sphere.
    pub fn new(flat: &'a FlatMetric, inside: usize) -> Option<PuncturedPlane<'a>> {
        let places = flat.plane.as_ref()?;
        let mut far: Vec<f64> = places.iter().map(|&z| norm(z)).filter(|far| far.is_finite()).collect();
        far.sort_by(|a, b| b.total_cmp(a));
        let radius = *far.get(inside.min(far.len().max(1) - 1))?;
        Some(PuncturedPlane { places, radius })
    }

    /// True if a vertex may be taken into the triangulation.
    pub fn is_free(&self, v: VertexId) -> bool {
        norm(self.places[v]) * BARE <= self.radius
    }

    /// The domain on the vertices that `keep` names, Delaunay in the plane.
    ///
    /// # Errors
    /// [`Error::Layout`] for places that cannot be triangulated.
    pub fn domain(&self, keep: &PerVertex<bool>) -> Result<SurfaceDomain> {
        let n = self.places.len();
        let kept = (0..n as u32).map(VertexId).filter(|&v| keep[v] && self.is_free(v));
        let ring = (0..RING).map(|k| {
            let (far, angle) = (self.radius / RIM, TAU * k as f64 / RING as f64);
            (VertexId((n + k) as u32), [far * angle.cos(), far * angle.sin()])
        });
        let mut delaunay = PlaneDelaunay::new();
        let (mut vertices, mut places): (Vec<VertexId>, Vec<Complex>) = (Vec::new(), Vec::new());
        for (v, z) in ring.chain(kept.map(|v| (v, self.places[v]))) {
            let refuse = |why| Error::Layout(format!("place of vertex {v} in the plane: {why}"));
            let at = delaunay.insert(Point2::new(z[0], z[1])).map_err(refuse)?;
            // Among vertices with equal places only the first one is taken.
            if at.index() == places.len() {
                vertices.push(v);
                places.push(z);
            }
        }
        let corners = |f: FaceHandle<'_, _, _, _, _, _>| f.vertices().map(|v| v.index() as u32);
        let faces: Vec<[u32; 3]> = delaunay.inner_faces().map(corners).collect();
        let mesh = Mesh::from_faces(places.len(), &faces)?;
        let lengths = PerEdge::from_fn(mesh.n_edges(), |e| {
            let [a, b] = mesh.ends(e).map(|v| places[v.index()]);
            distance(a, b)
        });
        let found = self.locate(&delaunay, &faces, &places);
        let mut domain = SurfaceDomain::new(CoarseTriangulation { mesh, lengths, vertices, places: found })?;
        domain.infinity = Some(self.infinity(&domain, &places)?);
        Ok(domain)
    }

    /// The place of each vertex of the surface; none beyond the triangles.
    fn locate(
        &self,
        delaunay: &PlaneDelaunay,
        faces: &[[u32; 3]],
        places: &[Complex],
    ) -> PerVertex<Option<Place>> {
        let numbers: HashMap<usize, usize> =
            delaunay.inner_faces().enumerate().map(|(i, f)| (f.index(), i)).collect();
        let inner = |f: Option<FaceHandle<'_, spade::handles::InnerTag, _, _, _, _>>| f.map(|f| f.index());
        PerVertex::from_fn(self.places.len(), |v: VertexId| {
            let z = self.places[v];
            if !z[0].is_finite() {
                return None;
            }
            let face = match delaunay.locate(Point2::new(z[0], z[1])) {
                PositionInTriangulation::OnFace(f) => Some(f.index()),
                PositionInTriangulation::OnEdge(e) => {
                    let e = delaunay.directed_edge(e);
                    inner(e.face().as_inner()).or(inner(e.rev().face().as_inner()))
                }
                PositionInTriangulation::OnVertex(u) => {
                    delaunay.vertex(u).out_edges().find_map(|e| inner(e.face().as_inner()))
                }
                _ => None,
            };
            let face = *numbers.get(&face?)?;
            let corners = faces[face].map(|v| places[v as usize]);
            Some(Place { face: FaceId(face as u32), weights: weights(z, corners) })
        })
    }

    fn infinity(&self, domain: &SurfaceDomain, places: &[Complex]) -> Result<InfinityHole> {
        let mesh = &domain.coarse().mesh;
        let sector = |f: FaceId| {
            let z = mesh.face_vertices(f).map(|v| places[v.index()]);
            let corners = domain.corners(f);
            let along = sub(corners[1], corners[0]);
            let turn = scale(1.0 / norm2(along), mul(sub(z[1], z[0]), conj(along)));
            let to = PlaneSimilarity { turn, shift: sub(z[0], mul(turn, corners[0])) };
            let is_far = z.iter().any(|&z| norm(z) > self.radius);
            is_far.then(|| domain.sector(f, to, 0.0))
        };
        let sectors = mesh.faces().filter_map(sector).collect();
        let hole = Hole::new(mesh.n_faces() as u32, sectors, INFINITE, self.radius)?;
        let all = (0..self.places.len() as u32).map(VertexId);
        let beyond = all.filter(|&v| domain.coarse().places[v].is_none()).map(|v| (v, self.in_hole(v)));
        Ok(InfinityHole { hole, beyond: beyond.collect() })
    }

    /// The coordinate w of a vertex.
    fn in_hole(&self, v: VertexId) -> Complex {
        let z = self.places[v];
        if z[0].is_finite() { scale(self.radius / norm2(z), conj(z)) } else { [0.0; 2] }
    }
}
