//! Surfaces of bicubic patches that share curves and points.

use super::cubic::{DEGREE, LOCAL, basis, combined, curve_at};
use crate::error::{Error, Result};
use crate::geometry::vector::{Vector, cross, diagonal, dot};
use crate::mesh::union_find::UnionFind;
use crate::spline::triangular::SurfacePoint;

/// A cubic B-spline curve over [0, 1]: a side of one patch or of two.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "json", derive(serde::Serialize, serde::Deserialize))]
pub struct PatchCurve {
    /// The numbers in [`BicubicSurface::points`] of the points at which the curve begins and ends: its first and last control point.
    pub ends: [u32; 2],
    /// Clamped knots: 0 four times, then ascending, then 1 four times.
    pub knots: Vec<f64>,
    /// The control points, four fewer than knots.
    pub control: Vec<Vector>,
}

/// A side of a patch.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "json", derive(serde::Serialize, serde::Deserialize))]
pub struct PatchSide {
    /// The number of its curve in [`BicubicSurface::curves`].
    pub curve: u32,
    /// True if the curve runs against the way around the patch.
    pub reversed: bool,
}

/// A bicubic B-spline patch over [0, 1]²; its normal is ∂s × ∂t.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "json", derive(serde::Serialize, serde::Deserialize))]
pub struct BicubicPatch {
    /// The triangular patch of the spline that was cut into three, and the corner of it where this third lies. Numbers from that of the patches
    /// on are those of the triangles that close a sphere's spline around the point at infinity.
    pub source: (u32, usize),
    /// The clamped knots in s and in t.
    pub knots: [Vec<f64>; 2],
    /// The control points `control[i][j]`, i along s, j along t.
    pub control: Vec<Vec<Vector>>,
    /// The sides along the way around (0, 0), (1, 0), (1, 1), (0, 1). The control points of a side are those of its curve, bit for bit.
    pub sides: [PatchSide; 4],
}

/// Bicubic patches that meet along common curves.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct BicubicSurface {
    /// The points at which curves end.
    pub points: Vec<Vector>,
    /// The curves, each once.
    pub curves: Vec<PatchCurve>,
    /// The patches.
    pub patches: Vec<BicubicPatch>,
}

impl PatchCurve {
    /// The point at x from 0 to 1, with first and second derivative.
    pub fn evaluate(&self, x: f64) -> [Vector; 3] {
        curve_at(&self.knots, &self.control, x)
    }
}

impl BicubicPatch {
    /// The point at (s, t), from 0 to 1 each, with first and second derivatives by s and t.
    pub fn evaluate(&self, [s, t]: [f64; 2]) -> SurfacePoint {
        let [(i, along_s), (j, along_t)] = [basis(&self.knots[0], s), basis(&self.knots[1], t)];
        let at = |of_s: usize, of_t: usize| {
            combined(&along_s[of_s], |k| combined(&along_t[of_t], |l| self.control[i + k][j + l]))
        };
        SurfacePoint { point: at(0, 0), first: [at(1, 0), at(0, 1)], second: [at(2, 0), at(1, 1), at(0, 2)] }
    }

    /// The parameters (s, t) of the point at a share of the way along a side, in the direction around the patch.
    pub fn on_side(side: usize, x: f64) -> [f64; 2] {
        [[x, 0.0], [1.0, x], [1.0 - x, 1.0], [0.0, 1.0 - x]][side % 4]
    }

    /// The knots and control points of a side, along the way around or `reversed`.
    pub fn boundary(&self, side: usize, reversed: bool) -> (Vec<f64>, Vec<Vector>) {
        let [m, n] = [self.control.len() - 1, self.control[0].len() - 1];
        let mut control: Vec<Vector> = match side % 4 {
            0 => (0..=m).map(|i| self.control[i][0]).collect(),
            1 => self.control[m].clone(),
            2 => (0..=m).map(|i| self.control[i][n]).collect(),
            _ => self.control[0].clone(),
        };
        let mut knots = self.knots[side % 2].clone();
        // Sides 2 and 3 run against their parameter.
        if (side % 4 >= 2) != reversed {
            control.reverse();
            knots = knots.iter().rev().map(|x| 1.0 - x).collect();
        }
        (knots, control)
    }

