//! Harmonic and holomorphic 1-forms.

use crate::arrays::{array_of, copy_counted, copy_out};
use crate::choice::choices;
use crate::control::{self, ricci_control};
use crate::failure::{Failure, Outcome};
use crate::guard::{self, handle, shared};
use crate::memory;
use crate::mesh::ricci_mesh;
use crate::paths::vertex_or_none;
use crate::status::*;
use crate::structs::{self, sized};
use ricci::geometry::Space;
use ricci::harmonic::{
    Classes, ComplexForm, Domain, FormsOptions, HarmonicForms, PeriodMatrix, with_conjugate, zeros,
};
use std::sync::Arc;

pub struct ricci_forms {
    pub(crate) forms: HarmonicForms,
    /// The harmonic forms of the dual classes; none on a closed surface, whose classes are their own duals.
    pub(crate) dual: Option<HarmonicForms>,
    pub(crate) periods: Option<PeriodMatrix>,
}
handle!(ricci_forms, "forms", |forms| forms.forms.domain.mesh().n_vertices());

choices!(CLASSES: Classes = "classes", [
    RICCI_CLASSES_ABSOLUTE => Classes::Absolute,
    RICCI_CLASSES_RELATIVE => Classes::Relative,
]);

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_forms_options {
    pub size: usize,
    pub base: *const u32,
    pub classes: u32,
    pub reserved: u32,
}
// SAFETY: numbers and a raw pointer; 8-byte alignment, size first.
sized!(ricci_forms_options, "options", reserved);

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_forms_summary {
    pub size: usize,
    pub n_forms: usize,
    pub n_edges: usize,
    pub genus: usize,
    pub n_flips: usize,
    pub closedness: f64,
    pub coclosedness: f64,
    pub asymmetry: f64,
    pub star_residual: f64,
    pub least_eigenvalue: f64,
    pub modulus: [f64; 2],
}
// SAFETY: numbers; 8-byte alignment, size first.
sized!(ricci_forms_summary, "summary");

impl ricci_forms {
    /// ω + i*ω for a combination ω of the forms.
    fn combination(&self, coefficients: *const f64, n: usize) -> Outcome<ComplexForm> {
        let x = array_of("coefficients", coefficients, n, self.forms.forms.len())?;
        Ok(with_conjugate(&self.forms, self.dual.as_ref().unwrap_or(&self.forms), &x)?)
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_forms_new(
    mesh: *const ricci_mesh,
    options: *const ricci_forms_options,
    control: *const ricci_control,
    forms: *mut *mut ricci_forms,
) -> ricci_status {
    guard::make(forms, || {
        let (mesh, given, control) = (shared(mesh)?, structs::read(options)?, control::of(control)?);
        let _reserve = memory::work(mesh.connectivity.n_vertices(), memory::UNIFORM)?;
        let options =
            FormsOptions { classes: CLASSES.choose(given.classes)?, base: vertex_or_none(given.base)? };
        let domain = Domain::new(mesh.surface()?, &control)?;
        let forms = HarmonicForms::new(&domain, &options, &control)?;
        let other = match options.classes {
            Classes::Absolute => Classes::Relative,
            Classes::Relative => Classes::Absolute,
        };
        let is_open = forms.basis.group.boundaries > 0;
        let dual = if is_open {
            Some(HarmonicForms::new(&domain, &FormsOptions { classes: other, ..options }, &control)?)
        } else {
            None
        };
        let periods = if is_open || forms.forms.is_empty() { None } else { Some(PeriodMatrix::new(&forms)?) };
        Ok(ricci_forms { forms, dual, periods })
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_forms_free(forms: *mut ricci_forms) {
    guard::free(forms);
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_forms_summarise(
    forms: *const ricci_forms,
    summary: *mut ricci_forms_summary,
    size: usize,
) -> ricci_status {
    guard::with(forms, |ricci_forms { forms, periods, .. }| {
        let of = |figure: fn(&PeriodMatrix) -> f64| periods.as_ref().map_or(f64::NAN, figure);
        let figures = ricci_forms_summary {
            size: 0,
            n_forms: forms.forms.len(),
            n_edges: forms.domain.mesh().n_edges(),
            genus: forms.basis.group.genus,
            n_flips: forms.domain.metric().start_flips(),
            closedness: forms.closedness,
            coclosedness: forms.coclosedness,
            asymmetry: of(|p| p.asymmetry),
            star_residual: of(|p| p.star_residual),
            least_eigenvalue: of(|p| p.least_eigenvalue),
            modulus: periods.as_ref().and_then(PeriodMatrix::modulus).unwrap_or([f64::NAN; 2]),
        };
        structs::write(figures, summary, size)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_forms_mesh(
    forms: *const ricci_forms,
    mesh: *mut *mut ricci_mesh,
) -> ricci_status {
    guard::make(mesh, || {
        let domain = &shared(forms)?.forms.domain;
        Ok(ricci_mesh::intrinsic(domain.mesh().clone(), Arc::new(domain.lengths().clone()), Space::E2))
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_forms_values(
    forms: *const ricci_forms,
    form: usize,
    values: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(forms, |ricci_forms { forms, .. }| match forms.forms.get(form) {
        Some(form) => copy_out("values", &form.0, values, capacity),
        None => Err(Failure::argument(format!("form {form}: they are 0 to n_forms - 1"))),
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_forms_holomorphic(
    forms: *const ricci_forms,
    coefficients: *const f64,
    n_coefficients: usize,
    values: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(forms, |forms| {
        let form = forms.combination(coefficients, n_coefficients)?;
        copy_out("values", &form.0, values, capacity)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_forms_zeros(
    forms: *const ricci_forms,
    coefficients: *const f64,
    n_coefficients: usize,
    found: *mut i64,
    capacity: usize,
    n_entries: *mut usize,
) -> ricci_status {
    guard::with(forms, |forms| {
        let form = forms.combination(coefficients, n_coefficients)?;
        let all = zeros(forms.forms.domain.mesh(), &form);
        let all: Vec<i64> = all.iter().flat_map(|z| [i64::from(z.vertex.0), z.multiplicity]).collect();
        copy_counted("zeros", &all, found, capacity, n_entries)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_forms_periods(
    forms: *const ricci_forms,
    matrix: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(forms, |forms| match &forms.periods {
        Some(periods) => copy_out("matrix", &periods.matrix.concat(), matrix, capacity),
        None => {
            Err(Failure::new(RICCI_LAYOUT, "only a closed surface of genus 1 or more has a period matrix"))
        }
    })
}
