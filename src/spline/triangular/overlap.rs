//! The search for patches of one chart that reach into each other.

use super::patch::{IDENTITY, Patch, Support};
use crate::geometry::complex::doubled_area;

/// For each patch all those, ascending and itself included, whose knots have a convex hull that touches its triangle.
pub(super) fn supports_in_plane(patches: &[Patch]) -> Vec<Vec<Support>> {
    let boxes: Vec<[[f64; 2]; 2]> =
        patches.iter().map(|patch| bounds(patch.knots.iter().flatten())).collect();
    let mut order: Vec<usize> = (0..patches.len()).collect();
    order.sort_by(|&a, &b| boxes[a][0][0].total_cmp(&boxes[b][0][0]));
    let mut supports = vec![Vec::new(); patches.len()];
    for (at, &a) in order.iter().enumerate() {
        let begins_later = order[at..].iter().take_while(|&&b| boxes[b][0][0] <= boxes[a][1][0]);
        for &b in begins_later {
            if boxes[a][0][1] > boxes[b][1][1] || boxes[b][0][1] > boxes[a][1][1] {
                continue;
            }
            for (of, other) in [(a, b), (b, a)] {
                if touches(&patches[other], &patches[of]) {
                    supports[of].push(other as u32);
                }
            }
        }
    }
    let support = |patch: u32| Support { patch, to: IDENTITY };
    supports
        .into_iter()
        .map(|mut of: Vec<u32>| {
            of.sort_unstable();
            of.dedup();
            of.into_iter().map(support).collect()
        })
        .collect()
}

/// The least and the largest coordinates of points.
pub(super) fn bounds<'a>(points: impl Iterator<Item = &'a [f64; 2]>) -> [[f64; 2]; 2] {
    points.fold([[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]], |[low, high], p| {
        [[low[0].min(p[0]), low[1].min(p[1])], [high[0].max(p[0]), high[1].max(p[1])]]
    })
}

/// True if the convex hull of the knots of one patch touches the triangle of another.
fn touches(reaching: &Patch, of: &Patch) -> bool {
    overlaps(&reaching.knots.concat(), [0, 1, 2].map(|k| of.knots[k][0]), 0.0)
}

/// True if the convex hull of some points overlaps a triangle, that is, no side of either separates them. A side separates if all points
/// have doubled areas with it below `slack`; with 0, hulls that touch overlap.
pub(crate) fn overlaps(knots: &[[f64; 2]], corners: [[f64; 2]; 3], slack: f64) -> bool {
    let is_beyond = |a: [f64; 2], b: [f64; 2], points: &[[f64; 2]]| {
        points.iter().all(|&p| doubled_area([p, a, b]) < slack)
    };
    let by_triangle = (0..3).any(|k| is_beyond(corners[k], corners[(k + 1) % 3], knots));
    let by_hull = || {
        let pairs = knots.iter().flat_map(|&a| knots.iter().map(move |&b| [a, b]));
        let is_side =
            |[a, b]: &[[f64; 2]; 2]| a != b && knots.iter().all(|&p| doubled_area([p, *a, *b]) >= 0.0);
        pairs.filter(is_side).any(|[a, b]| is_beyond(a, b, &corners))
    };
    !by_triangle && !by_hull()
}
