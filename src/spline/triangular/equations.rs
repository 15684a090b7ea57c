//! The linear equations of a fit: points of the surface in the control points and the coefficients of fillings.

use super::fill::Fill;
use super::hole::Hole;
use super::patch::Parameter;
use super::recurrence::Scratch;
use super::space::SplineSpace;
use crate::error::Result;
use crate::geometry::complex::Complex;
use crate::parallel;

/// Weight, times |m|³ for |m| > 1, of the mean square distance between filling and spline on the rings of a hole, relative to that of the points in
/// it.
/// With more weight reflection lines bend less there; but around a vertex of many turns there are too few triangles to follow the filling,
/// and the fit to points farther away would become worse.
const RINGS: f64 = 3.0;
/// Weight of the mean square of the second differences of a filling's coefficients, relative to the mean square distance: it matters where
/// there are no points.
const FILL_FAIRNESS: f64 = 1e-6;

/// The unknowns of an equation with their factors, ascending, each once.
pub(super) type EquationTerms = Vec<(u32, f64)>;

/// The filling of a hole among the unknowns.
#[derive(Clone, Copy)]
pub(super) struct NumberedFill<'a> {
    pub hole: &'a Hole,
    pub fill: &'a Fill,
    /// The number of its first coefficient among the unknowns.
    pub first: usize,
}

impl NumberedFill<'_> {
    /// The terms of the filling at a place w/ρ, times a factor.
    fn terms(&self, w: Complex, factor: f64) -> impl Iterator<Item = (u32, f64)> {
        let first = self.first;
        self.fill.factors(w).map(move |(k, x)| ((first + k) as u32, factor * x))
    }
}

/// The unknowns of a fit: control points, and after them the coefficients of fillings.
pub(super) struct FitUnknowns<'a> {
    pub space: &'a SplineSpace,
    pub fills: Vec<NumberedFill<'a>>,
}

