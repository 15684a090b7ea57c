//! STEP files of splines over four-sided patches: a face for each patch or plane, an edge for each arc that bounds one.

use super::layout::PatchArc;
use super::quintic::{QUINTIC, knots};
use super::spline::QuadSpline;
use crate::error::Result;
use crate::geometry::vector::diagonal;
use crate::mesh::union_find::UnionFind;
use crate::spline::step::{
    StepCurve, StepCurveGeometry, StepOptions, StepPart, StepPatch, StepPatches, StepSurfaceGeometry,
};
use std::collections::BTreeMap;
use std::io::Write;

impl QuadSpline {
    /// Writes the patches as STEP AP242; those that lie in one plane and meet as one face of it. Each part that closes up becomes a solid with outward normals; the others become shells of one
    /// surface model. Common sides are common edges with common control points. The same spline gives the same bytes.
    ///
    /// # Errors
    /// [`crate::Error::Spline`] for control points that are not finite; [`crate::Error::Io`], without a path, if writing to `out` fails.
    pub fn write_step(&self, options: &StepOptions, out: &mut impl Write) -> Result<()> {
        self.with_step_patches(|patches| patches.write(options, out))?
    }

    /// The number of faces that [`QuadSpline::write_step`] writes: one for each patch, but patches that lie in one plane and meet are one.
    ///
    /// # Errors
    /// [`crate::Error::Spline`].
    pub fn n_step_faces(&self) -> Result<usize> {
        self.with_step_patches(|patches| patches.n_faces())
    }

    fn with_step_patches<T>(&self, use_them: impl FnOnce(&StepPatches<'_>) -> T) -> Result<T> {
        let layout = self.space().layout();
        let mut points = vec![[0.0; 3]; layout.n_nodes()];
        layout.corners().for_each(|at| points[layout.node(at) as usize] = self.side_points(at)[0]);
        let mut curves = Vec::with_capacity(layout.arcs().len());
        for (arc, PatchArc { ends, is_crease, .. }) in layout.arcs().iter().enumerate() {
            let curve = StepCurveGeometry {
                degree: QUINTIC,
                knots: knots(self.space().spans()[arc]),
                control_points: self.arc_control_points(arc)?,
            };
            curves.push(StepCurve { ends: *ends, is_crease: *is_crease, curve });
        }
        let patch = |at: usize| StepPatch {
            surface: StepSurfaceGeometry {
                degree: QUINTIC,
                knots: self.knots(at),
                control_points: self.net(at),
            },
            sides: layout.patches()[at].map(|side| (side.arc as usize, side.reversed)),
        };
        let patches = StepPatches {
            points: &points,
            curves,
            patches: (0..layout.patches().len()).map(patch).collect(),
            parts: self.parts(),
            diagonal: diagonal(self.control_points()),
            planes: true,
        };
        Ok(use_them(&patches))
    }

    /// The connected parts of the surface.
    fn parts(&self) -> Vec<StepPart> {
        let layout = self.space().layout();
        let mut same = UnionFind::new(layout.patches().len());
        for arc in 0..layout.arcs().len() {
            if let [Some(left), Some(right)] = layout.beside(arc) {
                _ = same.join(left.patch as u32, right.patch as u32);
            }
        }
        let mut parts: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
        (0..layout.patches().len()).for_each(|p| parts.entry(same.root(p as u32)).or_default().push(p));
        let part = |patches: Vec<usize>| {
            let mut sides = patches.iter().flat_map(|&p| layout.patches()[p]);
            let is_closed = sides.all(|side| !layout.beside(side.arc as usize).contains(&None));
            StepPart { is_closed, is_inverted: is_closed && self.volume_of(&patches) < 0.0, patches }
        };
        parts.into_values().map(part).collect()
    }
}
