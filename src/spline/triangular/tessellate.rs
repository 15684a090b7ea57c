//! Triangle meshes of spline surfaces.

use super::cap::SurfaceTriangle;
use super::index::multi_indices;
use super::patch::Parameter;
use super::surface::Spline;
use crate::control::Control;
use crate::error::{Error, Result};
use crate::mesh::io::{Attributes, Soup};
use std::cmp::Ordering;
use std::collections::HashMap;
use std::collections::hash_map::Entry;

/// Most vertices of a tessellation.
const MOST_VERTICES: usize = 100_000_000;
/// Number of places that are evaluated at a time, of which a point and a normal are kept each.
const EVALUATED: usize = 1 << 14;

impl Spline {
    /// A triangle mesh of the surface: n² triangles for each patch, and after these for each cap triangle at infinity, counterclockwise as
    /// the charts are. It has normals of vertices (0 where the surface has none), and as texture coordinates of corners those of the chart.
    /// Patches with the control points of a side in common share its vertices.
    ///
    /// # Errors
    /// [`Error::Argument`] for n = 0; [`Error::TooLarge`] for more than a hundred million vertices; [`Error::Cancelled`].
    pub fn tessellate(&self, n: usize, threads: usize, control: &Control) -> Result<Soup> {
        if n == 0 {
            return Err(Error::argument("triangles per side", n, "1 or more"));
        }
        let all = self.triangles();
        let count = all.len().saturating_mul((n + 1).saturating_mul(n + 2) / 2);
        if count > MOST_VERTICES {
            return Err(Error::TooLarge { what: "vertices of the tessellation", count });
        }
        let mut known: HashMap<(Vec<u32>, [usize; 2]), u32> = HashMap::new();
        let (mut places, mut faces, mut uv) = (Vec::new(), Vec::new(), Vec::new());
        for (at, triangle) in all.iter().enumerate() {
            control.check()?;
            let mut numbers = Vec::new();
            let mut coordinates = Vec::new();
            for weights in multi_indices(n) {
                let place = place(at, triangle, weights.map(|w| w as f64 / n as f64));
                let mut add = || {
                    places.push(place);
                    places.len() as u32 - 1
                };
                let number = match self.shared(triangle, weights).map(|key| known.entry(key)) {
                    Some(Entry::Occupied(vertex)) => *vertex.get(),
                    Some(Entry::Vacant(free)) => *free.insert(add()),
                    None => add(),
                };
                numbers.push(number);
                coordinates.push([place.x, place.y]);
            }
            for triangle in triangles(n) {
                faces.push(triangle.map(|i| numbers[i]));
                uv.push(triangle.map(|i| coordinates[i]));
            }
        }
        drop(known);
        let (mut positions, mut normals) = (Vec::new(), Vec::new());
        let parts = places.len().div_ceil(EVALUATED);
        for (k, places) in places.chunks(EVALUATED).enumerate() {
            let found = self.evaluate(places, 1, threads, &control.part_of(k, parts))?;
            positions.extend(found.iter().map(|at| at.point));
            normals.extend(found.iter().map(|at| at.normal().unwrap_or_default()));
        }
        let attributes = Attributes { normals: Some(normals), uv: Some(uv), ..Attributes::default() };
        Ok(Soup { positions, faces, attributes })
    }

    /// A key that is equal for a point on a side and the same point of the triangle beyond: the control points of the side, in an order
    /// that does not depend on its direction, with the weights of its ends; for a corner its control point. None inside.
    fn shared(&self, triangle: &SurfaceTriangle<'_>, weights: [usize; 3]) -> Option<(Vec<u32>, [usize; 2])> {
        let k = (0..3).find(|&k| weights[(k + 2) % 3] == 0)?;
        let mut along = triangle.along(k, self);
        let mut ends = [weights[k], weights[(k + 1) % 3]];
        if ends[1] == 0 {
            return Some((vec![along[0]], [0; 2]));
        }
        if ends[0] == 0 {
            return Some((vec![along[along.len() - 1]], [0; 2]));
        }
        match along.iter().rev().cmp(along.iter()) {
            Ordering::Less => {
                along.reverse();
                ends.reverse();
            }
            // A side from a vertex to itself can have too few control points to tell its direction.
            Ordering::Equal => return None,
            Ordering::Greater => {}
        }
        Some((along, ends))
    }
}

/// The place in a triangle, given by its number and barycentric weights.
fn place(at: usize, triangle: &SurfaceTriangle<'_>, weights: [f64; 3]) -> Parameter {
    match triangle {
        SurfaceTriangle::Patch(patch) => {
            let corners = patch.corners();
            let [x, y] = [0, 1].map(|x| (0..3).map(|k| weights[k] * corners[k][x]).sum());
            Parameter { patch: at as u32, x, y }
        }
        SurfaceTriangle::Cap(cap) => cap.place(weights),
    }
}

/// The triangles of the division of a triangle into n² equal parts, as numbers of corners in the [`multi_indices`] of n.
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
