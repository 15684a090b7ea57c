//! The normal equations of a fit: one symbolic analysis for all fits over one space.

use super::equations::{EquationTerms, FitUnknowns};
use super::fairness::{FairnessUnit, PatchEnergy, energies};
use super::fill::Fill;
use super::hole::Hole;
use super::patch::Parameter;
use super::space::SplineSpace;
use super::surface::Spline;
use crate::control::Control;
use crate::error::{Error, Result};
use crate::geometry::vector::{Vector, dot, norm, sub};
use crate::linalg::{Cholesky, Pattern, Symmetric};
use crate::mesh::shapes::SplitMix64;
use crate::parallel;
use std::sync::Arc;

/// Most iterations of conjugate gradients, and the share of the residual at which they end: places are moved after each solution, so that
/// digits beyond are lost.
const ITERATIONS: usize = 40;
const RESIDUAL: f64 = 1e-2;
/// Factor from one weight of the fairness to the next that is tried.
const WEIGHT_STEP: f64 = 10.0;
/// The seed of the signs with which degrees of freedom are estimated.
const SEED: u64 = 1;

/// The normal equations of fits over one space to points whose places change.
pub(crate) struct FitSystem<'a> {
    unknowns: FitUnknowns<'a>,
    pattern: Pattern,
    cholesky: Cholesky,
    /// The fairness energies of the patches.
    energies: Vec<PatchEnergy>,
    /// Their weighted sum.
    fairness: Vec<f64>,
    /// The conditions on fillings at their rings.
    rings: Vec<f64>,
    /// For each filling the equations of its fairness.
    fair_fillings: Vec<Vec<EquationTerms>>,
    /// The conditions on fillings at their rings, with the weighted ones of their fairness.
    conditions: Vec<f64>,
    /// Looked at between the steps of a fit.
    control: Control,
}

/// Points, each with the surface at its place as a sum over the unknowns.
pub(crate) struct PlacedRows<'a> {
    rows: Vec<EquationTerms>,
    points: &'a [Vector],
}

/// The distances of points from tangent planes: the normals at their places, and the weight of tangential distances.
pub(crate) struct TangentPlanes<'a> {
    /// The unit normal at each place; none where the whole distance counts, as on the boundary of the surface.
    pub normals: &'a [Option<Vector>],
    /// Weight of squared tangential distances relative to those along normals.
    pub damping: f64,
}

/// Weights of the fairness of patches and of fillings, relative to that of all.
pub(crate) struct FairnessWeights {
    /// The weight of each patch.
    pub patches: Vec<f64>,
    /// The weight of each hole with a filling.
    pub fillings: Vec<f64>,
}

impl FairnessWeights {
    /// A weight of 1 everywhere.
    pub fn even(space: &SplineSpace, holes: &[Hole]) -> FairnessWeights {
        let filled = holes.iter().filter(|hole| hole.fill.is_some()).count();
        FairnessWeights { patches: vec![1.0; space.patches().len()], fillings: vec![1.0; filled] }
    }
}

/// A fit with its weight of the fairness.
pub(crate) struct WeightedFit {
    pub unknowns: Vec<Vector>,
    pub fairness: f64,
}

