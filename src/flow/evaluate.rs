//! Lengths, angles and curvature at given variables: the right-hand side of the flow.

use crate::geometry::Space;
use crate::geometry::triangle::{self, Angles};
use crate::mesh::{EdgeId, FaceId, Mesh, PerVertex, VertexId};
use crate::metric::curvature::curvature_from_angles;
use crate::metric::lengths::{Edge, Metric, Vertex, edge};
use crate::parallel::fill;

/// The metric at one u. Buffers are reused from step to step.
pub(super) struct State {
    pub u: PerVertex<f64>,
    pub vertices: Vec<Vertex>,
    pub edges: Vec<Edge>,
    pub angles: Vec<Angles>,
    pub curvature: PerVertex<f64>,
}

impl State {
    pub fn new(mesh: &Mesh, metric: &Metric) -> State {
        State {
            u: metric.u.clone(),
            vertices: vec![Vertex::new(metric.space, 0, 0.0); mesh.n_vertices()],
            edges: vec![Edge::default(); mesh.n_edges()],
            angles: vec![Angles { at: [0.0; 3], broken: false }; mesh.n_faces()],
            curvature: PerVertex::filled(mesh.n_vertices(), 0.0),
        }
    }

    /// Compute everything from `self.u`; false when some edge has no real length there (outside the domain).
    pub fn evaluate(&mut self, mesh: &Mesh, class: &Metric) -> bool {
        let (space, u) = (class.space, &self.u);
        fill(&mut self.vertices, |v| {
            let v = VertexId::from(v);
            Vertex::new(space, class.epsilon[v], u[v])
        });
        let vertices = &self.vertices;
        fill(&mut self.edges, |e| {
            let e = EdgeId::from(e);
            let [i, j] = mesh.ends(e);
            edge(space, vertices[i.index()], vertices[j.index()], class.eta[e]).unwrap_or_default()
        });
        if self.edges.iter().any(|e| e.length == 0.0) {
            return false;
        }
        let edges = &self.edges;
        fill(&mut self.angles, |f| {
            triangle::angles(space, mesh.opposite_edges(FaceId::from(f)).map(|e| edges[e.index()].length))
        });
        self.curvature = curvature_from_angles(mesh, self.angles.iter().map(|a| a.at));
        true
    }

    /// ∂θ/∂u weights of the edges opposite the corners of a face.
    pub fn weights(&self, mesh: &Mesh, space: Space, f: FaceId) -> [f64; 3] {
        let edges = mesh.opposite_edges(f).map(|e| self.edges[e.index()]);
        let power = mesh.face_vertices(f).map(|v| self.vertices[v.index()].power(space));
        triangle::weights(space, edges.map(|e| e.length), edges.map(|e| e.q2), power)
    }

    pub fn broken(&self) -> usize {
        self.angles.iter().filter(|a| a.broken).count()
    }

    pub fn area(&self, mesh: &Mesh, class: &Metric) -> f64 {
        let lengths = |f| mesh.opposite_edges(f).map(|e| self.edges[e.index()].length);
        mesh.faces().map(|f| triangle::area(class.space, lengths(f))).sum()
    }

    /// `K̄ − K` into `out`, 0 at pinned vertices; returns its maximum norm.
    pub fn residual(&self, target: &[f64], pinned: &[bool], out: &mut [f64]) -> f64 {
        let mut worst = 0.0f64;
        for (i, out) in out.iter_mut().enumerate() {
            *out = if pinned[i] { 0.0 } else { target[i] - self.curvature[VertexId::from(i)] };
            worst = worst.max(out.abs());
        }
        worst
    }
}
