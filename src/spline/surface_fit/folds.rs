//! The search for patches in which a spline folds.

use super::domain::SurfaceDomain;
use crate::control::Control;
use crate::error::Result;
use crate::geometry::complex::{Complex, add, scale, sub};
use crate::geometry::vector::{Vector, cross, dot, norm};
use crate::mesh::FaceId;
use crate::spline::{Hole, Parameter, Spline};
use std::collections::HashMap;

/// Steps of the grid along a side of a patch.
const STEPS: usize = 12;
/// Distance of the grid from sides and corners, in steps, so that places are inside their patch and not at its singular vertex.
const INSET: f64 = 0.01;
/// Largest angle, in degrees, between the normals at neighbouring places of the grid that is not a fold: at sharp ridges of scanned
/// surfaces, angles up to 45 were measured.
const TURN: f64 = 60.0;

impl SurfaceDomain {
    /// The patches in which a spline over this domain folds: its normals turn by more than 60 degrees between neighbouring places of a
    /// grid, which are at most a twelfth of a side apart. Around a singular vertex they are also at most as far apart in the coordinate in
    /// which the vertex is a regular point.
    ///
    /// # Errors
    /// [`crate::Error::Spline`] for a spline over another domain; [`crate::Error::Cancelled`].
    pub fn folds(&self, spline: &Spline, threads: usize, control: &Control) -> Result<Vec<usize>> {
        let mesh = &self.coarse().mesh;
        let singular: Vec<_> = self.singular().into_iter().zip(spline.holes()).collect();
        let places = |f: FaceId| {
            let around = mesh.face_vertices(f);
            let at = |k: usize| {
                let (_, hole) = singular.iter().find(|(v, _)| *v == around[k])?;
                Some((k, Some(*hole)))
            };
            let (k, hole) = (0..3).find_map(at).unwrap_or((0, None));
            let corners = [0, 1, 2].map(|j| self.corners(f)[(k + j) % 3]);
            grid(f.0, corners, hole)
        };
        let grids: Vec<Vec<Parameter>> = mesh.faces().map(places).collect();
        folded_grids(spline, &grids, threads, control)
    }
}

impl Spline {
    /// The patches in which the spline folds, as [`SurfaceDomain::folds`] finds them, without its domain.
    ///
    /// # Errors
    /// [`crate::Error::Cancelled`].
    pub fn folds(&self, threads: usize, control: &Control) -> Result<Vec<usize>> {
        let patches = self.space().patches();
        let mut singular: HashMap<usize, (usize, &Hole)> = HashMap::new();
        for hole in self.holes().iter().filter(|hole| !hole.is_at_infinity()) {
            for (patch, k) in hole.corners(self.space()) {
                singular.entry(patch).or_insert((k, hole));
            }
        }
        let places = |patch: usize| {
            let (k, hole) = singular.get(&patch).map_or((0, None), |&(k, hole)| (k, Some(hole)));
            let corners = patches[patch].corners();
            grid(patch as u32, [0, 1, 2].map(|j| corners[(k + j) % 3]), hole)
        };
        let grids: Vec<Vec<Parameter>> = (0..patches.len()).map(places).collect();
        folded_grids(self, &grids, threads, control)
    }
}

/// The numbers of the grids, one in each patch, at which the normals of a spline turn too much.
fn folded_grids(
    spline: &Spline,
    grids: &[Vec<Parameter>],
    threads: usize,
    control: &Control,
) -> Result<Vec<usize>> {
    let found = spline.evaluate(&grids.concat(), 1, threads, control)?;
    let normals: Vec<Vector> = found.iter().map(|at| cross(at.first[0], at.first[1])).collect();
    let mut rest = &normals[..];
    let is_folded = |grid: &Vec<Parameter>| {
        let (of, later) = rest.split_at(grid.len());
        rest = later;
        is_folded(of)
    };
    let folded: Vec<bool> = grids.iter().map(is_folded).collect();
    Ok((0..folded.len()).filter(|&patch| folded[patch]).collect())
}

