//! The equations of a fit on the control points of one patch, as they add up.

use super::quintic::{LOCAL, QuinticBasis};
use super::span_direction::SpanDirection;
use crate::geometry::vector::{Vector, add, scale};

/// Number of control points that a place depends on.
const AROUND: usize = LOCAL * LOCAL;
/// Functions that begin before another one, or with it, and overlap it along one direction at most; along the other also those that begin after it.
const BEFORE: usize = LOCAL;
const BESIDE: usize = 2 * LOCAL - 1;
/// The entries (i, j) of a symmetric 3 × 3 matrix.
const ENTRIES: [[usize; 2]; 6] = [[0, 0], [0, 1], [0, 2], [1, 1], [1, 2], [2, 2]];
/// The place of the entry (c, d) in [`ENTRIES`], and those on the diagonal.
pub(super) const ENTRY: [[usize; 3]; 3] = [[0, 1, 2], [1, 3, 4], [2, 4, 5]];
const DIAGONAL: [usize; 3] = [0, 3, 5];

/// A symmetric 3 × 3 matrix, as [`ENTRIES`].
pub(super) type Block = [f64; 6];

/// The matrix of the squared distance from the tangent plane at a foot and from the foot itself, with these weights, times another one.
pub(super) fn tensor(normal: Vector, [flat, whole]: [f64; 2], weight: f64) -> Block {
    ENTRIES.map(|[c, d]| weight * (flat * normal[c] * normal[d] + if c == d { whole } else { 0.0 }))
}

/// The product of a symmetric matrix and a vector.
fn product([xx, xy, xz, yy, yz, zz]: &Block, [x, y, z]: Vector) -> Vector {
    [xx * x + xy * y + xz * z, xy * x + yy * y + yz * z, xz * x + yz * y + zz * z]
}

/// The control points of a patch and which of their functions overlap.
#[derive(Debug, Clone, Copy)]
pub(super) struct PatchOverlaps {
    /// The numbers of control points along u and along v.
    pub sides: [usize; 2],
}

impl PatchOverlaps {
    /// Number of control points.
    pub fn len(self) -> usize {
        self.sides[0] * self.sides[1]
    }

    /// The control points up to a control point, by number, whose functions may overlap its own.
    pub fn up_to(self, i: usize) -> impl Iterator<Item = usize> {
        let [n_u, n_v] = self.sides;
        let [u, v] = [i / n_v, i % n_v];
        debug_assert!(u < n_u, "a control point of the patch");
        let columns = v.saturating_sub(LOCAL - 1)..(v + LOCAL).min(n_v);
        let rows = u.saturating_sub(LOCAL - 1)..=u;
        rows.flat_map(move |k| columns.clone().map(move |l| k * n_v + l)).filter(move |&j| j <= i)
    }

    /// The place of a pair of control points j ≤ i, whose functions may overlap, among those of all.
    pub fn place(self, i: usize, j: usize) -> usize {
        let n_v = self.sides[1];
        (i * BEFORE + i / n_v - j / n_v) * BESIDE + j % n_v + LOCAL - 1 - i % n_v
    }

    /// The number of these places.
    pub fn places(self) -> usize {
        self.len() * BEFORE * BESIDE
    }
}

/// The equations of a patch on its own control points.
pub(super) struct PatchSum {
    /// Per place of [`PatchOverlaps`] the block of that pair.
    pub matrix: Vec<Block>,
    pub right: Vec<Vector>,
    overlaps: PatchOverlaps,
    /// The lengths in parameters.
    lengths: [f64; 2],
}

impl PatchSum {
    pub fn new(overlaps: PatchOverlaps, lengths: [f64; 2]) -> PatchSum {
        let (matrix, right) = (vec![[0.0; 6]; overlaps.places()], vec![[0.0; 3]; overlaps.len()]);
        PatchSum { matrix, right, overlaps, lengths }
    }

    /// Adds the squared distance of a place from its foot.
    pub fn add(&mut self, basis: &[QuinticBasis; 2], tensor: &Block, point: Vector) {
        let pulled = product(tensor, point);
        let terms = terms(basis, self.overlaps.sides[1]);
        for (number, (i, value)) in terms.into_iter().enumerate() {
            self.right[i] = [0, 1, 2].map(|x| self.right[i][x] + value * pulled[x]);
            for &(j, other) in &terms[..=number] {
                let both = value * other;
                let block = &mut self.matrix[self.overlaps.place(i, j)];
                block.iter_mut().zip(tensor).for_each(|(x, t)| *x += both * t);
            }
        }
    }

