//! Lines of a seamless layout that are parallel to an axis exactly: which coordinates are to be the same, and the least whole changes of the
//! cut's sides with which they can be.
//!
//! Corners along a line have one coordinate in common. Where such a class has corners on the boundary of the opened surface, the sides between
//! them have to add up to 0 along one axis. With the closing of the whole boundary these are linear equations for the sides, solved by
//! elimination with powers of two as pivots, so that all numbers stay dyadic.

use super::layout::Layout;
use crate::mesh::HalfedgeId;
use crate::mesh::union_find::UnionFind;
use std::collections::BTreeMap;

/// A Gaussian integer: a vector in units of the grid.
pub(super) type GridVector = [i64; 2];

/// A side of the opened surface's boundary: that many quarter turns of the vector of an edge, in units of the grid.
#[derive(Clone, Copy)]
pub(super) struct OpenedSide {
    /// The number of the edge's vector.
    pub vector: usize,
    /// Quarter turns from that vector to the side.
    pub turns: i32,
}

/// The axes along which the vector of an edge may change: along x, along y.
pub(super) type FreeAxes = [bool; 2];

/// Coordinates that are to be the same, by the lines that connect their corners: coordinate `axis` of corner k has the number 2k + axis.
pub(super) struct CoordinateClasses(UnionFind);

impl CoordinateClasses {
    /// Those of lines inside the opened surface; lines on its boundary are sides.
    pub fn new(layout: &Layout, straight: &[HalfedgeId]) -> CoordinateClasses {
        let mut classes = UnionFind::new(2 * layout.coordinates.len());
        for &h in
            straight.iter().filter(|&&h| layout.side[h] == 0 && !layout.mesh().is_boundary_edge(h.edge()))
        {
            let ends = [h, layout.mesh().next(h)].map(|h| layout.corner_index[h]);
            let [a, b] = ends.map(|k| layout.coordinates[k as usize]);
            let across = across(a, b) as u32;
            classes.join(2 * ends[0] + across, 2 * ends[1] + across);
        }
        CoordinateClasses(classes)
    }

    /// Gives coordinates of the same class the same value: that of one on the boundary, whose corners are listed, if there is one.
    pub fn make_equal(&mut self, corners: &mut [GridVector], boundary: &[u32]) {
        let mut value: BTreeMap<u32, i64> = BTreeMap::new();
        for axis in 0..2 {
            for &k in boundary {
                value.entry(self.of(k, axis)).or_insert(corners[k as usize][axis]);
            }
        }
        for (k, corner) in corners.iter_mut().enumerate() {
            for axis in 0..2 {
                corner[axis] = *value.entry(self.of(k as u32, axis)).or_insert(corner[axis]);
            }
        }
    }

    /// The class of a coordinate.
    pub fn of(&mut self, corner: u32, axis: usize) -> u32 {
        self.0.root(2 * corner + axis as u32)
    }
}

/// iᵏ z.
pub(super) fn turned([x, y]: GridVector, k: i32) -> GridVector {
    match k.rem_euclid(4) {
        0 => [x, y],
        1 => [-y, x],
        2 => [-x, -y],
        _ => [y, -x],
    }
}

/// The axis across a line.
pub(super) fn across(a: [f64; 2], b: [f64; 2]) -> usize {
    usize::from((b[0] - a[0]).abs() >= (b[1] - a[1]).abs())
}

/// Changes vectors of edges such that the boundary closes and coordinates of the same class agree; false if that has no solution in whole
/// numbers, and nothing is changed. `corners`: the corner at which each side begins.
pub(super) fn straighten(
    vectors: &mut [GridVector],
    free: &[FreeAxes],
    sides: &[OpenedSide],
    corners: &[u32],
    classes: &mut CoordinateClasses,
) -> bool {
    let mut equations = Elimination::new(vectors, free);
    for axis in 0..2 {
        if !equations.add(sides, axis) {
            return false;
        }
        let mut last: BTreeMap<u32, usize> = BTreeMap::new();
        for (k, &corner) in corners.iter().enumerate() {
            if let Some(before) = last.insert(classes.of(corner, axis), k)
                && !equations.add(&sides[before..k], axis)
            {
                return false;
            }
        }
    }
    let Some(changes) = equations.solution() else { return false };
    for (vector, change) in vectors.iter_mut().zip(changes) {
        *vector = [vector[0] + change[0], vector[1] + change[1]];
    }
    true
}

