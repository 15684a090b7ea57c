//! Least-squares fits of splines to points with given places.

use super::fill::Fill;
use super::hole::Hole;
use super::patch::{Parameter, Patch};
use super::recurrence::{BasisJet, Scratch};
use super::space::SplineSpace;
use super::surface::Spline;
use crate::control::{Control, Stage};
use crate::error::{Error, Result, check_size};
use crate::geometry::complex::{Complex, distance as between, doubled_area};
use crate::geometry::vector::{Vector, distance};
use crate::linalg::{Cholesky, Pattern, Symmetric};
use crate::parallel::{self, Pool};
use sprs::{CsMat, TriMat};
use std::f64::consts::SQRT_2;
use std::sync::Arc;

/// Number of sample points along each side of a patch for the fairness energy: enough that some lie in the strips between the knots of two
/// vertices.
const GRID: usize = 8;
/// Weight of the bending relative to that of its variation: it matters where there are fewer points than a quadratic polynomial needs.
const BENDING: f64 = 0.1;

/// Weight, times |m|³, of the mean square distance between filling and spline on the rings of a hole, relative to that of the points in it.
/// With more weight reflection lines bend less there; but around a vertex of many turns there are too few triangles to follow the filling,
/// and the fit to points farther away would become worse.
const RINGS: f64 = 3.0;
/// Weight of the mean square of the second differences of a filling's coefficients, relative to the mean square distance: it matters where
/// there are no points.
const FILL_FAIRNESS: f64 = 1e-6;

/// Options of [`fit`].
#[derive(Debug, Clone, PartialEq)]
pub struct FitOptions {
    /// Weight of the fairness energy ∫ h² |D³F|² + 0.1 |D²F|², times the area of the domain, relative to the mean square distance; h is the
    /// mean side of a triangle. Splines of degree 1 have ∫ |DF|² instead. Default 1e-12: it matters where there are few points, and hardly
    /// changes a fit to many.
    pub fairness: f64,
    /// Number of threads; 0 (default) is one for each core. The result does not depend on it.
    pub threads: usize,
}

impl Default for FitOptions {
    fn default() -> Self {
        FitOptions { fairness: 1e-12, threads: 0 }
    }
}

/// Points in space, each with the place in the domain that it belongs to.
#[derive(Debug, Clone, Copy)]
pub struct PlacedPoints<'a> {
    /// The places.
    pub places: &'a [Parameter],
    /// The points, as many as places.
    pub points: &'a [Vector],
}

/// A spline fitted to points, with its distances from them.
#[derive(Debug, Clone)]
pub struct SplineFit {
    /// The spline.
    pub spline: Spline,
    /// Root mean square of the distances between points and their places on the spline.
    pub rms: f64,
    /// The largest such distance.
    pub max: f64,
}

/// The spline of a space that is the least-squares fit to points at given places.
///
/// # Errors
/// [`Error::Size`] where points and places differ in number; [`Error::Argument`] for a fairness that is negative, or points that are not
/// finite; [`Error::Factorisation`] where the points do not determine the spline (more of them, or a fairness above 0, would);
/// [`Error::Spline`] for places outside their patches; [`Error::Cancelled`].
pub fn fit(
    space: &Arc<SplineSpace>,
    places: &[Parameter],
    points: &[Vector],
    options: &FitOptions,
    control: &Control,
) -> Result<SplineFit> {
    fit_filled(space, &[], PlacedPoints { places, points }, options, control)
}