    /// Adds ∫ d_u² + d_v² over the rectangle with a weight, d the way from a spline with these control points.
    pub fn keep_shape(&mut self, weight: f64, along: [&SpanDirection; 2], before: &[Vector]) {
        let [a, b] = self.lengths;
        let of_pair = products(along);
        for i in 0..self.overlaps.len() {
            for j in self.overlaps.up_to(i) {
                let both = weight * (b / a * of_pair([1, 0], i, j) + a / b * of_pair([0, 1], i, j));
                self.right[i] = add(self.right[i], scale(both, before[j]));
                if j != i {
                    self.right[j] = add(self.right[j], scale(both, before[i]));
                }
                self.add_diagonal(i, j, both);
            }
        }
    }

    /// Adds ∫ S_uu² + 2 S_uv² + S_vv² over the rectangle with a weight.
    pub fn bend(&mut self, weight: f64, along: [&SpanDirection; 2]) {
        let bent = bending(self.lengths, along);
        for i in 0..self.overlaps.len() {
            self.overlaps.up_to(i).for_each(|j| self.add_diagonal(i, j, weight * bent(i, j)));
        }
    }

    /// Adds a number to the diagonal of the block of a pair.
    fn add_diagonal(&mut self, i: usize, j: usize, x: f64) {
        let block = &mut self.matrix[self.overlaps.place(i, j)];
        DIAGONAL.into_iter().for_each(|k| block[k] += x);
    }
}

/// The control points that count where these basis functions do, by ascending numbers in the patch, with their weights.
fn terms([u, v]: &[QuinticBasis; 2], side: usize) -> [(usize, f64); AROUND] {
    std::array::from_fn(|t| {
        let (k, l) = (t / LOCAL, t % LOCAL);
        ((u.first + k) * side + v.first + l, u.derivatives[0][k] * v.derivatives[0][l])
    })
}

/// ∫ of the products of the derivatives of two control points' functions over the unit square, of these orders along u and v.
fn products([along_u, along_v]: [&SpanDirection; 2]) -> impl Fn([usize; 2], usize, usize) -> f64 {
    let [n_u, n_v] = [along_u, along_v].map(|along| along.products[0].len().isqrt());
    move |[order_u, order_v], i, j| {
        let [u, v] = [(i / n_v) * n_u + j / n_v, (i % n_v) * n_v + j % n_v];
        along_u.products[order_u][u] * along_v.products[order_v][v]
    }
}

/// ∫ of the products of the second derivatives of two control points' functions over a rectangle with these sides, as in
/// ∫ S_uu² + 2 S_uv² + S_vv².
pub(super) fn bending([a, b]: [f64; 2], along: [&SpanDirection; 2]) -> impl Fn(usize, usize) -> f64 {
    let [by_uu, by_uv, by_vv] = [b / a.powi(3), 2.0 / (a * b), a / b.powi(3)];
    let of_pair = products(along);
    move |i, j| by_uu * of_pair([2, 0], i, j) + by_uv * of_pair([1, 1], i, j) + by_vv * of_pair([0, 2], i, j)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pairs_whose_functions_overlap_have_places_of_their_own_and_others_none() {
        for spans in [[1, 1], [4, 3], [2, 5]] {
            let along = spans.map(SpanDirection::new);
            let overlaps = PatchOverlaps { sides: spans.map(super::super::quintic::basis_size) };
            let of_pair = products([&along[0], &along[1]]);
            let mut seen = vec![false; overlaps.places()];
            for i in 0..overlaps.len() {
                let near: Vec<usize> = overlaps.up_to(i).collect();
                for &j in &near {
                    assert!(!std::mem::replace(&mut seen[overlaps.place(i, j)], true), "{spans:?}: {i}, {j}");
                }
                let is_far = |j: &usize| !near.contains(j);
                assert!((0..=i).filter(is_far).all(|j| of_pair([0, 0], i, j) == 0.0), "{spans:?}: {i}");
                assert!(of_pair([0, 0], i, i) > 0.0 && near.contains(&i));
            }
        }
    }
}
