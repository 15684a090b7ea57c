//! The points at which triangles of a spline are divided into quadrilaterals.
//!
//! Sides are divided at their middle, and triangles at their centroid, except around singular vertices. There the surface is smooth in w =
//! z^{1/m}, in which the middle of a side lies far out (at 0.5^{1/m} of the |w| of its end), and a triangle with a wide angle at the vertex
//! has its opposite side bent towards it, so that the quadrilateral at the vertex may not be sound: its Coons patch in w turns over, or
//! leaves the triangle. If one is not sound, all sides at that vertex are divided at another place, at one share of |w| for all; [`SHARES`]
//! are tried in order.

use super::patch_quad::{PatchDivision, PatchQuad, root};
use crate::geometry::complex::{Complex, add, conj, mul, norm, scale, sub, unit};
use crate::spline::triangular::Spline;
use std::collections::HashMap;

/// Shares of |w| at which the sides at a singular vertex are divided if the middles do not give sound quadrilaterals; the first is taken
/// for which all are sound.
const SHARES: [f64; 5] = [0.8, 0.7, 0.6, 0.5, 0.4];
/// The centre, the common corner of the three quadrilaterals, lies on the median from the singular vertex. Its distance in w is this share
/// of the way from |midpoint of the quadrilateral's two side ends| to |middle of the opposite side|; for m = 1 and sides divided at 1/2 that
/// is the centroid.
const CENTRE_SHARE: f64 = 1.0 / 3.0;

/// The division of a patch without singular vertices.
const EVEN: PatchDivision = PatchDivision { middles: [0.5; 3], centre: [1.0 / 3.0; 3], turns: [1.0; 3] };

/// The division of each patch. A singular vertex around which no division gives sound quadrilaterals keeps the even one, and the caller
/// gets no sign of it: [`PatchQuad`] then places the points of an unsound quadrilateral without a Coons patch.
pub(super) fn divisions(spline: &Spline) -> Vec<PatchDivision> {
    let mut all = vec![EVEN; spline.space().patches().len()];
    let singular_vertices: Vec<(f64, Vec<(usize, usize)>)> = spline
        .holes()
        .iter()
        .filter(|hole| !hole.is_at_infinity() && hole.turns != 1.0)
        .map(|hole| (hole.turns, hole.corners(spline.space())))
        .collect();
    let mut singular_corners: HashMap<usize, usize> = HashMap::new();
    for (turns, corners) in &singular_vertices {
        for &(patch, k) in corners {
            all[patch].turns[k] = *turns;
            *singular_corners.entry(patch).or_insert(0) += 1;
        }
    }
    for (turns, corners) in singular_vertices {
        // A singular vertex that shares a triangle with another keeps the middles on all its sides.
        if corners.iter().any(|(patch, _)| singular_corners[patch] > 1) {
            continue;
        }
        let are_sound = |divided: &[PatchDivision]| {
            let each = corners.iter().zip(divided);
            each.into_iter().all(|(&at, division)| PatchQuad::new(spline, at, division).is_sound())
        };
        let evenly: Vec<PatchDivision> = corners.iter().map(|&(patch, _)| all[patch]).collect();
        let at_share = |share: f64| -> Option<Vec<PatchDivision>> {
            corners.iter().map(|&at| at_vertex(spline, at, share, turns)).collect()
        };
        let tried = std::iter::once(evenly).chain(SHARES.into_iter().filter_map(at_share));
        if let Some(divided) = tried.into_iter().find(|divided| are_sound(divided)) {
            corners.iter().zip(divided).for_each(|((patch, _), division)| all[*patch] = division);
        }
    }
    all
}

/// The division of a patch with a singular vertex at corner k. None if the middle of the opposite side is nearer to the vertex in w than the
/// midpoint of the two side ends.
fn at_vertex(spline: &Spline, (patch, k): (usize, usize), share: f64, turns: f64) -> Option<PatchDivision> {
    let knots = &spline.space().patches()[patch].knots;
    let [a, b, c] = [0, 1, 2].map(|j| knots[(k + j) % 3][0]);
    let (to_next, to_previous) = (sub(b, a), sub(c, a));
    let along = share.powf(turns);
    let root = |z: Complex| root(z, turns);
    // Sides are turned so that the first one is on the positive real axis, and the second one less than half a turn further.
    let turned = |z: Complex| mul(z, conj(unit(to_next)));
    let ends = [turned(to_next), turned(to_previous)];
    let midpoint_distance = norm(scale(0.5 * share, add(root(ends[0]), root(ends[1]))));
    let opposite_distance = norm(root(scale(0.5, add(ends[0], ends[1]))));
    if midpoint_distance >= opposite_distance {
        return None;
    }
    let centre_share = ((midpoint_distance + CENTRE_SHARE * (opposite_distance - midpoint_distance))
        / opposite_distance)
        .powf(turns);
    let mut division = EVEN;
    division.turns[k] = turns;
    division.middles[k] = along;
    division.middles[(k + 2) % 3] = 1.0 - along;
    division.centre = [0.5 * centre_share; 3];
    division.centre[k] = 1.0 - centre_share;
    Some(division)
}
