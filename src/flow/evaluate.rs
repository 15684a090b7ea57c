//! Lengths, angles and curvature at given variables: the right-hand side of the flow.

use super::measure::{FaceMeasures, chord, needs_chords_alone};
use super::seconds::{FlowSeconds, timed};
use crate::control::Control;
use crate::error::Result;
use crate::geometry::conformal::{Edge, Vertex};
use crate::geometry::double_double::two_sum;
use crate::geometry::scaling::{fill_chords, fill_vertices};
use crate::geometry::triangle::Angles;
use crate::geometry::{DoubleDouble, Space, largest, worse};
use crate::mesh::{EdgeId, FixedEdges, Flip, Mesh, PerVertex, VertexId};
use crate::metric::Metric;
use crate::metric::curvature::curvature_into;
use crate::metric::delaunay::{ClassFlips, FlipQueue};
use crate::parallel::fill;

/// A face with a weight above this is a needle, whose other weights are differences of numbers of this size: their rounding may hide
/// that an edge fails the Delaunay condition by more than 1e-12.
const NEEDLE: f64 = 1e3;
/// Largest number of roundings of the largest weight of a needle that add up in its other weights.
const ROUNDINGS: f64 = 256.0;

/// The metric at one u: the variables with their curvature, and the measurements that led to it, whose memory goes from step to step.
#[derive(Clone)]
pub(super) struct FlowState {
    pub u: PerVertex<f64>,
    /// The low parts of u in double-double precision.
    pub low: PerVertex<f64>,
    pub vertices: Vec<Vertex>,
    /// Empty where half chords are enough.
    edges: Vec<Edge>,
    /// Their half chords, where these are enough.
    chords: Vec<DoubleDouble>,
    pub angles: Vec<Angles>,
    /// Per face: ∂θ/∂u weights of the edges opposite its corners, 0 in a broken face.
    pub weights: Vec<[f64; 3]>,
    pub curvature: PerVertex<f64>,
    /// True if all edges had a length at the last measurement.
    is_real: bool,
    /// The rounding errors of the sums of `curvature` while they are formed.
    lost: Vec<f64>,
}

impl FlowState {
    pub fn new(u: &PerVertex<f64>, low: &PerVertex<f64>) -> FlowState {
        FlowState {
            u: u.clone(),
            low: low.clone(),
            vertices: Vec::new(),
            edges: Vec::new(),
            chords: Vec::new(),
            angles: Vec::new(),
            weights: Vec::new(),
            curvature: PerVertex::filled(u.len(), 0.0),
            is_real: false,
            lost: Vec::new(),
        }
    }

    /// [`FlowState::new`] with the memory of this one.
    pub fn at(mut self, u: &PerVertex<f64>, low: &PerVertex<f64>) -> FlowState {
        if self.u.len() != u.len() {
            return FlowState::new(u, low);
        }
        self.u.copy_from_slice(u);
        self.low.copy_from_slice(low);
        self.curvature.fill(0.0);
        self.vertices.clear();
        self.edges.clear();
        self.chords.clear();
        self.angles.clear();
        self.weights.clear();
        self
    }

    /// Compute everything from `self.u` and `self.low`; false where some edge has no real length (u is outside the domain).
    pub fn evaluate(&mut self, mesh: &Mesh, class: &Metric) -> bool {
        self.measure(mesh, class);
        self.finish(mesh)
    }

    /// The curvature from the measured angles; false if some edge had no real length.
    pub fn finish(&mut self, mesh: &Mesh) -> bool {
        if self.is_real {
            self.sum_up(mesh);
        }
        self.is_real
    }

    /// The curvature from the angles.
    fn sum_up(&mut self, mesh: &Mesh) {
        let angles = self.angles.iter().map(|a| a.at);
        curvature_into(mesh, angles, &mut self.curvature, &mut self.lost);
    }