/// The spline with holes whose filled surface is the least-squares fit to points at given places. Control points and coefficients of the
/// fillings are found together; a hole has a filling if it comes with one, such as a [`Hole::blank`] of the wanted size.
///
/// # Errors
/// Those of [`fit`].
pub fn fit_filled(
    space: &Arc<SplineSpace>,
    holes: &[Hole],
    PlacedPoints { places, points }: PlacedPoints<'_>,
    options: &FitOptions,
    control: &Control,
) -> Result<SplineFit> {
    check_size("points", points.len(), places.len())?;
    let FitOptions { fairness, threads } = *options;
    if !(fairness >= 0.0 && fairness.is_finite()) {
        return Err(Error::argument("fairness", fairness, "0 or positive, and finite"));
    }
    if let Some(at) = points.iter().position(|p| !p.iter().all(|x| x.is_finite())) {
        return Err(Error::argument("point", at, "one with finite coordinates"));
    }
    let unknown = Pool::new(threads)?.run(|| {
        control.step(Stage::Flow, 0.0)?;
        let mut equations =
            FitEquations { space, fills: numbered(holes, space.n_control_points()), rows: Vec::new() };
        let share = (1.0 / places.len().max(1) as f64).sqrt();
        equations.add_points(places, share)?;
        equations.add_holes(places, share)?;
        if fairness > 0.0 {
            control.step(Stage::Flow, 0.3)?;
            equations.make_fair(fairness)?;
        }
        control.step(Stage::Flow, 0.6)?;
        let matrix = equations.matrix();
        let mut right = vec![[0.0; 3]; matrix.cols()];
        for (row, point) in matrix.outer_iterator().zip(points) {
            for (column, weight) in row.iter() {
                (0..3).for_each(|x| right[column][x] += share * weight * point[x]);
            }
        }
        solve(&(&matrix.transpose_view() * &matrix), right)
    })?;
    let (control_points, mut rest) = unknown.split_at(space.n_control_points());
    let mut filled = holes.to_vec();
    for fill in filled.iter_mut().filter_map(|hole| hole.fill.as_mut()) {
        let (coefficients, later) = rest.split_at(fill.coefficients().len());
        (*fill, rest) = (Fill::new(coefficients.to_vec())?, later);
    }
    let spline = Spline::new(space.clone(), control_points.to_vec())?.with_holes(filled);
    let found = spline.evaluate(places, 0, threads, control)?;
    let (mut sum, mut max) = (0.0, 0.0f64);
    for (found, point) in found.iter().zip(points) {
        let miss = distance(found.point, *point);
        (sum, max) = (sum + miss * miss, max.max(miss));
    }
    Ok(SplineFit { spline, rms: (sum / points.len().max(1) as f64).sqrt(), max })
}

/// The filling of a hole among the unknowns.
#[derive(Clone, Copy)]
struct NumberedFill<'a> {
    hole: &'a Hole,
    fill: &'a Fill,
    /// The number of its first coefficient among the unknowns.
    first: usize,
}

impl NumberedFill<'_> {
    /// The terms of the filling at a place w/ρ, times a factor.
    fn terms(&self, w: Complex, factor: f64) -> impl Iterator<Item = (u32, f64)> {
        let first = self.first;
        self.fill.factors(w).map(move |(k, x)| ((first + k) as u32, factor * x))
    }
}

/// The fillings of holes; their coefficients are numbered from `next` on.
fn numbered(holes: &[Hole], mut next: usize) -> Vec<NumberedFill<'_>> {
    let mut fills = Vec::new();
    for (hole, fill) in holes.iter().filter_map(|hole| Some((hole, hole.fill.as_ref()?))) {
        fills.push(NumberedFill { hole, fill, first: next });
        next += fill.coefficients().len();
    }
    fills
}

/// The linear least-squares equations for the control points and, after them, the coefficients of fillings.
struct FitEquations<'a> {
    space: &'a SplineSpace,
    fills: Vec<NumberedFill<'a>>,
    /// The unknowns and their factors in each equation.
    rows: Vec<Vec<(u32, f64)>>,
}

impl<'a> FitEquations<'a> {
    /// The filling that has a part in the surface at a place, with the weights of spline and filling, and the coordinate w/ρ.
    fn filling(&self, at: Parameter) -> Option<(NumberedFill<'a>, [f64; 2], Complex)> {
        self.fills.iter().find_map(|fill| {
            let (parts, w) = fill.hole.parts(at)?;
            Some((*fill, parts, w))
        })
    }

    /// Adds an equation for the surface at each place, times a factor.
    fn add_points(&mut self, places: &[Parameter], share: f64) -> Result<()> {
        let fillings: Vec<_> = places.iter().map(|&at| self.filling(at)).collect();
        let row = self.rows.len();
        self.add(places, 0, |i, jet| {
            vec![share * jet[0] * fillings[i].map_or(1.0, |(_, [spline, _], _)| spline)]
        })?;
        for (i, filling) in fillings.into_iter().enumerate() {
            if let Some((fill, [_, part], w)) = filling {
                self.rows[row + i].extend(fill.terms(w, share * part));
            }
        }
        Ok(())
    }

