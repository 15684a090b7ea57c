//! The normal equations of a fit: squared distances of places of the patches from their feet, and the bending of the patches.

use super::layout::PatchCorner;
use super::quintic::{LOCAL, QUINTIC, QuinticBasis};
use super::space::QuadSplineSpace;
use super::target::FootPoint;
use crate::error::{Error, Result};
use crate::geometry::quadrature::gauss_legendre;
use crate::geometry::vector::Vector;
use crate::linalg::{Cholesky, Pattern, Symmetric};
use crate::parallel;

/// Places in every span and direction at which distances are taken. As many as the degree has coefficients would be interpolated, with large
/// errors between them.
pub(super) const PLACES: usize = 2 * QUINTIC;
/// Pairs of unknowns beyond which repeated ones are dropped on the way.
const MOST_PAIRS: usize = 1 << 24;
/// Number of control points that a place depends on.
const AROUND: usize = LOCAL * LOCAL;
/// The entries (i, j) of a symmetric 3 × 3 matrix.
const ENTRIES: [[usize; 2]; 6] = [[0, 0], [0, 1], [0, 2], [1, 1], [1, 2], [2, 2]];

/// The weights of the terms of a fit.
#[derive(Debug, Clone, Copy)]
pub(super) struct FitWeights {
    /// That of the squared distance from the tangent plane at the foot.
    pub normal: f64,
    /// That of the squared distance from the foot.
    pub tangential: f64,
    /// That of ∫ S_uu² + 2 S_uv² + S_vv² over the rectangles of the parameters.
    pub bending: f64,
}

/// A place in every patch, with the share of the patch that it stands for.
pub(super) struct FitPlace {
    pub basis: [QuinticBasis; 2],
    pub parameters: [f64; 2],
    weight: f64,
}

/// The normal equations of fits over a space. Unknown 3 k + c is coordinate c of the free control point k.
pub(super) struct QuadSystem<'a> {
    space: &'a QuadSplineSpace,
    pub places: Vec<FitPlace>,
    /// Per patch the free control points that it depends on, ascending, and its own control points as combinations of them.
    free: Vec<Vec<u32>>,
    pattern: Pattern,
    cholesky: Cholesky,
}

/// The equations of one patch on its free control points.
struct PatchEquations {
    /// Per entry of [`ENTRIES`] a matrix over pairs of free control points.
    matrix: Vec<[f64; 6]>,
    right: Vec<Vector>,
}

