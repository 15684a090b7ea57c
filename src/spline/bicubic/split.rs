//! The points at which triangles of a spline are divided into quadrilaterals.
//!
//! Sides are divided at their middle, and triangles at their centroid, except around singular vertices. There the surface is smooth in w =
//! z^{1/m}, in which the middle of a side lies far out, and a triangle with a wide angle at the vertex has its opposite side bent towards
//! it, so that the quadrilateral at the vertex may not be convex in w. If one is not, all sides at that vertex are divided nearer to it, at
//! the same share of |w|.

use super::patch_quad::{PatchDivision, PatchQuad, root};
use crate::geometry::complex::{Complex, add, conj, mul, norm, scale, sub, unit};
use crate::spline::triangular::Spline;
use std::collections::HashMap;

/// Shares of |w| at which the sides at a singular vertex are divided if the middles do not give sound quadrilaterals; the first is taken
/// for which all are sound.
const SHARES: [f64; 5] = [0.8, 0.7, 0.6, 0.5, 0.4];
/// Position of the last corner of a quadrilateral on the line in w from the middle between the ends of its two sides, 0, to the opposite
/// side, 1: it is the centroid if m = 1.
const ONWARD: f64 = 1.0 / 3.0;

/// The division of a patch without singular vertices.
const EVEN: PatchDivision = PatchDivision { middles: [0.5; 3], centre: [1.0 / 3.0; 3], turns: [1; 3] };

/// The division of each patch.
pub(super) fn divisions(spline: &Spline) -> Vec<PatchDivision> {
    let mut all = vec![EVEN; spline.space().patches().len()];
    let holes: Vec<(i32, Vec<(usize, usize)>)> = spline
        .holes()
        .iter()
        .filter(|hole| !hole.is_at_infinity() && hole.turns > 1)
        .map(|hole| (hole.turns, hole.corners(spline.space())))
        .collect();
    let mut singular: HashMap<usize, usize> = HashMap::new();
    for (turns, corners) in &holes {
        for &(patch, k) in corners {
            all[patch].turns[k] = *turns;
            *singular.entry(patch).or_insert(0) += 1;
        }
    }
    for (turns, corners) in holes {
        // A side between two singular vertices keeps its middle.
        if corners.iter().any(|(patch, _)| singular[patch] > 1) {
            continue;
        }
        let is_sound = |divided: &[PatchDivision]| {
            let each = corners.iter().zip(divided);
            each.into_iter().all(|(&at, division)| PatchQuad::new(spline, at, division).is_coons())
        };
        let evenly: Vec<PatchDivision> = corners.iter().map(|&(patch, _)| all[patch]).collect();
        let nearer = |share: f64| -> Option<Vec<PatchDivision>> {
            corners.iter().map(|&at| at_vertex(spline, at, share, turns)).collect()
        };
        let tried = std::iter::once(evenly).chain(SHARES.into_iter().filter_map(nearer));
        if let Some(divided) = tried.into_iter().find(|divided| is_sound(divided)) {
            corners.iter().zip(divided).for_each(|((patch, _), division)| all[*patch] = division);
        }
    }
    all
}

/// The division of a patch with a singular vertex at corner k; none if the opposite side comes nearer to the vertex in w than the middle
/// between the ends of the quadrilateral's sides.
fn at_vertex(spline: &Spline, (patch, k): (usize, usize), share: f64, turns: i32) -> Option<PatchDivision> {
    let knots = &spline.space().patches()[patch].knots;
    let [a, b, c] = [0, 1, 2].map(|j| knots[(k + j) % 3][0]);
    let (next, last) = (sub(b, a), sub(c, a));
    let along = share.powi(turns);
    let root = |z: Complex| root(z, turns);
    // Sides are turned so that the first one is on the positive real axis, and the second one less than half a turn further.
    let turned = |z: Complex| mul(z, conj(unit(next)));
    let ends = [turned(next), turned(last)];
    let between = norm(scale(0.5 * share, add(root(ends[0]), root(ends[1]))));
    let whole = norm(root(scale(0.5, add(ends[0], ends[1]))));
    if between >= whole {
        return None;
    }
    let far = ((between + ONWARD * (whole - between)) / whole).powi(turns);
    let mut division = EVEN;
    division.turns[k] = turns;
    division.middles[k] = along;
    division.middles[(k + 2) % 3] = 1.0 - along;
    division.centre = [0.5 * far; 3];
    division.centre[k] = 1.0 - far;
    Some(division)
}
