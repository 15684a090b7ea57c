//! Discrete 1-forms, which are given by their integrals over the edges.
//!
//! ```
//! use ricci::harmonic::OneForm;
//! use ricci::mesh::Mesh;
//! let mesh = Mesh::from_faces(3, &[[0, 1, 2]])?;
//! let gradient = OneForm::exact(&mesh, &[0.0, 1.0, 3.0])?;
//! assert_eq!(gradient.closedness(&mesh), 0.0);
//! # Ok::<(), ricci::Error>(())
//! ```

use super::domain::Domain;
use crate::archive::stored;
use crate::error::{Result, check_size};
use crate::geometry::complex::{Complex, add};
use crate::mesh::{EdgeId, HalfedgeId, Mesh, PerEdge};

/// A real 1-form: its integral over the half-edge 2e of every edge e (E entries).
#[derive(Debug, Clone, PartialEq)]
pub struct OneForm(pub PerEdge<f64>);
stored!(id OneForm);

/// A complex 1-form: its integral over the half-edge 2e of every edge e (E entries).
#[derive(Debug, Clone, PartialEq)]
pub struct ComplexForm(pub PerEdge<Complex>);

impl OneForm {
    /// The form that is 0.
    pub fn zero(mesh: &Mesh) -> OneForm {
        OneForm(PerEdge::filled(mesh.n_edges(), 0.0))
    }

    /// The derivative `u_j − u_i` of a function of the vertices (V entries).
    ///
    /// # Errors
    /// [`crate::Error::Size`].
    pub fn exact(mesh: &Mesh, u: &[f64]) -> Result<OneForm> {
        check_size("function", u.len(), mesh.n_vertices())?;
        let along = |e: EdgeId| {
            let [i, j] = mesh.ends(e).map(|v| u[v.index()]);
            j - i
        };
        Ok(OneForm(PerEdge::from_fn(mesh.n_edges(), along)))
    }

    /// The integral over a half-edge, in its direction.
    #[inline]
    pub fn along(&self, h: HalfedgeId) -> f64 {
        let value = self.0[h.edge()];
        if h.0 & 1 == 0 { value } else { -value }
    }

    /// The integral over a path.
    pub fn over(&self, path: &[HalfedgeId]) -> f64 {
        path.iter().map(|&h| self.along(h)).sum()
    }

    /// The largest |value|; NaN if one is NaN.
    pub fn size(&self) -> f64 {
        self.0.iter().fold(0.0, |most, x| crate::geometry::worse(most, x.abs()))
    }

    /// The largest |dω| of a face over the largest |value|: 0 for a closed form up to rounding.
    pub fn closedness(&self, mesh: &Mesh) -> f64 {
        let around = mesh.faces().map(|f| self.over(&mesh.face_halfedges(f)).abs());
        relative(around.fold(0.0, crate::geometry::worse), self.size())
    }

    /// `d*ω` per vertex (V entries): `Σ w_ij ω_ij` over the edges that leave it.
    pub fn codifferential(&self, domain: &Domain) -> Vec<f64> {
        let mesh = domain.mesh();
        let mut sum = vec![0.0; mesh.n_vertices()];
        for e in mesh.edges() {
            let [i, j] = mesh.ends(e).map(|v| v.index());
            let flux = domain.weights()[e] * self.0[e];
            sum[i] += flux;
            sum[j] -= flux;
        }
        sum
    }

    /// The largest |d*ω| at the vertices for which `counts` is true, over the largest |value|.
    pub fn coclosedness(&self, domain: &Domain, counts: impl Fn(usize) -> bool) -> f64 {
        let all = self.codifferential(domain);
        let worst = (0..all.len()).filter(|&v| counts(v)).map(|v| all[v].abs());
        relative(worst.fold(0.0, crate::geometry::worse), self.size())
    }

    /// The inner product `Σ w_e ω_e ω'_e`, the integral of `ω ∧ *ω'`.
    pub fn inner(&self, other: &OneForm, domain: &Domain) -> f64 {
        domain.mesh().edges().map(|e| domain.weights()[e] * self.0[e] * other.0[e]).sum()
    }

    /// The integral of `ω ∧ ω'`, where both are taken to be linear on every face: for closed forms this depends on their classes alone.
    pub fn wedge(&self, other: &OneForm, mesh: &Mesh) -> f64 {
        let of_face = |f| {
            let [h, next, _] = mesh.face_halfedges(f);
            0.5 * (self.along(h) * other.along(next) - self.along(next) * other.along(h))
        };
        mesh.faces().map(of_face).sum()
    }

    /// Adds `times · other`.
    pub fn add(&mut self, times: f64, other: &OneForm) {
        self.0.iter_mut().zip(&other.0).for_each(|(x, y)| *x += times * y);
    }
}

fn relative(x: f64, size: f64) -> f64 {
    if size > 0.0 { x / size } else { x }
}

impl ComplexForm {
    /// The form `re + i im`.
    pub fn new(re: &OneForm, im: &OneForm) -> ComplexForm {
        ComplexForm(PerEdge::from_fn(re.0.len(), |e| [re.0[e], im.0[e]]))
    }

    /// The integral over a half-edge, in its direction.
    #[inline]
    pub fn along(&self, h: HalfedgeId) -> Complex {
        let value = self.0[h.edge()];
        if h.0 & 1 == 0 { value } else { value.map(|x| -x) }
    }

    /// The integral over a path.
    pub fn over(&self, path: &[HalfedgeId]) -> Complex {
        path.iter().fold([0.0; 2], |sum, &h| add(sum, self.along(h)))
    }

    /// The real part.
    pub fn re(&self) -> OneForm {
        OneForm(PerEdge::from_fn(self.0.len(), |e| self.0[e][0]))
    }

    /// The imaginary part.
    pub fn im(&self) -> OneForm {
        OneForm(PerEdge::from_fn(self.0.len(), |e| self.0[e][1]))
    }
}
