//! The simplex splines of one patch, evaluated together.
//!
//! The recurrence of a basis function leads to simplex splines of fewer knots, and most of these serve several basis functions. So every
//! set of knots that occurs is numbered once, by ascending degree ([`super::recurrence`]). What a set needs of a point is three cross
//! products of knots seen from the point, and each pair of knots serves many sets.
//!
//! Inside Ω, where the point lies within every triangle of three knots of different vertices, sets without knots of one vertex vanish
//! \[Sei91\]: there a much shorter recurrence is enough, which is that of a B-patch.

use super::index::basis_size;
use super::overlap::bounds;
use super::recurrence::{Jet, Recurrence, Scratch, Sets};
use crate::geometry::complex::{cross, doubled_area, sub};

/// The recurrences of the basis functions of one patch, in the patch's own coordinates.
#[derive(Debug, Clone)]
pub(super) struct Plan {
    degree: usize,
    sets: Sets,
    everywhere: Recurrence,
    inside: Recurrence,
    /// |d| per basis function.
    weights: Vec<f64>,
    /// Per side of the patch two knots that have all others on their left, or on their line.
    outer: Vec<[usize; 2]>,
    lower: [f64; 2],
    upper: [f64; 2],
}

impl Plan {
    /// For the knots t_{k,j} of a patch, j = 0 … n for each k, all of whose triangles (t_{0,a}, t_{1,b}, t_{2,c}) are counterclockwise.
    pub fn new(knots: &[Vec<[f64; 2]>; 3]) -> Plan {
        let degree = knots[0].len() - 1;
        let sets = Sets::new(knots);
        let all = &sets.knots;
        let is_outer = |[a, b]: &[usize; 2]| all.iter().all(|&p| doubled_area([p, all[*a], all[*b]]) >= 0.0);
        let [lower, upper] = bounds(all.iter());
        Plan {
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

    /// The basis functions at a point with their derivatives up to `order` (0, 1, 2), in the order of [`super::multi_indices`]; none where
    /// all of them vanish because the point is not in the convex hull of the knots.
    pub fn evaluate<'s>(&self, u: [f64; 2], order: usize, scratch: &'s mut Scratch) -> Option<&'s [Jet]> {
        let within = |k: usize| self.lower[k] <= u[k] && u[k] <= self.upper[k];
        let knots = &self.sets.knots;
        let is_beyond = |&[a, b]: &[usize; 2]| cross(sub(knots[a], u), sub(knots[b], u)) < 0.0;
        if !(within(0) && within(1)) || self.outer.iter().any(is_beyond) {
            return None;
        }
        let is_inside = self.sets.see(u, &mut scratch.seen);
        let recurrence = if is_inside { &self.inside } else { &self.everywhere };
        recurrence.run(self.degree, order, scratch);
        scratch.jets.iter_mut().zip(&self.weights).for_each(|(jet, d)| jet.iter_mut().for_each(|x| *x *= d));
        debug_assert_eq!(scratch.jets.len(), basis_size(self.degree));
        Some(&scratch.jets)
    }
}