/// True if the normals at two neighbouring places of a grid differ by too large an angle.
fn is_folded(normals: &[Vector]) -> bool {
    let (side, limit) = (STEPS + 1, TURN.to_radians());
    let turn = |a: Vector, b: Vector| norm(cross(a, b)).atan2(dot(a, b));
    let next = |at: usize| [(at % side + 1 < side, at + 1), (at + side < normals.len(), at + side)];
    let turns =
        |at: usize| next(at).iter().any(|&(is_there, to)| is_there && turn(normals[at], normals[to]) > limit);
    (0..normals.len()).any(turns)
}

/// The grid in a triangle, in rows from its first corner, where the vertex of `hole` is, to the opposite side. Places where the filling
/// alone is the surface are in the chart of the hole, since differences from a corner have few digits in the chart of the patch.
fn grid(patch: u32, [a, b, c]: [Complex; 3], hole: Option<&Hole>) -> Vec<Parameter> {
    let place = |[x, y]: Complex| Parameter { patch, x, y };
    let at = |row: f64, column: usize| {
        let column = (column as f64 + INSET) / (STEPS as f64 + 2.0 * INSET);
        let end = add(scale(1.0 - column, sub(b, a)), scale(column, sub(c, a)));
        let inside = hole.and_then(|hole| hole.near_vertex([place(a), place(add(a, end))], row));
        let turns = hole.map_or(1.0, |hole| hole.turns);
        inside.unwrap_or_else(|| place(add(a, scale(row.powf(turns), end))))
    };
    let rows = rows(hole.map_or(1.0, |hole| hole.turns));
    rows.into_iter()
        .flat_map(|row| (0..=STEPS).map(move |column| (row, column)))
        .map(|(r, c)| at(r, c))
        .collect()
}

/// The rows of the grid of a triangle with m turns at its first corner, as values of |w| = |z|^(1/m): steps are at most a twelfth in w and
/// in z.
fn rows(turns: f64) -> Vec<f64> {
    let step = 1.0 / (STEPS as f64 + 2.0 * INSET);
    let [first, last] = [INSET * step, 1.0 - INSET * step];
    let next = |row: &f64| {
        let of_z = (row.powf(turns) + step).powf(1.0 / turns);
        (*row < last).then_some(of_z.min(row + step).min(last))
    };
    std::iter::successors(Some(first), next).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spline::Sector;

    /// At a vertex with any number of turns, neighbouring rows are at most a twelfth apart, in w and in z = wᵐ.
    #[test]
    fn rows_are_near_each_other_in_both_coordinates() {
        for turns in [0.25, 0.5, 1.0, 2.0, 2.7, 3.0, 5.0, 31.0] {
            let rows = rows(turns);
            let most =
                |power: f64| rows.windows(2).map(|w| w[1].powf(power) - w[0].powf(power)).fold(0.0, f64::max);
            let twelfth = 1.0 / STEPS as f64;
            assert!(
                most(1.0) <= 1.000001 * twelfth && most(turns) <= 1.000001 * twelfth,
                "{turns}: {rows:?}"
            );
            assert!(rows[0] > 0.0 && rows[rows.len() - 1] < 1.0 && rows.len() > STEPS, "{turns}: {rows:?}");
        }
    }

    /// Places near a vertex of five turns are in the chart of its hole, those farther away in the patch.
    #[test]
    fn places_near_a_vertex_are_in_the_chart_of_its_hole() {
        let corners = [[1.0, 1.0], [2.0, 1.0], [1.5, 2.0]];
        let sector = Sector { patch: 3, angle: 0.2, to: [[1.0, 0.0, -1.0], [0.0, 1.0, -1.0]] };
        let hole = Hole::new(7, vec![sector], 5.0, 0.4).unwrap().blank(25);
        let places = grid(3, corners, Some(&hole));
        let inside: Vec<_> = places.iter().filter(|at| at.patch == 7).collect();
        assert!(!inside.is_empty() && inside.len() < places.len());
        // |w| = (|z| / 0.4)^(1/5): up to 0.8.
        assert!(inside.iter().all(|at| at.x.hypot(at.y) <= hole.inner));
        let beyond = places.iter().filter(|at| at.patch == 3);
        let far = |at: &Parameter| ((at.x - 1.0).hypot(at.y - 1.0) / 0.4).powf(0.2);
        assert!(
            beyond.clone().all(|at| far(at) > hole.inner - 1e-9),
            "{:?}",
            beyond.map(far).fold(9.0, f64::min)
        );
    }
}
