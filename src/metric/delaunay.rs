//! Weighted Delaunay triangulations of a metric, by edge flips inside its conformal class.
//!
//! A flip keeps the vectors of the vertices in Lorentz space ([`crate::geometry::flip`]), and with them the conformal class. It changes
//! the surface unless the edge is cocircular. Flips that leave the surface as it is are in [`super::isometric`].
//!
//! ```
//! use ricci::metric::delaunay::{ClassFlips, FlipQueue, failing};
//! use ricci::{Class, Control, Surface, geometry::Space, mesh::{FixedEdges, Mesh, shapes}};
//!
//! let torus = Surface::from_soup(&shapes::torus(2.0, 1.0, 24, 12)?)?;
//! let mut mesh = Mesh::clone(torus.mesh());
//! let mut metric = torus.initial(Class::yamabe(Space::E2))?.metric;
//! let (vertices, mut queue) = (metric.vertices(), FlipQueue::all(&mesh, &FixedEdges::none()));
//! let mut flips = ClassFlips { mesh: &mut mesh, metric: &mut metric, record: &mut |_, _| {} };
//! flips.restore_delaunay(&vertices, &mut queue, &Control::new())?;
//! assert!(failing(&mesh, &metric).is_empty());
//! # Ok::<(), ricci::Error>(())
//! ```

use super::flip_queue::{Flippable, allowance, between_faces, endless};
use super::lengths::Metric;
use crate::control::Control;
use crate::error::{Result, check_size};
use crate::geometry::conformal::Vertex;
use crate::geometry::flip::{Hinge, precise_weight, weight};
use crate::geometry::{DoubleDouble, Space};
use crate::mesh::{EdgeId, FixedEdges, Flip, HalfedgeId, Mesh, PerEdge, PerVertex, VertexId};
use std::sync::Arc;

pub use super::flip_queue::FlipQueue;
pub use super::isometric::{IntrinsicOptions, Triangulated, intrinsic_delaunay};

/// Largest |η| that a flip makes, about 2^960: numbers formed from edges below it stay in the range of f64 with all their digits. An
/// edge whose other diagonal has a larger one is not flipped.
const MAX_ETA: f64 = 1e289;

/// Largest |η − 1| at which two circles count as touching. An edge is not flipped into one between such circles, since it could not be
/// flipped back. Such an edge arises where a circle meets itself around a point on it that has one other edge: the size of the point is
/// known from that edge alone.
const TOUCHING: f64 = 1e-12;

/// The four vertices of the hinge of half-edge h (origin, tip, left, right), and its five half-edges: h, then those of the left and the
/// right face at the origin and at the tip of h.
fn hinge_of(mesh: &Mesh, h: HalfedgeId) -> ([VertexId; 4], [HalfedgeId; 5]) {
    let [jk, ki, il, lj] = mesh.quadrilateral(h);
    ([h, h.twin(), ki, lj].map(|h| mesh.origin(h)), [h, ki, jk, il, lj])
}

/// A metric whose edges are flipped inside its conformal class: η changes on the edges flipped.
pub struct ClassFlips<'a> {
    /// The triangulation.
    pub mesh: &'a mut Mesh,
    /// The metric on it.
    pub metric: &'a mut Metric,
    /// Told each flip (the edge with its η) just before it is made.
    pub record: &'a mut dyn FnMut(&Mesh, Flip<DoubleDouble>),
}

impl ClassFlips<'_> {
    /// Flip, from the edges of `queue` on, until every edge is weighted Delaunay where the vertices are those of `vertices` (V entries;
    /// [`Metric::vertices`]) or cannot be flipped (E², H²). Returns the number of flips.
    ///
    /// # Errors
    /// Some flips are done then.
    /// - [`crate::Error::Size`]: not one entry per vertex.
    /// - [`crate::Error::Connectivity`]: the flips do not end, which rounding alone could cause.
    /// - [`crate::Error::Cancelled`].
    pub fn restore_delaunay(
        &mut self,
        vertices: &[Vertex],
        queue: &mut FlipQueue,
        control: &Control,
    ) -> Result<usize> {
        let ClassFlips { mesh, metric, record } = self;
        check_size("vertices", vertices.len(), mesh.n_vertices())?;
        control.check()?;
        let (space, is_precise) = (metric.space, metric.is_precise());
        let hinge = |mesh: &Mesh, h| VertexHinge::new(space, mesh, h, |v| vertices[v.index()]);
        queue.keep_where(|h| between_faces(mesh, h) && hinge(mesh, h).wants_flip(&metric.eta, is_precise));
        if queue.is_empty() {
            // Weights that other metrics share stay shared.
            return Ok(0);
        }
        let decide = |mesh: &Mesh, eta: &PerEdge<DoubleDouble>, h: HalfedgeId| {
            let hinge = hinge(mesh, h);
            if hinge.wants_flip(eta, is_precise) { hinge.other_diagonal(eta) } else { None }
        };
        let most = allowance(mesh.n_edges());
        let flips = queue.flip_until_empty(
            most,
            &mut Flippable { mesh, values: Arc::make_mut(&mut metric.eta), decide, record },
            control,
        )?;
        if queue.is_empty() {
            return Ok(flips);
        }
        Err(endless("edge flips inside the conformal class do not end after 100 per edge and a million"))
    }

    /// Flip one edge, whether it is Delaunay or not. False, and nothing done, where it has no other diagonal.
    pub(crate) fn flip(&mut self, edge: EdgeId) -> bool {
        let h = edge.halfedge();
        if !between_faces(self.mesh, h) {
            return false;
        }
        let metric = &mut *self.metric;
        let hinge = VertexHinge::new(metric.space, self.mesh, h, |v| metric.vertex(v));
        let Some(eta) = hinge.other_diagonal(&metric.eta) else { return false };
        (self.record)(self.mesh, Flip { edge, value: metric.eta[edge] });
        Arc::make_mut(&mut metric.eta)[edge] = eta;
        self.mesh.flip(edge)
    }
}

