//! Patches that share curves and points, as they are written to a STEP file.

use super::geometry::{StepCurveGeometry, StepSurfaceGeometry};
use crate::geometry::vector::Vector;
use crate::spline::cylinder::Cylinder;

/// A curve as a side of a face, and true if it runs against the way around.
pub(super) type Side = (usize, bool);

/// A curve that is a side of one patch or of two.
pub(crate) struct StepCurve {
    /// The points at which it begins and ends.
    pub ends: [u32; 2],
    /// True where the surface may have an edge: the file's edge is named `crease`.
    pub is_crease: bool,
    pub curve: StepCurveGeometry,
}

/// A patch.
pub(crate) struct StepPatch {
    pub surface: StepSurfaceGeometry,
    /// The cylinder on which it lies, if it does.
    pub cylinder: Option<PatchCylinder>,
    /// Its sides along the way around: the curve of each, and true if that runs against the way.
    pub sides: [(usize, bool); 4],
}

/// The cylinder of a patch.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PatchCylinder {
    pub cylinder: Cylinder,
    /// The unit direction from the axis to the middle of the patch.
    pub middle: Vector,
    /// True if the patch has the normals that point to the axis.
    pub is_hollow: bool,
}

/// A connected part of a surface of patches.
pub(crate) struct StepPart {
    /// The numbers of its patches.
    pub patches: Vec<usize>,
    /// True if every side of its patches belongs to two of them.
    pub is_closed: bool,
    /// True if the normals of its patches point inwards.
    pub is_inverted: bool,
}

/// Patches that share curves and points.
pub(crate) struct StepPatches<'a> {
    /// The points at which curves end.
    pub points: &'a [Vector],
    pub curves: Vec<StepCurve>,
    pub patches: Vec<StepPatch>,
    pub parts: Vec<StepPart>,
    /// The diagonal of the box around the surface.
    pub diagonal: f64,
    /// True: patches whose control points lie in a plane are written as faces of it, those that meet as one.
    pub planes: bool,
}

impl StepPatches<'_> {
    /// Per curve the patches of which it is a side, each with the number of that side.
    pub(super) fn beside(&self) -> Vec<Vec<(usize, usize)>> {
        let mut beside = vec![Vec::new(); self.curves.len()];
        for (at, StepPatch { sides, .. }) in self.patches.iter().enumerate() {
            sides.iter().enumerate().for_each(|(side, &(curve, _))| beside[curve].push((at, side)));
        }
        beside
    }
}
