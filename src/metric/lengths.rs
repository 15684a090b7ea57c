//! A metric as data (ε, η, u), and its edge lengths.
//!
//! With `e_i = e^{u_i}`, `d_i = 1 + λ ε_i e_i²` and
//!
//! ```text
//! N_ij = 2 η_ij e_i e_j + ε_i e_i² + ε_j e_j²
//! E²: l² = N          H²: sinh²(l/2) = N/(d_i d_j)          S²: sin²(l/2) = N/(d_i d_j)
//! ```
//!
//! (the length formulas of notation.md §2 solved for the half length, free of the cancellation in `cosh l − 1`).

use crate::error::{Error, Result, check_size};
use crate::geometry::Space;
use crate::mesh::{EdgeId, Mesh, PerEdge, PerVertex, Point, VertexId};
use crate::parallel;
use crate::topology::check_lengths;

/// A metric of the conformal class (ε, η) in a background geometry.
#[derive(Debug, Clone, PartialEq)]
pub struct Metric {
    /// Background geometry.
    pub space: Space,
    /// Vertex type ε ∈ {−1, 0, 1}; V entries, fixed in the class.
    pub epsilon: PerVertex<i8>,
    /// Edge weight η; E entries, fixed in the class (up to flips).
    pub eta: PerEdge<f64>,
    /// Conformal variable u; V entries. ε ≠ 0: `log γ`, `log tanh(γ/2)`, `log tan(γ/2)` in E², H², S².
    pub u: PerVertex<f64>,
}

/// What one edge contributes to its triangles.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Edge {
    /// Length l > 0.
    pub length: f64,
    /// Squared half chord: l²/4, sinh²(l/2), sin²(l/2) in E², H², S².
    pub q2: f64,
}

/// The vertex quantities that lengths and weights need.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Vertex {
    epsilon: f64,
    /// e^u
    scale: f64,
    /// d = 1 + λ ε e^{2u}; NaN outside the metric's domain (d ≤ 0).
    d: f64,
}

impl Vertex {
    /// The quantities of a vertex of type ε with variable u.
    pub fn new(space: Space, epsilon: i8, u: f64) -> Vertex {
        let d = match space {
            Space::E2 => 1.0,
            _ => match space.curvature() * f64::from(epsilon) {
                0.0 => 1.0,
                x if x < 0.0 => -(2.0 * u).exp_m1(),
                _ => 1.0 + (2.0 * u).exp(),
            },
        };
        Vertex { epsilon: f64::from(epsilon), scale: u.exp(), d: if d > 0.0 { d } else { f64::NAN } }
    }

    /// `P = ε e^{2u}/d`, in E² `ε e^{2u}/4`: the power of the vertex in [`crate::geometry::triangle::weights`].
    #[inline]
    pub fn power(self, space: Space) -> f64 {
        let p = self.epsilon * self.scale * self.scale;
        if space == Space::E2 { 0.25 * p } else { p / self.d }
    }
}

/// Length and chord of an edge; `None` when (ε, η, u) give no real positive finite length.
#[inline]
pub fn edge(space: Space, a: Vertex, b: Vertex, eta: f64) -> Option<Edge> {
    // ε = 0 at both ends leaves the first term alone; otherwise squares are completed where signs differ.
    let n = if eta < 0.0 || a.epsilon < 0.0 || b.epsilon < 0.0 {
        let (x, y) = (a.scale, b.scale);
        match (a.epsilon > 0.0, a.epsilon < 0.0, b.epsilon > 0.0, b.epsilon < 0.0) {
            (true, _, true, _) => (x - y) * (x - y) + 2.0 * (eta + 1.0) * x * y,
            (_, true, _, true) => 2.0 * (eta - 1.0) * x * y - (x - y) * (x - y),
            _ => 2.0 * eta * x * y + a.epsilon * x * x + b.epsilon * y * y,
        }
    } else {
        2.0 * eta * (a.scale * b.scale) + a.epsilon * (a.scale * a.scale) + b.epsilon * (b.scale * b.scale)
    };
    let (length, q2) = match space {
        Space::E2 => (n.sqrt(), 0.25 * n),
        Space::H2 => {
            let q2 = n / (a.d * b.d);
            (2.0 * q2.sqrt().asinh(), q2)
        }
        Space::S2 => {
            let q2 = n / (a.d * b.d);
            (2.0 * q2.sqrt().asin(), q2)
        }
    };
    (length > 0.0 && length.is_finite() && q2 > 0.0 && q2.is_finite()).then_some(Edge { length, q2 })
}

