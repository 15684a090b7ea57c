//! The spin structure of a translation surface, by which some of them are known not to exist.

use super::dual_loops::DualLoops;
use crate::mesh::Mesh;

/// The Arf invariant of the quadratic form `q(γ) = turning/2π + 1 mod 2` of closed paths that turn by whole turns, given in quarter turns:
/// the value that q takes most often \[KZ03\]. Sums of classes have `q(x + y) = q(x) + q(y) + x·y`.
pub(super) fn arf_invariant(mesh: &Mesh, loops: &DualLoops, quarter_turns: &[i32]) -> bool {
    let n = loops.len();
    let meets: Vec<Vec<bool>> =
        (0..n).map(|i| (0..n).map(|j| meet_oddly(mesh, loops, i, j)).collect()).collect();
    let alone: Vec<bool> = quarter_turns.iter().map(|k| (k / 4 + 1).rem_euclid(2) == 1).collect();
    let form = |class: usize| {
        let has = |i: usize| class >> i & 1 == 1;
        let mut value = false;
        for i in (0..n).filter(|&i| has(i)) {
            value ^= alone[i];
            (0..i).filter(|&j| has(j)).for_each(|j| value ^= meets[i][j]);
        }
        value
    };
    let ones = (0..1usize << n).filter(|&class| form(class)).count();
    2 * ones > 1 << n
}

/// True if two closed paths from face to face cross an odd number of times, counted with the edges between the vertices that the first turns
/// around, which it can be moved to.
fn meet_oddly(mesh: &Mesh, loops: &DualLoops, i: usize, j: usize) -> bool {
    let turns: Vec<f64> = loops.passages(i).map(|passage| passage.pivot(mesh).1).collect();
    // Passage k leaves over the half-edge k of the path, into passage k + 1. Left turns go around its tip, right ones around its
    // origin: the path moves along the edge where one follows the other.
    let moves = |k: usize| turns[k] != turns[(k + 1) % turns.len()];
    let path = loops.path(i).iter().enumerate().filter(|(k, _)| moves(*k));
    let count: usize = path.map(|(_, h)| loops.path(j).iter().filter(|x| x.edge() == h.edge()).count()).sum();
    count % 2 == 1
}
