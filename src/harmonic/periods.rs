//! The period matrix of a closed surface and its holomorphic 1-forms.
//!
//! In the basis ω of harmonic forms dual to the loops (a; b), with `G = ∫ ω ∧ *ω = (P, Q; Qᵀ, R)` and `∫ ω ∧ ω = S = (0, 1; −1, 0)`, the
//! star is `*ω = J ω` with `J = G S`. The holomorphic form with integrals δ_ij over the a_j is `ζ_i = ω_{a_i} + Σ_j Π_ij ω_{b_j}`, with
//!
//! ```text
//!     Re Π = −Q R⁻¹,        Im Π = P − Q R⁻¹ Qᵀ.
//! ```
//!
//! Im Π is symmetric and positive definite on every mesh, as a Schur complement of G; Re Π is symmetric, and `J² = −1`, up to O(h²)
//! \[BS16\].
//!
//! ```
//! use ricci::harmonic::{Domain, FormsOptions, HarmonicForms, PeriodMatrix};
//! use ricci::{Control, Surface, mesh::shapes};
//! let torus = Surface::from_soup(&shapes::torus(2.0, 1.0, 48, 24)?)?;
//! let forms = HarmonicForms::new(&Domain::new(&torus, &Control::new())?, &FormsOptions::default(), &Control::new())?;
//! let tau = PeriodMatrix::new(&forms)?.modulus().unwrap();
//! assert!(tau[0].abs() < 1e-10 && (tau[1] - 3f64.sqrt()).abs() < 0.03);
//! # Ok::<(), ricci::Error>(())
//! ```

use super::forms::HarmonicForms;
use super::one_form::{ComplexForm, OneForm};
use crate::archive::stored;
use crate::error::{Error, Result, check_size};
use crate::geometry::complex::Complex;
use crate::geometry::modulus::modulus;
use crate::linalg::dense::{solve_definite, symmetric_eigenvalues};

/// The period matrix, with residuals that show how well the mesh resolves it.
#[derive(Debug, Clone, PartialEq)]
pub struct PeriodMatrix {
    /// Π (g × g): entry i, j is the integral of ζ_i over b_j.
    pub matrix: Vec<Vec<Complex>>,
    /// The star J (2g × 2g) in the order of the loops a1, b1, …: `*ω_k = Σ_l J_kl ω_l`.
    pub star: Vec<Vec<f64>>,
    /// `‖Π − Πᵀ‖/‖Π‖`, Frobenius norms.
    pub asymmetry: f64,
    /// `‖J² + 1‖`, Frobenius norm.
    pub star_residual: f64,
    /// The least eigenvalue of Im Π, which is positive.
    pub least_eigenvalue: f64,
}
stored!(sections PeriodMatrix { matrix, star, asymmetry, star_residual, least_eigenvalue });

impl PeriodMatrix {
    /// The period matrix of a surface, from its harmonic forms.
    ///
    /// # Errors
    /// [`Error::Argument`] for forms of a surface with boundary or of genus 0; [`Error::Factorisation`] if rounding has made G indefinite.
    pub fn new(forms: &HarmonicForms) -> Result<PeriodMatrix> {
        let group = &forms.basis.group;
        let g = group.genus;
        if group.boundaries > 0 || g == 0 {
            let value = format!("of genus {g} with {} boundary loops", group.boundaries);
            return Err(Error::argument(
                "surface",
                value,
                "closed and of genus 1 or more, to have a period matrix",
            ));
        }
        let products = forms.inner_products();
        let block = |i: usize, j: usize| -> Vec<Vec<f64>> {
            (0..g).map(|k| (0..g).map(|l| products[2 * k + i][2 * l + j]).collect()).collect()
        };
        let [p, q, qt, r] = [block(0, 0), block(0, 1), block(1, 0), block(1, 1)];
        // X = R⁻¹ Qᵀ: Re Π = −Xᵀ, Im Π = P − Q X.
        let x = solve_definite(&r, &qt)?;
        let im = |i: usize, j: usize| p[i][j] - (0..g).map(|k| q[i][k] * x[k][j]).sum::<f64>();
        let im: Vec<Vec<f64>> =
            (0..g).map(|i| (0..g).map(|j| 0.5 * (im(i, j) + im(j, i))).collect()).collect();
        let least_eigenvalue = symmetric_eigenvalues(&im)?.first().copied().unwrap_or(f64::NAN);
        let matrix: Vec<Vec<Complex>> =
            (0..g).map(|i| (0..g).map(|j| [-x[j][i], im[i][j]]).collect()).collect();
        let star = forms.star();
        let (asymmetry, star_residual) = (asymmetry(&matrix), square_plus_one(&star));
        Ok(PeriodMatrix { matrix, star, asymmetry, star_residual, least_eigenvalue })
    }

