//! The pairs of pants of a surface, how they are glued, and the fundamental group of the result.
//!
//! With n = g + b curves e_i, the commutators `a_i b_i a_i⁻¹ b_i⁻¹` and then the boundary loops, whose product is 1, and `d_j = e_1 ⋯ e_j`, the pairs of
//! pants have the boundary elements `a_i, b_i a_i⁻¹ b_i⁻¹, e_i⁻¹` (handle i) and `d_j, e_{j+1}, d_{j+1}⁻¹`, 1 ≤ j ≤ n − 2, all with the pants on their
//! left. A twist is the way along the curve from the foot of the seam on its right to that on its left, of the seams to the neighbours that
//! [`crate::moduli::fenchel_nielsen`] names.

use super::hexagon::{Hexagon, along, half_turn};
use crate::error::{Error, Result};
use crate::geometry::{DoubleDouble, Motion, Space};
use crate::mesh::shapes::check_count;
use std::ops::RangeInclusive;

/// Range of the lengths, and largest size of a twist. The coordinates of a curve that twists farther need more than the digits of
/// double-double precision.
const LENGTHS: RangeInclusive<f64> = 1e-3..=30.0;
const TWIST: f64 = 30.0;

/// Lengths and twists of a surface of genus g with b boundary loops, 2g − 2 + b > 0.
#[derive(Debug, Clone, PartialEq)]
pub struct FenchelNielsen {
    /// g.
    pub genus: usize,
    /// Length and twist of each curve: a_1, …, a_g, the commutators (in genus 2 without boundary the first alone, in genus 1 with one boundary
    /// loop none), and the products d_j of the first j of commutators and boundary loops, 2 ≤ j ≤ g + b − 2: 3g − 3 + b.
    pub curves: Vec<[f64; 2]>,
    /// The lengths of the boundary loops (b).
    pub boundaries: Vec<f64>,
}

/// One side of a curve: the pair of pants there, which of its cuffs it is, and whether the foot that twists are measured from is the start
/// (0) or the end (1) of the hexagon's side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct CurveSide {
    pub pants: usize,
    pub cuff: usize,
    pub foot: usize,
}

/// A curve along which two cuffs are glued, or a boundary loop.
#[derive(Debug, Clone)]
pub(super) struct GluedCurve {
    pub length: f64,
    pub twist: f64,
    pub left: CurveSide,
    /// `None` on the boundary.
    pub right: Option<CurveSide>,
}

/// All pairs of pants and curves.
pub(super) struct Decomposition {
    pub hexagons: Vec<Hexagon>,
    pub curves: Vec<GluedCurve>,
    /// The pants from which the others are placed: in the middle of the row.
    pub root: usize,
}

impl FenchelNielsen {
    /// Checks the numbers.
    pub(super) fn check(&self) -> Result<()> {
        let (g, b) = (self.genus, self.boundaries.len());
        let need = "with a hyperbolic metric: genus 2, or boundary loops";
        if 2 * g + b < 3 {
            return Err(Error::argument("surface", format!("genus {g} with {b} boundary loops"), need));
        }
        check_count("genus", g + b, 1, 24.0 * (g as f64 + b as f64))?;
        crate::error::check_size("lengths and twists", self.curves.len(), 3 * g + b - 3)?;
        let lengths = self.curves.iter().map(|curve| curve[0]).chain(self.boundaries.iter().copied());
        if let Some(l) = lengths.into_iter().find(|l| !LENGTHS.contains(l)) {
            return Err(Error::argument("length of a curve", l, "between 1e-3 and 30"));
        }
        if let Some([_, t]) = self.curves.iter().find(|[_, t]| t.is_nan() || t.abs() > TWIST) {
            let need = "between -30 and 30: adding the length of the curve changes the marking alone";
            return Err(Error::argument("twist", t, need));
        }
        Ok(())
    }

    /// Number n of commutators and boundary loops.
    fn n_ends(&self) -> usize {
        self.genus + self.boundaries.len()
    }

    /// The curve of e_i, and that of d_j, as numbers in [`Decomposition::curves`]; i and j count from 1. Boundary loops come last, as does
    /// the commutator of genus 1 with one of them.
    fn end(&self, i: usize) -> usize {
        let (g, n) = (self.genus, self.n_ends());
        match i.checked_sub(g + 1) {
            Some(k) => self.curves.len() + k,
            None if n == 2 => g,
            None => g + i - 1,
        }
    }

    fn product(&self, j: usize) -> usize {
        match (j, self.n_ends()) {
            (1, _) => self.end(1),
            (j, n) if j == n - 1 => self.end(n),
            (j, _) => 2 * self.genus + j - 2,
        }
    }

