//! Seams of a seamless layout that are exact: coordinates on a grid of powers of two, in which the two sides of each seam differ by a rotation
//! by a multiple of 90° and a translation without any rounding.
//!
//! The opened surface is a disk whose boundary is a closed polygon. An edge of the cut is two of its sides: w and −iᵏ w. The polygon closes
//! if `Σ (1 − iᵏ) w = 0`. Sides are rounded to Gaussian integers; what the sum is off then is a multiple of 1 − i, or of 2 if every k is
//! even, and one long edge takes it up. Edges of the boundary are sides of their own; they are made parallel to an axis, and the longest in
//! each direction can take up anything along it.

use super::layout::Layout;
use super::straight_lines::{CoordinateClasses, GridVector, OpenedSide, across, straighten, turned};
use crate::error::{Error, Result};
use crate::geometry::{DoubleDouble, Motion, Space};
use crate::mesh::HalfedgeId;
use std::f64::consts::FRAC_PI_2;

/// Largest difference, radians, of a seam's rotation from a multiple of 90° that is rounding.
const ROTATION_ROUNDING: f64 = 1e-6;
/// Coordinates are below 2 to this power in units of the grid, so that sums and differences of two of them are exact.
const GRID_BITS: i32 = 51;
/// Multiples of the grid that coordinates are rounded to where lines are to be straight: what equations leave then can be halved some times.
const COARSE: i64 = 256;

impl Layout {
    /// Turns the layout such that a half-edge has the direction of the x axis.
    ///
    /// # Errors
    /// [`Error::Layout`] for a layout that is not in E².
    pub fn align(&mut self, h: HalfedgeId) -> Result<()> {
        let [a, b] = [self.uv(h), self.uv(self.mesh().next(h))];
        let direction = [b[0] - a[0], a[1] - b[1]].map(DoubleDouble::from);
        let size = (direction[0] * direction[0] + direction[1] * direction[1]).sqrt();
        let zero = DoubleDouble::from(0.0);
        self.move_by(&Motion::in_plane(direction.map(|x| x / size), [zero, zero]))
    }

    /// Moves the corners to a grid of powers of two such that the two sides of each edge of the cut differ by a rotation by a multiple of
    /// 90° and a translation exactly, and edges of the boundary are parallel to an axis; so are those of `straight`, half-edges that are nearly
    /// so, if the equations for them have a solution in whole numbers. Returns the largest distance by which a corner was moved: a few units of
    /// rounding per edge of the cut.
    ///
    /// # Errors
    /// [`Error::Layout`] for a layout that is not in E², closed without cut or of several pieces, with a seam whose rotation is no multiple of
    /// 90° to 1e-6, or with an edge of the boundary that is off the axes by more ([`Layout::align`]).
    pub fn make_seams_exact(&mut self, straight: &[HalfedgeId]) -> Result<f64> {
        self.moved_to_grid(straight, true)
    }

    /// The same of a layout whose boundary has any direction, and keeps it.
    ///
    /// # Errors
    /// Those of [`Layout::make_seams_exact`] but for the boundary's.
    pub fn make_seams_exact_beside_free_boundary(&mut self) -> Result<f64> {
        self.moved_to_grid(&[], false)
    }