    /// Adds the equations that keep fillings near the spline on their rings, and fair.
    fn add_holes(&mut self, places: &[Parameter], share: f64) -> Result<()> {
        for numbered in self.fills.clone() {
            let NumberedFill { hole, fill, first } = numbered;
            let inside = places.iter().filter(|&&at| hole.contains(at)).count().max(1) as f64;
            let rings = hole.rings(self.space);
            let rings_weight = RINGS / f64::from(hole.turns.abs()).powi(3);
            let weight = share * (rings_weight * inside / rings.len().max(1) as f64).sqrt();
            let row = self.rows.len();
            self.add(&rings, 0, |_, jet| vec![weight * jet[0]])?;
            for (k, &at) in rings.iter().enumerate() {
                if let Some((_, w)) = hole.parts(at) {
                    self.rows[row + k].extend(numbered.terms(w, -weight));
                }
            }
            let weight = share * (FILL_FAIRNESS * inside / fill.coefficients().len() as f64).sqrt();
            let row = |terms: Vec<(usize, f64)>| {
                terms.into_iter().map(|(k, x)| ((first + k) as u32, weight * x)).collect()
            };
            self.rows.extend(fill.differences().into_iter().map(row));
        }
        Ok(())
    }

    /// Adds equations at places: `of` gives the factor of a basis function, from its derivatives up to `order`, in each equation.
    fn add(
        &mut self,
        places: &[Parameter],
        order: usize,
        of: impl Fn(usize, &BasisJet) -> Vec<f64> + Sync,
    ) -> Result<()> {
        let mut found = vec![Ok(Vec::new()); places.len()];
        parallel::fill_with(&mut found, Scratch::default, |scratch, i| {
            let mut rows: Vec<Vec<(u32, f64)>> = vec![Vec::new()];
            // In the chart of a hole its filling alone is the surface.
            if self.fills.iter().any(|fill| fill.hole.chart == places[i].patch) {
                return Ok(rows);
            }
            self.space.each(places[i], order, scratch, |control, jet| {
                let factors = of(i, jet);
                rows.resize(factors.len(), Vec::new());
                let terms = rows.iter_mut().zip(factors).filter(|(_, x)| *x != 0.0);
                terms.for_each(|(row, x)| row.push((control, x)));
            })?;
            Ok(rows)
        });
        for rows in found {
            self.rows.extend(rows?);
        }
        Ok(())
    }

    /// Adds the fairness energy, times its weight and the area of the domain, as equations with right-hand side 0.
    fn make_fair(&mut self, fairness: f64) -> Result<()> {
        let grids: Vec<FairnessGrid> = self.space.patches().iter().map(FairnessGrid::new).collect();
        let each = GRID * (GRID + 1) / 2;
        let places = |(patch, grid): (usize, &FairnessGrid)| grid.places(patch as u32);
        let places: Vec<Parameter> = grids.iter().enumerate().flat_map(places).collect();
        let area: f64 = grids.iter().map(|grid| grid.area).sum();
        // The unit of length is the side of an equilateral triangle of the mean area, so that a larger domain is as fair.
        let side = (4.0 / 3f64.sqrt() * area / grids.len().max(1) as f64).sqrt();
        let weight = |i: usize| (fairness * area * grids[i / each].area / each as f64).sqrt();
        if self.space.degree() == 1 {
            return self.add(&places, 1, |i, jet| vec![weight(i) * jet[1], weight(i) * jet[2]]);
        }
        let bending = self.rows.len();
        self.add(&places, 2, |i, jet| {
            vec![weight(i) * jet[3], weight(i) * SQRT_2 * jet[4], weight(i) * jet[5]]
        })?;
        for (patch, grid) in grids.iter().enumerate() {
            for ([i, j], length) in grid.steps() {
                for second in 0..3 {
                    let row = |k: usize| &self.rows[bending + 3 * (patch * each + k) + second];
                    // Steps in three directions measure the squared gradient 1.5 times.
                    let scaled = |factor: f64| {
                        let factor = factor * side / (length * 1.5f64.sqrt());
                        move |&(control, x): &(u32, f64)| (control, factor * x)
                    };
                    let change = row(i).iter().map(scaled(1.0)).chain(row(j).iter().map(scaled(-1.0)));
                    let change = change.collect();
                    self.rows.push(change);
                }
            }
        }
        let share = BENDING.sqrt();
        let bending = &mut self.rows[bending..][..3 * places.len()];
        bending.iter_mut().flatten().for_each(|(_, x)| *x *= share);
        Ok(())
    }