    /// The genus.
    pub fn genus(&self) -> usize {
        self.matrix.len()
    }

    /// `(Π + Πᵀ)/2`.
    pub fn symmetrised(&self) -> Vec<Vec<Complex>> {
        let m = &self.matrix;
        let mean = |i: usize, j: usize| [0, 1].map(|k| 0.5 * (m[i][j][k] + m[j][i][k]));
        (0..m.len()).map(|i| (0..m.len()).map(|j| mean(i, j)).collect()).collect()
    }

    /// The modulus τ of a torus, reduced to |Re τ| ≤ ½, |τ| ≥ 1; `None` for another genus.
    pub fn modulus(&self) -> Option<[f64; 2]> {
        if self.genus() == 1 { modulus([[1.0, 0.0], self.matrix[0][0]]) } else { None }
    }

    /// The form `Σ c_i ζ_i` for g complex coefficients.
    ///
    /// # Errors
    /// [`Error::Size`].
    pub fn holomorphic(&self, forms: &HarmonicForms, coefficients: &[Complex]) -> Result<ComplexForm> {
        let g = self.genus();
        check_size("coefficients", coefficients.len(), g)?;
        check_size("harmonic forms", forms.forms.len(), 2 * g)?;
        let part = |k: usize| -> OneForm {
            let mut all = vec![0.0; 2 * g];
            for (i, &c) in coefficients.iter().enumerate() {
                all[2 * i] += c[k];
                for j in 0..g {
                    all[2 * j + 1] += crate::geometry::complex::mul(c, self.matrix[i][j])[k];
                }
            }
            forms.combination(&all)
        };
        Ok(ComplexForm::new(&part(0), &part(1)))
    }

    /// The form ζ_i for i < g.
    ///
    /// # Errors
    /// [`Error::Argument`]; [`Error::Size`] for other forms.
    pub fn basis_form(&self, forms: &HarmonicForms, i: usize) -> Result<ComplexForm> {
        if i >= self.genus() {
            return Err(Error::argument("holomorphic form", i, "less than the genus"));
        }
        let chosen: Vec<Complex> = (0..self.genus()).map(|k| [f64::from(u8::from(k == i)), 0.0]).collect();
        self.holomorphic(forms, &chosen)
    }
}

fn asymmetry(m: &[Vec<Complex>]) -> f64 {
    let square = |z: Complex| z[0] * z[0] + z[1] * z[1];
    let pairs = || (0..m.len()).flat_map(|i| (0..m.len()).map(move |j| (i, j)));
    let off: f64 = pairs().map(|(i, j)| square([0, 1].map(|k| m[i][j][k] - m[j][i][k]))).sum();
    (off / pairs().map(|(i, j)| square(m[i][j])).sum::<f64>()).sqrt()
}

fn square_plus_one(j: &[Vec<f64>]) -> f64 {
    let n = j.len();
    let entry =
        |i: usize, k: usize| (0..n).map(|l| j[i][l] * j[l][k]).sum::<f64>() + f64::from(u8::from(i == k));
    (0..n).flat_map(|i| (0..n).map(move |k| (i, k))).map(|(i, k)| entry(i, k).powi(2)).sum::<f64>().sqrt()
}
