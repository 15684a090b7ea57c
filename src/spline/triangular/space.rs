//! Spline spaces: triangular B-splines (DMS splines) over patches that lie in charts of their own [DMS92; Sei91; GHQ06].
//!
//! ```
//! use ricci::spline::{PlaneDomain, KnotOptions, Parameter, Polynomial, Spline, SplineSpace};
//! use std::sync::Arc;
//! let square = PlaneDomain {
//!     vertices: vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.4, 0.6]],
//!     triangles: vec![[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]],
//! };
//! let space = Arc::new(SplineSpace::planar(&square, &square.knots(3, &KnotOptions::default())?)?);
//! // The plane z = 1 + 2 x, as a cubic.
//! let mut coefficients = vec![[0.0; 3]; 10];
//! coefficients[..3].copy_from_slice(&[[0.0, 0.0, 1.0], [1.0, 0.0, 2.0], [0.0, 1.0, 0.0]]);
//! let points = space.control_points_of(&Polynomial::new(3, coefficients))?;
//! let plane = Spline::new(space, points)?;
//! let [x, y, z] = plane.point(Parameter { patch: 0, x: 0.5, y: 0.25 })?;
//! assert!((x - 0.5).abs() + (y - 0.25).abs() + (z - 2.0).abs() < 1e-14);
//! # Ok::<(), ricci::Error>(())
//! ```

use super::index::{basis_size, multi_indices};
use super::knots::{PlaneDomain, check_degree, check_knots};
use super::overlap::supports_in_plane;
use super::patch::{IDENTITY, OUTSIDE, Parameter, Patch, Support};
use super::plan::EvaluationPlan;
use super::polar::Polynomial;
use super::recurrence::{BasisJet, Scratch};
use crate::error::{Error, Result, check_size};
use crate::geometry::complex::doubled_area;
use crate::geometry::worse;
use crate::parallel;
use std::collections::HashMap;

/// Share of the patch to which points near its sides, or outside by rounding, are moved inside: basis functions jump to 0 at the boundary
/// of the domain, and the limit from inside is meant. Values change by about as much.
const INSIDE: f64 = 1e-13;

/// A space of splines: everything of a spline but its control points.
#[derive(Debug, Clone)]
pub struct SplineSpace {
    degree: usize,
    patches: Vec<Patch>,
    supports: Vec<Vec<Support>>,
    /// For each support the inverse of its map; none if that is the identity.
    back: Vec<Vec<Option<[[f64; 3]; 2]>>>,
    plans: Vec<EvaluationPlan>,
    n_control_points: usize,
}

impl SplineSpace {
    /// The space of given patches and, for each of them, the patches whose basis functions reach into it.
    ///
    /// # Errors
    /// [`Error::Argument`] for a degree that is not 1 to 5; [`Error::Spline`] for knots that give no basis, numbers of patches or control
    /// points that do not fit, affine maps that turn the plane over; [`Error::Size`].
    pub fn new(degree: usize, patches: Vec<Patch>, supports: Vec<Vec<Support>>) -> Result<SplineSpace> {
        check_degree(degree)?;
        check_size("supports", supports.len(), patches.len())?;
        for (at, patch) in patches.iter().enumerate() {
            check_knots(at, &patch.knots)?;
            check_size("knots of a corner", patch.knots[0].len(), degree + 1)?;
            check_size("control points of a patch", patch.control.len(), basis_size(degree))?;
        }
        let back = supports
            .iter()
            .enumerate()
            .map(|(at, of)| of.iter().map(|support| backwards(at, support, patches.len())).collect())
            .collect::<Result<_>>()?;
        let largest = patches.iter().flat_map(|patch| &patch.control).max();
        let n_control_points = largest.map_or(0, |&last| last as usize + 1);
        if n_control_points > patches.len() * basis_size(degree) {
            let need = "numbers below the count of basis functions";
            return Err(Error::argument("largest control point", n_control_points - 1, need));
        }
        let mut plans: Vec<Option<EvaluationPlan>> = vec![None; patches.len()];
        parallel::fill(&mut plans, |at| Some(EvaluationPlan::new(&patches[at].knots)));
        let plans = plans.into_iter().flatten().collect();
        Ok(SplineSpace { degree, patches, supports, back, plans, n_control_points })
    }

