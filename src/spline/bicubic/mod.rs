//! Bicubic patches near a spline, for CAD: three for each triangle, with sides that neighbours have in common to the last bit.
//!
//! A triangle is divided into three quadrilaterals, each between a corner, the middles of two sides and the centroid. In its own
//! coordinates a quadrilateral is a C² bicubic over clamped knots that interpolates the spline at the ends of its spans. Derivatives along
//! its rim are difference quotients of the spline, projected to tangent planes that neighbours have in common. The curve of a side is made
//! once, from points of the side, and both neighbours have its control points; so have corners.
//!
//! Opposite sides of a quadrilateral have equally many spans, so the number of spans goes on from quadrilateral to quadrilateral around a
//! vertex of the triangles. Each vertex therefore has a number of its own: in the quadrilateral at corner a, the spans along the half side
//! towards b are the number of b. So patches can be refined where they miss the spline, and still match along all sides.
//!
//! The exact way, three patches of bidegree (n, n) for each polynomial, works for Bézier triangles only: `docs/results/splines-step.md`.

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
pub use outcome::{BicubicFit, BicubicOptions};
pub use surface::{BicubicPatch, BicubicSurface, PatchCurve, PatchSide};
