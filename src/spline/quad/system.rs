//! The normal equations of a fit: squared distances of places of the patches from their feet, and the bending of the patches.

use super::layout::PatchCorner;
use super::nearest::NearestToVertex;
use super::piece_form::{FootPoint, PieceForm};
use super::quintic::{LOCAL, QuinticBasis};
use super::space::QuadSplineSpace;
use super::span_direction::SpanDirection;
use super::spline::QuadSpline;
use crate::error::{Error, Result};
use crate::geometry::vector::{Vector, add, dot, scale, sub};
use crate::linalg::{Cholesky, Pattern, Symmetric};
use crate::parallel;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Pairs of unknowns beyond which repeated ones are dropped on the way.
const MOST_PAIRS: usize = 1 << 24;
/// Number of control points that a place depends on.
const AROUND: usize = LOCAL * LOCAL;
/// The entries (i, j) of a symmetric 3 × 3 matrix.
const ENTRIES: [[usize; 2]; 6] = [[0, 0], [0, 1], [0, 2], [1, 1], [1, 2], [2, 2]];

/// The place of the entry (c, d) in [`ENTRIES`], and those on the diagonal.
const ENTRY: [[usize; 3]; 3] = [[0, 1, 2], [1, 3, 4], [2, 4, 5]];
const DIAGONAL: [usize; 3] = [0, 3, 5];
/// The weight of distances from flat pieces of the target against those from others, so that their patches are flat too.
const OF_FLAT: f64 = 1e6;
/// That of distances from pieces on cylinders, near which polynomials come but on which they do not lie.
const OF_ROUND: f64 = 1e3;
/// The weight of the squared way from where places were, over that of its gradient.
const OF_WAY: f64 = 1e-3;
/// The weight of all vertices of the target against that of all places of the patches.
const VERTICES: f64 = 1.0;

/// The weights of the terms of a fit.
#[derive(Debug, Clone, Copy)]
pub(super) struct FitWeights {
    /// That of the squared distance from the tangent plane at the foot.
    pub normal: f64,
    /// That of ∫ S_uu² + 2 S_uv² + S_vv² over the rectangles of the parameters.
    pub bending: f64,
}

/// A place of a patch.
pub(super) struct FitPlace {
    pub basis: [QuinticBasis; 2],
    pub parameters: [f64; 2],
    /// The share of the patch that it stands for.
    weight: f64,
}

/// What a fit comes near: a foot for every place of a patch, and for every patch the vertices of the target that are nearest to it.
pub(super) struct FitGoal<'a> {
    pub weights: FitWeights,
    /// Per patch the weight of the squared distance from the foot or, where patches keep their shape, of the squared gradient of the way from the spline
    /// before.
    pub tangential: &'a [f64],
    /// The spline before, and per patch true if it keeps its shape; none at the start.
    pub shape: Option<(&'a QuadSpline, &'a [bool])>,
    /// Those of the places of a patch, in order.
    pub feet: &'a (dyn Fn(usize) -> &'a [FootPoint] + Sync),
    pub vertices: &'a (dyn Fn(usize) -> &'a [NearestToVertex] + Sync),
}

/// The normal equations of fits over a space. Unknown 3 k + c is coordinate c of the free control point k.
pub(super) struct QuadSystem {
    space: Arc<QuadSplineSpace>,
    /// By numbers of spans the directions of patches.
    along: BTreeMap<usize, SpanDirection>,
    /// The area of all patches in parameters.
    area: f64,
    /// Per patch the weight of the distances of its places.
    of_places: Vec<f64>,
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

impl QuadSystem {
    /// `forms`: per patch the plane or cylinder on which its piece of the target lies.
    pub fn new(space: Arc<QuadSplineSpace>, forms: &[Option<PieceForm>]) -> Result<QuadSystem> {
        let free: Vec<Vec<u32>> = (0..space.layout().patches().len()).map(|p| free_of(&space, p)).collect();
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
        let along = space.spans().iter().map(|&spans| (spans, SpanDirection::new(spans))).collect();
        let of_patch = |p: usize| lengths(&space, p).iter().product::<f64>();
        let area = (0..space.layout().patches().len()).map(of_patch).sum();
        let of_places = |form: &Option<PieceForm>| match form {
            Some(PieceForm::Plane(_)) => OF_FLAT,
            Some(PieceForm::Cylinder(..)) => OF_ROUND,
            None => 1.0,
        };
        let of_places = forms.iter().map(of_places).collect();
        Ok(QuadSystem { space, along, area, of_places, free, pattern, cholesky })
    }

    /// The space of the splines.
    pub fn space(&self) -> &Arc<QuadSplineSpace> {
        &self.space
    }

