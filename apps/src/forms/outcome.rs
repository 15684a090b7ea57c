//! The forms of a surface, their zeros and periods, and the form that is drawn.

use super::args::FormsArgs;
use crate::failure::Failure;
use crate::input::Input;
use crate::progress::doing;
use crate::report::{PhaseSeconds, timed};
use ricci::Control;
use ricci::harmonic::{
    Classes, ComplexForm, Domain, FormLayout, FormsOptions, HarmonicForms, PeriodMatrix, Zero,
    even_combination, indices, integrate, unevenness, with_conjugate, zeros,
};
use ricci::mesh::VertexId;
use ricci::moduli::{BoundsOptions, PeriodBounds, period_bounds};
use ricci::topology::cut_graph;
use std::sync::Arc;

pub struct FormsOutcome {
    pub input: Input,
    pub forms: HarmonicForms,
    /// The forms of the dual classes, of a surface with boundary.
    dual: Option<HarmonicForms>,
    /// The period matrix of a closed surface of genus 1 or more.
    pub periods: Option<PeriodMatrix>,
    /// Its bounds.
    pub bounds: Option<PeriodBounds>,
    /// The width that was asked for; none for the default.
    pub width: Option<f64>,
    /// The holomorphic forms: the basis ζ_i of a closed surface; of an open one every form with its conjugate.
    pub holomorphic: Vec<ComplexForm>,
    /// The zeros of each holomorphic form.
    pub zeros: Vec<Vec<Zero>>,
    /// The form that is drawn; none where the surface has no form but 0.
    pub chosen: Option<ChosenForm>,
}

/// A combination of the forms, and its integral.
pub struct ChosenForm {
    pub coefficients: Vec<f64>,
    pub unevenness: f64,
    pub zeros: Vec<Zero>,
    /// The integral on the given surface, or on its subdivision with the domain's triangulation.
    pub layout: FormLayout,
    /// The quasi-conformal dilatation: its mean by area, and the bound that 99 % of the area stay below.
    pub dilatation: (f64, f64),
}

impl FormsOutcome {
    pub fn new(
        input: Input,
        args: &FormsArgs,
        seconds: &mut PhaseSeconds,
        control: &Control,
    ) -> Result<FormsOutcome, Failure> {
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
        for phases in [Some(&forms), dual.as_ref()].into_iter().flatten().map(|forms| forms.seconds) {
            seconds.build += phases.topology;
            seconds.assemble += phases.assemble;
            seconds.analyse += phases.analyse;
            seconds.factor += phases.factor;
            seconds.solve += phases.solve;
        }
        let has_forms = !forms.forms.is_empty();
        let mut outcome = FormsOutcome {
            periods: if is_open || !has_forms { None } else { Some(PeriodMatrix::new(&forms)?) },
            bounds: None,
            width: args.width,
            holomorphic: Vec::new(),
            zeros: Vec::new(),
            chosen: None,
            input,
            forms,
            dual,
        };
        outcome.find_bounds(args, seconds, control)?;
        outcome.find_holomorphic()?;
        outcome.chosen = if has_forms { Some(outcome.choose(args, seconds, control)?) } else { None };
        Ok(outcome)
    }

    /// The form that is drawn.
    ///
    /// # Errors
    /// [`Failure::Failed`] where there is none.
    pub fn chosen(&self) -> Result<&ChosenForm, Failure> {
        let none = || Failure::Failed("the surface has no harmonic form but 0".into());
        self.chosen.as_ref().ok_or_else(none)
    }

    fn find_bounds(
        &mut self,
        args: &FormsArgs,
        seconds: &mut PhaseSeconds,
        control: &Control,
    ) -> Result<(), Failure> {
        if self.periods.is_some() {
            let default = BoundsOptions::default();
            let options = BoundsOptions {
                width: args.width.unwrap_or(default.width),
                degree: args.degree.into(),
                ..default
            };
            let find = || doing("bounds", || period_bounds(&self.forms, &options, control));
            self.bounds = Some(timed(&mut seconds.bounds, find)?);
        }
        Ok(())
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

    fn choose(
        &self,
        args: &FormsArgs,
        seconds: &mut PhaseSeconds,
        control: &Control,
    ) -> Result<ChosenForm, Failure> {
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
        let laid = timed(&mut seconds.layout, || -> ricci::Result<_> {
            let cut = cut_graph(domain.mesh(), domain.lengths(), &[], control)?;
            integrate(domain, &form, &cut)
        })?;
        let dilatation = laid.dilatation(domain);
        let layout = match timed(&mut seconds.refine, || domain.common_subdivision(control))? {
            Some(subdivision) => laid.on_subdivision(&Arc::new(subdivision))?,
            None => laid,
        };
        Ok(ChosenForm {
            unevenness: unevenness(domain, &self.forms.combination(&coefficients)),
            zeros: zeros(domain.mesh(), &form),
            coefficients,
            layout,
            dilatation,
        })
    }

    /// The largest error of the integral of a form of the basis over a loop, which is 1 over its own loop and 0 over the others.
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

    /// The largest index of a form of the basis at a vertex or a face.
    pub fn largest_index(&self) -> i64 {
        let mesh = self.forms.domain.mesh();
        self.forms.forms.iter().map(|form| indices(mesh, form).largest()).max().unwrap_or(0)
    }
}
