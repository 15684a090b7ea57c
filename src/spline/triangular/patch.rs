//! The patches of a spline, and places in them.

use super::index::position;

/// The identity as an affine map.
pub(super) const IDENTITY: [[f64; 3]; 2] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];

/// Share of a patch by which a place may lie outside it: rounding of coordinates that were computed elsewhere.
pub(super) const OUTSIDE: f64 = 1e-9;

/// One triangle of a spline, with its knots and the numbers of its control points.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "json", derive(serde::Serialize, serde::Deserialize))]
pub struct Patch {
    /// The chart in whose coordinates the knots are.
    pub chart: u32,
    /// The knots t_{k,j} of corner k, j = 0 … n; the first is the corner itself. Corners are counterclockwise.
    pub knots: [Vec<[f64; 2]>; 3],
    /// The control point of each basis function, in the order of [`super::multi_indices`].
    pub control: Vec<u32>,
}

impl Patch {
    /// The corners, counterclockwise in the chart of the patch.
    pub fn corners(&self) -> [[f64; 2]; 3] {
        [0, 1, 2].map(|k| self.knots[k][0])
    }

    /// The control points along side k, from corner k to the next.
    pub(super) fn along(&self, k: usize) -> Vec<u32> {
        let degree = self.knots[k].len() - 1;
        let control = |i: usize| {
            let mut beta = [0; 3];
            (beta[k], beta[(k + 1) % 3]) = (degree - i, i);
            self.control[position(beta)]
        };
        (0..=degree).map(control).collect()
    }
}

/// A patch with basis functions that do not vanish on another patch, or on its boundary.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "json", derive(serde::Serialize, serde::Deserialize))]
pub struct Support {
    /// The patch with the basis functions.
    pub patch: u32,
    /// The affine map from its chart to that of the other patch, by rows: `x' = to[0] · (x, y, 1)`.
    pub to: [[f64; 3]; 2],
}

/// A place in a patch, in the coordinates of its chart.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Parameter {
    /// The patch; numbers after those of the patches are the charts of holes, see [`super::Hole::chart`].
    pub patch: u32,
    /// Abscissa.
    pub x: f64,
    /// Ordinate.
    pub y: f64,
}
