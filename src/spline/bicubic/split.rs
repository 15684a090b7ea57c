//! Where triangles of a spline are divided into quadrilaterals.
//!
//! Sides have their middle there, and triangles their centroid, but around singular vertices. There the surface is smooth in w = z^{1/m},
//! in which the middle of a side lies far out, and a triangle with a wide angle at the vertex has its opposite side bent towards it: the
//! quadrilateral at the vertex would not be convex in w. Where one is not, all sides at that vertex are divided nearer to it, at the same
//! share of |w|.

use super::patch_quad::{Division, PatchQuad, root};
use crate::geometry::complex::{Complex, add, conj, mul, norm, scale, sub, unit};
use crate::spline::hole::Hole;
use crate::spline::surface::Spline;
use std::collections::HashMap;

/// Shares of |w| at which sides at a singular vertex are divided where quadrilaterals from their middles are not sound, the first with
/// which all are.
const SHARES: [f64; 5] = [0.8, 0.7, 0.6, 0.5, 0.4];
/// How far on from the middle between the ends of its two sides to the opposite side a quadrilateral has its last corner: at the centroid,
/// where m = 1.
const ONWARD: f64 = 1.0 / 3.0;

/// Without singular vertices.
const EVEN: Division = Division { middles: [0.5; 3], centre: [1.0 / 3.0; 3], turns: [1; 3] };

/// Per patch its division.
pub(super) fn divisions(spline: &Spline) -> Vec<Division> {
    let mut all = vec![EVEN; spline.space().patches().len()];
    let holes: Vec<(i32, Vec<(usize, usize)>)> = spline
        .holes()
        .iter()
        .filter(|hole| !hole.is_at_infinity() && hole.turns > 1)
        .map(|hole| (hole.turns, corners(spline, hole)))
        .collect();
    let mut singular: HashMap<usize, usize> = HashMap::new();
    for (turns, corners) in &holes {
        for &(patch, k) in corners {
            all[patch].turns[k] = *turns;
            *singular.entry(patch).or_insert(0) += 1;
        }
    }
    for (turns, corners) in holes {
        // A side between two singular vertices has its middle at the middle.
        if corners.iter().any(|(patch, _)| singular[patch] > 1) {
            continue;
        }
        let is_sound = |divided: &[Division]| {
            let each = corners.iter().zip(divided);
            each.into_iter().all(|(&at, division)| PatchQuad::new(spline, at, division).is_coons())
        };
        let evenly: Vec<Division> = corners.iter().map(|&(patch, _)| all[patch]).collect();
        let nearer = |share: f64| -> Option<Vec<Division>> {
            corners.iter().map(|&at| at_vertex(spline, at, share, turns)).collect()
        };
        let tried = std::iter::once(evenly).chain(SHARES.into_iter().filter_map(nearer));
        if let Some(divided) = tried.into_iter().find(|divided| is_sound(divided)) {
            corners.iter().zip(divided).for_each(|((patch, _), division)| all[*patch] = division);
        }
    }
    all
}

/// The patches at the vertex of a hole, and which corner of each it is.
fn corners(spline: &Spline, hole: &Hole) -> Vec<(usize, usize)> {
    let mut found = Vec::new();
    for sector in &hole.sectors {
        let knots = &spline.space().patches()[sector.patch as usize].knots;
        let is_here = |k: &usize| sector.starts_at(knots[*k][0], knots[(k + 1) % 3][0]);
        found.extend((0..3).find(is_here).map(|k| (sector.patch as usize, k)));
    }
    found
}

/// The division of a patch with a singular vertex at corner k; none where its opposite side comes nearer to this than the ends of the
/// quadrilateral's sides.
fn at_vertex(spline: &Spline, (patch, k): (usize, usize), share: f64, turns: i32) -> Option<Division> {
    let knots = &spline.space().patches()[patch].knots;
    let [a, b, c] = [0, 1, 2].map(|j| knots[(k + j) % 3][0]);
    let (next, last) = (sub(b, a), sub(c, a));
    let along = share.powi(turns);
    let root = |z: Complex| root(z, turns);
    // Sides are turned so that the first one is real, the second one less than half a turn on.
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
