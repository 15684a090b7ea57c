//! Measurements of a metric: lengths of edges to all their digits, shapes of triangles, curvature.
//!
//! ```
//! # use ricci::{Class, Surface, geometry::Space, mesh::shapes};
//! let torus = Surface::from_soup(&shapes::torus(2.0, 1.0, 24, 12)?)?;
//! let metric = torus.initial(Class::yamabe(Space::E2))?.metric;
//! let measured = metric.measured(torus.mesh())?;
//! assert_eq!(measured.lengths()?, metric.lengths(torus.mesh())?);
//! # Ok::<(), ricci::Error>(())
//! ```

use super::curvature::{Curvature, curvature_of};
use super::lengths::{Metric, face_differences};
use crate::error::{Error, Result};
use crate::geometry::conformal::{Edge, Vertex};
use crate::geometry::scaled::scaled;
use crate::mesh::{EdgeId, FaceId, Mesh, PerEdge, PerFace, PerVertex};
use crate::parallel;

impl Metric {
    /// The edge lengths.
    ///
    /// # Errors
    /// Those of [`Metric::check_domain`]; [`Error::EdgeWeight`] for the first edge whose length no f64 holds, below 2e-308
    /// or above 2e308, which happens in E² alone. Angles, curvature and the flow have no such limit.
    pub fn lengths(&self, mesh: &Mesh) -> Result<PerEdge<f64>> {
        self.measured(mesh)?.lengths()
    }

    /// The half-perimeter differences `r_k = s − l_k` of every face, in corner order (F entries, `s = Σ r`).
    ///
    /// They have their full relative accuracy also where circles of very different sizes meet. Differences of rounded lengths do not.
    ///
    /// # Errors
    /// As [`Metric::lengths`].
    pub fn differences(&self, mesh: &Mesh) -> Result<PerFace<[f64; 3]>> {
        let measured = self.measured(mesh)?;
        measured.lengths()?;
        Ok(measured.differences())
    }

    /// The rounding errors of [`Metric::lengths`], per edge: `l` in double-double precision is `length + remainder`.
    ///
    /// It matters where circles of very different sizes meet, and far out in H². It is 0 in S² on edges with ε = 0 at both ends.
    ///
    /// # Errors
    /// As [`Metric::lengths`].
    pub fn length_remainders(&self, mesh: &Mesh) -> Result<PerEdge<f64>> {
        let measured = self.measured(mesh)?;
        Ok(measured.remainders(&measured.lengths()?))
    }

    /// The vertices and edges of the metric, formed once for several measurements.
    ///
    /// # Errors
    /// Those of [`Metric::check_domain`].
    pub fn measured<'a>(&'a self, mesh: &'a Mesh) -> Result<Measured<'a>> {
        let (vertices, edges) = self.vertices_and_edges(mesh)?;
        Ok(Measured { metric: self, mesh, vertices, edges })
    }

    /// Curvature, from the variables themselves: also where lengths are beyond the range of f64.
    ///
    /// # Errors
    /// Those of [`Metric::check_domain`]; [`Error::Argument`] where the area is beyond the range of f64: u is then to be shifted by a
    /// constant, which changes neither angles nor curvature.
    pub fn curvature(&self, mesh: &Mesh) -> Result<Curvature> {
        self.measured(mesh)?.curvature()
    }
}

/// A metric's vertices and edges, from which lengths, angles and curvature come ([`Metric::measured`]).
pub struct Measured<'a> {
    metric: &'a Metric,
    mesh: &'a Mesh,
    vertices: PerVertex<Vertex>,
    edges: PerEdge<Edge>,
}

impl Measured<'_> {
    /// [`Metric::lengths`].
    ///
    /// # Errors
    /// [`Error::EdgeWeight`] as there.
    pub fn lengths(&self) -> Result<PerEdge<f64>> {
        let Measured { metric, edges, .. } = self;
        let mut lengths = vec![0.0; edges.len()];
        parallel::fill(&mut lengths, |e| edges[EdgeId::from(e)].length(metric.space));
        match lengths.iter().position(|l| !l.is_normal()) {
            Some(edge) => {
                let need = "one that gives the edge a length between 2e-308 and 2e308 at this u (angles have no such limit)";
                Err(Error::EdgeWeight { edge, eta: metric.eta[EdgeId::from(edge)].high, need })
            }
            None => Ok(lengths.into()),
        }
    }

    /// [`Metric::differences`].
    pub(crate) fn differences(&self) -> PerFace<[f64; 3]> {
        let mut differences = vec![[0.0; 3]; self.mesh.n_faces()];
        parallel::fill(&mut differences, |f| self.differences_of(f.into()));
        differences.into()
    }

    /// [`Metric::differences`] of one face.
    pub(crate) fn differences_of(&self, f: FaceId) -> [f64; 3] {
        let (r, unit) = self.face_differences(f);
        r.map(|r| scaled(r, unit))
    }

    /// [`Metric::length_remainders`] of these lengths.
    pub fn remainders(&self, lengths: &PerEdge<f64>) -> PerEdge<f64> {
        let mut remainders = vec![0.0; self.edges.len()];
        parallel::fill(&mut remainders, |e| {
            let e = EdgeId::from(e);
            let [a, b] = self.mesh.ends(e).map(|v| self.vertices[v]);
            self.edges[e].remainder(a, b, lengths[e])
        });
        remainders.into()
    }

    /// [`Metric::curvature`].
    ///
    /// # Errors
    /// [`Error::Argument`] as there.
    pub fn curvature(&self) -> Result<Curvature> {
        let curvature = curvature_of(self.mesh, self.metric.space, |f| self.face_differences(f));
        if !curvature.area.is_finite() {
            let value = "so large that the area is out of floating-point range".into();
            return Err(Error::Argument { what: "u", value, need: "smaller: subtract a constant" });
        }
        Ok(curvature)
    }

    fn face_differences(&self, f: FaceId) -> ([f64; 3], i32) {
        face_differences(self.mesh, &self.vertices, &self.edges, f)
    }
}
