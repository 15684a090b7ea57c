//! Weighted Delaunay triangulations of a surface, by edge flips.
//!
//! Two kinds of flips. *Isometric*: the surface stays as it is, the new edge is the geodesic across its two triangles. *Inside the
//! conformal class*: vertices keep their vectors ([`crate::geometry::flip`]), and the surface changes wherever the edge was not
//! weighted Delaunay. Only edges around what has changed are looked at.

use super::lengths::Metric;
use crate::control::Control;
use crate::error::{Error, Result, check_size};
use crate::geometry::conformal::Vertex;
use crate::geometry::flip::{Hinge, TOLERANCE, Weight, diagonal, weight};
use crate::geometry::{Space, triangle};
use crate::mesh::{EdgeId, FaceId, HalfedgeId, Mesh, PerEdge, PerVertex, VertexId};
use crate::parallel;
use crate::topology::check_lengths;
use std::collections::VecDeque;
use std::f64::consts::PI;

/// Flips per edge before a flip sequence is given up: real surfaces need less than one, and rounding could make one go in circles.
const MOST_FLIPS: usize = 1000;
/// Isometric flips also lower the sum of all cotangents [Musin97], which is above the number that a sheared torus needs. What the sum
/// allows is capped here: more flips take hours.
const MOST_BY_SHAPE: f64 = 1e11;

/// Sums of two cosines beyond this say which side of π the angles' sum is on; rounding is far below.
const CLEARLY: f64 = 1e-3;
/// Edges looked at between two looks at the control.
const EDGES_PER_STEP: usize = 4096;

/// Edges that may fail the Delaunay condition, first come first served.
#[derive(Debug, Clone)]
pub struct Queue {
    waiting: VecDeque<EdgeId>,
    queued: PerEdge<bool>,
}

impl Queue {
    /// No edge of a surface with this many; `fixed` edges never enter it, and so are never flipped.
    pub fn new(n_edges: usize, fixed: &[EdgeId]) -> Queue {
        let mut queued = PerEdge::filled(n_edges, false);
        fixed.iter().for_each(|&e| queued[e] = true);
        Queue { waiting: VecDeque::new(), queued }
    }

    /// Every edge of a surface but the `fixed` ones.
    pub fn all(mesh: &Mesh, fixed: &[EdgeId]) -> Queue {
        let mut queue = Queue::new(mesh.n_edges(), fixed);
        mesh.edges().for_each(|e| queue.push(e));
        queue
    }

    /// The edges between two faces of which `holds`, asked in parallel, says so of a half-edge; `fixed` ones never.
    fn where_holds(mesh: &Mesh, fixed: &[EdgeId], holds: impl Fn(HalfedgeId) -> bool + Sync) -> Queue {
        let mut held = vec![false; mesh.n_edges()];
        parallel::fill(&mut held, |e| {
            let h = EdgeId::from(e).halfedge();
            between(mesh, h) && holds(h)
        });
        let mut queue = Queue::new(mesh.n_edges(), fixed);
        mesh.edges().filter(|e| held[e.index()]).for_each(|e| queue.push(e));
        queue
    }

    /// Look at this edge.
    pub fn push(&mut self, e: EdgeId) {
        if !std::mem::replace(&mut self.queued[e], true) {
            self.waiting.push_back(e);
        }
    }

    fn pop(&mut self) -> Option<EdgeId> {
        let e = self.waiting.pop_front()?;
        self.queued[e] = false;
        Some(e)
    }

    /// Flip edges until the queue is empty. `decide` gives an edge's value after its flip, or `None` where it stays; `record` is
    /// told each flip. Edges with a face on one side only, or the same on both, stay. Returns the flips. Errors: more than `most`;
    /// [`Error::Cancelled`]; some flips are then done.
    fn run<T>(
        &mut self,
        most: usize,
        mesh: &mut Mesh,
        values: &mut PerEdge<T>,
        mut decide: impl FnMut(&Mesh, &PerEdge<T>, HalfedgeId) -> Option<T>,
        record: &mut dyn FnMut(&Mesh, EdgeId),
        control: &Control,
    ) -> Result<usize> {
        let (mut flips, mut looked_at) = (0, 0usize);
        while let Some(e) = self.pop() {
            if usize::is_multiple_of(looked_at, EDGES_PER_STEP) {
                control.check()?;
            }
            looked_at += 1;
            let h = e.halfedge();
            if !between(mesh, h) {
                continue;
            }
            let Some(value) = decide(mesh, values, h) else { continue };
            if flips == most {
                return Err(endless());
            }
            record(mesh, e);
            let sides = mesh.quadrilateral(h);
            mesh.flip(e);
            values[e] = value;
            flips += 1;
            sides.into_iter().for_each(|side| self.push(side.edge()));
        }
        Ok(flips)
    }
}