    /// Completes [`FlowState::evaluate`] after [`FlowState::measure`]: flips the edges of `surface` inside its class until it is weighted Delaunay
    /// at `self.u`, except for `fixed` edges, and measures what has changed. Returns also the number of flips.
    ///
    /// An edge is Delaunay if its Laplacian weight, which Newton's method needs anyway, is not negative. So the flips start at the edges of
    /// negative weight and at broken faces, and only the faces that they touch are measured again.
    pub fn flip_to_delaunay(
        &mut self,
        surface: ClassFlips,
        fixed: &FixedEdges,
        seconds: &mut FlowSeconds,
        control: &Control,
    ) -> Result<(bool, usize)> {
        let ClassFlips { mesh, metric: class, record } = surface;
        let real = self.is_real;
        let mut touched = Vec::new();
        let flips = timed(&mut seconds.flip, || {
            let mut queue = if real { self.suspects(mesh, fixed) } else { FlipQueue::all(mesh, fixed) };
            let mut record = |mesh: &Mesh, flip: Flip<DoubleDouble>| {
                touched.push(flip.edge);
                record(mesh, flip);
            };
            ClassFlips { mesh, metric: class, record: &mut record }.restore_delaunay(
                &self.vertices,
                &mut queue,
                control,
            )
        })?;
        let real = timed(&mut seconds.assemble, || {
            match flips {
                0 => (),
                _ if !real => self.measure(mesh, class),
                _ => self.measure_again(mesh, class, &touched),
            }
            self.finish(mesh)
        });
        Ok((real, flips))
    }

    /// Measure everything but the curvature.
    pub fn measure(&mut self, mesh: &Mesh, class: &Metric) {
        let (space, u, low) = (class.space, &self.u, &self.low);
        self.vertices.resize(mesh.n_vertices(), Vertex::default());
        self.angles.resize(mesh.n_faces(), Angles { at: [0.0; 3] });
        self.weights.resize(mesh.n_faces(), [0.0; 3]);
        fill_vertices(space, &mut self.vertices, |v| {
            let v = VertexId::from(v);
            (class.epsilon[v], u[v], low[v])
        });
        self.is_real =
            (needs_chords_alone(class) && self.find_chords(mesh, class)) || self.find_edges(mesh, class);
        if self.is_real {
            let FlowState { vertices, edges, chords, angles, weights, .. } = self;
            let parts = FaceMeasures { mesh, class, vertices, edges, chords };
            parts.measure(angles, weights);
        }
    }

    /// The half chords of the edges; false where some have no length, or need units of their own.
    fn find_chords(&mut self, mesh: &Mesh, class: &Metric) -> bool {
        let FlowState { vertices, edges, chords, .. } = self;
        edges.clear();
        chords.resize(mesh.n_edges(), DoubleDouble::default());
        fill_chords(class.space, chords, |e| class.ends_and_eta(mesh, vertices, e.into()));
        let is_known = chords.iter().all(|chord| chord.high > 0.0);
        if !is_known {
            chords.clear();
        }
        is_known
    }

    /// The edges; false where some have no length.
    fn find_edges(&mut self, mesh: &Mesh, class: &Metric) -> bool {
        let FlowState { vertices, edges, chords, .. } = self;
        chords.clear();
        edges.resize(mesh.n_edges(), Edge::default());
        fill(edges, |e| class.edge(mesh, vertices, e.into()));
        edges.iter().all(|e| e.q2 != 0.0)
    }

