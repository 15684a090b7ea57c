//! Harmonic 1-forms: one in every cohomology class, from one linear solve each with one factorisation of the Laplacian.
//!
//! ```
//! use ricci::harmonic::{Domain, FormsOptions, HarmonicForms};
//! use ricci::{Control, Surface, mesh::shapes};
//! let two = Surface::from_soup(&shapes::genus(2, 4)?)?;
//! let domain = Domain::new(&two, &Control::new())?;
//! let forms = HarmonicForms::new(&domain, &FormsOptions::default(), &Control::new())?;
//! assert_eq!(forms.forms.len(), 4);
//! // Form k has the integral 1 over loop k of the basis, and 0 over the others.
//! assert_eq!(forms.forms[2].over(&forms.basis.loops[2]), 1.0);
//! # Ok::<(), ricci::Error>(())
//! ```

use super::cohomology::{Cochain, absolute, relative};
use super::domain::Domain;
use super::laplace::Laplace;
use super::one_form::OneForm;
use crate::archive::stored;
use crate::control::{Control, Stage};
use crate::error::Result;
use crate::geometry::worse;
use crate::mesh::{Mesh, VertexId};
use crate::topology::{HomotopyBasis, homotopy_basis};
use std::time::Instant;

/// The two kinds of cohomology classes of a surface with boundary; on a closed surface both are the same.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Classes {
    /// Forms whose conjugate is 0 along the boundary: harmonic functions with free boundary values locally. On the double they are those
    /// that the mirror symmetry keeps.
    #[default]
    Absolute,
    /// Forms that are 0 along the boundary. On the double they are those that the mirror symmetry reverses.
    Relative,
}
stored!(variants Classes {
        Absolute = 0,
        Relative = 1,
    }
);

/// The options of [`HarmonicForms::new`].
#[derive(Debug, Clone, Copy, Default)]
pub struct FormsOptions {
    /// The classes.
    pub classes: Classes,
    /// The base vertex of the loops; default: a vertex from which they are short.
    pub base: Option<VertexId>,
}

/// The seconds that the phases took.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct FormsSeconds {
    /// The search for the loops and the closed forms.
    pub topology: f64,
    /// The assembly of the matrix.
    pub assemble: f64,
    /// Its analysis.
    pub analyse: f64,
    /// Its factorisation.
    pub factor: f64,
    /// The solves of all forms.
    pub solve: f64,
}

/// A basis of the harmonic 1-forms.
///
/// Their values are whole multiples of a power of two, so small that sums of a few hundred are exact: dω = 0, and integrals over loops
/// are whole numbers, without rounding.
#[derive(Debug, Clone)]
pub struct HarmonicForms {
    /// The surface of the forms.
    pub domain: Domain,
    /// The loops to which the forms are dual.
    pub basis: HomotopyBasis,
    /// The kind of the classes.
    pub classes: Classes,
    /// One form per class, in the order of the basis' loops: 2g on a closed surface, 2g + b − 1 with b boundary loops.
    pub forms: Vec<OneForm>,
    /// Per class, a closed form with integer values.
    pub cochains: Vec<Cochain>,
    /// The largest [`OneForm::closedness`].
    pub closedness: f64,
    /// The largest [`OneForm::coclosedness`], for relative classes at interior vertices alone.
    pub coclosedness: f64,
    /// The seconds that the phases took.
    pub seconds: FormsSeconds,
}
stored!(sections HarmonicForms { domain, basis, classes, forms, cochains, closedness, coclosedness } without
    { seconds });

/// Number of forms in one solve, which reads the factor once for all of them.
const COLUMNS: usize = 8;
/// Largest coclosedness of a solution that is not corrected by a second solve.
const COCLOSED: f64 = 1e-12;
/// Number of binary digits of the values of a form: the sum of a few of them needs at most three more, so it is exact in 53.
const DIGITS: i32 = 50;

