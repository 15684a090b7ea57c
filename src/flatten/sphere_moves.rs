//! Maps to the unit sphere as a descent moves them.

use super::descent::MovingMap;
use super::descent_matrix::DescentMatrix;
use super::energy::EnergyShares;
use super::rest_triangle::RestTriangle;
use super::sphere_triangle::{SoftDet, tangents};
use crate::control::Control;
use crate::error::Result;
use crate::geometry::predicates::winding;
use crate::geometry::vector::{Vector, add, normalised, scale};
use crate::parallel;
use std::cmp::Ordering;

/// What the energy of a map to the sphere is made of.
pub(super) struct SphereMoves<'a> {
    pub corners: &'a [[u32; 3]],
    pub rest: &'a [RestTriangle],
    pub shares: EnergyShares,
    pub soft: SoftDet,
}

impl SphereMoves<'_> {
    pub fn at(&self, f: usize, points: &[Vector]) -> [Vector; 3] {
        self.corners[f].map(|v| points[v as usize])
    }

    /// The number of triangles that do not run counterclockwise as seen from outside, by exact arithmetic.
    pub fn n_turned(&self, points: &[Vector]) -> usize {
        let mut turned = vec![false; self.corners.len()];
        parallel::fill(&mut turned, |f| {
            let [a, b, c] = self.at(f, points);
            winding(a, b, c) != Ordering::Greater
        });
        turned.into_iter().filter(|turned| *turned).count()
    }

    /// The least determinant of a triangle.
    pub fn least_det(&self, points: &[Vector]) -> f64 {
        let mut dets = vec![0.0; self.corners.len()];
        parallel::fill(&mut dets, |f| self.rest[f].sphere_square_and_det(self.at(f, points))[1]);
        dets.into_iter().fold(f64::INFINITY, f64::min)
    }
}

impl MovingMap for SphereMoves<'_> {
    type Place = Vector;

    fn merit(&self, points: &[Vector]) -> f64 {
        let mut parts = vec![0.0; self.rest.len()];
        parallel::fill(&mut parts, |f| {
            self.rest[f].sphere_energy(&self.shares, self.soft, self.at(f, points))
        });
        parts.into_iter().sum()
    }

    fn conditions_value(&self, _: &[Vector]) -> f64 {
        0.0
    }

    fn look_at(&mut self, _: &[Vector], _: &mut DescentMatrix<'_>, _: &Control) -> Result<()> {
        Ok(())
    }

    fn assemble(&self, system: &mut DescentMatrix<'_>, points: &[Vector], clamped: bool) {
        let model =
            |f: usize| self.rest[f].sphere_model(&self.shares, self.soft, self.at(f, points), clamped);
        system.assemble(model);
    }

    /// Triangles that a step turns over have infinite energy, so that steps need no other bound.
    fn bound(&self, _: &[Vector], _: &[[f64; 2]]) -> f64 {
        1.0
    }

    fn moved(&self, place: Vector, [u, v]: [f64; 2]) -> Vector {
        let [first, second] = tangents(place);
        normalised(add(place, add(scale(u, first), scale(v, second))))
    }

    fn is_map(&self, points: &[Vector]) -> bool {
        self.soft.softness > 0.0 || self.n_turned(points) == 0
    }
}