impl Metric {
    /// Number of vertices, edges agree with the mesh; ε is −1, 0 or 1; η and u are finite.
    pub fn check(&self, mesh: &Mesh) -> Result<()> {
        check_size("epsilon", self.epsilon.len(), mesh.n_vertices())?;
        check_size("eta", self.eta.len(), mesh.n_edges())?;
        check_size("u", self.u.len(), mesh.n_vertices())?;
        if let Some(v) = mesh.vertices().find(|&v| !(-1..=1).contains(&self.epsilon[v])) {
            let value = format!("{} at vertex {v}", self.epsilon[v]);
            return Err(Error::Argument { what: "epsilon", value, need: "−1, 0 or 1" });
        }
        if let Some(v) = mesh.vertices().find(|&v| !self.u[v].is_finite()) {
            return Err(Error::Domain { vertex: v.index(), u: self.u[v], need: "finite" });
        }
        match mesh.edges().find(|&e| !self.eta[e].is_finite()) {
            Some(e) => Err(Error::EdgeWeight { edge: e.index(), eta: self.eta[e], need: "finite" }),
            None => Ok(()),
        }
    }

    /// The vertex quantities at variables `u`.
    pub fn vertex(&self, v: VertexId) -> Vertex {
        Vertex::new(self.space, self.epsilon[v], self.u[v])
    }

    /// The edge lengths; the first edge without a real positive length is an error that names it.
    pub fn lengths(&self, mesh: &Mesh) -> Result<PerEdge<f64>> {
        self.check(mesh)?;
        let vertices: PerVertex<Vertex> = PerVertex::from_fn(mesh.n_vertices(), |v| self.vertex(v));
        if let Some(v) = mesh.vertices().find(|&v| vertices[v].d.is_nan()) {
            let need = "u < 0 where ε has the sign of −λ";
            return Err(Error::Domain { vertex: v.index(), u: self.u[v], need });
        }
        let mut lengths = vec![0.0; mesh.n_edges()];
        parallel::fill(&mut lengths, |e| {
            let e = EdgeId::from(e);
            let [i, j] = mesh.ends(e);
            edge(self.space, vertices[i], vertices[j], self.eta[e]).map_or(f64::NAN, |x| x.length)
        });
        match lengths.iter().position(|l| l.is_nan()) {
            Some(e) => {
                let need = "u differs too much between the ends for this weight: no real length";
                Err(Error::EdgeWeight { edge: e, eta: self.eta[EdgeId::from(e)], need })
            }
            None => Ok(lengths.into()),
        }
    }

    /// Circle radii γ from u (ε = 0: e^u).
    pub fn radii(&self) -> PerVertex<f64> {
        let radius = |v: VertexId| {
            let scale = self.u[v].exp();
            match self.space {
                _ if self.epsilon[v] == 0 => scale,
                Space::E2 => scale,
                Space::H2 => 2.0 * scale.atanh(),
                Space::S2 => 2.0 * scale.atan(),
            }
        };
        PerVertex::from_fn(self.u.len(), radius)
    }
}

/// Euclidean edge lengths of a mesh in space; an edge of zero or non-finite length is an error that names it.
pub fn lengths_from_positions(mesh: &Mesh, positions: &[Point]) -> Result<PerEdge<f64>> {
    check_size("positions", positions.len(), mesh.n_vertices())?;
    let length = |e: EdgeId| {
        let [i, j] = mesh.ends(e).map(|v| positions[v.index()]);
        // Scaled, so that neither tiny nor huge coordinates under- or overflow when squared.
        let d = [j[0] - i[0], j[1] - i[1], j[2] - i[2]];
        let scale = d.iter().fold(0.0f64, |m, x| m.max(x.abs()));
        scale * d.iter().map(|x| (x / scale) * (x / scale)).sum::<f64>().sqrt()
    };
    let lengths = PerEdge::from_fn(mesh.n_edges(), length);
    check_lengths(mesh, &lengths)?;
    Ok(lengths)
}

/// The lengths opposite the corners of a face: `[l_bc, l_ca, l_ab]` for the face (a, b, c).
#[inline]
pub fn face_lengths(mesh: &Mesh, lengths: &PerEdge<f64>, f: crate::mesh::FaceId) -> [f64; 3] {
    mesh.opposite_edges(f).map(|e| lengths[e])
}