impl<'a> FitSystem<'a> {
    /// The system of a space with holes, for points at about these places. Its fits end when the call is cancelled.
    pub fn new(
        space: &'a SplineSpace,
        holes: &'a [Hole],
        places: &[Parameter],
        unit: FairnessUnit,
        control: &Control,
    ) -> Result<FitSystem<'a>> {
        let control = control.still();
        let unknowns = FitUnknowns::new(space, holes);
        let pairs = unknowns.pairs();
        control.check()?;
        let pattern = Pattern::new(unknowns.count(), &pairs)?;
        drop(pairs);
        control.check()?;
        let cholesky = Cholesky::analyse(&pattern)?;
        control.check()?;
        let mut rings = vec![0.0; pattern.entries()];
        let share = (1.0 / places.len().max(1) as f64).sqrt();
        for row in unknowns.on_rings(places, share)? {
            add_square(&pattern, &mut rings, &row, 1.0);
        }
        let fair_fillings = unknowns.fair_fillings(places, share);
        let (energies, nothing) = (energies(space, unit, &control)?, vec![0.0; pattern.entries()]);
        let (fairness, conditions) = (nothing.clone(), nothing);
        let mut system = FitSystem {
            unknowns,
            pattern,
            cholesky,
            energies,
            fairness,
            rings,
            fair_fillings,
            conditions,
            control,
        };
        system.weigh(&FairnessWeights::even(space, holes));
        Ok(system)
    }

    /// Gives the fairness of each patch and filling a weight relative to that of all.
    pub fn weigh(&mut self, weights: &FairnessWeights) {
        self.fairness.fill(0.0);
        for (energy, weight) in self.energies.iter().zip(&weights.patches) {
            let mut matrix = energy.matrix.iter();
            for (k, &i) in energy.control.iter().enumerate() {
                for (&j, x) in energy.control[..=k].iter().zip(matrix.by_ref()) {
                    add_to(&self.pattern, &mut self.fairness, [i, j], weight * x);
                }
            }
        }
        self.conditions.copy_from_slice(&self.rings);
        for (rows, &weight) in self.fair_fillings.iter().zip(&weights.fillings) {
            rows.iter().for_each(|row| add_square(&self.pattern, &mut self.conditions, row, weight));
        }
    }

    /// The points with their places.
    pub fn placed<'p>(&self, places: &[Parameter], points: &'p [Vector]) -> Result<PlacedRows<'p>> {
        self.control.check()?;
        Ok(PlacedRows { rows: self.unknowns.at(places)?, points })
    }

    /// The least-squares fit to points at their places.
    pub fn fit(&mut self, placed: &PlacedRows<'_>, fairness: f64) -> Result<Vec<Vector>> {
        let points = self.matrix_of_points(placed);
        self.factor(&points, fairness)?;
        Ok(self.solve(placed.right(self.unknowns.count())))
    }

    /// The fit to points at their places whose weight of the fairness predicts them best from the others, by generalised cross-validation
    /// \[CW79\]: the mean square distance over the square of the share of free dimensions is least. Weights are tried from `start` on.
    pub fn fit_cross_validated(
        &mut self,
        placed: &PlacedRows<'_>,
        start: f64,
        [least, most]: [f64; 2],
    ) -> Result<WeightedFit> {
        let points = self.matrix_of_points(placed);
        let right = placed.right(self.unknowns.count());
        let mut signs = SplitMix64::new(SEED);
        let signs: Vec<f64> =
            placed.rows.iter().map(|_| if signs.bits() & 1 == 0 { 1.0 } else { -1.0 }).collect();
        let score = |system: &mut FitSystem<'_>, fairness: f64| -> Result<(f64, WeightedFit)> {
            system.factor(&points, fairness)?;
            let unknowns = system.solve(right.clone());
            let free = 1.0 - system.share_of_dimensions(placed, &signs);
            let score = placed.mean_square(&unknowns) / (free * free);
            Ok((score, WeightedFit { unknowns, fairness }))
        };
        let mut best = score(self, start)?;
        for factor in [1.0 / WEIGHT_STEP, WEIGHT_STEP] {
            let mut is_better = false;
            loop {
                let next = best.1.fairness * factor;
                if !(least..=most).contains(&next) {
                    break;
                }
                // A matrix that is singular in rounding has too little fairness.
                let Ok(found) = score(self, next) else { break };
                if found.0 >= best.0 {
                    break;
                }
                (best, is_better) = (found, true);
            }
            if is_better {
                break;
            }
        }
        self.factor(&points, best.1.fairness)?;
        Ok(best.1)
    }

    /// The fit whose tangent planes are nearest to the points, from another fit, by conjugate gradients with the last factor.
    pub fn fit_tangentially(
        &mut self,
        placed: &PlacedRows<'_>,
        planes: &TangentPlanes<'_>,
        mut fit: WeightedFit,
    ) -> Result<WeightedFit> {
        let weight = fit.fairness;
        let constant: Vec<f64> =
            self.conditions.iter().zip(&self.fairness).map(|(c, f)| c + weight * f).collect();
        let by_unknown = placed.by_unknown(self.unknowns.count());
        let misses = placed.misses(&fit.unknowns);
        let mut residual = planes.summed(placed, &by_unknown, &misses);
        let held = self.product(&constant, &fit.unknowns);
        residual.iter_mut().zip(&held).for_each(|(r, h)| *r = sub(*r, *h));
        let mut ahead = self.solve(residual.clone());
        let mut direction = ahead.clone();
        let mut size = scalar(&residual, &ahead);
        let small = RESIDUAL * RESIDUAL * size;
        for _ in 0..ITERATIONS {
            self.control.check()?;
            if size.is_nan() || size <= small {
                break;
            }
            let images = placed.values(&direction);
            let mut image = planes.summed(placed, &by_unknown, &images);
            let rest = self.product(&constant, &direction);
            image.iter_mut().zip(&rest).for_each(|(r, h)| (0..3).for_each(|x| r[x] += h[x]));
            let step = size / scalar(&direction, &image);
            if !step.is_finite() {
                break;
            }
            add_scaled(&mut fit.unknowns, step, &direction);
            add_scaled(&mut residual, -step, &image);
            ahead = self.solve(residual.clone());
            let next = scalar(&residual, &ahead);
            let turn = next / size;
            size = next;
            direction.iter_mut().zip(&ahead).for_each(|(d, a)| *d = [0, 1, 2].map(|x| a[x] + turn * d[x]));
        }
        Ok(fit)
    }

    /// The spline of a solution.
    pub fn spline(&self, space: &Arc<SplineSpace>, holes: &[Hole], unknowns: &[Vector]) -> Result<Spline> {
        let (control_points, mut rest) = unknowns.split_at(space.n_control_points());
        let mut filled = holes.to_vec();
        for fill in filled.iter_mut().filter_map(|hole| hole.fill.as_mut()) {
            let (coefficients, later) = rest.split_at(fill.coefficients().len());
            (*fill, rest) = (Fill::new(coefficients.to_vec())?, later);
        }
        Ok(Spline::new(space.clone(), control_points.to_vec())?.with_holes(filled))
    }

    /// The lower triangle of the mean of the squares of the points' equations.
    fn matrix_of_points(&self, placed: &PlacedRows<'_>) -> Vec<f64> {
        let mut values = vec![0.0; self.pattern.entries()];
        let share = placed.share();
        placed.rows.iter().for_each(|row| add_square(&self.pattern, &mut values, row, share));
        values
    }

    fn factor(&mut self, points: &[f64], fairness: f64) -> Result<()> {
        self.control.check()?;
        let rest = self.conditions.iter().zip(&self.fairness);
        let values: Vec<f64> = points.iter().zip(rest).map(|(p, (c, f))| p + c + fairness * f).collect();
        let size = self.pattern.size();
        self.cholesky.factor(Symmetric { pattern: &self.pattern, values: &values }).map_err(|_| {
            Error::Factorisation {
                size,
                message: "the points do not determine the spline; give more of them, or a fairness above 0"
                    .into(),
            }
        })
    }

    fn solve(&mut self, mut right: Vec<Vector>) -> Vec<Vector> {
        let mut column = vec![0.0; right.len()];
        for x in 0..3 {
            column.iter_mut().zip(&right).for_each(|(c, p)| *c = p[x]);
            self.cholesky.solve(&mut column);
            right.iter_mut().zip(&column).for_each(|(p, c)| p[x] = *c);
        }
        right
    }

    fn product(&self, values: &[f64], x: &[Vector]) -> Vec<Vector> {
        let matrix = Symmetric { pattern: &self.pattern, values };
        let mut found = vec![[0.0; 3]; x.len()];
        let (mut column, mut image) = (vec![0.0; x.len()], vec![0.0; x.len()]);
        for k in 0..3 {
            column.iter_mut().zip(x).for_each(|(c, p)| *c = p[k]);
            matrix.product(&column, &mut image);
            found.iter_mut().zip(&image).for_each(|(p, c)| p[k] = *c);
        }
        found
    }

    /// The trace of the map from points to fitted points over their number, estimated by one vector of random signs \[Hut89\].
    fn share_of_dimensions(&mut self, placed: &PlacedRows<'_>, signs: &[f64]) -> f64 {
        let mut right = vec![0.0; self.unknowns.count()];
        for (row, sign) in placed.rows.iter().zip(signs) {
            row.iter().for_each(|&(k, x)| right[k as usize] += placed.share() * sign * x);
        }
        self.cholesky.solve(&mut right);
        let value = |row: &EquationTerms| row.iter().map(|&(k, x)| x * right[k as usize]).sum::<f64>();
        placed.rows.iter().zip(signs).map(|(row, sign)| sign * value(row)).sum::<f64>() * placed.share()
    }
}

