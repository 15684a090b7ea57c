//! Lengths, angles and curvature at given variables: the right-hand side of the flow.

use crate::geometry::Space;
use crate::geometry::conformal::{Edge, Vertex, differences, edge, weights};
use crate::geometry::triangle::{self, Angles};
use crate::mesh::{EdgeId, FaceId, Mesh, PerVertex, VertexId};
use crate::metric::Metric;
use crate::metric::curvature::curvature_from_angles;
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
    pub fn new(mesh: &Mesh, u: &PerVertex<f64>) -> State {
        State {
            u: u.clone(),
            vertices: vec![Vertex::default(); mesh.n_vertices()],
            edges: vec![Edge::default(); mesh.n_edges()],
            angles: vec![Angles { at: [0.0; 3] }; mesh.n_faces()],
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
        if self.edges.iter().any(|e| e.q2 == 0.0) {
            return false;
        }
        let edges = &self.edges;
        fill(&mut self.angles, |f| {
            triangle::angles_from(space, face_differences(mesh, vertices, edges, FaceId::from(f)))
        });
        self.curvature = curvature_from_angles(mesh, self.angles.iter().map(|a| a.at));
        true
    }

    /// ∂θ/∂u weights of the edges opposite the corners of a face.
    pub fn weights(&self, mesh: &Mesh, class: &Metric, f: FaceId) -> [f64; 3] {
        let edges = mesh.opposite_edges(f);
        let q2 = edges.map(|e| self.edges[e.index()].q2);
        let corners = mesh.face_vertices(f).map(|v| self.vertices[v.index()]);
        weights(class.space, self.differences(mesh, f), q2, corners, edges.map(|e| class.eta[e]))
    }

    /// Half-perimeter differences of a face.
    fn differences(&self, mesh: &Mesh, f: FaceId) -> [f64; 3] {
        face_differences(mesh, &self.vertices, &self.edges, f)
    }

    /// Area of a face.
    pub fn face_area(&self, mesh: &Mesh, space: Space, f: FaceId) -> f64 {
        triangle::area_from(space, self.differences(mesh, f))
    }

    pub fn broken(&self) -> usize {
        self.angles.iter().filter(|a| a.broken()).count()
    }

    pub fn area(&self, mesh: &Mesh, class: &Metric) -> f64 {
        mesh.faces().map(|f| self.face_area(mesh, class.space, f)).sum()
    }

    /// `K̄ − K` into `out`, 0 at pinned vertices; returns its maximum norm.
    pub fn residual(&self, target: &[f64], pinned: &[bool], out: &mut [f64]) -> f64 {
        let mut worst = 0.0f64;
        for (i, out) in out.iter_mut().enumerate() {
            *out = if pinned[i] { 0.0 } else { target[i] - self.curvature[VertexId::from(i)] };
            // NaN, which `max` would drop, must not look like a small error.
            worst = if out.is_nan() { f64::INFINITY } else { worst.max(out.abs()) };
        }
        worst
    }
}

fn face_differences(mesh: &Mesh, vertices: &[Vertex], edges: &[Edge], f: FaceId) -> [f64; 3] {
    let corners = mesh.face_vertices(f).map(|v| vertices[v.index()]);
    differences(corners, mesh.opposite_edges(f).map(|e| edges[e.index()]))
}
