//! The forms of a surface with what is said of them.

use super::args::FormsArgs;
use crate::failure::Failure;
use crate::input::Input;
use crate::progress::doing;
use crate::report::{Attempts, Checks, Seconds, timed};
use ricci::Control;
use ricci::harmonic::{
    Classes, ComplexForm, Domain, FormLayout, FormsOptions, HarmonicForms, PeriodMatrix, Zero,
    even_combination, indices, integrate, unevenness, with_conjugate, zeros,
};
use ricci::mesh::VertexId;
use ricci::topology::cut_graph;
use std::sync::Arc;

/// What must hold of every basis of harmonic forms: dω = 0 and d*ω = 0 relative to the largest value, and the integrals over the loops.
const CLOSED: f64 = 1e-12;
const COCLOSED: f64 = 1e-10;
const PERIODS: f64 = 1e-10;

pub struct Found {
    pub forms: HarmonicForms,
    /// Forms of the dual classes, of a surface with boundary.
    pub dual: Option<HarmonicForms>,
    /// Of a closed surface of genus 1 or more.
    pub periods: Option<PeriodMatrix>,
    /// The holomorphic forms: the basis ζ_i of a closed surface, of an open one every form with its conjugate.
    pub holomorphic: Vec<ComplexForm>,
    pub zeros: Vec<Vec<Zero>>,
    /// The form that is drawn.
    pub chosen: Option<Chosen>,
    pub failed: Attempts,
    pub seconds: Seconds,
}

/// A combination of the forms, and its integral.
pub struct Chosen {
    pub coefficients: Vec<f64>,
    pub unevenness: f64,
    pub zeros: Vec<Zero>,
    /// On the given surface, or on its refinement with the domain's triangulation.
    pub layout: FormLayout,
    /// Quasi-conformal dilatation: area-weighted mean, and what 99% of the area stay below.
    pub dilatation: (f64, f64),
}

impl Found {
    pub fn new(input: &Input, args: &FormsArgs, control: &Control) -> Result<Found, Failure> {
        let mut seconds = input.seconds;
        let domain = timed(&mut seconds.flip, || Domain::new(&input.surface, control))?;
        let of = |classes| {
            let options = FormsOptions { classes, base: args.base.map(VertexId) };
            doing("forms", || HarmonicForms::new(&domain, &options, control))
        };
        let classes = args.classes.into();
        let forms = of(classes)?;
        let is_open = forms.basis.group.boundaries > 0;
        let other = if classes == Classes::Absolute { Classes::Relative } else { Classes::Absolute };
        let dual = if is_open { Some(of(other)?) } else { None };
        for of in [Some(&forms), dual.as_ref()].into_iter().flatten().map(|forms| forms.seconds) {
            seconds.build += of.topology;
            seconds.assemble += of.assemble;
            seconds.analyse += of.analyse;
            seconds.factor += of.factor;
            seconds.solve += of.solve;
        }
        let mut found = Found {
            periods: if is_open || forms.forms.is_empty() { None } else { Some(PeriodMatrix::new(&forms)?) },
            holomorphic: Vec::new(),
            zeros: Vec::new(),
            chosen: None,
            failed: Attempts::default(),
            forms,
            dual,
            seconds,
        };
        found.find_holomorphic()?;
        if !found.forms.forms.is_empty() {
            found.chosen = Some(found.choose(args, control)?);
        }
        Ok(found)
    }

    fn find_holomorphic(&mut self) -> Result<(), Failure> {
        let n = self.forms.forms.len();
        self.holomorphic = match (&self.periods, &self.dual) {
            (Some(periods), _) => {
                (0..periods.genus()).map(|i| periods.basis_form(&self.forms, i)).collect::<Result<_, _>>()?
            }
            (None, Some(dual)) => {
                let unit = |k: usize| (0..n).map(|l| f64::from(u8::from(k == l))).collect::<Vec<_>>();
                (0..n).map(|k| with_conjugate(&self.forms, dual, &unit(k))).collect::<Result<_, _>>()?
            }
            (None, None) => Vec::new(),
        };
        let mesh = self.forms.domain.mesh();
        self.zeros = self.holomorphic.iter().map(|form| zeros(mesh, form)).collect();
        Ok(())
    }

    fn choose(&mut self, args: &FormsArgs, control: &Control) -> Result<Chosen, Failure> {
        let n = self.forms.forms.len();
        let coefficients = match args.combination.len() {
            0 => even_combination(&self.forms, control)?,
            given if given == n => args.combination.clone(),
            given => {
                return Err(Failure::Usage(format!("--combination: {given} coefficients for {n} forms")));
            }
        };
        let domain = &self.forms.domain;
        let form = with_conjugate(&self.forms, self.dual.as_ref().unwrap_or(&self.forms), &coefficients)?;
        let mut seconds = self.seconds;
        let laid = timed(&mut seconds.layout, || -> ricci::Result<_> {
            let cut = cut_graph(domain.mesh(), domain.lengths(), &[], control)?;
            integrate(domain, &form, &cut)
        })?;
        let dilatation = laid.dilatation(domain);
        let layout = match timed(&mut seconds.refine, || domain.refinement(control))? {
            Some(refinement) => laid.on_refinement(&Arc::new(refinement))?,
            None => laid,
        };
        self.seconds = seconds;
        Ok(Chosen {
            unevenness: unevenness(domain, &self.forms.combination(&coefficients)),
            zeros: zeros(domain.mesh(), &form),
            coefficients,
            layout,
            dilatation,
        })
    }

    /// Largest difference of an integral over a loop from what it is to be.
    pub fn period_error(&self) -> f64 {
        let handles = 2 * self.forms.basis.group.genus;
        let n = self.forms.forms.len();
        let is_relative = self.forms.classes == Classes::Relative;
        let periods = self.forms.periods();
        let off = |k: usize, l: usize| {
            let is_own = k == l && (k < handles || !is_relative);
            (periods[k][l] - f64::from(u8::from(is_own))).abs()
        };
        (0..n).flat_map(|k| (0..n).map(move |l| (k, l))).map(|(k, l)| off(k, l)).fold(0.0, f64::max)
    }

    /// Largest index of a form of the basis at a vertex or a face.
    pub fn largest_index(&self) -> i64 {
        let mesh = self.forms.domain.mesh();
        self.forms.forms.iter().map(|form| indices(mesh, form).largest()).max().unwrap_or(0)
    }

    pub fn checks(&self) -> Checks {
        let mut checks = Checks::default();
        checks.add("closedness", self.forms.closedness, CLOSED);
        checks.add("coclosedness", self.forms.coclosedness, COCLOSED);
        checks.add("period_error", self.period_error(), PERIODS);
        if let Some(periods) = &self.periods {
            // Positive definite: minus the least eigenvalue is below 0.
            checks.add("riemann_indefinite", -periods.least_eigenvalue, 0.0);
            let expected = 2 * periods.genus() as i64 - 2;
            let total = |zeros: &Vec<Zero>| zeros.iter().map(|z| z.multiplicity).sum::<i64>();
            let off = self.zeros.iter().map(|zeros| (total(zeros) - expected).abs()).max().unwrap_or(0);
            checks.add("zeros_missing", off as f64, 0.0);
        }
        checks
    }
}
