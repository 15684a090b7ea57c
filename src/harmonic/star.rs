//! The Hodge star of harmonic forms, as a matrix between their classes.
//!
//! On a surface with boundary the star of an absolute class is a relative one, and conversely. With the products `G_kl = ∫ ω_k ∧ *ω_l` and
//! `P_km = ∫ ω_k ∧ ρ_m`, where the ρ are the dual classes, `*ω_l = Σ_m J_lm ρ_m` has `P Jᵀ = G`. P is the intersection matrix of the loops:
//! (0, 1; −1, 0) for each handle, −1 for a boundary loop and its arc (of relative with absolute classes +1).
//!
//! ```
//! use ricci::harmonic::{Classes, Domain, FormsOptions, HarmonicForms, with_conjugate};
//! use ricci::{Control, Surface, mesh::shapes};
//! let annulus = Surface::from_soup(&shapes::annulus(0.5, 1.0, 8, 40)?)?;
//! let control = Control::new();
//! let domain = Domain::new(&annulus, &control)?;
//! let [around, across] = [Classes::Absolute, Classes::Relative]
//!     .map(|classes| HarmonicForms::new(&domain, &FormsOptions { classes, base: None }, &control));
//! // dφ/2π, with the conjugate −d log r/2π: from the inner to the outer circle log 2/2π.
//! let form = with_conjugate(&around?, &across?, &[1.0])?;
//! let across = annulus.mesh().edges().map(|e| form.0[e][1].abs()).fold(0.0, f64::max);
//! assert!(across > 0.01 && across < 0.02);
//! # Ok::<(), ricci::Error>(())
//! ```

use super::forms::{Classes, HarmonicForms};
use super::one_form::ComplexForm;
use crate::error::{Error, Result, check_size};

impl HarmonicForms {
    /// The matrix J, whose row k holds the coefficients of `*ω_k` in the dual classes; on a closed surface these are the same forms.
    pub fn star(&self) -> Vec<Vec<f64>> {
        let (handles, arcs) =
            (2 * self.basis.group.genus, if self.classes == Classes::Absolute { -1.0 } else { 1.0 });
        let entry = |row: &[f64], m: usize| {
            if m >= handles {
                arcs * row[m]
            } else if m.is_multiple_of(2) {
                -row[m + 1]
            } else {
                row[m - 1]
            }
        };
        self.inner_products().iter().map(|row| (0..row.len()).map(|m| entry(row, m)).collect()).collect()
    }
}

/// The form `ω + i *ω`, holomorphic up to O(h²), for the combination ω of forms with these coefficients. `dual`: the forms of the dual
/// classes on the same domain; on a closed surface the same forms.
///
/// # Errors
/// [`Error::Size`]; [`Error::Argument`] for classes that are not dual.
pub fn with_conjugate(
    forms: &HarmonicForms,
    dual: &HarmonicForms,
    coefficients: &[f64],
) -> Result<ComplexForm> {
    check_size("coefficients", coefficients.len(), forms.forms.len())?;
    check_size("dual forms", dual.forms.len(), forms.forms.len())?;
    if forms.basis.group.boundaries > 0 && forms.classes == dual.classes {
        return Err(Error::argument("classes", "the same", "absolute and relative, which are dual"));
    }
    let star = forms.star();
    let conjugate = |m: usize| (0..star.len()).map(|k| coefficients[k] * star[k][m]).sum();
    let conjugate: Vec<f64> = (0..star.len()).map(conjugate).collect();
    Ok(ComplexForm::new(&forms.combination(coefficients), &dual.combination(&conjugate)))
}
