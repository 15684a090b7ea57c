//! Weighted Delaunay triangulations of a metric, by edge flips inside its conformal class.
//!
//! A flip keeps the vectors of the vertices in Lorentz space ([`crate::geometry::flip`]), and with them the conformal class. It changes
//! the surface unless the edge is cocircular. Flips that leave the surface as it is are in [`super::isometric`].
//!
//! ```
//! use ricci::metric::delaunay::{ClassFlips, Queue, failing};
//! use ricci::{Class, Control, Surface, geometry::Space, mesh::{FixedEdges, Mesh, shapes}};
//!
//! let torus = Surface::from_soup(&shapes::torus(2.0, 1.0, 24, 12)?)?;
//! let mut mesh = Mesh::clone(torus.mesh());
//! let mut metric = torus.initial(Class::yamabe(Space::E2))?.metric;
//! let (u, mut queue) = (metric.u.clone(), Queue::all(&mesh, &FixedEdges::none()));
//! let mut flips = ClassFlips { mesh: &mut mesh, metric: &mut metric, record: &mut |_, _| {} };
//! flips.restore_delaunay(&u, &mut queue, &Control::new())?;
//! assert!(failing(&mesh, &metric, &u).is_empty());
//! # Ok::<(), ricci::Error>(())
//! ```

use super::flip_queue::{Flippable, allowance, between_faces, endless};
use super::lengths::Metric;
use crate::control::Control;
use crate::error::{Result, check_size};
use crate::geometry::conformal::Vertex;
use crate::geometry::flip::{Hinge, Weight, weight};
use crate::mesh::{EdgeId, FixedEdges, Flip, HalfedgeId, Mesh, PerEdge, PerVertex, VertexId};

pub use super::flip_queue::Queue;
pub use super::isometric::{IntrinsicOptions, Triangulated, intrinsic_delaunay};

/// The four vertices of the hinge of half-edge h (origin, tip, left, right), and its five half-edges: h, then those of the left and the right
/// face at the origin and at the tip of h.
fn hinge_of(mesh: &Mesh, h: HalfedgeId) -> ([VertexId; 4], [HalfedgeId; 5]) {
    let [jk, ki, il, lj] = mesh.quadrilateral(h);
    ([h, h.twin(), ki, lj].map(|h| mesh.origin(h)), [h, ki, jk, il, lj])
}

/// The Delaunay hinge of half-edge h, with `w` per vertex of the mesh, and the product of the `w` of its left and right vertex in the
/// hinge's unit.
fn hinge(
    mesh: &Mesh,
    h: HalfedgeId,
    epsilon: &PerVertex<i8>,
    eta: &PerEdge<f64>,
    w: &PerVertex<Weight>,
) -> (Hinge, f64) {
    let (vertices, sides) = hinge_of(mesh, h);
    let epsilon = vertices.map(|v| f64::from(epsilon[v]));
    Hinge::of_weights(epsilon, vertices.map(|v| w[v]), sides.map(|h| eta[h.edge()]))
}

/// A metric whose edges are flipped inside its conformal class: η changes on the edges flipped.
pub struct ClassFlips<'a> {
    /// The triangulation.
    pub mesh: &'a mut Mesh,
    /// The metric on it.
    pub metric: &'a mut Metric,
    /// Told each flip (the edge with its η) just before it is made.
    pub record: &'a mut dyn FnMut(&Mesh, Flip),
}

impl ClassFlips<'_> {
    /// Flip, from the edges of `queue` on, until every edge is weighted Delaunay at variables `u` (V entries) or cannot be flipped
    /// (E², H²). Returns the number of flips.
    ///
    /// # Errors
    /// Some flips are done then.
    /// - [`crate::Error::Size`]: `u` has not one entry per vertex.
    /// - [`crate::Error::Connectivity`]: the flips do not end, which rounding alone could cause.
    /// - [`crate::Error::Cancelled`].
    pub fn restore_delaunay(
        &mut self,
        u: &PerVertex<f64>,
        queue: &mut Queue,
        control: &Control,
    ) -> Result<usize> {
        let ClassFlips { mesh, metric, record } = self;
        check_size("u", u.len(), mesh.n_vertices())?;
        let w = weights(metric, u);
        let Metric { epsilon, eta, .. } = &mut **metric;
        let decide = |mesh: &Mesh, eta: &PerEdge<f64>, h: HalfedgeId| {
            let (hinge, scale) = hinge(mesh, h, epsilon, eta, &w);
            if !hinge.wants_flip() {
                return None;
            }
            hinge.flipped().map(|product| product / scale).filter(|eta| eta.is_finite())
        };
        let most = allowance(mesh.n_edges());
        let flips =
            queue.flip_until_empty(most, &mut Flippable { mesh, values: eta, decide, record }, control)?;
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
        let (vertices, sides) = hinge_of(self.mesh, h);
        let w = vertices.map(|v| weight(metric.space, metric.vertex(v)));
        let epsilon = vertices.map(|v| f64::from(metric.epsilon[v]));
        let (hinge, scale) = Hinge::of_weights(epsilon, w, sides.map(|h| metric.eta[h.edge()]));
        let flipped = hinge.flipped().map(|product| product / scale);
        let Some(eta) = flipped.filter(|eta| eta.is_finite()) else { return false };
        (self.record)(self.mesh, Flip { edge, value: metric.eta[edge] });
        metric.eta[edge] = eta;
        self.mesh.flip(edge)
    }
}

/// The edges between two faces that fail the weighted Delaunay condition at variables `u` (V entries), ascending.
///
/// # Panics
/// If `u` does not have an entry per vertex.
pub fn failing(mesh: &Mesh, metric: &Metric, u: &PerVertex<f64>) -> Vec<EdgeId> {
    let w = weights(metric, u);
    let fails = |h| hinge(mesh, h, &metric.epsilon, &metric.eta, &w).0.wants_flip();
    Queue::where_holds(mesh, &FixedEdges::none(), fails).into_vec()
}

/// Whether some boundary edge would be flipped on the surface's double, where its face meets the mirror image of that face. `fixed`
/// edges would not be.
pub fn boundary_fails(mesh: &Mesh, metric: &Metric, u: &PerVertex<f64>, fixed: &FixedEdges) -> bool {
    let fails = |h: HalfedgeId| {
        let [jk, ki] = [mesh.next(h), mesh.prev(h)];
        let [i, j, k] = [h, jk, ki].map(|h| mesh.origin(h));
        let corners = [i, j, k, k];
        let w = corners.map(|v| weight(metric.space, Vertex::new(metric.space, metric.epsilon[v], u[v])));
        let eta = [h, ki, jk, ki, jk].map(|h| metric.eta[h.edge()]);
        Hinge::of_weights(corners.map(|v| f64::from(metric.epsilon[v])), w, eta).0.wants_flip()
    };
    let mut along = mesh.edges().flat_map(|e| [e.halfedge(), e.halfedge().twin()]);
    along.any(|h| mesh.is_outside(h.twin()) && !fixed.contains(h.edge()) && fails(h))
}

/// `w` of every vertex at variables `u`.
fn weights(metric: &Metric, u: &PerVertex<f64>) -> PerVertex<Weight> {
    PerVertex::from_fn(u.len(), |v| weight(metric.space, Vertex::new(metric.space, metric.epsilon[v], u[v])))
}