    /// The space on a plane domain with knots for each vertex. All patches lie in one chart; basis functions with equal polar arguments
    /// have one control point.
    ///
    /// # Errors
    /// Those of [`PlaneDomain::check`] and [`SplineSpace::new`].
    pub fn planar(domain: &PlaneDomain, knots: &[Vec<[f64; 2]>]) -> Result<SplineSpace> {
        domain.check()?;
        check_size("knots", knots.len(), domain.vertices.len())?;
        let degree = knots.first().map_or(0, Vec::len).saturating_sub(1);
        check_degree(degree)?;
        let mut numbers: HashMap<Vec<(u32, usize)>, u32> = HashMap::new();
        let patches = domain.triangles.iter().map(|corners| {
            let control = multi_indices(degree).map(|beta| {
                let mut key: Vec<(u32, usize)> =
                    (0..3).filter(|&k| beta[k] > 0).map(|k| (corners[k], beta[k])).collect();
                key.sort_unstable();
                let next = numbers.len() as u32;
                *numbers.entry(key).or_insert(next)
            });
            let control = control.collect();
            Patch { chart: 0, knots: corners.map(|v| knots[v as usize].clone()), control }
        });
        let patches: Vec<Patch> = patches.collect();
        let supports = supports_in_plane(&patches);
        SplineSpace::new(degree, patches, supports)
    }

    /// The degree n.
    pub fn degree(&self) -> usize {
        self.degree
    }

    /// The patches.
    pub fn patches(&self) -> &[Patch] {
        &self.patches
    }

    /// For each patch the patches whose basis functions reach into it.
    pub fn supports(&self) -> &[Vec<Support>] {
        &self.supports
    }

    /// The number of control points.
    pub fn n_control_points(&self) -> usize {
        self.n_control_points
    }

    /// Calls `add` with each basis function that possibly does not vanish at a place: the number of its control point, its value and
    /// derivatives up to `order` (0, 1, 2) in the coordinates of the place's chart.
    ///
    /// # Errors
    /// [`Error::Spline`] for a patch that does not exist or a place outside its patch.
    pub(super) fn each(
        &self,
        at: Parameter,
        order: usize,
        scratch: &mut Scratch,
        mut add: impl FnMut(u32, &BasisJet),
    ) -> Result<()> {
        let u = self.place(at)?;
        let of = at.patch as usize;
        for (support, back) in self.supports[of].iter().zip(&self.back[of]) {
            let patch = support.patch as usize;
            let control = &self.patches[patch].control;
            match back {
                None => {
                    let jets = self.plans[patch].evaluate(u, order, scratch).unwrap_or_default();
                    control.iter().zip(jets).for_each(|(&c, jet)| add(c, jet));
                }
                Some(map) => {
                    let there = affine(map, u);
                    let jets = self.plans[patch].evaluate(there, order, scratch).unwrap_or_default();
                    control.iter().zip(jets).for_each(|(&c, jet)| add(c, &pulled_back(map, jet)));
                }
            }
        }
        Ok(())
    }

    /// The coordinates of a place, moved inside its patch if it is outside by rounding.
    fn place(&self, at: Parameter) -> Result<[f64; 2]> {
        let Parameter { patch, x, y } = at;
        let refuse = |message: String| Err(Error::Spline { what: "patch", index: patch as usize, message });
        let Some(Patch { knots, .. }) = self.patches.get(patch as usize) else {
            return refuse(format!(
                "it does not exist, there are patches 0 to {}",
                self.patches.len().max(1) - 1
            ));
        };
        let corners = [0, 1, 2].map(|k| knots[k][0]);
        let whole = doubled_area([corners[0], corners[1], corners[2]]);
        let weight = |k: usize| doubled_area([[x, y], corners[(k + 1) % 3], corners[(k + 2) % 3]]) / whole;
        let weights = [weight(0), weight(1), weight(2)];
        let least = -weights.iter().map(|w| -w).fold(f64::NEG_INFINITY, worse);
        if least >= INSIDE {
            return Ok([x, y]);
        }
        if least.is_nan() || least < -OUTSIDE {
            return refuse(format!(
                "({x}, {y}) is outside it, at barycentric coordinates ({:.3e}, {:.3e}, {:.3e})",
                weights[0], weights[1], weights[2]
            ));
        }
        let weights = weights.map(|w| w.max(2.0 * INSIDE));
        let sum: f64 = weights.iter().sum();
        Ok([0, 1].map(|x| (0..3).map(|k| weights[k] / sum * corners[k][x]).sum()))
    }

