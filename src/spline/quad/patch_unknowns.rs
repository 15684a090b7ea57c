//! The free control points that a patch depends on, and the entries of the equations of a fit that belong to it.

use super::patch_sum::{Block, ENTRY, PatchOverlaps, PatchSum};
use super::space::QuadSplineSpace;
use crate::geometry::vector::Vector;
use crate::linalg::Pattern;

/// The free control points of a patch with the pairs of them that its equations couple.
pub(super) struct PatchUnknowns {
    /// Their numbers, ascending.
    free: Vec<u32>,
    /// Per control point of the patch the free ones that it is a combination of, by their place in `free`, with the weights.
    rows: Vec<Vec<(u32, f64)>>,
    pub overlaps: PatchOverlaps,
    /// Per place in `free` the range of its pairs.
    start: Vec<usize>,
    /// Per pair the place of the second in `free`, which is not behind the first; ascending for each first one.
    second: Vec<u32>,
}

/// The equations of one patch on its free control points: per pair a block, and the right side.
pub(super) struct PatchEquations {
    matrix: Vec<Block>,
    right: Vec<Vector>,
}

impl PatchUnknowns {
    pub fn new(space: &QuadSplineSpace, patch: usize) -> PatchUnknowns {
        let combinations = || space.control(patch).iter().map(|&c| space.combination(c as usize));
        let mut free: Vec<u32> = combinations().flatten().map(|&(k, _)| k).collect();
        free.sort_unstable();
        free.dedup();
        let place = |k: u32| free.partition_point(|&x| x < k) as u32;
        let local = |row: &[(u32, f64)]| row.iter().map(|&(k, w)| (place(k), w)).collect();
        let rows: Vec<Vec<(u32, f64)>> = combinations().map(local).collect();
        let overlaps = PatchOverlaps { sides: space.sides(patch) };
        let mut coupled = vec![Vec::new(); free.len()];
        for i in 0..overlaps.len() {
            for j in overlaps.up_to(i) {
                for &(a, _) in &rows[i] {
                    rows[j].iter().for_each(|&(b, _)| coupled[a.max(b) as usize].push(a.min(b)));
                }
            }
        }
        let (mut start, mut second) = (vec![0], Vec::new());
        for mut of_one in coupled {
            of_one.sort_unstable();
            of_one.dedup();
            second.extend(of_one);
            start.push(second.len());
        }
        PatchUnknowns { free, rows, overlaps, start, second }
    }

    /// The pairs of free control points, by number, the first not below the second.
    pub fn pairs(&self) -> impl Iterator<Item = (u32, u32)> + '_ {
        (0..self.free.len()).flat_map(move |a| {
            self.second[self.start[a]..self.start[a + 1]]
                .iter()
                .map(move |&b| (self.free[a], self.free[b as usize]))
        })
    }

    /// The place of a pair.
    fn place(&self, a: u32, b: u32) -> usize {
        let range = self.start[a as usize]..self.start[a as usize + 1];
        range.start + self.second[range].partition_point(|&x| x < b)
    }

    /// The equations on control points as equations on the free ones.
    pub fn extracted(&self, sum: &PatchSum) -> PatchEquations {
        let mut found = PatchEquations {
            matrix: vec![[0.0; 6]; self.second.len()],
            right: vec![[0.0; 3]; self.free.len()],
        };
        for i in 0..self.overlaps.len() {
            for &(a, w) in &self.rows[i] {
                let right = &mut found.right[a as usize];
                *right = [0, 1, 2].map(|x| right[x] + w * sum.right[i][x]);
            }
            for j in self.overlaps.up_to(i) {
                let entry = &sum.matrix[self.overlaps.place(i, j)];
                let mut add = |a: u32, b: u32, weight: f64| {
                    let block = &mut found.matrix[self.place(a, b)];
                    block.iter_mut().zip(entry).for_each(|(x, y)| *x += weight * y);
                };
                for &(a, w) in &self.rows[i] {
                    for &(b, v) in &self.rows[j] {
                        // The pair (j, i) has the same entry: of both products one is on or below the diagonal, or both are on it.
                        if a >= b {
                            add(a, b, w * v);
                        }
                        if b >= a && i != j {
                            add(b, a, w * v);
                        }
                    }
                }
            }
        }
        found
    }

    /// Adds equations to those of all unknowns, 3 to a control point; `blocks` is the pattern of pairs of control points, `pattern` that of unknowns.
    pub fn add(
        &self,
        equations: &PatchEquations,
        [blocks, pattern]: [&Pattern; 2],
        values: &mut [f64],
        right: &mut [f64],
    ) {
        for (&k, v) in self.free.iter().zip(&equations.right) {
            (0..3).for_each(|c| right[3 * k as usize + c] += v[c]);
        }
        for ((i, j), block) in self.pairs().zip(&equations.matrix) {
            let (i, j) = (i as usize, j as usize);
            let Some(place) = blocks.position(i, j) else { continue };
            // Blocks below the diagonal follow the one on it, of which a column has the entries from the diagonal on.
            let before = 3 * (place - blocks.diagonal(j));
            for d in 0..3 {
                let (first, skipped) = if i == j { (d, 0) } else { (0, before - d) };
                let at = pattern.diagonal(3 * j + d) + skipped;
                let column = &mut values[at..at + 3 - first];
                column.iter_mut().zip(first..).for_each(|(x, c)| *x += block[ENTRY[c][d]]);
            }
        }
    }
}