impl PlacedRows<'_> {
    fn share(&self) -> f64 {
        1.0 / self.points.len().max(1) as f64
    }

    fn right(&self, count: usize) -> Vec<Vector> {
        let mut right = vec![[0.0; 3]; count];
        for (row, point) in self.rows.iter().zip(self.points) {
            for &(k, x) in row {
                (0..3).for_each(|c| right[k as usize][c] += self.share() * x * point[c]);
            }
        }
        right
    }

    /// The surface at each place.
    fn values(&self, unknowns: &[Vector]) -> Vec<Vector> {
        let mut values = vec![[0.0; 3]; self.rows.len()];
        parallel::fill(&mut values, |i| {
            self.rows[i].iter().fold([0.0; 3], |sum, &(k, x)| {
                let point = unknowns[k as usize];
                [0, 1, 2].map(|c| sum[c] + x * point[c])
            })
        });
        values
    }

    /// The distances between the points and their places on the surface.
    pub fn distances(&self, unknowns: &[Vector]) -> Vec<f64> {
        self.misses(unknowns).into_iter().map(norm).collect()
    }

    /// The vectors from the surface to the points.
    fn misses(&self, unknowns: &[Vector]) -> Vec<Vector> {
        self.points.iter().zip(self.values(unknowns)).map(|(&point, value)| sub(point, value)).collect()
    }

    fn mean_square(&self, unknowns: &[Vector]) -> f64 {
        self.share() * self.misses(unknowns).iter().map(|&miss| dot(miss, miss)).sum::<f64>()
    }

    /// For each unknown the equations that have it, with its factors.
    fn by_unknown(&self, count: usize) -> Vec<EquationTerms> {
        let mut found = vec![Vec::new(); count];
        for (i, row) in self.rows.iter().enumerate() {
            row.iter().for_each(|&(k, x)| found[k as usize].push((i as u32, x)));
        }
        found
    }
}