    /// Replaces the control points of a side by those of its curve.
    pub(super) fn set_side(&mut self, k: usize, curve: &PatchCurve) {
        let [m, n] = [self.control.len() - 1, self.control[0].len() - 1];
        let against = (k >= 2) != self.sides[k].reversed;
        let length = curve.control.len();
        for (i, &point) in curve.control.iter().enumerate() {
            let i = if against { length - 1 - i } else { i };
            match k {
                0 => self.control[i][0] = point,
                1 => self.control[m][i] = point,
                2 => self.control[i][n] = point,
                _ => self.control[0][i] = point,
            }
        }
    }

    /// The numbers of the points at the corners (0, 0), (1, 0), (1, 1), (0, 1).
    pub fn corners(&self, curves: &[PatchCurve]) -> [u32; 4] {
        self.sides.map(|side| curves[side.curve as usize].ends[usize::from(side.reversed)])
    }

    /// True if side k has the control points and the knots of its curve.
    fn has_curve(&self, k: usize, curves: &[PatchCurve]) -> bool {
        let PatchSide { curve, reversed } = self.sides[k];
        let PatchCurve { knots, control, .. } = &curves[curve as usize];
        let same = |a: &[f64], b: &[f64]| a.iter().map(|x| x.to_bits()).eq(b.iter().map(|x| x.to_bits()));
        let (here, points) = self.boundary(k, reversed);
        same(&here, knots) && same(points.as_flattened(), control.as_flattened())
    }
}

impl BicubicSurface {
    /// For each curve the patches that have it, each with the number of the side.
    pub fn uses(&self) -> Vec<Vec<(usize, usize)>> {
        let mut uses = vec![Vec::new(); self.curves.len()];
        for (at, patch) in self.patches.iter().enumerate() {
            patch.sides.iter().enumerate().for_each(|(k, side)| uses[side.curve as usize].push((at, k)));
        }
        uses
    }

    /// True if every curve is a side of two patches.
    pub fn is_closed(&self) -> bool {
        self.uses().iter().all(|of| of.len() == 2)
    }

    /// The connected parts, each as its patches in ascending order.
    pub fn parts(&self) -> Vec<Vec<usize>> {
        let mut sets = UnionFind::new(self.patches.len());
        for of in self.uses() {
            of.windows(2).for_each(|pair| _ = sets.join(pair[0].0 as u32, pair[1].0 as u32));
        }
        let mut parts: Vec<Vec<usize>> = vec![Vec::new(); self.patches.len()];
        (0..self.patches.len()).for_each(|at| parts[sets.root(at as u32) as usize].push(at));
        parts.retain(|part| !part.is_empty());
        parts
    }

    /// The diagonal of the bounding box of the points at which curves end.
    pub fn diagonal(&self) -> f64 {
        diagonal(&self.points)
    }

    /// The number of control points of all patches; those of common sides count once for each patch.
    pub fn n_control_points(&self) -> usize {
        self.patches.iter().flat_map(|patch| &patch.control).map(Vec::len).sum()
    }

    /// The number of sides of patches whose knots or control points are not bit for bit those of their curve; 0 if the surface is watertight.
    pub fn open_sides(&self) -> usize {
        let open = |patch: &BicubicPatch| (0..4).filter(|&k| !patch.has_curve(k, &self.curves)).count();
        self.patches.iter().map(open).sum()
    }

