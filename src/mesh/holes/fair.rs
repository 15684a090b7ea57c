//! Fairing of a patch: its vertices move to where the squared mean curvature over patch and loop is least.

use super::patch::HolePatch;
use crate::geometry::vector;
use crate::linalg::{Cholesky, Pattern, Symmetric};
use crate::mesh::Point;
use std::collections::BTreeMap;

/// Largest cotangent: those of thinner triangles would drown the others in rounding.
const MOST_COTANGENT: f64 = 1e4;

/// A face of the surface at a loop.
pub(super) struct RingFace(pub [RingCorner; 3]);

/// A corner of such a face.
#[derive(Clone, Copy)]
pub(super) struct RingCorner {
    /// Its number on the loop, if it is on it.
    pub on_loop: Option<u32>,
    pub place: Point,
}

/// Solves for the least Σ |L x|² / A over the points of the patch, where L has cotangent weights and A is the area at a point \[BS08\]. The
/// corners of the loop stay, as do the faces around it, whose tangent planes are continued. Where the system is singular nothing moves.
pub(super) fn fair(patch: &mut HolePatch, ring: &[RingFace]) {
    let n_new = patch.points.len() - patch.n_corners;
    if n_new == 0 {
        return;
    }
    let stars = Stars::new(patch, ring);
    let Some(moves) = stars.moves(n_new) else { return };
    if moves.iter().flatten().all(|x| x.is_finite()) {
        for (point, by) in patch.points[patch.n_corners..].iter_mut().zip(moves) {
            *point = vector::add(*point, by);
        }
    }
}

/// The Laplacian at the points of a patch.
struct Stars {
    /// For each point the other points of the patch that it has an edge to, with the cotangent weights.
    weights: Vec<BTreeMap<u32, f64>>,
    /// For each point the sum of its weights to all neighbours.
    sums: Vec<f64>,
    /// L x at each point.
    curvatures: Vec<Point>,
    areas: Vec<f64>,
    n_corners: usize,
}

impl Stars {
    fn new(patch: &HolePatch, ring: &[RingFace]) -> Stars {
        let n = patch.points.len();
        let mut stars = Stars {
            weights: vec![BTreeMap::new(); n],
            sums: vec![0.0; n],
            curvatures: vec![[0.0; 3]; n],
            areas: vec![0.0; n],
            n_corners: patch.n_corners,
        };
        for triangle in &patch.triangles {
            stars.add(triangle.map(Some), triangle.map(|k| patch.points[k as usize]));
        }
        for RingFace(corners) in ring {
            stars.add(corners.map(|corner| corner.on_loop), corners.map(|corner| corner.place));
        }
        stars
    }

    /// Adds a triangle, whose corners are points of the patch or lie outside.
    fn add(&mut self, numbers: [Option<u32>; 3], places: [Point; 3]) {
        let twice = vector::norm(vector::triangle_normal(places));
        for k in 0..3 {
            let [i, j] = [(k + 1) % 3, (k + 2) % 3];
            let [u, v] = [i, j].map(|i| vector::sub(places[i], places[k]));
            let cotangent = (vector::dot(u, v) / twice).clamp(-MOST_COTANGENT, MOST_COTANGENT);
            // A triangle without area has no angle to speak of.
            let weight = if cotangent.is_finite() { 0.5 * cotangent } else { 0.0 };
            for (from, to) in [(i, j), (j, i)] {
                let Some(a) = numbers[from] else { continue };
                self.sums[a as usize] += weight;
                let along = vector::scale(weight, vector::sub(places[to], places[from]));
                self.curvatures[a as usize] = vector::add(self.curvatures[a as usize], along);
                if let Some(b) = numbers[to] {
                    *self.weights[a as usize].entry(b).or_insert(0.0) += weight;
                }
            }
            if let Some(a) = numbers[k] {
                self.areas[a as usize] += twice / 6.0;
            }
        }
    }

    /// The row of L at a point, in the numbers of the new vertices.
    fn row(&self, a: usize) -> Vec<(usize, f64)> {
        let new = |k: usize| k.checked_sub(self.n_corners);
        let others = self.weights[a].iter().filter_map(|(&b, &weight)| Some((new(b as usize)?, weight)));
        others.chain(new(a).map(|a| (a, -self.sums[a + self.n_corners]))).collect()
    }

    /// How far each new vertex has to move.
    fn moves(&self, n_new: usize) -> Option<Vec<Point>> {
        let rows: Vec<_> = (0..self.weights.len()).map(|a| self.row(a)).collect();
        let pairs = rows.iter().flat_map(|row| {
            row.iter().flat_map(move |&(i, _)| row.iter().map(move |&(j, _)| (i as u32, j as u32)))
        });
        let pattern = Pattern::new(n_new, &pairs.collect::<Vec<_>>()).ok()?;
        let (mut values, mut sides) = (vec![0.0; pattern.entries()], [0; 3].map(|_| vec![0.0; n_new]));
        for (row, (curvature, area)) in rows.iter().zip(self.curvatures.iter().zip(&self.areas)) {
            if *area <= 0.0 {
                continue;
            }
            for &(i, x) in row {
                for &(j, y) in row.iter().filter(|(j, _)| *j <= i) {
                    values[pattern.position(i, j)?] += x * y / area;
                }
                (0..3).for_each(|k| sides[k][i] -= x * curvature[k] / area);
            }
        }
        let mut cholesky = Cholesky::analyse(&pattern).ok()?;
        cholesky.factor(Symmetric { pattern: &pattern, values: &values }).ok()?;
        sides.iter_mut().for_each(|side| cholesky.solve(side));
        Some((0..n_new).map(|i| [sides[0][i], sides[1][i], sides[2][i]]).collect())
    }
}
