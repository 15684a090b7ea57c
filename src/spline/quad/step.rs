//! STEP files of splines over four-sided patches: a face for each patch, on a cylinder where it lies on one, or plane, an edge for each arc that bounds one.

use super::layout::PatchArc;
use super::quintic::{QUINTIC, knots};
use super::spline::QuadSpline;
use crate::error::Result;
use crate::geometry::vector::{add, diagonal, dot, norm, normalised};
use crate::mesh::union_find::UnionFind;
use crate::spline::cylinder::Cylinder;
use crate::spline::step::{
    PatchCylinder, StepCurve, StepCurveGeometry, StepOptions, StepPart, StepPatch, StepPatches,
    StepSurfaceGeometry,
};
use std::collections::BTreeMap;
use std::io::Write;

/// Places of a patch in each direction that lie on the cylinder that is written in its place, the distance within which they do, over the
/// diagonal, and the least cosine of the angle between normals.
const PLACES_ON_CYLINDER: usize = 9;
const ON_CYLINDER: f64 = 1e-6;
const ALONG: f64 = 0.999;
/// The least part of the radius to which the mean of the directions from the axis comes: patches that go farther around stay splines.
const LEAST_MIDDLE: f64 = 0.3;

impl QuadSpline {
    /// Writes the patches as STEP AP242; those that lie in one plane and meet as one face of it, and those that lie on a cylinder as faces of
    /// it. Each part that closes up becomes a solid with outward normals; the others become shells of one
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
        let diagonal = diagonal(self.control_points());
        let patch = |at: usize| StepPatch {
            cylinder: self.cylinder_of(at, diagonal),
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
            diagonal,
            planes: true,
        };
        Ok(use_them(&patches))
    }

    /// The cylinder on which a patch lies.
    fn cylinder_of(&self, patch: usize, diagonal: f64) -> Option<PatchCylinder> {
        let place = |k: usize| k as f64 / (PLACES_ON_CYLINDER - 1) as f64;
        let of_place = |k: usize| {
            let [u, v] = [place(k / PLACES_ON_CYLINDER), place(k % PLACES_ON_CYLINDER)];
            let at = self.at(patch, [u, v]);
            at.normal().map(|normal| (at.point, (normal, 1.0)))
        };
        let all: Option<Vec<_>> = (0..PLACES_ON_CYLINDER * PLACES_ON_CYLINDER).map(of_place).collect();
        let (points, normals): (Vec<_>, Vec<_>) = all?.into_iter().unzip();
        let cylinder = Cylinder::near(&points, &normals)?;
        let is_on = points.iter().all(|&p| cylinder.distance(p).abs() <= ON_CYLINDER * diagonal);
        let cosines = points.iter().zip(&normals).map(|(&p, (n, _))| dot(normalised(cylinder.radial(p)), *n));
        let cosines: Vec<f64> = cosines.collect();
        let is_hollow = cosines[0] < 0.0;
        let is_along = cosines.iter().all(|cosine| cosine.abs() > ALONG && (*cosine < 0.0) == is_hollow);
        let sum = points.iter().map(|&p| cylinder.radial(p)).fold([0.0; 3], add);
        let is_half_or_less = norm(sum) > LEAST_MIDDLE * cylinder.radius * points.len() as f64;
        let fits = is_on && is_along && is_half_or_less && cylinder.radius <= diagonal;
        fits.then(|| PatchCylinder { cylinder, middle: normalised(sum), is_hollow })
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
