//! The removal of flat vertices from a triangulated flat surface: few vertices are left, and the others get places in their triangles.
//!
//! A vertex with total angle 2π (on the boundary π) is not singular: it can be removed, and the triangles around it replaced by fewer that
//! cover the same flat region. The metric does not change.

use super::flat::{FLAT, FlatMetric};
use crate::control::{Control, Stage};
use crate::error::{Result, check_size};
use crate::geometry::complex::{Complex, add, cross, distance, doubled_area, mul, scale, sub};
use crate::geometry::plane_triangle::PlaneTriangle;
use crate::mesh::{EdgeId, FaceId, HalfedgeId, Mesh, PerEdge, PerVertex, Place, Thinning, VertexId};

/// Least share of the quadrilateral's area that both triangles at a diagonal need for a flip to it.
const LEAST_SHARE: f64 = 1e-9;
/// Least violation of the Delaunay condition, relative to the sum of its terms, at which an edge is flipped: above rounding.
const DELAUNAY: f64 = 1e-12;
/// Least share of the quadrilateral's area for both triangles when an edge is flipped away from a corner of the boundary.
const EAR: f64 = 0.1;
/// Most vertices that are removed per boundary corner, on average, to leave each corner with one triangle.
const REMOVALS: usize = 4;
/// Number of removals between two checks for cancellation.
const STEPS: usize = 256;

/// An intrinsic Delaunay triangulation of a flat surface on few of its vertices.
#[derive(Debug, Clone)]
pub struct CoarseTriangulation {
    /// The triangulation, possibly a Δ-complex (with loops and double edges).
    pub mesh: Mesh,
    /// The lengths of its edges.
    pub lengths: PerEdge<f64>,
    /// For each vertex its number in the fine triangulation; vertices added around a vertex at infinity have the numbers after those.
    pub vertices: Vec<VertexId>,
    /// For each vertex of the fine triangulation its place; none for vertices at infinity or near it, beyond the triangles.
    pub places: PerVertex<Option<Place>>,
}

impl CoarseTriangulation {
    /// The triangulation of a flat metric on the vertices that `keep` names, the cones and the corners of the boundary.
    /// A kept inner vertex is removed as well if otherwise a corner of the boundary would have several triangles.
    ///
    /// # Errors
    /// [`crate::Error::Size`]; [`crate::Error::Cancelled`].
    pub fn new(flat: &FlatMetric, keep: &PerVertex<bool>, control: &Control) -> Result<CoarseTriangulation> {
        let mesh = &flat.mesh;
        check_size("vertices to keep", keep.len(), mesh.n_vertices())?;
        let curvature = flat.curvature()?;
        let mut work = Coarsening {
            n_vertices: mesh.n_vertices(),
            points: vec![Vec::new(); mesh.n_faces()],
            queue: Vec::new(),
            is_queued: vec![false; mesh.n_edges()],
            thinning: Thinning::new(Mesh::clone(mesh)),
            lengths: flat.lengths.clone(),
        };
        let mut steps = 0;
        for v in mesh.vertices() {
            if steps % STEPS == 0 {
                control.step(Stage::Layout, v.index() as f64 / mesh.n_vertices() as f64)?;
            }
            if !keep[v] && curvature[v].abs() <= FLAT {
                work.remove(v);
                steps += 1;
            }
        }
        let is_corner = |v: &VertexId| mesh.is_boundary_vertex(*v) && curvature[*v] > FLAT;
        let corners: Vec<VertexId> = mesh.vertices().filter(is_corner).collect();
        let is_free = |v: VertexId| !mesh.is_boundary_vertex(v) && curvature[v].abs() <= FLAT;
        // Removing a vertex can undo the flips at other corners, so the search starts again.
        for _ in 0..REMOVALS * corners.len() {
            let Some(v) = corners.iter().find_map(|&v| work.cut_ear(v, is_free)) else { break };
            work.remove(v);
        }
        for &v in &corners {
            work.cut_ear(v, is_free);
        }
        work.finish()
    }
}