/// The four vertices of a hinge at variables of their own, and its five half-edges.
struct VertexHinge {
    space: Space,
    vertices: [Vertex; 4],
    sides: [HalfedgeId; 5],
}

impl VertexHinge {
    fn new(space: Space, mesh: &Mesh, h: HalfedgeId, vertex: impl Fn(VertexId) -> Vertex) -> VertexHinge {
        let (vertices, sides) = hinge_of(mesh, h);
        VertexHinge { space, vertices: vertices.map(vertex), sides }
    }

    fn epsilon(&self) -> [f64; 4] {
        self.vertices.map(|v| v.epsilon)
    }

    /// True if the edge fails the weighted Delaunay condition and can be flipped. `is_precise`: [`Metric::is_precise`] of the metric.
    fn wants_flip(&self, eta: &PerEdge<DoubleDouble>, is_precise: bool) -> bool {
        let w = self.vertices.map(|v| weight(self.space, v));
        let rounded = Hinge::of_weights(self.epsilon(), w, self.sides.map(|h| eta[h.edge()].high)).0;
        rounded.verdict().unwrap_or_else(|| is_precise && self.precise(eta).0.wants_flip())
    }

    /// The hinge in double-double precision, and the product of the `w` of its left and right vertex in the hinge's unit.
    fn precise(&self, eta: &PerEdge<DoubleDouble>) -> (Hinge<DoubleDouble>, DoubleDouble) {
        let w = self.vertices.map(|v| precise_weight(self.space, v));
        Hinge::of_weights(self.epsilon(), w, self.sides.map(|h| eta[h.edge()]))
    }

    /// η of the other diagonal in double-double precision, also where w is less precise, since it does not depend on w; `None` where there
    /// is no other diagonal, where its η is above [`MAX_ETA`], or where it would join circles that touch.
    fn other_diagonal(&self, eta: &PerEdge<DoubleDouble>) -> Option<DoubleDouble> {
        let (hinge, scale) = self.precise(eta);
        let [.., k, l] = self.vertices;
        let touch =
            |eta: DoubleDouble| k.epsilon * l.epsilon > 0.0 && (eta - 1.0.into()).high.abs() <= TOUCHING;
        let flipped = hinge.flipped().map(|product| product / scale);
        flipped.filter(|&eta| eta.high.abs() <= MAX_ETA && !touch(eta))
    }
}

/// The edges that fail the weighted Delaunay condition and can be flipped, ascending.
pub fn failing(mesh: &Mesh, metric: &Metric) -> Vec<EdgeId> {
    let (vertices, is_precise) = (metric.vertices(), metric.is_precise());
    let fails =
        |h| VertexHinge::new(metric.space, mesh, h, |v| vertices[v]).wants_flip(&metric.eta, is_precise);
    FlipQueue::where_holds(mesh, &FixedEdges::none(), fails).into_vec()
}

/// True if some boundary edge would be flipped on the surface's double, where its face meets the mirror image of that face. `fixed`
/// edges would not be.
pub fn boundary_fails(mesh: &Mesh, metric: &Metric, u: &PerVertex<f64>, fixed: &FixedEdges) -> bool {
    let fails = |h: HalfedgeId| {
        let [jk, ki] = [mesh.next(h), mesh.prev(h)];
        let [i, j, k] = [h, jk, ki].map(|h| mesh.origin(h));
        let corners = [i, j, k, k];
        let w = corners.map(|v| weight(metric.space, Vertex::new(metric.space, metric.epsilon[v], u[v])));
        let eta = [h, ki, jk, ki, jk].map(|h| metric.eta[h.edge()].high);
        Hinge::of_weights(corners.map(|v| f64::from(metric.epsilon[v])), w, eta).0.wants_flip()
    };
    let mut along = mesh.edges().flat_map(|e| [e.halfedge(), e.halfedge().twin()]);
    along.any(|h| mesh.is_outside(h.twin()) && !fixed.contains(h.edge()) && fails(h))
}
