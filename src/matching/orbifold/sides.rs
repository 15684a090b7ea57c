//! The arcs of the boundary as straight sides of the domain, and the vertices on them.

use super::tree::MarkTree;
use crate::geometry::{DoubleDouble, Motion};
use crate::matching::cover::{PlacedMesh, aimed, logarithm, moved, seen_from};
use crate::matching::landmarks::MarkedSurface;
use crate::mesh::HalfedgeId;

/// The straight line of an arc of the boundary.
pub(super) struct ArcLine {
    /// The frame at its start, with the x axis along it.
    start: Motion<DoubleDouble>,
    length: f64,
}

/// The straight line of each arc.
pub(super) fn lines(placed: &PlacedMesh, tree: &MarkTree) -> Vec<ArcLine> {
    let space = placed.cover.space;
    let line = |arc: &Vec<HalfedgeId>| {
        let ends = arc
            .first()
            .zip(arc.last())
            .map(|(&h, &last)| [placed.corner(h), placed.corner(placed.cover.mesh.next(last))]);
        let (start, length) =
            aimed(space, ends.unwrap_or_else(|| [Motion::<DoubleDouble>::identity(space).origin(); 2]));
        ArcLine { start, length }
    };
    tree.arcs.iter().map(line).collect()
}

/// Per arc the distances of its vertices from its start on the target's line, by their shares of the arc's length where the surface lies
/// in its own metric.
pub(super) fn own_shares(
    own: &PlacedMesh,
    tree: &MarkTree,
    lines: &[ArcLine],
    target: &[ArcLine],
) -> Vec<Vec<f64>> {
    let space = own.cover.space;
    let of = |((arc, line), to): ((&Vec<HalfedgeId>, &ArcLine), &ArcLine)| {
        let longer = to.length / line.length.max(f64::MIN_POSITIVE);
        let along = |h: &HalfedgeId| {
            let [x, _] = logarithm(space, seen_from(&line.start, &own.frame_at(*h)));
            longer * x
        };
        let mut all: Vec<f64> = arc.iter().map(along).collect();
        all.iter_mut().take(1).for_each(|x| *x = 0.0);
        all
    };
    tree.arcs.iter().zip(lines).zip(target).map(of).collect()
}

/// The same distances by shares of the length in the surface as it came: from corner to corner, and around a loop without corners from the
/// start of its first arc.
pub(super) fn length_shares(side: MarkedSurface, tree: &MarkTree, lines: &[ArcLine]) -> Vec<Vec<f64>> {
    let (mesh, lengths) = (side.surface.mesh(), side.surface.lengths());
    let start = |k: usize| tree.arcs[k].first().map(|&h| mesh.origin(h));
    let after = |k: usize| {
        let end = tree.arcs[k].last().map(|&h| mesh.tip(h));
        (0..tree.arcs.len()).find(|&j| start(j) == end)
    };
    let is_corner = |k: usize| start(k).is_some_and(|v| side.marks.corners.contains(&v));
    let mut shares: Vec<Vec<f64>> = vec![Vec::new(); tree.arcs.len()];
    let (corners, others): (Vec<usize>, Vec<usize>) = (0..tree.arcs.len()).partition(|&k| is_corner(k));
    for first in corners.into_iter().chain(others) {
        if !shares[first].is_empty() {
            continue;
        }
        let mut arcs = vec![first];
        while let Some(next) = arcs.last().and_then(|&k| after(k)).filter(|&k| k != first && !is_corner(k)) {
            arcs.push(next);
        }
        let total: f64 = arcs.iter().flat_map(|&k| &tree.arcs[k]).map(|h| lengths[h.edge()]).sum();
        let length: f64 = arcs.iter().map(|&k| lines[k].length).sum();
        let (mut before, mut start) = (0.0, 0.0);
        for k in arcs {
            for h in &tree.arcs[k] {
                shares[k].push(length * (before / total) - start);
                before += lengths[h.edge()];
            }
            start += lines[k].length;
        }
    }
    shares
}

/// Puts the vertices of each arc on its line at these distances from its start.
pub(super) fn slide(placed: &mut PlacedMesh, tree: &MarkTree, lines: &[ArcLine], along: &[Vec<f64>]) {
    for ((arc, line), along) in tree.arcs.iter().zip(lines).zip(along) {
        for (&h, &x) in arc.iter().zip(along) {
            let v = placed.cover.mesh.origin(h);
            placed.at[v] = moved(&line.start, [x, 0.0]);
        }
    }
}