impl<'a> FitUnknowns<'a> {
    pub fn new(space: &'a SplineSpace, holes: &'a [Hole]) -> FitUnknowns<'a> {
        let (mut fills, mut next) = (Vec::new(), space.n_control_points());
        for (hole, fill) in holes.iter().filter_map(|hole| Some((hole, hole.fill.as_ref()?))) {
            fills.push(NumberedFill { hole, fill, first: next });
            next += fill.coefficients().len();
        }
        FitUnknowns { space, fills }
    }

    /// The number of unknowns.
    pub fn count(&self) -> usize {
        let last = self.fills.last();
        last.map_or(self.space.n_control_points(), |last| last.first + last.fill.coefficients().len())
    }

    /// The surface at each place as a sum over the unknowns.
    ///
    /// # Errors
    /// Those of [`SplineSpace::each`].
    pub fn at(&self, places: &[Parameter]) -> Result<Vec<EquationTerms>> {
        self.equations(places, |i, scratch| {
            let filling = self.filling(places[i]);
            let mut terms = self.spline(places[i], filling.map_or(1.0, |(_, [part, _], _)| part), scratch)?;
            if let Some((fill, [_, part], w)) = filling {
                terms.extend(fill.terms(w, part));
            }
            Ok(terms)
        })
    }

    /// The equations with right-hand side 0 that keep fillings near the spline on their rings, beside a fit to points at these places whose
    /// squared distances are weighted by the square of `share`.
    ///
    /// # Errors
    /// Those of [`SplineSpace::each`].
    pub fn on_rings(&self, places: &[Parameter], share: f64) -> Result<Vec<EquationTerms>> {
        let mut all = Vec::new();
        for numbered in &self.fills {
            let hole = numbered.hole;
            let rings = hole.rings(self.space);
            let rings_weight = RINGS / hole.turns.abs().max(1.0).powi(3);
            let inside = points_inside(hole, places);
            let weight = share * (rings_weight * inside / rings.len().max(1) as f64).sqrt();
            all.extend(self.equations(&rings, |i, scratch| {
                let mut terms = self.spline(rings[i], weight, scratch)?;
                if let Some((_, w)) = hole.parts(rings[i]) {
                    terms.extend(numbered.terms(w, -weight));
                }
                Ok(terms)
            })?);
        }
        Ok(all)
    }

    /// For each filling the equations with right-hand side 0 that keep it fair, beside such a fit.
    pub fn fair_fillings(&self, places: &[Parameter], share: f64) -> Vec<Vec<EquationTerms>> {
        let of = |NumberedFill { hole, fill, first }: &NumberedFill<'_>| {
            let inside = points_inside(hole, places);
            let weight = share * (FILL_FAIRNESS * inside / fill.coefficients().len() as f64).sqrt();
            let row = |terms: Vec<(usize, f64)>| {
                sorted(terms.into_iter().map(|(k, x)| ((first + k) as u32, weight * x)).collect())
            };
            fill.differences().into_iter().map(row).collect()
        };
        self.fills.iter().map(of).collect()
    }

    /// The pairs of unknowns that an equation can have in common.
    pub fn pairs(&self) -> Vec<(u32, u32)> {
        let mut pairs = Vec::new();
        let mut around: Vec<Vec<u32>> = Vec::new();
        for of in self.space.supports() {
            let patches = of.iter().map(|support| &self.space.patches()[support.patch as usize]);
            let mut controls: Vec<u32> = patches.flat_map(|patch| patch.control.iter().copied()).collect();
            controls.sort_unstable();
            controls.dedup();
            for (k, &i) in controls.iter().enumerate() {
                pairs.extend(controls[..k].iter().map(|&j| (i, j)));
            }
            around.push(controls);
        }
        for NumberedFill { hole, fill, first } in &self.fills {
            let own: Vec<u32> = (*first..first + fill.coefficients().len()).map(|k| k as u32).collect();
            for (k, &i) in own.iter().enumerate() {
                pairs.extend(own[..k].iter().map(|&j| (i, j)));
            }
            let mut controls: Vec<u32> = hole
                .sectors
                .iter()
                .flat_map(|sector| around[sector.patch as usize].iter().copied())
                .collect();
            controls.sort_unstable();
            controls.dedup();
            controls.iter().for_each(|&j| pairs.extend(own.iter().map(|&i| (i, j))));
        }
        pairs
    }

    /// The filling that has a part in the surface at a place, with the weights of spline and filling, and the coordinate w/ρ.
    fn filling(&self, at: Parameter) -> Option<(NumberedFill<'a>, [f64; 2], Complex)> {
        self.fills.iter().find_map(|fill| {
            let (parts, w) = fill.hole.parts(at)?;
            Some((*fill, parts, w))
        })
    }

    /// The spline without fillings at a place, times a factor; no terms in the chart of a hole.
    fn spline(&self, at: Parameter, factor: f64, scratch: &mut Scratch) -> Result<EquationTerms> {
        let mut terms = Vec::new();
        if factor == 0.0 || self.fills.iter().any(|fill| fill.hole.chart == at.patch) {
            return Ok(terms);
        }
        self.space.each(at, 0, scratch, |control, jet| {
            if jet[0] != 0.0 {
                terms.push((control, factor * jet[0]));
            }
        })?;
        Ok(terms)
    }

    fn equations(
        &self,
        places: &[Parameter],
        of: impl Fn(usize, &mut Scratch) -> Result<EquationTerms> + Sync,
    ) -> Result<Vec<EquationTerms>> {
        let mut found = vec![Ok(Vec::new()); places.len()];
        parallel::fill_with(&mut found, Scratch::default, |scratch, i| of(i, scratch).map(sorted));
        found.into_iter().collect()
    }
}

/// The number of places in a hole, at least 1.
fn points_inside(hole: &Hole, places: &[Parameter]) -> f64 {
    places.iter().filter(|&&at| hole.contains(at)).count().max(1) as f64
}

/// The terms in the order of their unknowns; factors of an unknown that is named twice are added.
fn sorted(mut terms: EquationTerms) -> EquationTerms {
    terms.sort_by_key(|(unknown, _)| *unknown);
    terms.dedup_by(|next, before| {
        let is_same = next.0 == before.0;
        if is_same {
            before.1 += next.1;
        }
        is_same
    });
    terms
}