/// A triangulation from which vertices are being removed.
struct Coarsening {
    /// The number of vertices of the fine triangulation.
    n_vertices: usize,
    thinning: Thinning,
    lengths: PerEdge<f64>,
    /// For each face the removed vertices in it, with their weights in the order of its corners.
    points: Vec<Vec<(VertexId, [f64; 3])>>,
    /// Edges that are possibly not Delaunay.
    queue: Vec<EdgeId>,
    is_queued: Vec<bool>,
}

/// The two triangles at a half-edge, laid out in the plane: its origin a at 0, its tip b on the positive axis, c on the
/// left, d on the right.
struct EdgeQuad {
    corners: [Complex; 4],
}

impl EdgeQuad {
    /// The shares of the area that the two triangles have after a flip, that of a first; one is not positive if the quadrilateral is not
    /// convex.
    fn shares(&self) -> [f64; 2] {
        let [a, b, c, d] = self.corners;
        let parts = [doubled_area([d, c, a]), doubled_area([c, d, b])];
        parts.map(|x| x / (parts[0] + parts[1]))
    }

    /// The height over the longest side of the triangle with corner b after a flip.
    fn quality(&self) -> f64 {
        let [_, b, c, d] = self.corners;
        let longest = distance(b, c).max(distance(c, d)).max(distance(d, b));
        doubled_area([c, d, b]) / (longest * longest)
    }

    /// The Delaunay condition sin(γ + δ) ≥ 0 for the angles γ, δ opposite the edge: negative by how much it fails.
    fn excess(&self) -> f64 {
        let [a, b, c, d] = self.corners;
        let direction = |p: Complex| {
            let (u, v) = (sub(a, p), sub(b, p));
            let (x, y) = (u[0] * v[0] + u[1] * v[1], cross(u, v).abs());
            let size = x.hypot(y);
            [x / size, y / size]
        };
        mul(direction(c), direction(d))[1]
    }
}

impl Coarsening {
    fn mesh(&self) -> &Mesh {
        self.thinning.mesh()
    }

    /// The third corner of the triangle on the left of a half-edge that is laid from 0 along the positive axis.
    fn apex(&self, h: HalfedgeId) -> Complex {
        let mesh = self.mesh();
        let [ab, bc, ca] = [h, mesh.next(h), mesh.prev(h)].map(|h| self.lengths[h.edge()]);
        scale(ca, PlaneTriangle::from_sides([bc, ca, ab]).direction[0])
    }

    /// The two triangles at a half-edge; none on the boundary, or if both are the same face.
    fn quad(&self, h: HalfedgeId) -> Option<EdgeQuad> {
        let mesh = self.mesh();
        let [f, g] = [mesh.face(h)?, mesh.face(h.twin())?];
        let (l, c, over) = (self.lengths[h.edge()], self.apex(h), self.apex(h.twin()));
        let d = [l - over[0], -over[1]];
        (f != g).then_some(EdgeQuad { corners: [[0.0; 2], [l, 0.0], c, d] })
    }

    fn flip(&mut self, h: HalfedgeId, quad: &EdgeQuad) {
        let mesh = self.thinning.mesh();
        let (Some(f), Some(g)) = (mesh.face(h), mesh.face(h.twin())) else { return };
        let [a, b, c, d] = quad.corners;
        let points = [(h, f, [a, b, c]), (h.twin(), g, [b, a, d])].map(|(h, f, corners)| {
            let first = mesh.corner(h).map_or(0, |(_, k)| k);
            let of = std::mem::take(&mut self.points[f.index()]);
            of.into_iter().map(move |(v, w)| {
                let w = [0, 1, 2].map(|k| w[(first + k) % 3]);
                (v, (0..3).fold([0.0; 2], |sum, k| add(sum, scale(w[k], corners[k]))))
            })
        });
        let points: Vec<(VertexId, Complex)> = points.into_iter().flatten().collect();
        self.thinning.flip(h.edge());
        self.lengths[h.edge()] = distance(c, d);
        // Mesh::flip leaves the triangle with corner a in the face of h, for either half-edge of the edge.
        for (v, p) in points {
            let is_near = quad.shares()[0] > LEAST_SHARE && doubled_area([d, c, p]) > 0.0;
            let (face, corners) = if is_near { (f, [d, c, a]) } else { (g, [c, d, b]) };
            self.points[face.index()].push((v, weights(p, corners)));
        }
        let around = [f, g].map(|f| self.mesh().face_halfedges(f));
        around.as_flattened().iter().for_each(|h| self.enqueue(h.edge()));
    }

