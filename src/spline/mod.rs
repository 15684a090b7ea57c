//! Triangular B-splines: piecewise polynomial surfaces over triangles, as smooth as their degree allows, on the plane or on a surface
//! with an affine atlas [DMS92; Sei91; GHQ06].
//!
//! `triangular` has the splines themselves, `surface_fit` their domains on flat metrics of whole surfaces and the fits over these, `bicubic`
//! the tensor-product patches that CAD programs read. `quad` has splines over layouts of four-sided patches.

mod batches;
mod bicubic;
mod cylinder;
mod quad;
#[cfg(feature = "step")]
mod step;
mod surface_fit;
mod triangular;

pub use bicubic::{
    BicubicFit, BicubicOptions, BicubicPatch, BicubicSurface, NormalAngles, PatchCurve, PatchSide,
};
pub use quad::{
    ArcSide, BezierExtraction, ExtractionMatrix, FitDistances, NearestPlace, NearestPlaces, PatchArc,
    PatchCorner, PatchLayout, PatchPlace, QUINTIC, QuadFit, QuadFitOptions, QuadSpline, QuadSplineSpace,
    SplineTarget, TessellationSize, bilinear, fit_quads,
};
#[cfg(feature = "quads")]
pub use quad::{
    ControlMesh, ControlMeshFit, FewPatchesOptions, LayoutFit, LayoutFitOptions, fit_control_mesh,
    fit_few_patches, fit_quad_layout,
};
#[cfg(feature = "step")]
pub use step::{LengthUnit, StepOptions};
pub use surface_fit::{
    CoarseTriangulation, FitCondition, FitFailure, FlatMetric, FlatMetricOptions, SingularVertices,
    SurfaceDomain, SurfaceFit, SurfaceFitOptions, fit_surface, fit_surface_over, flat_curvatures,
};
pub use triangular::{
    ClosestPoint, ClosestPoints, Fill, FitOptions, Hole, Identities, KnotOptions, Locator, MAX_DEGREE,
    Parameter, Patch, PlacedPoints, PlaneDomain, Polynomial, SPREAD, Sector, Spline, SplineFit, SplineSpace,
    Support, SurfacePoint, basis_size, fit, fit_filled, monomials, multi_indices, simplex_spline,
    simplex_spline_gradient, triangulate,
};