    fn moved_to_grid(&mut self, straight: &[HalfedgeId], is_on_axes: bool) -> Result<f64> {
        let quarters = self.quarter_turns()?;
        let boundary = self.cut_boundary()?;
        let extent = self.coordinates.iter().flatten().fold(0.0, |top: f64, x| top.max(x.abs()));
        let unit = 2f64.powi(extent.log2().ceil() as i32 + 1 - GRID_BITS);
        let on_grid = |[x, y]: [f64; 2]| [(x / unit).round() as i64, (y / unit).round() as i64];
        let mut exact: Vec<GridVector> = self.coordinates.iter().map(|&z| on_grid(z)).collect();
        let mut classes = CoordinateClasses::new(self, straight);
        let straightened = self.straight_sides(&boundary, straight, unit, &mut classes)?;
        let is_straight = !straight.is_empty() && straightened.is_some();
        let sides = match straightened {
            Some(sides) => sides,
            None => {
                let outer = boundary.iter().copied().filter(|&h| self.side[h] == 0);
                let side =
                    |h| if is_on_axes { self.boundary_side(h, unit) } else { Ok(self.grid_side(h, unit)) };
                closed_sides(self, &boundary, &quarters, outer.map(side).collect::<Result<_>>()?, unit)?
            }
        };
        let mut at = boundary.first().map_or([0; 2], |&h| exact[self.corner_index[h] as usize]);
        for (&h, side) in boundary.iter().zip(&sides) {
            exact[self.corner_index[h] as usize] = at;
            at = [at[0] + side[0], at[1] + side[1]];
        }
        if is_straight {
            let outer: Vec<u32> = boundary.iter().map(|&h| self.corner_index[h]).collect();
            classes.make_equal(&mut exact, &outer);
        }
        let mut moved = 0.0f64;
        for (k, z) in exact.into_iter().enumerate() {
            let z = z.map(|x| x as f64 * unit);
            let old = self.coordinates[k];
            moved = moved.max((z[0] - old[0]).hypot(z[1] - old[1]));
            self.coordinates[k] = z;
            self.points[k] = [z[0], z[1], 1.0];
        }
        self.remainders.clear();
        self.find_flat();
        Ok(moved)
    }

    /// The sides of the boundary polygon with which it closes and lines inside can be straight; none without lines, and where the equations
    /// have no solution in whole numbers.
    fn straight_sides(
        &self,
        boundary: &[HalfedgeId],
        straight: &[HalfedgeId],
        unit: f64,
        classes: &mut CoordinateClasses,
    ) -> Result<Option<Vec<GridVector>>> {
        if straight.is_empty() {
            return Ok(None);
        }
        let (mesh, quarters) = (self.mesh(), self.quarter_turns()?);
        let mut is_line = vec![false; mesh.n_edges()];
        straight.iter().for_each(|h| is_line[h.edge().index()] = true);
        let (mut vectors, mut free) = (Vec::new(), Vec::new());
        let mut number = vec![usize::MAX; mesh.n_edges()];
        let coarse = unit * COARSE as f64;
        for &h in boundary.iter().filter(|&&h| self.side[h] >= 0) {
            let [a, b] = [self.uv(h), self.uv(mesh.next(h))];
            let mut axes = [true; 2];
            if self.side[h] == 0 {
                self.boundary_side(h, unit)?;
            }
            if self.side[h] == 0 || is_line[h.edge().index()] {
                axes[across(a, b)] = false;
            }
            number[h.edge().index()] = vectors.len();
            let whole = |k: usize| if axes[k] { ((b[k] - a[k]) / coarse).round() as i64 * COARSE } else { 0 };
            vectors.push([whole(0), whole(1)]);
            free.push(axes);
        }
        let side = |&h: &HalfedgeId| {
            let turn = |h: HalfedgeId| quarters[self.side[h].unsigned_abs() as usize - 1].rem_euclid(4);
            let turns = if self.side[h] >= 0 { 0 } else { turn(h) + 2 };
            OpenedSide { vector: number[h.edge().index()], turns }
        };
        let sides: Vec<OpenedSide> = boundary.iter().map(side).collect();
        let corners: Vec<u32> = boundary.iter().map(|&h| self.corner_index[h]).collect();
        let is_solved = straighten(&mut vectors, &free, &sides, &corners, classes);
        let vector = |side: &OpenedSide| turned(vectors[side.vector], side.turns);
        Ok(is_solved.then(|| sides.iter().map(vector).collect()))
    }