    /// The control points of a polynomial: its polar form at t_{0,0}, …, t_{0,β_0−1}, t_{1,0}, … \[DMS92\]. Exact if all patches lie in one
    /// chart.
    ///
    /// # Errors
    /// [`Error::Argument`] for a polynomial of another degree, or charts that differ.
    pub fn control_points_of<const D: usize>(&self, polynomial: &Polynomial<D>) -> Result<Vec<[f64; D]>> {
        if polynomial.degree() != self.degree {
            return Err(Error::argument(
                "degree of the polynomial",
                polynomial.degree(),
                "that of the spline",
            ));
        }
        self.check_one_chart()?;
        let mut points = vec![[0.0; D]; self.n_control_points];
        self.for_each_argument(|control, arguments| points[control] = polynomial.polar(arguments));
        Ok(points)
    }

    /// Checks that all patches lie in one chart.
    pub(super) fn check_one_chart(&self) -> Result<()> {
        match self.patches.iter().find(|patch| patch.chart != self.patches[0].chart) {
            Some(patch) => Err(Error::argument(
                "chart",
                patch.chart,
                "that of the first patch: this needs a single chart",
            )),
            None => Ok(()),
        }
    }

    /// Calls `take` with each control point and its polar arguments t_{k,j}, j < β_k, once for each patch that has it.
    pub(super) fn for_each_argument(&self, mut take: impl FnMut(usize, &[[f64; 2]])) {
        for Patch { knots, control, .. } in &self.patches {
            for (beta, &control) in multi_indices(self.degree).zip(control) {
                let arguments: Vec<[f64; 2]> =
                    (0..3).flat_map(|k| knots[k][..beta[k]].iter().copied()).collect();
                take(control as usize, &arguments);
            }
        }
    }

    /// The positions of the control points in the plane: the means of their polar arguments, which are the control points of the identity.
    /// With several charts, each is in the chart of a patch that has the control point.
    pub fn abscissas(&self) -> Vec<[f64; 2]> {
        let mut points = vec![[0.0; 2]; self.n_control_points];
        let mean = |arguments: &[[f64; 2]], x: usize| arguments.iter().map(|p| p[x]).sum::<f64>();
        self.for_each_argument(|control, arguments| {
            points[control] = [0, 1].map(|x| mean(arguments, x) / self.degree as f64);
        });
        points
    }
}

/// The image of a point under an affine map.
pub(super) fn affine(map: &[[f64; 3]; 2], [x, y]: [f64; 2]) -> [f64; 2] {
    map.map(|[a, b, c]| a * x + b * y + c)
}

/// The inverse of a support's map; none if that is the identity.
fn backwards(of: usize, support: &Support, n_patches: usize) -> Result<Option<[[f64; 3]; 2]>> {
    let refuse = |message: String| Err(Error::Spline { what: "patch", index: of, message });
    let [[a, b, c], [d, e, f]] = support.to;
    let det = a * e - b * d;
    if support.patch as usize >= n_patches {
        return refuse(format!("patch {} of its supports does not exist", support.patch));
    }
    if !(det > 0.0 && det.is_finite() && c.is_finite() && f.is_finite()) {
        return refuse(format!("the map from patch {} turns the plane over, or is no map", support.patch));
    }
    let back = [[e, -b, b * f - e * c], [-d, a, d * c - a * f]].map(|row| row.map(|x| x / det));
    if !back.iter().flatten().all(|x| x.is_finite()) {
        return refuse(format!(
            "the map from patch {} has no inverse in the range of doubles",
            support.patch
        ));
    }
    Ok((support.to != IDENTITY).then_some(back))
}

/// The jet of f ∘ A, from that of f.
fn pulled_back([[a, b, _], [c, d, _]]: &[[f64; 3]; 2], [value, x, y, xx, xy, yy]: &BasisJet) -> BasisJet {
    [
        *value,
        a * x + c * y,
        b * x + d * y,
        a * a * xx + 2.0 * a * c * xy + c * c * yy,
        a * b * xx + (a * d + b * c) * xy + c * d * yy,
        b * b * xx + 2.0 * b * d * xy + d * d * yy,
    ]
}