impl HarmonicForms {
    /// The harmonic form `ω_closed + dψ` of every class, which satisfies `d(ω_closed + dψ) = 0` and `d*(ω_closed + dψ) = 0` \[GY03\]. O(E
    /// log E) for the loops, one factorisation, and one solve per class.
    ///
    /// # Errors
    /// Those of [`homotopy_basis`] and [`Laplace::new`].
    pub fn new(domain: &Domain, options: &FormsOptions, control: &Control) -> Result<HarmonicForms> {
        let start = Instant::now();
        let mesh = domain.mesh();
        let basis = homotopy_basis(mesh, domain.lengths(), options.base, control)?;
        let is_relative = options.classes == Classes::Relative;
        let cochains = if is_relative { relative } else { absolute }(mesh, &basis, control)?;
        let mut seconds = FormsSeconds { topology: start.elapsed().as_secs_f64(), ..FormsSeconds::default() };
        let laplace = Laplace::new(domain, |v| is_relative && mesh.is_boundary_vertex(v), control)?;
        [seconds.assemble, seconds.analyse, seconds.factor] = laplace.seconds;
        let start = Instant::now();
        let mut forms = Vec::with_capacity(cochains.len());
        for (k, block) in cochains.chunks(COLUMNS).enumerate() {
            control.step(Stage::Flow, (k * COLUMNS) as f64 / cochains.len() as f64)?;
            forms.extend(harmonic(domain, &laplace, block)?);
        }
        seconds.solve = start.elapsed().as_secs_f64();
        let counts = |v: usize| !is_relative || !mesh.is_boundary_vertex(VertexId::from(v));
        let closedness = forms.iter().map(|form: &OneForm| form.closedness(mesh)).fold(0.0, worse);
        let coclosedness = forms.iter().map(|form| form.coclosedness(domain, counts)).fold(0.0, worse);
        let (domain, classes) = (domain.clone(), options.classes);
        Ok(HarmonicForms { domain, basis, classes, forms, cochains, closedness, coclosedness, seconds })
    }

    /// The inner products `∫ ω_k ∧ *ω_l = Σ w_e ω_k(e) ω_l(e)`, symmetric and positive definite. Since ω_k is orthogonal to derivatives,
    /// the closed form of class l, which has few values, takes the place of ω_l.
    pub fn inner_products(&self) -> Vec<Vec<f64>> {
        let weights = self.domain.weights();
        let product = |form: &OneForm, closed: &Cochain| -> f64 {
            closed.0.iter().map(|&(e, x)| weights[e] * form.0[e] * f64::from(x)).sum()
        };
        let rows: Vec<Vec<f64>> =
            self.forms.iter().map(|form| self.cochains.iter().map(|c| product(form, c)).collect()).collect();
        let n = rows.len();
        (0..n).map(|k| (0..n).map(|l| 0.5 * (rows[k][l] + rows[l][k])).collect()).collect()
    }

    /// The integrals of every form over every loop of the basis: rows are forms.
    pub fn periods(&self) -> Vec<Vec<f64>> {
        self.forms.iter().map(|form| self.basis.loops.iter().map(|path| form.over(path)).collect()).collect()
    }

    /// The combination of the forms with these coefficients.
    pub fn combination(&self, coefficients: &[f64]) -> OneForm {
        let mut sum = OneForm::zero(self.domain.mesh());
        self.forms.iter().zip(coefficients).for_each(|(form, &x)| sum.add(x, form));
        sum
    }
}

/// The harmonic forms in the classes of some closed forms.
fn harmonic(domain: &Domain, laplace: &Laplace, closed: &[Cochain]) -> Result<Vec<OneForm>> {
    let (mesh, n) = (domain.mesh(), domain.mesh().n_vertices());
    let mut potentials = vec![0.0; n * closed.len()];
    for (load, cochain) in potentials.chunks_mut(n).zip(closed) {
        for &(e, x) in &cochain.0 {
            let [i, j] = mesh.ends(e).map(|v| v.index());
            let flux = domain.weights()[e] * f64::from(x);
            load[i] += flux;
            load[j] -= flux;
        }
    }
    laplace.solve(&mut potentials)?;
    let forms = |potentials: &mut [f64]| -> Vec<OneForm> {
        closed.iter().zip(potentials.chunks_mut(n)).map(|(c, psi)| exact_sums(mesh, c, psi)).collect()
    };
    let found = forms(&mut potentials);
    if found.iter().all(|form| form.coclosedness(domain, |v| !laplace.is_held(v)) <= COCLOSED) {
        return Ok(found);
    }
    let mut corrections: Vec<f64> = found.iter().flat_map(|form| form.codifferential(domain)).collect();
    laplace.solve(&mut corrections)?;
    potentials.iter_mut().zip(corrections).for_each(|(psi, x)| *psi += x);
    Ok(forms(&mut potentials))
}

/// The form `closed + dψ`, with ψ rounded to multiples of 2^−[`DIGITS`] times the power of two above the largest value.
fn exact_sums(mesh: &Mesh, closed: &Cochain, psi: &mut [f64]) -> OneForm {
    let largest = psi.iter().fold(f64::from(closed.size()), |most, x| most.max(x.abs()));
    let quantum = 2f64.powi(largest.max(f64::MIN_POSITIVE).log2().ceil() as i32 - DIGITS);
    psi.iter_mut().for_each(|x| *x = (*x / quantum).round() * quantum);
    let mut form = OneForm::zero(mesh);
    for e in mesh.edges() {
        let [i, j] = mesh.ends(e).map(|v| psi[v.index()]);
        form.0[e] = j - i;
    }
    closed.0.iter().for_each(|&(e, x)| form.0[e] += f64::from(x));
    form
}