    /// Flips edges away from a vertex until its degree allows a removal, removes it, and makes the triangulation Delaunay again. A vertex
    /// without which there is no triangulation stays, such as the last one of a torus.
    fn remove(&mut self, v: VertexId) {
        let few = if self.mesh().is_boundary_vertex(v) { 2 } else { 3 };
        loop {
            let fan = self.mesh().fan(v);
            if fan.len() <= few {
                self.take_out(v, &fan);
                break;
            }
            let leaves = |h: &HalfedgeId| {
                let mesh = self.mesh();
                [*h, h.twin()].iter().all(|&h| mesh.origin(mesh.prev(h)) != v) && mesh.tip(*h) != v
            };
            let inner = fan.iter().filter(|h| !self.mesh().is_boundary_edge(h.edge()) && leaves(h));
            let quads: Vec<(HalfedgeId, EdgeQuad)> = inner
                .filter_map(|&h| Some((h, self.quad(h)?)))
                .filter(|(_, quad)| quad.shares()[1] > LEAST_SHARE)
                .collect();
            // If the vertex lies on the line of two neighbours, a triangle at it has no area until the vertex is gone.
            let best = |least: f64| {
                let convex = quads.iter().filter(|(_, quad)| quad.shares()[0] > least);
                convex.max_by(|(e, x), (f, y)| x.quality().total_cmp(&y.quality()).then(f.cmp(e)))
            };
            let best = best(LEAST_SHARE).or_else(|| best(-LEAST_SHARE));
            let Some(&(h, ref quad)) = best else { break };
            self.flip(h, quad);
        }
        self.make_delaunay();
    }

    /// Flips edges away from a corner of the boundary, as long as triangles stay fat, to leave it one triangle: a spline is less smooth
    /// across edges that end at a corner. Returns the other end of an edge that is left, if `is_free` allows its removal.
    fn cut_ear(&mut self, v: VertexId, is_free: impl Fn(VertexId) -> bool) -> Option<VertexId> {
        loop {
            let fan = self.mesh().fan(v);
            let inner = fan.iter().filter(|h| !self.mesh().is_boundary_edge(h.edge()));
            let quads = inner.filter_map(|&h| Some((h, self.quad(h)?)));
            let fat = quads.filter(|(_, quad)| quad.shares().iter().all(|&share| share > EAR));
            let best = fat.max_by(|(e, x), (f, y)| x.quality().total_cmp(&y.quality()).then(f.cmp(e)));
            let Some((h, quad)) = best else { break };
            self.flip(h, &quad);
        }
        let mesh = self.mesh();
        let inner = mesh.fan(v).into_iter().filter(|h| !mesh.is_boundary_edge(h.edge()));
        let left = inner.filter(|&h| is_free(mesh.tip(h)));
        left.min_by(|a, b| self.lengths[a.edge()].total_cmp(&self.lengths[b.edge()])).map(|h| mesh.tip(h))
    }