    /// The pairs of pants, handles first, and their curves.
    pub(super) fn decomposition(&self) -> Decomposition {
        let (g, n) = (self.genus, self.n_ends());
        let length = |c: usize| {
            self.curves.get(c).map_or_else(|| self.boundaries[c - self.curves.len()], |curve| curve[0])
        };
        let hexagon = |curves: [usize; 3]| Hexagon::new(curves.map(|c| 0.5 * length(c)));
        let handles = (0..g).map(|i| hexagon([i, self.end(i + 1), i]));
        let others =
            (1..n.max(2) - 1).map(|j| hexagon([self.product(j), self.product(j + 1), self.end(j + 1)]));
        let side = |pants: usize, cuff: usize, foot: usize| CurveSide { pants, cuff, foot };
        let mut curves = Vec::new();
        for (c, &[length, twist]) in self.curves.iter().enumerate() {
            let (left, right) = if c < g {
                (side(c, 0, 0), side(c, 2, 1))
            } else if n == 2 {
                (side(1, 1, 0), side(0, 1, 0))
            } else if c < 2 * g {
                let i = c - g + 1;
                (self.beyond(i), side(i - 1, 1, 0))
            } else {
                let j = c - 2 * g + 2;
                (side(g + j - 1, 0, 0), side(g + j - 2, 1, 1))
            };
            curves.push(GluedCurve { length, twist, left, right: Some(right) });
        }
        for (k, &length) in self.boundaries.iter().enumerate() {
            let left = if n == 2 { side(0, 1, 0) } else { self.beyond(g + k + 1) };
            curves.push(GluedCurve { length, twist: 0.0, left, right: None });
        }
        let hexagons: Vec<Hexagon> = handles.chain(others).collect();
        let root = g.min(hexagons.len() - 1) + hexagons.len().saturating_sub(g) / 2;
        Decomposition { hexagons, curves, root }
    }

    /// The side of e_i in the pants of products.
    fn beyond(&self, i: usize) -> CurveSide {
        let (g, n) = (self.genus, self.n_ends());
        match i {
            1 => CurveSide { pants: g, cuff: 0, foot: 0 },
            i if i == n => CurveSide { pants: g + n - 3, cuff: 1, foot: 0 },
            i => CurveSide { pants: g + i - 2, cuff: 2, foot: 1 },
        }
    }

    /// Per generator the pair of pants that it is formed in, and its isometry as seen from there.
    pub(super) fn local_generators(&self, all: &Decomposition) -> Vec<(usize, Motion<DoubleDouble>)> {
        let mut generators = Vec::new();
        for (i, curve) in all.curves.iter().enumerate().take(self.genus) {
            // b⁻¹ brings the pants to the right side of the axis of a.
            let b = all.across(curve).inverse();
            generators.extend([(i, all.hexagons[i].around(0)), (i, b)]);
        }
        // In genus 1 with one boundary loop that is the inverse of the commutator, as it has to be.
        let around = |curve: &GluedCurve| {
            let CurveSide { pants, cuff, .. } = curve.left;
            (pants, all.hexagons[pants].around(cuff))
        };
        generators.extend(all.curves[self.curves.len()..].iter().map(around));
        generators
    }
}

impl Decomposition {
    fn foot(&self, side: CurveSide) -> &Motion<DoubleDouble> {
        &self.hexagons[side.pants].feet[side.cuff][side.foot]
    }

    /// The frame of the pants on the right of a curve, as seen from the pants on its left.
    fn across(&self, curve: &GluedCurve) -> Motion<DoubleDouble> {
        let Some(right) = curve.right else { return Motion::identity(Space::H2) };
        let back = along(-curve.twist).compose(&half_turn());
        self.foot(curve.left).compose(&back).compose(&self.foot(right).inverse()).normalised()
    }

    /// A lift of each pair of pants, such that two that meet along a curve of a commutator or product are neighbours.
    pub fn placed(&self) -> Vec<PlacedPants> {
        let mut placed: Vec<Option<PlacedPants>> = (0..self.hexagons.len()).map(|_| None).collect();
        placed[self.root] = Some(PlacedPants { frame: Motion::identity(Space::H2), from: None });
        // Every round places the pants beside those that are placed.
        for _ in 0..self.hexagons.len() {
            for curve in &self.curves {
                let Some(right) = curve.right.map(|right| right.pants) else { continue };
                let (left, step) = (curve.left.pants, self.across(curve));
                let (from, to, step) = match (&placed[left], &placed[right]) {
                    (Some(_), None) => (left, right, step),
                    (None, Some(_)) => (right, left, step.inverse()),
                    _ => continue,
                };
                let frame = placed[from].as_ref().map(|p| p.frame.compose(&step).normalised());
                placed[to] = frame.map(|frame| PlacedPants { frame, from: Some((from, step)) });
            }
        }
        placed.into_iter().flatten().collect()
    }
}

/// A lift of a pair of pants.
pub(super) struct PlacedPants {
    pub frame: Motion<DoubleDouble>,
    /// The neighbour from which it was placed, and its frame as seen from there; none of the root, whose frame is 1.
    pub from: Option<(usize, Motion<DoubleDouble>)>,
}