/// Whether an edge lies between two different faces.
fn between(mesh: &Mesh, h: HalfedgeId) -> bool {
    let [f, g] = [h, h.twin()].map(|h| mesh.face(h));
    f.is_some() && g.is_some() && f != g
}

/// The Delaunay hinge of half-edge h, `w` per vertex: vertices origin, tip, left, right. Beside it `w w` of left and right in its unit.
fn hinge(
    mesh: &Mesh,
    h: HalfedgeId,
    epsilon: &PerVertex<i8>,
    eta: &PerEdge<f64>,
    w: &PerVertex<Weight>,
) -> (Hinge, f64) {
    let [jk, ki, il, lj] = mesh.quadrilateral(h);
    let vertices = [h, h.twin(), ki, lj].map(|h| mesh.origin(h));
    Hinge::of_weights(
        vertices.map(|v| f64::from(epsilon[v])),
        vertices.map(|v| w[v]),
        [h, ki, jk, il, lj].map(|h| eta[h.edge()]),
    )
}

/// Flip inside the conformal class, from the edges of `queue` on, until every edge is weighted Delaunay at variables `u`
/// or cannot be flipped (E², H²). η changes on the edges flipped; `record` is told each edge just before its flip.
///
/// Returns the number of flips. Errors: [`Error::Connectivity`] if the flips do not end, which rounding alone could cause;
/// [`Error::Cancelled`]. Some flips are done then.
pub fn restore_delaunay(
    mesh: &mut Mesh,
    metric: &mut Metric,
    u: &PerVertex<f64>,
    queue: &mut Queue,
    record: &mut dyn FnMut(&Mesh, EdgeId),
    control: &Control,
) -> Result<usize> {
    let w = weights(metric, u);
    let epsilon = &metric.epsilon;
    let decide = |mesh: &Mesh, eta: &PerEdge<f64>, h: HalfedgeId| {
        let (hinge, scale) = hinge(mesh, h, epsilon, eta, &w);
        if !hinge.wants_flip() {
            return None;
        }
        hinge.flipped().map(|product| product / scale).filter(|eta| eta.is_finite())
    };
    queue.run(MOST_FLIPS * mesh.n_edges(), mesh, &mut metric.eta, decide, record, control)
}

/// Flip one edge inside the conformal class, whether it is Delaunay or not; `record` is told just before. False, and nothing done,
/// where it has no other diagonal.
pub(crate) fn flip_in_class(
    mesh: &mut Mesh,
    metric: &mut Metric,
    e: EdgeId,
    record: &mut dyn FnMut(&Mesh, EdgeId),
) -> bool {
    let h = e.halfedge();
    if !between(mesh, h) {
        return false;
    }
    let w = |v: VertexId| weight(metric.space, metric.vertex(v));
    let [jk, ki, il, lj] = mesh.quadrilateral(h);
    let vertices = [h, h.twin(), ki, lj].map(|h| mesh.origin(h));
    let w = vertices.map(w);
    let epsilon = vertices.map(|v| f64::from(metric.epsilon[v]));
    let eta = [h, ki, jk, il, lj].map(|h| metric.eta[h.edge()]);
    let (hinge, scale) = Hinge::of_weights(epsilon, w, eta);
    let flipped = hinge.flipped().map(|product| product / scale);
    let Some(eta) = flipped.filter(|eta| eta.is_finite()) else { return false };
    record(mesh, e);
    metric.eta[e] = eta;
    mesh.flip(e)
}