    /// Removes a vertex of small enough degree; it and the points in its triangles move to the one triangle that replaces them.
    fn take_out(&mut self, v: VertexId, fan: &[HalfedgeId]) {
        let mesh = self.thinning.mesh();
        let is_boundary = mesh.is_boundary_vertex(v);
        let faces: Vec<(FaceId, usize)> = fan.iter().filter_map(|&h| mesh.corner(h)).collect();
        let ends = [fan.first(), fan.last()].map(|h| {
            h.map_or(0.0, |&h| {
                let along = if Some(&h) == fan.first() { h } else { mesh.prev(h) };
                self.lengths[along.edge()]
            })
        });
        let areas: Vec<f64> = faces.iter().map(|&(f, _)| self.area(f)).collect();
        let Some(left) = self.thinning.remove(v) else { return };
        // The weights of v in the triangle of its neighbours p_i, and the number of the corner at each p_i.
        let (shares, corner) = if is_boundary {
            let sum = ends[0] + ends[1];
            self.lengths[fan[0].edge()] = sum;
            ([ends[1] / sum, 0.0, ends[0] / sum], [1, 2, 0])
        } else {
            let sum = areas[0] + areas[1] + areas[2];
            ([areas[1] / sum, areas[2] / sum, areas[0] / sum], [0, 1, 2])
        };
        let mut points = Vec::new();
        let place = |w: [f64; 3]| {
            let mut weights = [0.0; 3];
            (0..3).for_each(|i| weights[corner[i]] = w[i]);
            weights
        };
        points.push((v, place(shares)));
        for (i, &(f, first)) in faces.iter().enumerate() {
            for (u, w) in std::mem::take(&mut self.points[f.index()]) {
                let mut p = shares.map(|share| share * w[first]);
                p[i] += w[(first + 1) % 3];
                p[(i + 1) % 3] += w[(first + 2) % 3];
                points.push((u, place(p)));
            }
        }
        self.points[left.index()] = points;
        let sides = self.mesh().face_halfedges(left);
        sides.iter().for_each(|h| self.enqueue(h.edge()));
    }

    fn area(&self, f: FaceId) -> f64 {
        PlaneTriangle::from_sides(self.mesh().opposite_edges(f).map(|e| self.lengths[e])).area
    }

    fn enqueue(&mut self, e: EdgeId) {
        if !std::mem::replace(&mut self.is_queued[e.index()], true) {
            self.queue.push(e);
        }
    }

    fn make_delaunay(&mut self) {
        while let Some(e) = self.queue.pop() {
            self.is_queued[e.index()] = false;
            if !self.thinning.has_edge(e) {
                continue;
            }
            if let Some(quad) = self.quad(e.halfedge())
                && quad.excess() < -DELAUNAY
                && quad.shares().iter().all(|&share| share > 0.0)
            {
                self.flip(e.halfedge(), &quad);
            }
        }
    }

    fn finish(mut self) -> Result<CoarseTriangulation> {
        let left = self.thinning.finish()?;
        let mut places = PerVertex::filled(self.n_vertices, None);
        for v in left.mesh.vertices() {
            let inside = left.mesh.outgoing(v).find_map(|h| left.mesh.corner(h));
            if let Some((face, corner)) = inside {
                let weights = [0, 1, 2].map(|k| if k == corner { 1.0 } else { 0.0 });
                places[left.vertices[v.index()]] = Some(Place { face, weights });
            }
        }
        for (face, old) in left.mesh.faces().zip(&left.faces) {
            for (v, weights) in std::mem::take(&mut self.points[old.index()]) {
                places[v] = Some(Place { face, weights });
            }
        }
        let lengths = PerEdge::from_fn(left.edges.len(), |e: EdgeId| self.lengths[left.edges[e.index()]]);
        Ok(CoarseTriangulation { mesh: left.mesh, lengths, vertices: left.vertices, places })
    }
}

/// The barycentric weights of a point in a triangle.
pub(super) fn weights(p: Complex, [a, b, c]: [Complex; 3]) -> [f64; 3] {
    let parts =
        [doubled_area([p, b, c]), doubled_area([a, p, c]), doubled_area([a, b, p])].map(|x| x.max(0.0));
    let sum = parts[0] + parts[1] + parts[2];
    parts.map(|x| x / sum)
}