impl<'a> QuadSystem<'a> {
    pub fn new(space: &'a QuadSplineSpace) -> Result<QuadSystem<'a>> {
        let free: Vec<Vec<u32>> = (0..space.layout().patches().len()).map(|p| free_of(space, p)).collect();
        let mut pairs = Vec::new();
        for of_patch in &free {
            let unknowns: Vec<u32> = of_patch.iter().flat_map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
            for (n, &i) in unknowns.iter().enumerate() {
                pairs.extend(unknowns[..n].iter().map(|&j| (i, j)));
            }
            // Pairs of neighbouring patches repeat.
            if pairs.len() > MOST_PAIRS {
                pairs.sort_unstable();
                pairs.dedup();
            }
        }
        let pattern = Pattern::new(3 * space.dimension(), &pairs)?;
        let cholesky = Cholesky::analyse(&pattern)?;
        Ok(QuadSystem { space, places: places(space.spans()), free, pattern, cholesky })
    }

    /// The free control points at which the weighted sum of squares is least. `foot`: the foot of a place of a patch, by their numbers.
    ///
    /// # Errors
    /// [`Error::Factorisation`] where the places do not determine the spline.
    pub fn solve(
        &mut self,
        weights: FitWeights,
        foot: impl Fn(usize, usize) -> FootPoint + Sync,
    ) -> Result<Vec<Vector>> {
        let n = self.free.len();
        let found = parallel::map(n, |p| self.of_patch(p, weights, |place| foot(p, place)));
        let mut values = vec![0.0; self.pattern.entries()];
        let mut right = vec![0.0; 3 * self.space.dimension()];
        for (free, equations) in self.free.iter().zip(&found) {
            self.add(free, equations, &mut values);
            for (&k, v) in free.iter().zip(&equations.right) {
                (0..3).for_each(|c| right[3 * k as usize + c] += v[c]);
            }
        }
        self.cholesky.factor(Symmetric { pattern: &self.pattern, values: &values }).map_err(|_| {
            let message = "the equations of the fit are not positive definite: ask for more bending";
            Error::Factorisation { size: self.pattern.size(), message: message.into() }
        })?;
        self.cholesky.solve(&mut right);
        Ok(right.as_chunks::<3>().0.to_vec())
    }

    fn add(&self, free: &[u32], equations: &PatchEquations, values: &mut [f64]) {
        let n = free.len();
        for (a, &i) in free.iter().enumerate() {
            for (b, &j) in free.iter().enumerate().take(a + 1) {
                let block = &equations.matrix[a * n + b];
                for (&[c, d], &x) in ENTRIES.iter().zip(block) {
                    add_to(&self.pattern, values, [3 * i as usize + c, 3 * j as usize + d], x);
                    // The lower triangle of the whole has both halves of a block, but on the diagonal.
                    if c != d && a != b {
                        add_to(&self.pattern, values, [3 * i as usize + d, 3 * j as usize + c], x);
                    }
                }
            }
        }
    }

    /// The equations of a patch on the free control points.
    fn of_patch(&self, p: usize, weights: FitWeights, foot: impl Fn(usize) -> FootPoint) -> PatchEquations {
        let side = self.space.side();
        let m = side * side;
        let (mut matrix, mut right) = (vec![[0.0; 6]; m * m], vec![[0.0; 3]; m]);
        let [a, b] = [0, 1].map(|corner| self.space.layout().length(PatchCorner { patch: p, corner }));
        let [by_uu, by_uv, by_vv] = [b / a.powi(3), 2.0 / (a * b), a / b.powi(3)];
        for (number, place) in self.places.iter().enumerate() {
            let FootPoint { point, normal } = foot(number);
            let tensor = ENTRIES.map(|[c, d]| {
                let whole = if c == d { weights.tangential } else { 0.0 };
                a * b * place.weight * (weights.normal * normal[c] * normal[d] + whole)
            });
            let pulled = product(&tensor, point);
            let terms = place.terms(side);
            let bending = weights.bending * place.weight;
            for (i, [value, uu, uv, vv]) in terms {
                right[i] = [0, 1, 2].map(|x| right[i][x] + value * pulled[x]);
                for (j, other) in terms.iter().take_while(|(j, _)| *j <= i) {
                    let bent =
                        bending * (by_uu * uu * other[1] + by_uv * uv * other[2] + by_vv * vv * other[3]);
                    let entry = &mut matrix[i * m + j];
                    for (k, x) in entry.iter_mut().enumerate() {
                        let [c, d] = ENTRIES[k];
                        *x += value * other[0] * tensor[k] + if c == d { bent } else { 0.0 };
                    }
                }
            }
        }
        self.extracted(p, &matrix, &right)
    }

    /// The equations on control points as equations on the free ones.
    fn extracted(&self, p: usize, matrix: &[[f64; 6]], right: &[Vector]) -> PatchEquations {
        let (free, control) = (&self.free[p], self.space.control(p));
        let (n, m) = (free.len(), control.len());
        let place = |k: u32| free.partition_point(|&x| x < k);
        let rows: Vec<Vec<(usize, f64)>> = control
            .iter()
            .map(|&c| self.space.combination(c as usize).iter().map(|&(k, w)| (place(k), w)).collect())
            .collect();
        let mut found = PatchEquations { matrix: vec![[0.0; 6]; n * n], right: vec![[0.0; 3]; n] };
        for i in 0..m {
            for &(a, w) in &rows[i] {
                found.right[a] = [0, 1, 2].map(|x| found.right[a][x] + w * right[i][x]);
            }
            for j in 0..m {
                let entry = matrix[i.max(j) * m + i.min(j)];
                if entry == [0.0; 6] {
                    continue;
                }
                for &(a, w) in &rows[i] {
                    for &(b, v) in rows[j].iter().filter(|(b, _)| *b <= a) {
                        let block = &mut found.matrix[a * n + b];
                        block.iter_mut().zip(entry).for_each(|(x, y)| *x += w * v * y);
                    }
                }
            }
        }
        found
    }
}

impl FitPlace {
    /// The control points around the place, by ascending numbers in the patch, with their weights in S, S_uu, S_uv and S_vv.
    fn terms(&self, side: usize) -> [(usize, [f64; 4]); AROUND] {
        let [u, v] = &self.basis;
        std::array::from_fn(|t| {
            let (k, l) = (t / LOCAL, t % LOCAL);
            let weight = |a: usize, b: usize| u.derivatives[a][k] * v.derivatives[b][l];
            ((u.first + k) * side + v.first + l, [weight(0, 0), weight(2, 0), weight(1, 1), weight(0, 2)])
        })
    }
}

/// The places of a patch: those of Gauss in every span and direction, at which bending is integrated exactly.
fn places(spans: usize) -> Vec<FitPlace> {
    let in_span = gauss_legendre(PLACES);
    let along: Vec<[f64; 2]> = (0..spans)
        .flat_map(|s| in_span.iter().map(move |[x, w]| [(s as f64 + x) / spans as f64, w / spans as f64]))
        .collect();
    let place = |&[u, of_u]: &[f64; 2], &[v, of_v]: &[f64; 2]| FitPlace {
        basis: [u, v].map(|x| QuinticBasis::at(spans, x)),
        parameters: [u, v],
        weight: of_u * of_v,
    };
    along.iter().flat_map(|u| along.iter().map(|v| place(u, v)).collect::<Vec<_>>()).collect()
}

/// The free control points that those of a patch depend on, ascending.
fn free_of(space: &QuadSplineSpace, patch: usize) -> Vec<u32> {
    let combinations = space.control(patch).iter().map(|&c| space.combination(c as usize));
    let mut free: Vec<u32> = combinations.flatten().map(|&(k, _)| k).collect();
    free.sort_unstable();
    free.dedup();
    free
}

/// The product of a symmetric matrix, as [`ENTRIES`], and a vector.
fn product([xx, xy, xz, yy, yz, zz]: &[f64; 6], [x, y, z]: Vector) -> Vector {
    [xx * x + xy * y + xz * z, xy * x + yy * y + yz * z, xz * x + yz * y + zz * z]
}

fn add_to(pattern: &Pattern, values: &mut [f64], [i, j]: [usize; 2], x: f64) {
    if let Some(at) = pattern.position(i, j) {
        values[at] += x;
    }
}