    /// The vertices and edges from which faces are measured.
    fn parts<'a>(&'a self, mesh: &'a Mesh, class: &'a Metric) -> FaceMeasures<'a> {
        let FlowState { vertices, edges, chords, .. } = self;
        FaceMeasures { mesh, class, vertices, edges, chords }
    }

    /// Measure flipped edges, and the faces at them.
    fn measure_again(&mut self, mesh: &Mesh, class: &Metric, flipped: &[EdgeId]) {
        for &e in flipped {
            match self.chords.get_mut(e.index()) {
                Some(known) => *known = chord(mesh, class, &self.vertices, e),
                None => self.edges[e.index()] = class.edge(mesh, &self.vertices, e),
            }
        }
        if flipped.iter().any(|&e| self.squared_chord(e) == 0.0) {
            self.is_real = false;
            if !self.chords.is_empty() {
                self.measure(mesh, class);
            }
            return;
        }
        let FlowState { vertices, edges, chords, angles, weights, .. } = self;
        let parts = FaceMeasures { mesh, class, vertices, edges, chords };
        for f in flipped.iter().flat_map(|e| [e.halfedge(), e.halfedge().twin()]).filter_map(|h| mesh.face(h))
        {
            (angles[f.index()], weights[f.index()]) = parts.measured(f);
        }
    }

    /// The squared half chord of an edge ([`Edge::q2`]).
    #[inline]
    pub fn squared_chord(&self, e: EdgeId) -> f64 {
        match self.chords.get(e.index()) {
            Some(chord) => chord.high * chord.high,
            None => self.edges[e.index()].q2,
        }
    }

    /// The edges that may fail the Delaunay condition: those whose weight is negative or may be so by rounding, and those of faces without
    /// weights.
    fn suspects(&self, mesh: &Mesh, fixed: &FixedEdges) -> FlipQueue {
        let mut queue = FlipQueue::new(mesh.n_edges(), fixed);
        let mut weight = vec![0.0; mesh.n_edges()];
        for f in mesh.faces() {
            let weights = self.weights[f.index()];
            let lowered = match largest(&weights) {
                0.0 => f64::INFINITY,
                most if most > NEEDLE => ROUNDINGS * f64::EPSILON * most,
                _ => 0.0,
            };
            for (e, w) in mesh.opposite_edges(f).into_iter().zip(weights) {
                weight[e.index()] += w - lowered;
            }
        }
        mesh.edges().filter(|e| weight[e.index()] < 0.0).for_each(|e| queue.push(e));
        queue
    }

    /// Move the memory of the measurements to `next`; u and its curvature stay.
    pub fn hand_on(&mut self, next: &mut FlowState) {
        if self.is_measured() {
            next.vertices = std::mem::take(&mut self.vertices);
            next.edges = std::mem::take(&mut self.edges);
            next.chords = std::mem::take(&mut self.chords);
            next.angles = std::mem::take(&mut self.angles);
            next.weights = std::mem::take(&mut self.weights);
            next.lost = std::mem::take(&mut self.lost);
        }
    }

    /// True if the measurements have not been handed on.
    pub fn is_measured(&self) -> bool {
        !self.angles.is_empty()
    }

    /// u of `from` plus `t` times `step`.
    pub fn set_step(&mut self, from: &FlowState, t: f64, step: &[f64]) {
        for (v, step) in step.iter().enumerate() {
            let v = VertexId::from(v);
            (self.u[v], self.low[v]) = add(from.u[v], from.low[v], t * step);
        }
    }

    /// Add a constant to u.
    pub fn shift(&mut self, by: f64) {
        for (u, low) in self.u.iter_mut().zip(self.low.iter_mut()) {
            (*u, *low) = add(*u, *low, by);
        }
    }

    /// Subtract the mean of u.
    pub fn centre(&mut self) {
        self.shift(-(self.u.iter().sum::<f64>() / self.u.len() as f64));
    }

    /// Per vertex a third of the area of the faces around it, divided by `unit`.
    pub fn vertex_areas(&self, mesh: &Mesh, class: &Metric, unit: f64) -> Vec<f64> {
        let (parts, mut areas) = (self.parts(mesh, class), vec![0.0; mesh.n_vertices()]);
        for f in mesh.faces() {
            let third = parts.area(f) / (3.0 * unit);
            mesh.face_vertices(f).into_iter().for_each(|v| areas[v.index()] += third);
        }
        areas
    }

    /// Number of faces that break the triangle inequality.
    pub fn broken(&self) -> usize {
        self.angles.iter().filter(|a| a.broken()).count()
    }

    /// True if the total area is in the range of f64. A face in H² and S² has at most π and 2π, and edges in E² without units of their own
    /// (those of which half chords are known) are short.
    pub fn has_finite_area(&self, mesh: &Mesh, class: &Metric) -> bool {
        class.space != Space::E2
            || !self.chords.is_empty()
            || self.edges.iter().all(|e| e.exponent == 0)
            || self.area(mesh, class).is_finite()
    }

    /// Total area; infinite beyond the range of f64.
    pub fn area(&self, mesh: &Mesh, class: &Metric) -> f64 {
        let (parts, mut areas) = (self.parts(mesh, class), vec![0.0; mesh.n_faces()]);
        fill(&mut areas, |f| parts.area(f.into()));
        areas.iter().sum()
    }

    /// `K̄ − K` into `out`, 0 at pinned vertices; returns its maximum norm.
    pub fn residual(&self, target: &[f64], pinned: &[bool], out: &mut [f64]) -> f64 {
        let mut worst = 0.0f64;
        for (i, out) in out.iter_mut().enumerate() {
            *out = if pinned[i] { 0.0 } else { target[i] - self.curvature[VertexId::from(i)] };
            worst = worse(worst, out.abs());
        }
        worst
    }
}

/// `u + low + x` as high and low part.
fn add(u: f64, low: f64, x: f64) -> (f64, f64) {
    let (sum, lost) = two_sum(u, x);
    two_sum(sum, lost + low)
}
