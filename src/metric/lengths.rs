//! A metric as data (ε, η, u), and its edge lengths ([`crate::geometry::conformal`]).
//!
//! ```
//! # use ricci::{Class, Surface, geometry::Space, mesh::shapes};
//! let torus = Surface::from_soup(&shapes::torus(2.0, 1.0, 24, 12)?)?;
//! let mut metric = torus.initial(Class::yamabe(Space::E2))?.metric;
//! metric.u.iter_mut().for_each(|u| *u += 2f64.ln());
//! let lengths = metric.lengths(torus.mesh())?;
//! assert!(lengths.iter().zip(torus.lengths().iter()).all(|(a, b)| (a / b - 2.0).abs() < 1e-14));
//! # Ok::<(), ricci::Error>(())
//! ```

use crate::archive::stored;
use crate::error::{Error, Result, check_size};
use crate::geometry::conformal::{self, Edge, Vertex, differences, in_one_unit, is_precise, radius};
use crate::geometry::double_double::MAX_EXPONENT;
use crate::geometry::scaling::{fill_chords, fill_vertices};
use crate::geometry::{DoubleDouble, Space};
use crate::mesh::{EdgeId, FaceId, Mesh, PerEdge, PerVertex, Point, VertexId};
use crate::parallel;
use crate::topology::check_lengths;
use std::sync::Arc;

/// A metric of the conformal class (ε, η) in a background geometry.
#[derive(Debug, Clone, PartialEq)]
pub struct Metric {
    /// Background geometry.
    pub space: Space,
    /// Vertex type ε ∈ {−1, 0, 1}; V entries, fixed in the class.
    pub epsilon: PerVertex<i8>,
    /// Edge weight η; E entries, fixed in the class (up to flips). It is in double-double precision, since flips add up their
    /// rounding, and the angles of a needle magnify it by the needle's length over its width. Metrics that differ in u alone share it.
    pub eta: Arc<PerEdge<DoubleDouble>>,
    /// Conformal variable u; V entries. ε ≠ 0: `log γ`, `log tanh(γ/2)`, `log tan(γ/2)` in E², H², S².
    pub u: PerVertex<f64>,
    /// The low parts of the u in double-double precision; V entries, at most half an ulp of u. 0 in a metric that no flow has made.
    pub u_low: PerVertex<f64>,
}
stored!(sections Metric { space, epsilon, eta, u, u_low });

impl Metric {
    /// Checks that the numbers of vertices and edges agree with the mesh.
    ///
    /// # Errors
    /// [`Error::Size`].
    pub(crate) fn check_sizes(&self, mesh: &Mesh) -> Result<()> {
        check_size("epsilon", self.epsilon.len(), mesh.n_vertices())?;
        check_size("eta", self.eta.len(), mesh.n_edges())?;
        check_size("u", self.u.len(), mesh.n_vertices())?;
        check_size("u_low", self.u_low.len(), mesh.n_vertices())
    }

    /// Checks that the numbers of vertices and edges agree with the mesh; ε is −1, 0 or 1; η and u are finite, and their low parts at most an ulp of them.
    ///
    /// # Errors
    /// [`Error::Size`], [`Error::Argument`] (ε, `u_low`), [`Error::Domain`] (u), [`Error::EdgeWeight`] (η).
    pub fn check(&self, mesh: &Mesh) -> Result<()> {
        self.check_sizes(mesh)?;
        if let Some(v) = mesh.vertices().find(|&v| !(-1..=1).contains(&self.epsilon[v])) {
            let value = format!("{} at vertex {v}", self.epsilon[v]);
            return Err(Error::Argument { what: "epsilon", value, need: "−1, 0 or 1" });
        }
        if let Some(v) = mesh.vertices().find(|&v| !self.u[v].is_finite()) {
            return Err(Error::Domain { vertex: v.index(), u: self.u[v], need: "finite" });
        }
        // An ulp of u is between ε|u|/2 and ε|u|. The comparison is false where `u_low` is NaN.
        let is_ulp = |v: VertexId| self.u_low[v].abs() <= f64::EPSILON * self.u[v].abs();
        if let Some(v) = mesh.vertices().find(|&v| !is_ulp(v)) {
            let value = format!("{} at vertex {v}, where u is {}", self.u_low[v], self.u[v]);
            return Err(Error::Argument {
                what: "u_low",
                value,
                need: "what the double u loses, at most an ulp of it",
            });
        }
        let is_sound = |e: EdgeId| {
            let DoubleDouble { high, low } = self.eta[e];
            high.is_finite() && low.abs() <= f64::EPSILON * high.abs()
        };
        match mesh.edges().find(|&e| !is_sound(e)) {
            Some(e) => Err(Error::EdgeWeight {
                edge: e.index(),
                eta: self.eta[e].high,
                need: "finite, with a low part of at most an ulp",
            }),
            None => Ok(()),
        }
    }

