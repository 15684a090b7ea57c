//! The evaluation of all basis functions of one patch at a point.
//!
//! The recurrence of a basis function leads to simplex splines of fewer knots, most of which serve several basis functions. Every set of
//! knots that occurs is numbered once, by ascending degree ([`super::recurrence`]). A set depends on the point by three cross products of
//! pairs of knots relative to the point, and each pair serves many sets.
//!
//! Inside Ω, where the point lies within every triangle of three knots of different vertices, sets without knots of one vertex vanish
//! \[Sei91\], so that a much shorter recurrence, that of a B-patch, is enough.

use super::index::basis_size;
use super::overlap::bounds;
use super::recurrence::{BasisJet, KnotSets, Recurrence, Scratch};
use crate::geometry::complex::{cross, doubled_area, sub};

/// The recurrences of the basis functions of one patch, in the patch's own coordinates.
#[derive(Debug, Clone)]
pub(super) struct EvaluationPlan {
    degree: usize,
    sets: KnotSets,
    everywhere: Recurrence,
    inside: Recurrence,
    /// The factor |d| of each basis function.
    weights: Vec<f64>,
    /// The pairs of knots, of different vertices, that have all others on their left or on their line.
    outer: Vec<[usize; 2]>,
    lower: [f64; 2],
    upper: [f64; 2],
}

impl EvaluationPlan {
    /// The plan for the knots t_{k,j} of a patch, all of whose triangles (t_{0,a}, t_{1,b}, t_{2,c}) are counterclockwise.
    pub fn new(knots: &[Vec<[f64; 2]>; 3]) -> EvaluationPlan {
        let degree = knots[0].len() - 1;
        let sets = KnotSets::new(knots);
        let all = &sets.knots;
        let is_outer = |[a, b]: &[usize; 2]| all.iter().all(|&p| doubled_area([p, all[*a], all[*b]]) >= 0.0);
        let [lower, upper] = bounds(all.iter());
        EvaluationPlan {
            degree,
            everywhere: Recurrence::new(&sets, false),
            inside: Recurrence::new(&sets, true),
            weights: super::index::multi_indices(degree).map(|beta| sets.weight(beta)).collect(),
            outer: sets.crossing().iter().copied().filter(is_outer).collect(),
            lower,
            upper,
            sets,
        }
    }

    /// The basis functions at a point with their derivatives up to `order` (0, 1, 2), in the order of [`super::multi_indices`]; none if the
    /// point is outside the convex hull of the knots, where all vanish.
    pub fn evaluate<'s>(
        &self,
        u: [f64; 2],
        order: usize,
        scratch: &'s mut Scratch,
    ) -> Option<&'s [BasisJet]> {
        let within = |k: usize| self.lower[k] <= u[k] && u[k] <= self.upper[k];
        let knots = &self.sets.knots;
        let is_beyond = |&[a, b]: &[usize; 2]| cross(sub(knots[a], u), sub(knots[b], u)) < 0.0;
        if !(within(0) && within(1)) || self.outer.iter().any(is_beyond) {
            return None;
        }
        let is_inside = self.sets.cross_products(u, &mut scratch.crosses);
        let recurrence = if is_inside { &self.inside } else { &self.everywhere };
        recurrence.run(self.degree, order, scratch);
        scratch.jets.iter_mut().zip(&self.weights).for_each(|(jet, d)| jet.iter_mut().for_each(|x| *x *= d));
        debug_assert_eq!(scratch.jets.len(), basis_size(self.degree));
        Some(&scratch.jets)
    }
}
