//! Splines over layouts of four-sided patches.

use super::layout::PatchCorner;
use super::quintic::{LOCAL, QUINTIC, QuinticBasis, knots};
use super::space::QuadSplineSpace;
use crate::archive::stored;
use crate::error::{Error, Result, check_size};
use crate::geometry::vector::{Vector, add, scale};
use crate::spline::triangular::SurfacePoint;
use std::sync::Arc;

/// A spline over a layout of four-sided patches: a surface whose tangent plane is continuous but at creases.
#[derive(Clone)]
pub struct QuadSpline {
    space: Arc<QuadSplineSpace>,
    control_points: Vec<Vector>,
}
stored!(sections QuadSpline { space, control_points } check QuadSpline::check_parts);

impl QuadSpline {
    /// Checks that the parts of an archive fit each other.
    fn check_parts(&self) -> Result<()> {
        check_size("control points", self.control_points.len(), self.space.n_control_points())
    }

    /// The spline with these free control points.
    ///
    /// # Errors
    /// [`Error::Size`] for another number than the dimension of the space.
    pub fn of_free(space: Arc<QuadSplineSpace>, free: &[Vector]) -> Result<QuadSpline> {
        let control_points = space.control_points(free)?;
        Ok(QuadSpline { space, control_points })
    }

    /// The space.
    pub fn space(&self) -> &Arc<QuadSplineSpace> {
        &self.space
    }

    /// The control points, by their numbers in [`QuadSplineSpace::control`].
    pub fn control_points(&self) -> &[Vector] {
        &self.control_points
    }

    /// The control points of a patch: `net[i][j]`, i along u, j along v.
    pub fn net(&self, patch: usize) -> Vec<Vec<Vector>> {
        let rows = self.space.control(patch).chunks(self.space.sides(patch)[1]);
        rows.map(|row| row.iter().map(|&c| self.control_points[c as usize]).collect()).collect()
    }

    /// The control points of an arc, from its start to its end. Its knots are those of the patches along it.
    ///
    /// # Errors
    /// [`Error::Spline`] for an arc that does not exist.
    pub fn arc_control_points(&self, arc: usize) -> Result<Vec<Vector>> {
        let layout = self.space.layout();
        if arc >= layout.arcs().len() {
            return Err(Error::Spline { what: "arc", index: arc, message: "it does not exist".into() });
        }
        let [left, right] = layout.beside(arc);
        let mut along = left.or(right).map(|side| self.side_points(side)).unwrap_or_default();
        if left.is_none() {
            along.reverse();
        }
        Ok(along)
    }

    /// The control points along a side, in the direction around the patch.
    pub(super) fn side_points(&self, at: PatchCorner) -> Vec<Vector> {
        let along = (0..self.space.side(at)).map(|i| self.space.along(at, i, 0));
        along.map(|c| self.control_points[c as usize]).collect()
    }

    /// The degree in each direction: 5.
    pub fn degree(&self) -> usize {
        QUINTIC
    }

    /// The knots of a patch along u and along v.
    pub fn knots(&self, patch: usize) -> [Vec<f64>; 2] {
        self.space.patch_spans(patch).map(knots)
    }

    /// The point at (u, v) of a patch, from 0 to 1 each, with first and second derivatives.
    ///
    /// # Errors
    /// [`Error::Spline`] for a patch that does not exist or a place outside of it.
    pub fn evaluate(&self, patch: usize, [u, v]: [f64; 2]) -> Result<SurfacePoint> {
        self.check_place(patch, [u, v])?;
        Ok(self.at(patch, [u, v]))
    }

    /// Refuses a patch that does not exist, and a place outside of it.
    pub(super) fn check_place(&self, patch: usize, [u, v]: [f64; 2]) -> Result<()> {
        let is_inside = (0.0..=1.0).contains(&u) && (0.0..=1.0).contains(&v);
        if patch >= self.space.layout().patches().len() || !is_inside {
            let message = format!("there is no place ({u}, {v}) of it: u and v run from 0 to 1");
            return Err(Error::Spline { what: "patch", index: patch, message });
        }
        Ok(())
    }

    /// The point at a place of a patch that exists, without derivatives.
    pub(super) fn point_at(&self, patch: usize, [u, v]: [f64; 2]) -> Vector {
        let [m, n] = self.space.patch_spans(patch);
        self.point(patch, [&QuinticBasis::at(m, u), &QuinticBasis::at(n, v)])
    }

    /// The point at a place of a patch that exists.
    pub(super) fn at(&self, patch: usize, [u, v]: [f64; 2]) -> SurfacePoint {
        let [m, n] = self.space.patch_spans(patch);
        self.combined(patch, &QuinticBasis::at(m, u), &QuinticBasis::at(n, v))
    }

    /// The control points of a patch that count where the basis functions are known: row k those of the function k along u.
    fn around(
        &self,
        patch: usize,
        [along_u, along_v]: [&QuinticBasis; 2],
    ) -> impl Iterator<Item = [Vector; LOCAL]> + '_ {
        let (control, [_, side]) = (self.space.control(patch), self.space.sides(patch));
        let (first_u, first_v) = (along_u.first, along_v.first);
        (0..LOCAL).map(move |k| {
            let row = &control[(first_u + k) * side + first_v..][..LOCAL];
            std::array::from_fn(|l| self.control_points[row[l] as usize])
        })
    }

    /// The point where the basis functions of both directions are known.
    pub(super) fn point(&self, patch: usize, along: [&QuinticBasis; 2]) -> Vector {
        self.derivative(patch, along, [0, 0])
    }

    /// The derivative of these orders along u and v where the basis functions of both directions are known.
    pub(super) fn derivative(
        &self,
        patch: usize,
        along: [&QuinticBasis; 2],
        [of_u, of_v]: [usize; 2],
    ) -> Vector {
        let (weights, across) = (&along[0].derivatives[of_u], &along[1].derivatives[of_v]);
        let rows = self.around(patch, along).zip(weights);
        rows.fold([0.0; 3], |sum, (row, &weight)| add(sum, scale(weight, weighted(&row, across))))
    }

    /// The point with its derivatives where the basis functions of both directions are known.
    pub(super) fn combined(
        &self,
        patch: usize,
        along_u: &QuinticBasis,
        along_v: &QuinticBasis,
    ) -> SurfacePoint {
        let mut sums = [[[0.0; 3]; 3]; 3];
        for (k, row) in self.around(patch, [along_u, along_v]).enumerate() {
            let along_row = [0, 1, 2].map(|of_v| weighted(&row, &along_v.derivatives[of_v]));
            for (of_u, sums) in sums.iter_mut().enumerate() {
                for (sum, row) in sums.iter_mut().zip(&along_row).take(3 - of_u) {
                    *sum = add(*sum, scale(along_u.derivatives[of_u][k], *row));
                }
            }
        }
        let [[point, by_v, by_vv], [by_u, by_uv, _], [by_uu, ..]] = sums;
        SurfacePoint { point, first: [by_u, by_v], second: [by_uu, by_uv, by_vv] }
    }
}

/// The sum of points with weights.
fn weighted(points: &[Vector; LOCAL], weights: &[f64; LOCAL]) -> Vector {
    points.iter().zip(weights).fold([0.0; 3], |sum, (point, weight)| add(sum, scale(*weight, *point)))
}