    /// True if lengths are formed in double-double precision: [`is_precise`] of all vertices.
    pub fn is_precise(&self) -> bool {
        self.epsilon.iter().all(|&epsilon| is_precise(self.space, epsilon))
    }

    /// η rounded to f64 (E entries).
    pub fn rounded_eta(&self) -> PerEdge<f64> {
        PerEdge::from_fn(self.eta.len(), |e| self.eta[e].high)
    }

    /// The derived quantities of all vertices (V entries).
    pub fn vertices(&self) -> PerVertex<Vertex> {
        let mut vertices = vec![Vertex::default(); self.u.len()];
        fill_vertices(self.space, &mut vertices, |v| {
            let v = VertexId::from(v);
            (self.epsilon[v], self.u[v], self.u_low[v])
        });
        vertices.into()
    }

    /// The derived quantities of a vertex.
    pub fn vertex(&self, v: VertexId) -> Vertex {
        Vertex::precise(self.space, self.epsilon[v], self.u[v], self.u_low[v])
    }

    /// True if this is a metric: every edge has a real positive length, whether an f64 holds it or not.
    ///
    /// # Errors
    /// Those of [`Metric::check`]; [`Error::Domain`] where u is outside the domain of its vertex type (in E² beyond ±5e5),
    /// [`Error::EdgeWeight`] for the first edge without a length (in H² without one between 2e-140 and 300).
    pub fn check_domain(&self, mesh: &Mesh) -> Result<()> {
        self.check(mesh)?;
        if self.is_surely_inside() || self.has_plain_chords(mesh) {
            return Ok(());
        }
        self.vertices_and_edges(mesh).map(|_| ())
    }

    /// True if this is vertex scaling in E² with u and η in a range where every edge has a length.
    fn is_surely_inside(&self) -> bool {
        self.space == Space::E2
            && self.epsilon.iter().all(|&e| e == 0)
            && self.u.iter().all(|u| u.abs() <= MAX_EXPONENT)
            && self.eta.iter().all(|eta| eta.high > 0.0 && eta.high.is_normal())
    }

    /// True if this is vertex scaling in H² with a [`plain_chord`](conformal::plain_chord) at each edge.
    fn has_plain_chords(&self, mesh: &Mesh) -> bool {
        if self.space != Space::H2 || self.epsilon.iter().any(|&e| e != 0) {
            return false;
        }
        let vertices = self.vertices();
        let mut chords = vec![DoubleDouble::default(); mesh.n_edges()];
        fill_chords(self.space, &mut chords, |e| self.ends_and_eta(mesh, &vertices, e.into()));
        chords.iter().all(|q| q.high > 0.0)
    }

    /// The derived quantities of all vertices and edges.
    ///
    /// # Errors
    /// Those of [`Metric::check_domain`].
    pub(super) fn vertices_and_edges(&self, mesh: &Mesh) -> Result<(PerVertex<Vertex>, PerEdge<Edge>)> {
        self.check(mesh)?;
        let vertices = self.vertices();
        if let Some(v) = mesh.vertices().find(|&v| vertices[v].d.is_nan()) {
            let need = "u < 0 where ε has the sign of −λ, in E² between −5e5 and 5e5, in H² above −708";
            return Err(Error::Domain { vertex: v.index(), u: self.u[v], need });
        }
        let mut edges = vec![Edge::default(); mesh.n_edges()];
        parallel::fill(&mut edges, |e| self.edge(mesh, &vertices, e.into()));
        match edges.iter().position(|e| e.q2 == 0.0) {
            Some(e) => {
                let need = "one that gives the edge a real length at this u (in S² below π, in H² between 2e-140 and 300)";
                Err(Error::EdgeWeight { edge: e, eta: self.eta[EdgeId::from(e)].high, need })
            }
            None => Ok((vertices, edges.into())),
        }
    }