/// Isometric flips until the triangulation is the intrinsic Delaunay one of the surface (weighted by circles of these `radii`
/// around its vertices, 0 for none; `lengths` in `geometry`): it depends on the surface and the circles alone, up to ties. An edge stays
/// where the other diagonal would make a triangle too thin for doubles.
///
/// `fixed` edges stay (indices of the mesh). Returns the number of flips. Errors: sizes; a length out of range, a face that breaks the triangle inequality;
/// [`Error::Connectivity`] if the flips do not end; [`Error::Cancelled`]. Mesh and lengths are then as they were, whatever `record`
/// was told.
pub fn intrinsic_delaunay(
    mesh: &mut Mesh,
    lengths: &mut PerEdge<f64>,
    radii: Option<&PerVertex<f64>>,
    geometry: Space,
    fixed: &[EdgeId],
    record: &mut dyn FnMut(&Mesh, EdgeId),
    control: &Control,
) -> Result<usize> {
    control.check()?;
    check_lengths(mesh, lengths)?;
    if let Some(radii) = radii {
        check_size("radii", radii.len(), mesh.n_vertices())?;
    }
    let fails = |mesh: &Mesh, lengths: &PerEdge<f64>, h: HalfedgeId| match radii {
        None => is_obtuse(geometry, sides(mesh, lengths, h)),
        Some(radii) => weighted_hinge(mesh, lengths, radii, geometry, h).wants_flip(),
    };
    let decide = |mesh: &Mesh, lengths: &PerEdge<f64>, h: HalfedgeId| {
        if !fails(mesh, lengths, h) {
            return None;
        }
        let sides = sides(mesh, lengths, h);
        let [left, right] = sides.map(|l| triangle::angles(geometry, l));
        // Angle at the origin of h: corner 0 on the left; on the right its twin starts at the other end.
        let at_origin = left.at[0] + right.at[1];
        let at_tip = left.at[1] + right.at[0];
        if left.broken() || right.broken() || at_origin >= PI || at_tip >= PI {
            return None;
        }
        let [near, far] = [sides[0][1], sides[1][0]];
        let length = diagonal(geometry, near, far, at_origin);
        // Needles can be thinner than the digits of the new length: what is no triangle in doubles is not made.
        let made = [[near, far], [sides[0][0], sides[1][1]]].map(|[a, b]| [a, b, length]);
        let fits = length > 0.0 && length.is_finite() && made.iter().all(is_triangle);
        fits.then_some(length)
    };
    let mut queue = Queue::where_holds(mesh, fixed, |h| fails(mesh, lengths, h));
    if queue.waiting.is_empty() {
        return Ok(0);
    }
    let shape: f64 = mesh.faces().map(|f| cotangents(mesh, lengths, f)).sum();
    let most = MOST_FLIPS * mesh.n_edges() + shape.min(MOST_BY_SHAPE) as usize;
    let before = (mesh.clone(), lengths.clone());
    let flips = queue.run(most, mesh, lengths, decide, record, control);
    if flips.is_err() {
        (*mesh, *lengths) = before;
    }
    flips
}

/// Whether doubles hold these lengths apart from those of a triangle without area.
fn is_triangle(l: &[f64; 3]) -> bool {
    triangle::half_differences(*l).into_iter().all(|r| r > 0.0)
}

/// The sum of a face's cotangents, `(a² + b² + c²)/4A`; infinite where it is broken.
fn cotangents(mesh: &Mesh, lengths: &PerEdge<f64>, f: FaceId) -> f64 {
    let sides = mesh.opposite_edges(f).map(|e| lengths[e]);
    let squares: f64 = sides.iter().map(|l| l * l).sum();
    squares / (4.0 * triangle::area(Space::E2, sides))
}

/// Sides of the faces left and right of h, in the order opposite, next, previous of the corner at the origin of h, of its twin.
fn sides(mesh: &Mesh, lengths: &PerEdge<f64>, h: HalfedgeId) -> [[f64; 3]; 2] {
    [h, h.twin()].map(|h| [mesh.next(h), mesh.prev(h), h].map(|side| lengths[side.edge()]))
}