    /// The free control points at which the weighted sum of squares is least.
    ///
    /// # Errors
    /// [`Error::Factorisation`] where the places do not determine the spline.
    pub fn solve(&mut self, goal: &FitGoal<'_>) -> Result<Vec<Vector>> {
        let n = self.free.len();
        let found = parallel::map(n, |p| self.of_patch(p, goal));
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
                for d in 0..3 {
                    // The rows of a block follow each other; of one on the diagonal those from the diagonal on are stored.
                    let first = if a == b { d } else { 0 };
                    let Some(at) = self.pattern.position(3 * i as usize + first, 3 * j as usize + d) else {
                        continue;
                    };
                    let column = &mut values[at..at + 3 - first];
                    column.iter_mut().zip(first..).for_each(|(x, c)| *x += block[ENTRY[c][d]]);
                }
            }
        }
    }

    /// The places of a patch: those of Gauss in every span and direction.
    pub fn places(&self, p: usize) -> impl Iterator<Item = FitPlace> + '_ {
        let [of_u, of_v] = self.space.patch_spans(p).map(|spans| &self.along[&spans].places);
        of_u.iter().flat_map(move |u| {
            of_v.iter().map(move |v| FitPlace {
                basis: [u.basis, v.basis],
                parameters: [u.parameter, v.parameter],
                weight: u.weight * v.weight,
            })
        })
    }

    /// The places within a patch at which a fit is measured, each with the number of the nearest of [`QuadSystem::places`].
    pub fn measured(&self, p: usize) -> impl Iterator<Item = ([&QuinticBasis; 2], usize)> + '_ {
        let [of_u, of_v] = self.space.patch_spans(p).map(|spans| &self.along[&spans]);
        let n = of_v.places.len();
        of_u.measured
            .iter()
            .flat_map(move |(u, i)| of_v.measured.iter().map(move |(v, j)| ([u, v], i * n + j)))
    }

    /// The squared distances of the places of a patch from their feet and of vertices from theirs, with the weights that [`QuadSystem::solve`]
    /// gives them.
    pub fn squares(
        &self,
        spline: &QuadSpline,
        p: usize,
        feet: &[FootPoint],
        vertices: &[NearestToVertex],
    ) -> f64 {
        let square = |a: Vector, b: Vector| sub(a, b).map(|x| x * x).iter().sum::<f64>();
        let [a, b] = lengths(&self.space, p);
        let of_place = |(place, foot): (FitPlace, &FootPoint)| {
            self.of_places[p]
                * a
                * b
                * place.weight
                * square(spline.point(p, [&place.basis[0], &place.basis[1]]), foot.point)
        };
        let of_vertex = |NearestToVertex { vertex, parameters, .. }: &NearestToVertex| {
            VERTICES * self.area * vertex.share * square(spline.point_at(p, *parameters), vertex.point)
        };
        self.places(p).zip(feet).map(of_place).sum::<f64>() + vertices.iter().map(of_vertex).sum::<f64>()
    }

    /// ∫ S_uu² + 2 S_uv² + S_vv² over the rectangles of the parameters.
    pub fn bending_of(&self, spline: &QuadSpline) -> f64 {
        let of_patch = |p: usize| {
            let net: Vec<Vector> = spline.net(p).into_iter().flatten().collect();
            let m = net.len();
            let bent = bending(
                1.0,
                lengths(&self.space, p),
                self.space.patch_spans(p).map(|spans| &self.along[&spans]),
            );
            let of_pair = |i: usize, j: usize| {
                let twice = if i == j { 1.0 } else { 2.0 };
                twice * bent(i, j) * dot(net[i], net[j])
            };
            (0..m).flat_map(|i| (0..=i).map(move |j| (i, j))).map(|(i, j)| of_pair(i, j)).sum::<f64>()
        };
        parallel::map(self.free.len(), of_patch).into_iter().sum()
    }

    /// The equations of a patch on the free control points.
    fn of_patch(&self, p: usize, goal: &FitGoal<'_>) -> PatchEquations {
        let weights = goal.weights;
        let along = self.space.patch_spans(p).map(|spans| &self.along[&spans]);
        let tangential = goal.tangential[p];
        // Sides move, and the places between go with them: what is kept is the shape, and next to nothing of where it was.
        let shape = goal.shape.filter(|(_, is_kept)| is_kept[p]).map(|(before, _)| before);
        let along_surface = if shape.is_some() { OF_WAY * tangential } else { tangential };
        let of_distance = [weights.normal, along_surface];
        let mut sum = PatchSum::new(self.space.sides(p), lengths(&self.space, p));
        let [a, b] = sum.lengths;
        for (place, &FootPoint { point, normal }) in self.places(p).zip((goal.feet)(p)) {
            let [along_normal, tangential] = of_distance;
            let tensor = tensor(normal, [self.of_places[p] * along_normal, tangential], a * b * place.weight);
            sum.add(&place.basis, &tensor, point);
        }
        sum.bend(weights.bending, along);
        if let Some(before) = shape {
            sum.keep_shape(tangential, along, &before.net(p).concat());
        }
        let spans = self.space.patch_spans(p);
        for NearestToVertex { vertex, normal, parameters } in (goal.vertices)(p) {
            let basis = [0, 1].map(|k| QuinticBasis::at(spans[k], parameters[k]));
            let weight = VERTICES * self.area * vertex.share;
            let tensor = tensor(*normal, of_distance, weight);
            sum.add(&basis, &tensor, vertex.point);
        }
        self.extracted(p, &sum.matrix, &sum.right)
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

/// The control points that count where these basis functions do, by ascending numbers in the patch, with their weights.
fn terms([u, v]: &[QuinticBasis; 2], side: usize) -> [(usize, f64); AROUND] {
    std::array::from_fn(|t| {
        let (k, l) = (t / LOCAL, t % LOCAL);
        ((u.first + k) * side + v.first + l, u.derivatives[0][k] * v.derivatives[0][l])
    })
}

/// The lengths in parameters of the first two sides of a patch.
fn lengths(space: &QuadSplineSpace, patch: usize) -> [f64; 2] {
    [0, 1].map(|corner| space.layout().length(PatchCorner { patch, corner }))
}

/// The matrix of the squared distance from a tangent plane and from its point, with these weights, times another one.
fn tensor(normal: Vector, [flat, whole]: [f64; 2], weight: f64) -> [f64; 6] {
    ENTRIES.map(|[c, d]| weight * (flat * normal[c] * normal[d] + if c == d { whole } else { 0.0 }))
}

/// The equations of a patch on its own control points, as they add up.
struct PatchSum {
    matrix: Vec<[f64; 6]>,
    right: Vec<Vector>,
    /// The numbers of control points along u and along v.
    sides: [usize; 2],
    /// The lengths in parameters.
    lengths: [f64; 2],
}

impl PatchSum {
    fn new(sides: [usize; 2], lengths: [f64; 2]) -> PatchSum {
        let m = sides[0] * sides[1];
        PatchSum { matrix: vec![[0.0; 6]; m * m], right: vec![[0.0; 3]; m], sides, lengths }
    }

    /// Adds the squared distance of a place from a point.
    fn add(&mut self, basis: &[QuinticBasis; 2], tensor: &[f64; 6], point: Vector) {
        let m = self.right.len();
        let pulled = product(tensor, point);
        let terms = terms(basis, self.sides[1]);
        for (number, (i, value)) in terms.into_iter().enumerate() {
            self.right[i] = [0, 1, 2].map(|x| self.right[i][x] + value * pulled[x]);
            for &(j, other) in &terms[..=number] {
                let both = value * other;
                self.matrix[i * m + j].iter_mut().zip(tensor).for_each(|(x, t)| *x += both * t);
            }
        }
    }

    /// Adds ∫ d_u² + d_v² over the rectangle with a weight, d the way from a spline with these control points.
    fn keep_shape(&mut self, weight: f64, [along_u, along_v]: [&SpanDirection; 2], before: &[Vector]) {
        let ([a, b], m) = (self.lengths, before.len());
        let [n_u, n_v] = [along_u, along_v].map(|along| along.products[0].len().isqrt());
        for (i, j) in (0..m).flat_map(|i| (0..m).map(move |j| (i, j))) {
            let [u, v] = [(i / n_v) * n_u + j / n_v, (i % n_v) * n_v + j % n_v];
            let of =
                |order_u: usize, order_v: usize| along_u.products[order_u][u] * along_v.products[order_v][v];
            let both = weight * (b / a * of(1, 0) + a / b * of(0, 1));
            self.right[i] = add(self.right[i], scale(both, before[j]));
            if j <= i {
                DIAGONAL.into_iter().for_each(|k| self.matrix[i * m + j][k] += both);
            }
        }
    }

    /// Adds ∫ S_uu² + 2 S_uv² + S_vv² over the rectangle with a weight.
    fn bend(&mut self, weight: f64, along: [&SpanDirection; 2]) {
        let m = self.right.len();
        let bent = bending(weight, self.lengths, along);
        for (i, j) in (0..m).flat_map(|i| (0..=i).map(move |j| (i, j))) {
            let bent = bent(i, j);
            DIAGONAL.into_iter().for_each(|k| self.matrix[i * m + j][k] += bent);
        }
    }
}

/// A weight times ∫ of the products of the second derivatives of two control points' functions over a rectangle with these sides, as in
/// ∫ S_uu² + 2 S_uv² + S_vv².
fn bending(
    weight: f64,
    [a, b]: [f64; 2],
    [along_u, along_v]: [&SpanDirection; 2],
) -> impl Fn(usize, usize) -> f64 {
    let [by_uu, by_uv, by_vv] = [b / a.powi(3), 2.0 / (a * b), a / b.powi(3)].map(|x| weight * x);
    let [n_u, n_v] = [along_u, along_v].map(|along| along.products[0].len().isqrt());
    move |i, j| {
        let [u, v] = [(i / n_v) * n_u + j / n_v, (i % n_v) * n_v + j % n_v];
        let of = |order_u: usize, order_v: usize| along_u.products[order_u][u] * along_v.products[order_v][v];
        by_uu * of(2, 0) + by_uv * of(1, 1) + by_vv * of(0, 2)
    }
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
