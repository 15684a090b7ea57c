//! Triangle meshes of spline surfaces.

use super::index::multi_indices;
use super::patch::Parameter;
use super::surface::Spline;
use crate::control::Control;
use crate::error::{Error, Result};
use crate::mesh::io::{Attributes, Soup};
use std::collections::HashMap;
use std::collections::hash_map::Entry;

/// Most vertices of a tessellation.
const MOST_VERTICES: usize = 100_000_000;

impl Spline {
    /// n² triangles per patch, counterclockwise as the charts are; with normals per vertex (0 where there is none), and the coordinates of
    /// each corner in its patch's chart as texture coordinates. Patches with a common side, which have its control points in common, share
    /// its vertices.
    ///
    /// # Errors
    /// [`Error::Argument`] for n = 0; [`Error::TooLarge`] for more than a hundred million vertices; [`Error::Cancelled`].
    pub fn tessellate(&self, n: usize, threads: usize, control: &Control) -> Result<Soup> {
        if n == 0 {
            return Err(Error::argument("triangles per side", n, "1 or more"));
        }
        let patches = self.space().patches();
        let count = patches.len().saturating_mul((n + 1).saturating_mul(n + 2) / 2);
        if count > MOST_VERTICES {
            return Err(Error::TooLarge { what: "vertices of the tessellation", count });
        }
        let mut known: HashMap<Vec<(u32, usize)>, u32> = HashMap::new();
        let (mut places, mut faces, mut uv) = (Vec::new(), Vec::new(), Vec::new());
        for (at, patch) in patches.iter().enumerate() {
            let corners = [0, 1, 2].map(|k| patch.knots[k][0]);
            let mut numbers = Vec::new();
            let mut coordinates = Vec::new();
            for weights in multi_indices(n) {
                let [x, y] =
                    [0, 1].map(|x| (0..3).map(|k| weights[k] as f64 / n as f64 * corners[k][x]).sum());
                let mut add = || {
                    places.push(Parameter { patch: at as u32, x, y });
                    places.len() as u32 - 1
                };
                let number = match self.shared(at, weights).map(|key| known.entry(key)) {
                    Some(Entry::Occupied(vertex)) => *vertex.get(),
                    Some(Entry::Vacant(free)) => *free.insert(add()),
                    None => add(),
                };
                numbers.push(number);
                coordinates.push([x, y]);
            }
            for triangle in triangles(n) {
                faces.push(triangle.map(|i| numbers[i]));
                uv.push(triangle.map(|i| coordinates[i]));
            }
        }
        let found = self.evaluate(&places, 1, threads, control)?;
        let normals = found.iter().map(|at| at.normal().unwrap_or_default()).collect();
        let attributes = Attributes { normals: Some(normals), uv: Some(uv), ..Attributes::default() };
        Ok(Soup { positions: found.iter().map(|at| at.point).collect(), faces, attributes })
    }

    /// What a point on a side has in common with the same point of the patch beyond: the control points of the ends and next to them along
    /// the side, each with the point's weight; of a corner its own. None inside.
    fn shared(&self, patch: usize, weights: [usize; 3]) -> Option<Vec<(u32, usize)>> {
        let degree = self.space().degree();
        let control = |beta: [usize; 3]| self.space().patches()[patch].control[super::index::position(beta)];
        let ends: Vec<usize> = (0..3).filter(|&k| weights[k] > 0).collect();
        let at = |k: usize, towards: usize, steps: usize| {
            let mut beta = [0; 3];
            beta[k] += degree - steps;
            beta[towards] += steps;
            control(beta)
        };
        let mut key = match ends[..] {
            [k] => vec![(at(k, k, 0), 0)],
            [a, b] => {
                let next = usize::from(degree > 1);
                vec![
                    (at(a, b, 0), weights[a]),
                    (at(b, a, 0), weights[b]),
                    (at(a, b, next), weights[a]),
                    (at(b, a, next), weights[b]),
                ]
            }
            _ => return None,
        };
        key.sort_unstable();
        Some(key)
    }
}

/// The triangles of n² equal parts of a triangle, by the numbers of their corners in [`multi_indices`] of n.
pub(super) fn triangles(n: usize) -> Vec<[usize; 3]> {
    let at = |row: usize, k: usize| row * (row + 1) / 2 + k;
    let mut all = Vec::with_capacity(n * n);
    for row in 0..n {
        for k in 0..=row {
            all.push([at(row, k), at(row + 1, k), at(row + 1, k + 1)]);
            if k < row {
                all.push([at(row, k), at(row + 1, k + 1), at(row, k + 1)]);
            }
        }
    }
    all
}