    fn columns(&self) -> usize {
        let last = self.fills.last();
        last.map_or(self.space.n_control_points(), |last| last.first + last.fill.coefficients().len())
    }

    /// The matrix equations × unknowns; factors of an unknown that an equation names twice are added.
    fn matrix(&self) -> CsMat<f64> {
        let mut triplets = TriMat::new((self.rows.len(), self.columns()));
        for (i, row) in self.rows.iter().enumerate() {
            row.iter().for_each(|&(control, x)| triplets.add_triplet(i, control as usize, x));
        }
        triplets.to_csr()
    }
}

/// The sample points of the fairness energy in a patch: the centres of those of its GRID² equal triangles that have its orientation.
struct FairnessGrid {
    corners: [Complex; 3],
    area: f64,
}

impl FairnessGrid {
    fn new(patch: &Patch) -> FairnessGrid {
        let corners = [0, 1, 2].map(|k| patch.knots[k][0]);
        FairnessGrid { corners, area: 0.5 * doubled_area(corners) }
    }

    /// The sample points: rows from the first side to the third corner, each from left to right.
    fn places(&self, patch: u32) -> Vec<Parameter> {
        let [a, b, c] = self.corners;
        let cells = (0..GRID).flat_map(|row| (0..GRID - row).map(move |cell| (cell, row)));
        let place = |(cell, row): (usize, usize)| {
            let [s, t] = [cell, row].map(|at| (at as f64 + 1.0 / 3.0) / GRID as f64);
            let [x, y] = [0, 1].map(|x| (1.0 - s - t) * a[x] + s * b[x] + t * c[x]);
            Parameter { patch, x, y }
        };
        cells.map(place).collect()
    }

    /// The pairs of neighbouring sample points, by their numbers, with their distances.
    fn steps(&self) -> Vec<([usize; 2], f64)> {
        let [a, b, c] = self.corners;
        let [along, up, back] = [between(a, b), between(a, c), between(b, c)].map(|x| x / GRID as f64);
        let mut steps = Vec::new();
        let mut at = 0;
        for row in 0..GRID {
            let wide = GRID - row;
            for _ in 1..wide {
                let above = at + wide;
                steps.extend([([at, at + 1], along), ([at, above], up), ([at + 1, above], back)]);
                at += 1;
            }
            at += 1;
        }
        steps
    }
}

/// The solution of a symmetric positive definite system with three right-hand sides.
fn solve(matrix: &CsMat<f64>, right: Vec<Vector>) -> Result<Vec<Vector>> {
    let n = right.len();
    let lower: Vec<(u32, u32)> = entries(matrix).map(|(i, j, _)| (i as u32, j as u32)).collect();
    let pattern = Pattern::new(n, &lower)?;
    let mut values = vec![0.0; pattern.entries()];
    for (i, j, x) in entries(matrix) {
        if let Some(at) = pattern.position(i, j) {
            values[at] += x;
        }
    }
    let mut cholesky = Cholesky::analyse(&pattern)?;
    cholesky.factor(Symmetric { pattern: &pattern, values: &values }).map_err(|_| Error::Factorisation {
        size: n,
        message: "the points do not determine the spline; give more of them, or a fairness above 0".into(),
    })?;
    let mut solution = right;
    let mut column = vec![0.0; n];
    for x in 0..3 {
        column.iter_mut().zip(&solution).for_each(|(c, p)| *c = p[x]);
        cholesky.solve(&mut column);
        solution.iter_mut().zip(&column).for_each(|(p, c)| p[x] = *c);
    }
    Ok(solution)
}

/// The entries on and below the diagonal.
fn entries(matrix: &CsMat<f64>) -> impl Iterator<Item = (usize, usize, f64)> + '_ {
    matrix.iter().filter(|(_, (i, j))| i >= j).map(|(x, (i, j))| (i, j, *x))
}
