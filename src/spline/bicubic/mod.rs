//! Bicubic patches near a spline, for CAD: three to a triangle, with sides that neighbours have in common to the last bit.
//!
//! Each triangle becomes three quadrilaterals, from a corner over the middles of its sides to the centroid. In its own coordinates a
//! quadrilateral is a C² bicubic over clamped knots that interpolates the spline at the ends of its spans; derivatives along its rim are
//! difference quotients of the spline, turned into tangent planes that neighbours have in common. A side's curve is made once, from the
//! side's own points, and both neighbours have its control points; corners likewise.
//!
//! Spans go on across opposite sides of quadrilaterals, and so around one vertex of the triangles: quadrilaterals between the vertices a
//! and b of a side have as many spans along it near a as b asks for. So every vertex has a number of its own, and the patches are refined
//! where they miss the spline without a seam anywhere.
//!
//! The exact way, three patches of bidegree (n, n) for each polynomial, is open to Bézier triangles alone: `docs/results/splines-step.md`.

mod angles;
mod cubic;
#[cfg(feature = "json")]
mod file;
mod fit;
mod net;
mod outcome;
mod patch_quad;
mod quad;
mod refine;
mod sample;
mod split;
#[cfg(feature = "step")]
mod step;
mod surface;
mod tangents;

pub use angles::NormalAngles;
pub use outcome::{Bicubic, BicubicOptions};
#[cfg(feature = "step")]
pub use step::{LengthUnit, StepOptions};
pub use surface::{BicubicPatch, BicubicSurface, PatchCurve, PatchSide};
