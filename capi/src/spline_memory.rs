//! The bytes that calls about splines take, for their reserves; measured as those of `memory` were.

use ricci::spline::MAX_DEGREE;

/// Most bytes per evaluated point of a spline: 448 with its derivatives.
pub const POINT: usize = 1 << 9;
/// Most bytes per face of a tessellation, beside the points that are evaluated at a time: 144 with them were measured for a million faces, of which
/// 65,536 points were evaluated at a time, and 196 for a quarter of a million.
const FACE: usize = 1 << 8;
/// Most points of a tessellation that are evaluated at a time.
const EVALUATED: usize = 1 << 14;
/// Most bytes per point and per control point of a fit: 2,980 of degree 5.
pub const FIT: usize = 1 << 12;
/// Most bytes per byte of a spline's file while it is read: 29 of degree 5.
pub const TEXT: usize = 1 << 5;
/// Most bytes per patch while the text of a spline is made: 8,430 of degree 5.
pub const SPLINE_TEXT: usize = 1 << 14;
/// Most bytes per patch of a spline while bicubic patches are made, beside the evaluated points: 13,400 with 8 spans a side.
pub const BICUBIC: usize = 1 << 14;
/// Most bytes per control point of bicubic patches while their text is made: 520 as STEP.
pub const BICUBIC_TEXT: usize = 1 << 10;

/// Most bytes per vertex and quad for what a spline over a quad layout is fitted to: 1,970 with all that the fit took over 18 patches of one span.
#[cfg(feature = "quads")]
pub const QUAD_TARGET: usize = 1 << 12;
/// Most bytes per pole for the fit itself, mostly for the factor of its matrix: 44,900 with 42 patches of 3 × 3 spans, 49,500 with 6.
#[cfg(feature = "quads")]
pub const QUAD_FIT: usize = 1 << 16;
/// Most bytes per control point for the search structure of a spline over a quad layout: 310 over 42 patches of up to 3 × 3 spans.
#[cfg(feature = "quads")]
pub const QUAD_CELLS: usize = 1 << 12;

/// Most bytes per patch of a spline of this degree: 4,700 of degree 1 to 68,800 of degree 5 were measured.
pub fn patch(degree: usize) -> usize {
    1 << (12 + degree.min(MAX_DEGREE))
}

/// Most bytes for a tessellation with this number of faces.
pub fn tessellation(faces: usize) -> usize {
    faces.saturating_mul(FACE).saturating_add(faces.saturating_mul(3).min(EVALUATED) * POINT)
}
