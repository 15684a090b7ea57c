//! The angles between the normals of neighbouring patches.

use super::layout::PatchCorner;
use super::spline::QuadSpline;
use crate::geometry::vector::{cross, dot, norm};
use crate::spline::bicubic::BicubicPatch;

/// Parts of an arc at whose ends normals are compared.
const PARTS: usize = 20;

impl QuadSpline {
    /// The largest angle between the normals on both sides of an arc that is no crease, radians; at 21 places of every arc. Places at which a
    /// side has no normal are left out.
    pub fn normal_jump(&self) -> f64 {
        let layout = self.space().layout();
        let smooth = (0..layout.arcs().len()).filter(|&arc| !layout.arcs()[arc].is_crease);
        let sides = smooth.filter_map(|arc| match layout.beside(arc) {
            [Some(left), Some(right)] => Some([left, right]),
            _ => None,
        });
        sides.map(|sides| self.jump_between(sides)).fold(0.0, f64::max)
    }

    fn jump_between(&self, [left, right]: [PatchCorner; 2]) -> f64 {
        let angle = |k: usize| {
            let x = k as f64 / PARTS as f64;
            let [n, m] = [self.normal_on(left, x)?, self.normal_on(right, 1.0 - x)?];
            Some(norm(cross(n, m)).atan2(dot(n, m)))
        };
        (0..=PARTS).filter_map(angle).fold(0.0, f64::max)
    }

    /// The normal at a share of the way along a side.
    fn normal_on(&self, side: PatchCorner, x: f64) -> Option<[f64; 3]> {
        self.at(side.patch, BicubicPatch::on_side(side.corner, x)).normal()
    }
}
