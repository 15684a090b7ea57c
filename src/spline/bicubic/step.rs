//! STEP files of bicubic patches.

use super::cubic::DEGREE;
use super::surface::{BicubicPatch, BicubicSurface, PatchCurve};
use crate::error::Result;
use crate::spline::step::{
    StepCurve, StepCurveGeometry, StepOptions, StepPart, StepPatch, StepPatches, StepSurfaceGeometry,
};
use std::io::Write;

impl BicubicSurface {
    /// Writes the patches as STEP AP242. Each part that closes up becomes a solid with outward normals; the others become shells of one
    /// surface model. The same patches give the same bytes.
    ///
    /// # Errors
    /// Those of [`BicubicSurface::check`]; [`crate::Error::Io`], without a path, if writing to `out` fails.
    pub fn write_step(&self, options: &StepOptions, out: &mut impl Write) -> Result<()> {
        self.check()?;
        let uses = self.uses();
        let part = |patches: Vec<usize>| {
            let mut sides = patches.iter().flat_map(|&at| &self.patches[at].sides);
            let is_closed = sides.all(|side| uses[side.curve as usize].len() == 2);
            // Normals of a solid point outwards, which its signed volume tells.
            StepPart { is_closed, is_inverted: is_closed && self.volume(&patches) < 0.0, patches }
        };
        let curve = |PatchCurve { ends, knots, control }: &PatchCurve| StepCurve {
            ends: *ends,
            is_crease: false,
            curve: StepCurveGeometry {
                degree: DEGREE,
                knots: knots.clone(),
                control_points: control.clone(),
            },
        };
        let patch = |BicubicPatch { knots, control, sides, .. }: &BicubicPatch| StepPatch {
            cylinder: None,
            surface: StepSurfaceGeometry {
                degree: DEGREE,
                knots: knots.clone(),
                control_points: control.clone(),
            },
            sides: sides.map(|side| (side.curve as usize, side.reversed)),
        };
        let patches = StepPatches {
            planes: false,
            points: &self.points,
            curves: self.curves.iter().map(curve).collect(),
            patches: self.patches.iter().map(patch).collect(),
            parts: self.parts().into_iter().map(part).collect(),
            diagonal: self.diagonal(),
        };
        patches.write(options, out)
    }
}