/// Whether the angles α, β opposite a common side add up to more than π by more than [`TOLERANCE`]: in curved spaces those of the
/// Euclidean triangles of the half chords, which decide alike.
///
/// Far from π the sum of the cosines says so; near, with α near π and β near 0, it cannot, but `sin(α + β)` can.
fn is_obtuse(geometry: Space, sides: [[f64; 3]; 2]) -> bool {
    let chord = |l: f64| match geometry {
        Space::E2 => l,
        Space::H2 => (0.5 * l).sinh(),
        Space::S2 => (0.5 * l).sin(),
    };
    let chords = sides.map(|sides| sides.map(chord));
    let [cos_k, cos_l] = chords.map(|[a, b, c]| (a * a + b * b - c * c) / (2.0 * a * b));
    if (cos_k + cos_l).abs() > CLEARLY {
        return cos_k + cos_l < 0.0;
    }
    let [sin_k, sin_l] = chords.map(|[a, b, c]| 2.0 * triangle::area(Space::E2, [a, b, c]) / (a * b));
    sin_k * cos_l + cos_k * sin_l < -TOLERANCE
}

/// The hinge of circles with these radii around the vertices, from the current lengths.
fn weighted_hinge(
    mesh: &Mesh,
    lengths: &PerEdge<f64>,
    radii: &PerVertex<f64>,
    geometry: Space,
    h: HalfedgeId,
) -> Hinge {
    let [jk, ki, il, lj] = mesh.quadrilateral(h);
    let vertices = [h, h.twin(), ki, lj].map(|h| mesh.origin(h));
    // w = tanh γ and the like; η w w = (l² − γ_i² − γ_j²)/2 and the like.
    let circle = |v: VertexId| radii[v];
    let product = |e: HalfedgeId| {
        let [a, b] = mesh.ends(e.edge()).map(circle);
        let l = lengths[e.edge()];
        match geometry {
            Space::E2 => 0.5 * (l * l - a * a - b * b),
            Space::H2 => (l.cosh() - a.cosh() * b.cosh()) / (a.cosh() * b.cosh()),
            Space::S2 => (a.cos() * b.cos() - l.cos()) / (a.cos() * b.cos()),
        }
    };
    let square = |v: VertexId| match geometry {
        Space::E2 => circle(v) * circle(v),
        Space::H2 => circle(v).tanh().powi(2),
        Space::S2 => circle(v).tan().powi(2),
    };
    Hinge::from_products(vertices.map(square), [h, ki, jk, il, lj].map(product))
}

fn endless() -> Error {
    Error::Connectivity { element: "mesh", index: 0, message: "edge flips towards Delaunay do not end" }
}

/// The edges that fail the weighted Delaunay condition at variables `u` and can be flipped, ascending.
pub fn failing(mesh: &Mesh, metric: &Metric, u: &PerVertex<f64>) -> Vec<EdgeId> {
    let w = weights(metric, u);
    let fails = |h| hinge(mesh, h, &metric.epsilon, &metric.eta, &w).0.wants_flip();
    Queue::where_holds(mesh, &[], fails).waiting.into()
}

/// Whether a boundary edge would be flipped on the surface's double, where its face meets its mirror image; `fixed` ones would not.
pub fn boundary_fails(mesh: &Mesh, metric: &Metric, u: &PerVertex<f64>, fixed: &[EdgeId]) -> bool {
    let fails = |h: HalfedgeId| {
        let [jk, ki] = [mesh.next(h), mesh.prev(h)];
        let [i, j, k] = [h, jk, ki].map(|h| mesh.origin(h));
        let corners = [i, j, k, k];
        let w = corners.map(|v| weight(metric.space, Vertex::new(metric.space, metric.epsilon[v], u[v])));
        let eta = [h, ki, jk, ki, jk].map(|h| metric.eta[h.edge()]);
        Hinge::of_weights(corners.map(|v| f64::from(metric.epsilon[v])), w, eta).0.wants_flip()
    };
    let mut along = mesh.edges().flat_map(|e| [e.halfedge(), e.halfedge().twin()]);
    along.any(|h| mesh.is_outside(h.twin()) && fails(h) && !fixed.contains(&h.edge()))
}

/// `w` of every vertex at variables `u`.
fn weights(metric: &Metric, u: &PerVertex<f64>) -> PerVertex<Weight> {
    PerVertex::from_fn(u.len(), |v| weight(metric.space, Vertex::new(metric.space, metric.epsilon[v], u[v])))
}