/// Equations for changes of the vectors, in echelon form.
struct Elimination<'a> {
    vectors: &'a [GridVector],
    free: &'a [FreeAxes],
    /// Rows with coefficient 1 at their pivot, and their right sides.
    rows: Vec<(usize, BTreeMap<usize, f64>, f64)>,
}

impl<'a> Elimination<'a> {
    fn new(vectors: &'a [GridVector], free: &'a [FreeAxes]) -> Elimination<'a> {
        Elimination { vectors, free, rows: Vec::new() }
    }

    /// Asks that these sides add up to 0 along an axis; false if that contradicts what was asked before.
    fn add(&mut self, sides: &[OpenedSide], axis: usize) -> bool {
        let (mut row, mut right) = (BTreeMap::new(), 0.0);
        for side in sides {
            for from in 0..2 {
                let mut unit = [0, 0];
                unit[from] = 1;
                let factor = turned(unit, side.turns)[axis] as f64;
                right -= factor * self.vectors[side.vector][from] as f64;
                if factor != 0.0 && self.free[side.vector][from] {
                    *row.entry(2 * side.vector + from).or_insert(0.0) += factor;
                }
            }
        }
        row.retain(|_, x| *x != 0.0);
        for (pivot, known, known_right) in &self.rows {
            let Some(&factor) = row.get(pivot) else { continue };
            for (&column, x) in known {
                *row.entry(column).or_insert(0.0) -= factor * x;
            }
            right -= factor * known_right;
            row.retain(|_, x| *x != 0.0);
        }
        let Some(pivot) = self.pivot(&row) else { return row.is_empty() && right == 0.0 };
        let divisor = row[&pivot];
        row.values_mut().for_each(|x| *x /= divisor);
        self.rows.push((pivot, row, right / divisor));
        true
    }

    /// The column of a row by whose coefficient, a power of two, the row is divided: the one nearest to 1, of the longest edge.
    fn pivot(&self, row: &BTreeMap<usize, f64>) -> Option<usize> {
        let size = |column: usize| {
            let [x, y] = self.vectors[column / 2].map(|x| x as f64);
            x * x + y * y
        };
        let power = |x: f64| x.abs().log2();
        let candidates = row.iter().filter(|(_, x)| power(**x).fract() == 0.0);
        let order = |(i, x): &(&usize, &f64), (j, y): &(&usize, &f64)| {
            let [p, q] = [power(**x).abs(), power(**y).abs()];
            q.total_cmp(&p).then(size(**i).total_cmp(&size(**j)))
        };
        candidates.max_by(order).map(|(column, _)| *column)
    }

    /// The changes of the vectors, those without a pivot 0; none if they are not whole.
    fn solution(&self) -> Option<Vec<GridVector>> {
        let mut change = vec![0.0; 2 * self.vectors.len()];
        for (pivot, row, right) in self.rows.iter().rev() {
            let others: f64 = row.iter().filter(|(c, _)| *c != pivot).map(|(c, x)| x * change[*c]).sum();
            change[*pivot] = right - others;
        }
        let is_whole = |x: &f64| x.fract() == 0.0 && x.abs() < 2f64.powi(40);
        let whole = |x: &[f64]| [x[0] as i64, x[1] as i64];
        change.iter().all(is_whole).then(|| change.chunks_exact(2).map(whole).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rectangle_with_a_line_across_closes() {
        // Six sides: the line connects the middles of the lower and the upper edge, which are 64 off each other.
        let sides: Vec<_> = (0..6).map(|vector| OpenedSide { vector, turns: 0 }).collect();
        let mut vectors = vec![[1024, 0], [1088, 0], [0, 512], [-1024, 0], [-1024, 0], [0, -576]];
        let free =
            vec![[true, false], [true, false], [false, true], [true, false], [true, false], [false, true]];
        let mut classes = CoordinateClasses(UnionFind::new(12));
        classes.0.join(2, 8);
        let corners: Vec<u32> = (0..6).collect();
        assert!(straighten(&mut vectors, &free, &sides, &corners, &mut classes));
        let sum =
            |range: std::ops::Range<usize>, axis: usize| vectors[range].iter().map(|w| w[axis]).sum::<i64>();
        assert_eq!([sum(0..6, 0), sum(0..6, 1), sum(1..4, 0)], [0; 3]);
    }
}