    /// An edge from the vertex quantities; one without a real length is the default, whose `q2` is 0.
    pub(crate) fn edge(&self, mesh: &Mesh, vertices: &[Vertex], e: EdgeId) -> Edge {
        let ([a, b], eta) = self.ends_and_eta(mesh, vertices, e);
        conformal::edge(self.space, a, b, eta).unwrap_or_default()
    }

    /// The ends of an edge and its η, from which its length comes.
    #[inline]
    pub(crate) fn ends_and_eta(
        &self,
        mesh: &Mesh,
        vertices: &[Vertex],
        e: EdgeId,
    ) -> ([Vertex; 2], DoubleDouble) {
        (mesh.ends(e).map(|v| vertices[v.index()]), self.eta[e])
    }

    /// Circle radii γ from u (ε = 0: e^u): [`radius`].
    ///
    /// # Errors
    /// [`Error::Domain`] for the first vertex whose radius is no positive number that an f64 holds.
    pub fn radii(&self) -> Result<PerVertex<f64>> {
        let radii: PerVertex<f64> =
            PerVertex::from_fn(self.u.len(), |v| radius(self.space, self.epsilon[v], self.u[v]));
        match radii.iter().position(|r| !r.is_normal()) {
            Some(v) => {
                let need = "one whose radius is between 2e-308 and 2e308";
                Err(Error::Domain { vertex: v, u: self.u[VertexId::from(v)], need })
            }
            None => Ok(radii),
        }
    }
}

/// The half-perimeter differences of a face, and the exponent of their unit.
pub(crate) fn face_differences(
    mesh: &Mesh,
    vertices: &[Vertex],
    edges: &[Edge],
    f: FaceId,
) -> ([f64; 3], i32) {
    let mut corners = mesh.face_vertices(f).map(|v| vertices[v.index()]);
    let mut sides = mesh.opposite_edges(f).map(|e| edges[e.index()]);
    let unit = in_one_unit(&mut corners, &mut sides);
    (differences(corners, sides), unit)
}

/// Euclidean edge lengths of a mesh with a position per vertex (V entries).
///
/// # Errors
/// [`Error::Size`]; [`Error::EdgeLength`] for an edge of zero or non-finite length.
pub fn lengths_from_positions(mesh: &Mesh, positions: &[Point]) -> Result<PerEdge<f64>> {
    check_size("positions", positions.len(), mesh.n_vertices())?;
    let length = |e: EdgeId| {
        let [i, j] = mesh.ends(e).map(|v| positions[v.index()]);
        // Scaled, so that neither tiny nor huge coordinates under- or overflow when squared.
        let d = [j[0] - i[0], j[1] - i[1], j[2] - i[2]];
        let scale = d.iter().fold(0.0f64, |m, x| m.max(x.abs()));
        if scale == 0.0 {
            return 0.0;
        }
        scale * d.iter().map(|x| (x / scale) * (x / scale)).sum::<f64>().sqrt()
    };
    let mut lengths = vec![0.0; mesh.n_edges()];
    parallel::fill(&mut lengths, |e| length(e.into()));
    let lengths = lengths.into();
    check_lengths(mesh, &lengths)?;
    Ok(lengths)
}

/// The lengths opposite the corners of a face: `[l_bc, l_ca, l_ab]` for the face (a, b, c).
#[inline]
pub fn face_lengths(mesh: &Mesh, lengths: &PerEdge<f64>, f: FaceId) -> [f64; 3] {
    mesh.opposite_edges(f).map(|e| lengths[e])
}