    /// The rotation of each seam from its left to its right side, quarter turns.
    fn quarter_turns(&self) -> Result<Vec<i32>> {
        if self.space != Space::E2 {
            return Err(Error::Layout("exact seams are those of a layout in the plane".into()));
        }
        let quarters = |(k, rotation): (usize, f64)| {
            let turns = (rotation / FRAC_PI_2).round();
            let off = (rotation - turns * FRAC_PI_2).abs();
            if off <= ROTATION_ROUNDING {
                return Ok(turns as i32);
            }
            let message = format!("seam {k} turns by {rotation} radians, {off:.1e} off a multiple of 90°");
            Err(Error::Layout(message))
        };
        self.seams.iter().map(|seam| seam.isometry().rotation).enumerate().map(quarters).collect()
    }

    /// The half-edges of the cut and of the boundary around the opened surface, counterclockwise.
    fn cut_boundary(&self) -> Result<Vec<HalfedgeId>> {
        let mesh = self.mesh();
        let refused = |message: &str| Err(Error::Layout(message.into()));
        let is_side =
            |h: HalfedgeId| mesh.face(h).is_some() && (self.side[h] != 0 || mesh.is_outside(h.twin()));
        let Some(first) = mesh.halfedges().find(|&h| is_side(h)) else {
            return refused("the layout has no cut, so no seam to be made exact");
        };
        let mut boundary = Vec::new();
        let mut h = first;
        loop {
            boundary.push(h);
            h = mesh.next(h);
            while !is_side(h) {
                h = mesh.next(h.twin());
            }
            if h == first {
                break;
            }
        }
        if boundary.len() != mesh.halfedges().filter(|&h| is_side(h)).count() {
            return refused(
                "the opened surface has more than one boundary, so its seams cannot be made exact together",
            );
        }
        Ok(boundary)
    }

    /// An edge in units of the grid.
    fn grid_side(&self, h: HalfedgeId, unit: f64) -> GridVector {
        let [a, b] = [self.uv(h), self.uv(self.mesh().next(h))];
        [0, 1].map(|k| ((b[k] - a[k]) / unit).round() as i64)
    }

    /// An edge of the boundary in units of the grid, parallel to an axis.
    fn boundary_side(&self, h: HalfedgeId, unit: f64) -> Result<GridVector> {
        let [a, b] = [self.uv(h), self.uv(self.mesh().next(h))];
        let [x, y] = [b[0] - a[0], b[1] - a[1]];
        let (long, off) = (x.abs().max(y.abs()), x.abs().min(y.abs()));
        if off > ROTATION_ROUNDING * long {
            let message =
                format!("edge {} of the boundary is {:.1e} radians off the axes", h.edge(), off / long);
            return Err(Error::Layout(message));
        }
        let [right, up] = self.grid_side(h, unit);
        Ok(if x.abs() >= y.abs() { [right, 0] } else { [0, up] })
    }
}

/// The sides of the boundary polygon in units of the grid: those of one edge of the cut are exactly w and −iᵏ w, those of the boundary the
/// given ones (`free`) but for a few units, and all of them add up to 0.
fn closed_sides(
    layout: &Layout,
    boundary: &[HalfedgeId],
    quarters: &[i32],
    mut free: Vec<GridVector>,
    unit: f64,
) -> Result<Vec<GridVector>> {
    let mesh = layout.mesh();
    let turn = |h: HalfedgeId| quarters[layout.side[h].unsigned_abs() as usize - 1].rem_euclid(4);
    let left: Vec<HalfedgeId> = boundary.iter().copied().filter(|&h| layout.side[h] > 0).collect();
    let outer: Vec<HalfedgeId> = boundary.iter().copied().filter(|&h| layout.side[h] == 0).collect();
    let mut sides: Vec<GridVector> = left.iter().map(|&h| layout.grid_side(h, unit)).collect();
    let seams: Vec<i32> = left.iter().map(|&h| turn(h)).collect();
    let off = sides.iter().zip(&seams).fold([0; 2], |sum, (&w, &k)| add(sum, sub(w, turned(w, k))));
    close(&mut sides, &seams, &mut free, off)?;
    let mut of_edge = vec![[0; 2]; mesh.n_edges()];
    left.iter().zip(&sides).for_each(|(h, &w)| of_edge[h.edge().index()] = w);
    outer.iter().zip(&free).for_each(|(h, &w)| of_edge[h.edge().index()] = w);
    let side = |&h: &HalfedgeId| {
        let w = of_edge[h.edge().index()];
        if layout.side[h] >= 0 { w } else { turned(w, turn(h) + 2) }
    };
    Ok(boundary.iter().map(side).collect())
}