    /// About the signed volume inside some patches that close up: that of the polyhedron of their nets of control points; positive if normals
    /// point outwards.
    pub fn volume(&self, part: &[usize]) -> f64 {
        let sixfold = |[a, b, c]: [Vector; 3]| dot(a, cross(b, c));
        let cells = |patch: &BicubicPatch| {
            let rows = patch.control.windows(2);
            rows.flat_map(|two| {
                (1..two[0].len()).map(|j| {
                    let [a, b, c, d] = [two[0][j - 1], two[1][j - 1], two[1][j], two[0][j]];
                    sixfold([a, b, c]) + sixfold([a, c, d])
                })
            })
            .sum::<f64>()
        };
        part.iter().map(|&at| cells(&self.patches[at])).sum::<f64>() / 6.0
    }

    /// Checks that numbers fit together, everything is finite, knots are clamped, neighbours have the same orientation, and sides are their
    /// curves bit for bit.
    ///
    /// # Errors
    /// [`Error::Spline`], which names the curve or patch.
    pub fn check(&self) -> Result<()> {
        let refuse = |what, index, message: &str| Err(Error::Spline { what, index, message: message.into() });
        for (at, curve) in self.curves.iter().enumerate() {
            if let Some(message) = self.fault_of_curve(curve) {
                return refuse("curve", at, message);
            }
        }
        for (at, patch) in self.patches.iter().enumerate() {
            if let Some(message) = self.fault_of_patch(patch) {
                return refuse("bicubic patch", at, message);
            }
        }
        for (at, of) in self.uses().iter().enumerate() {
            let reversed = |&(patch, k): &(usize, usize)| self.patches[patch].sides[k].reversed;
            match of[..] {
                [_] => {}
                [a, b] if reversed(&a) != reversed(&b) => {}
                [_, _] => return refuse("curve", at, "its two patches are turned against each other"),
                _ => return refuse("curve", at, "it is the side of no patch, or of more than two"),
            }
        }
        Ok(())
    }

    fn fault_of_curve(&self, PatchCurve { ends, knots, control }: &PatchCurve) -> Option<&'static str> {
        let ends = ends.map(|p| self.points.get(p as usize));
        if !are_clamped(knots) || knots.len() != control.len() + LOCAL {
            return Some("its knots are not clamped on [0, 1], or not four more than its control points");
        }
        if !control.as_flattened().iter().all(|x| x.is_finite()) {
            return Some("a control point is no finite number");
        }
        (ends != [control.first(), control.last()]).then_some("it does not end at the points that it names")
    }

    fn fault_of_patch(&self, patch: &BicubicPatch) -> Option<&'static str> {
        let sizes = [patch.control.len(), patch.control.first().map_or(0, Vec::len)];
        let fits = |x: usize| are_clamped(&patch.knots[x]) && patch.knots[x].len() == sizes[x] + LOCAL;
        if !(fits(0) && fits(1)) || patch.control.iter().any(|row| row.len() != sizes[1]) {
            return Some("its knots are not clamped on [0, 1], or do not fit its control points");
        }
        if !patch.control.iter().flatten().flatten().all(|x| x.is_finite()) {
            return Some("a control point is no finite number");
        }
        if patch.sides.iter().any(|side| side.curve as usize >= self.curves.len()) {
            return Some("a curve of its sides does not exist");
        }
        let begins = patch.corners(&self.curves);
        let end =
            |k: usize| self.curves[patch.sides[k].curve as usize].ends[usize::from(!patch.sides[k].reversed)];
        if (0..4).any(|k| end(k) != begins[(k + 1) % 4]) {
            return Some("its sides do not follow each other");
        }
        let is_open = (0..4).any(|k| !patch.has_curve(k, &self.curves));
        is_open.then_some("the control points or knots of a side are not those of its curve")
    }
}

fn are_clamped(knots: &[f64]) -> bool {
    let n = knots.len();
    n >= 2 * LOCAL
        && knots[..LOCAL] == [0.0; LOCAL]
        && knots[n - LOCAL..] == [1.0; LOCAL]
        && knots[DEGREE..=n - LOCAL].windows(2).all(|w| w[0] < w[1])
}
