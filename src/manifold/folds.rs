//! Where a spline folds.

use super::domain::SurfaceDomain;
use crate::control::Control;
use crate::error::Result;
use crate::geometry::complex::{Complex, add, scale, sub};
use crate::geometry::vector::{Vector, cross, dot, norm};
use crate::mesh::FaceId;
use crate::spline::{Parameter, Spline};

/// Steps of a grid along a side of a patch.
const STEPS: usize = 12;
/// How far the grid stays from the sides and corners, in steps: a place is inside its patch, and not at its singular vertex.
const INSET: f64 = 0.01;
/// Largest angle, in degrees, by which normals may turn from a place of the grid to the next: at sharp ridges of scanned surfaces up to 45 were measured.
const TURN: f64 = 60.0;

impl SurfaceDomain {
    /// The patches in which a spline over this domain folds: its normals turn by more than 60 degrees from one place of a grid to the next, a twelfth of a side
    /// apart. At a singular vertex the grid is even in the coordinate in which that is a point as any other.
    ///
    /// # Errors
    /// [`crate::Error::Spline`] for a spline over another domain; [`crate::Error::Cancelled`].
    pub fn folds(&self, spline: &Spline, threads: usize, control: &Control) -> Result<Vec<usize>> {
        let mesh = &self.coarse().mesh;
        let turns = spline.holes().iter().map(|hole| hole.turns);
        let singular: Vec<_> = self.singular().into_iter().zip(turns).collect();
        let places = |f: FaceId| {
            let around = mesh.face_vertices(f);
            let at = |k: usize| {
                let (_, turns) = singular.iter().find(|(v, _)| *v == around[k])?;
                Some((k, *turns))
            };
            let (k, power) = (0..3).find_map(at).unwrap_or((0, 1));
            let corners = [0, 1, 2].map(|j| self.corners(f)[(k + j) % 3]);
            grid(corners, power).map(move |[x, y]| Parameter { patch: f.0, x, y })
        };
        let places: Vec<Parameter> = mesh.faces().flat_map(places).collect();
        let found = spline.evaluate(&places, 1, threads, control)?;
        let normals: Vec<Vector> = found.iter().map(|at| cross(at.first[0], at.first[1])).collect();
        let grids = normals.chunks((STEPS + 1) * (STEPS + 1)).enumerate();
        Ok(grids.filter(|(_, of)| is_folded(of)).map(|(patch, _)| patch).collect())
    }
}

/// Whether normals at the places of a grid turn too much.
fn is_folded(normals: &[Vector]) -> bool {
    let (side, limit) = (STEPS + 1, TURN.to_radians());
    let turn = |a: Vector, b: Vector| norm(cross(a, b)).atan2(dot(a, b));
    let next = |at: usize| [(at % side + 1 < side, at + 1), (at / side + 1 < side, at + side)];
    let turns =
        |at: usize| next(at).iter().any(|&(is_there, to)| is_there && turn(normals[at], normals[to]) > limit);
    (0..normals.len()).any(turns)
}

/// Places in a triangle: rows from the first corner to the opposite side, farther apart by a power.
fn grid([a, b, c]: [Complex; 3], power: i32) -> impl Iterator<Item = Complex> {
    let at = |k: usize| (k as f64 + INSET) / (STEPS as f64 + 2.0 * INSET);
    (0..=STEPS).flat_map(move |i| {
        (0..=STEPS).map(move |j| {
            let end = add(scale(1.0 - at(j), sub(b, a)), scale(at(j), sub(c, a)));
            add(a, scale(at(i).powi(power), end))
        })
    })
}
