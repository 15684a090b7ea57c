//! Splines over layouts of four-sided patches: degree 5 in both directions, tangent planes continuous across all arcs but creases.
//!
//! Across an arc with derivatives `p_v` and `q_v` into its patches and `p_u` along it the condition is `p_v + q_v = γ(u) p_u`, where γ is 2 cos of
//! the angle between neighbouring arcs at either end, and vanishes to second order towards nodes with four arcs. These equations are linear
//! in the control points and the same for every shape: they are solved once, and all splines over a layout are combinations of free control
//! points.
//!
//! ```
//! use ricci::spline::{PatchLayout, QuadSplineSpace};
//! let cube = [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]];
//! let space = QuadSplineSpace::new(PatchLayout::from_quads(8, &cube, &[])?, 1)?;
//! assert_eq!((space.dimension(), space.n_control_points()), (96, 152));
//! # Ok::<(), ricci::Error>(())
//! ```

mod bezier;
mod closest;
#[cfg(feature = "quads")]
mod control_mesh;
mod descent;
mod elimination;
mod extraction;
#[cfg(feature = "quads")]
mod few_patches;
#[cfg(feature = "json")]
mod file;
mod fit;
#[cfg(feature = "quads")]
mod fitted_surface;
mod gluing;
mod jumps;
mod layout;
mod nearest;
mod noise;
#[cfg(feature = "quads")]
mod over_control_mesh;
#[cfg(feature = "quads")]
mod over_quads;
#[cfg(feature = "quads")]
mod patch_grid;
mod patch_sum;
mod patch_unknowns;
mod piece_form;
mod places;
mod quintic;
#[cfg(feature = "quads")]
mod relaxed_quads;
mod space;
mod span_direction;
mod spline;
#[cfg(feature = "step")]
mod step;
mod system;
mod target;
mod tessellate;
mod volume;

pub use bezier::BezierExtraction;
pub use closest::{NearestPlace, NearestPlaces};
#[cfg(feature = "quads")]
pub use control_mesh::ControlMesh;
pub use extraction::ExtractionMatrix;
#[cfg(feature = "quads")]
pub use few_patches::{FewPatchesOptions, LayoutFit, fit_few_patches};
pub use fit::{FitDistances, QuadFit, QuadFitOptions, bilinear, fit_quads};
pub use layout::{ArcSide, PatchArc, PatchCorner, PatchLayout};
#[cfg(feature = "quads")]
pub use over_control_mesh::{ControlMeshFit, fit_control_mesh};
#[cfg(feature = "quads")]
pub use over_quads::{LayoutFitOptions, fit_quad_layout};
pub use places::PatchPlace;
pub use quintic::QUINTIC;
pub use space::QuadSplineSpace;
pub use spline::QuadSpline;
pub use target::SplineTarget;
pub use tessellate::TessellationSize;