impl TangentPlanes<'_> {
    /// The sums over the points of their vectors, tangential parts damped, times the factor of each unknown.
    fn summed(&self, placed: &PlacedRows<'_>, by_unknown: &[EquationTerms], of: &[Vector]) -> Vec<Vector> {
        let weighted: Vec<Vector> = of
            .iter()
            .zip(self.normals)
            .map(|(&v, normal)| {
                let Some(n) = normal else { return v.map(|x| placed.share() * x) };
                let along = (1.0 - self.damping) * dot(v, *n);
                [0, 1, 2].map(|x| placed.share() * (self.damping * v[x] + along * n[x]))
            })
            .collect();
        let mut sums = vec![[0.0; 3]; by_unknown.len()];
        parallel::fill(&mut sums, |k| {
            by_unknown[k].iter().fold([0.0; 3], |sum, &(i, x)| {
                let v = weighted[i as usize];
                [0, 1, 2].map(|c| sum[c] + x * v[c])
            })
        });
        sums
    }
}

fn add_to(pattern: &Pattern, values: &mut [f64], [i, j]: [u32; 2], x: f64) {
    if let Some(at) = pattern.position(i as usize, j as usize) {
        values[at] += x;
    }
}

/// Adds the square of an equation.
fn add_square(pattern: &Pattern, values: &mut [f64], row: &[(u32, f64)], factor: f64) {
    for (k, &(i, x)) in row.iter().enumerate() {
        row[..=k].iter().for_each(|&(j, y)| add_to(pattern, values, [i, j], factor * x * y));
    }
}

fn add_scaled(to: &mut [Vector], factor: f64, of: &[Vector]) {
    to.iter_mut().zip(of).for_each(|(t, o)| (0..3).for_each(|x| t[x] += factor * o[x]));
}

/// The scalar product, summed in the order of the entries.
fn scalar(a: &[Vector], b: &[Vector]) -> f64 {
    a.iter().zip(b).map(|(&a, &b)| dot(a, b)).sum()
}