/// Changes sides such that all add up to 0: those of the boundary, along axes along which they have a part, by what they can take up, and one of
/// the seams by the rest. `off`: the sum of the seams' sides.
fn close(sides: &mut [GridVector], turns: &[i32], free: &mut [GridVector], off: GridVector) -> Result<()> {
    let mut off = free.iter().fold(off, |sum, &w| add(sum, w));
    // The longest side of the boundary along each axis.
    let longest =
        |axis: usize| (0..free.len()).filter(|&k| free[k][axis] != 0).max_by_key(|&k| free[k][axis].abs());
    let takers = [longest(0), longest(1)];
    let rest = [0, 1].map(|axis: usize| if takers[axis].is_some() { 0 } else { off[axis] });
    if rest != [0; 2] {
        // 1 − iᵏ divides what the sum is off if k is odd, and if no k is odd. Beside a boundary an odd k leaves something along its axis.
        let size = |k: usize| sides[k].iter().map(|x| (*x as f64).powi(2)).sum::<f64>();
        let rank = |k: usize| (turns[k] % 2, turns[k] != 0);
        let order = |a: &usize, b: &usize| rank(*a).cmp(&rank(*b)).then(size(*a).total_cmp(&size(*b)));
        let chosen = (0..sides.len()).max_by(order);
        let correction = chosen.and_then(|k| {
            let whole = divided(rest, turns[k]);
            let beside = || takers.iter().any(Option::is_some) && turns[k] % 2 != 0;
            Some((
                k,
                whole.or_else(|| beside().then_some(if turns[k] == 1 { turned(rest, 1) } else { rest }))?,
            ))
        });
        let Some((k, correction)) = correction else {
            return Err(Error::Layout("the sides of the cut do not close, though no seam turns".into()));
        };
        sides[k] = sub(sides[k], correction);
        off = sub(off, sub(correction, turned(correction, turns[k])));
    }
    for axis in 0..2 {
        if let Some(k) = takers[axis] {
            free[k][axis] -= off[axis];
        }
    }
    Ok(())
}

fn add(a: GridVector, b: GridVector) -> GridVector {
    [a[0] + b[0], a[1] + b[1]]
}

fn sub(a: GridVector, b: GridVector) -> GridVector {
    [a[0] - b[0], a[1] - b[1]]
}

/// z / (1 − iᵏ), if that is a Gaussian integer.
fn divided(z: GridVector, k: i32) -> Option<GridVector> {
    let [x, y] = z;
    let halves = match k.rem_euclid(4) {
        // 1/(1 − i) = (1 + i)/2, 1/(1 + i) = (1 − i)/2.
        1 => add(z, turned(z, 1)),
        2 => [x, y],
        3 => add(z, turned(z, 3)),
        _ => return None,
    };
    (halves.iter().all(|x| x % 2 == 0)).then(|| halves.map(|x| x / 2))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quotients_are_undone_by_products() {
        for k in 1..4 {
            for z in [[3, -5], [0, 1], [7, 2]] {
                let product = sub(z, turned(z, k));
                assert_eq!(divided(product, k), Some(z));
            }
        }
        assert_eq!(divided([1, 0], 1), None);
    }
}
