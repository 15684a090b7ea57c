//! Layouts cut into charts that do not overlap, packed into the unit square.

use crate::arrays::copy_out;
use crate::control::{self, ricci_control};
use crate::failure::Outcome;
use crate::guard::{self, Poison, handle};
use crate::layout::{not_projective, ricci_layout};
use crate::sized::{self, sized};
use crate::status::ricci_status;
use ricci::embed::{ChartOptions, Charts, Layout, charts};
use ricci::flow::Solution;
use ricci::geometry::Space;
use ricci::mesh::Point;
use std::sync::Arc;

/// A layout in charts that do not overlap, packed into the unit square.
pub struct ricci_charts {
    poison: Poison,
    pub(crate) charts: Charts,
    /// What was cut into charts, and the positions of its vertices.
    pub(crate) layout: Arc<Layout>,
    pub(crate) positions: Option<Arc<Vec<Point>>>,
    pub(crate) surface: Arc<Solution>,
}

handle!(ricci_charts, "charts");

/// Figures of charts.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_charts_summary {
    /// Bytes of this struct that are filled.
    pub size: usize,
    /// Number of charts.
    pub n_charts: usize,
    /// F.
    pub n_faces: usize,
    /// Number of points in the unit square.
    pub n_points: usize,
    /// Faces that are clockwise by more than rounding, each a chart of its own.
    pub n_flipped: usize,
    /// Lengths in the unit square over lengths in the layout, the same for all charts.
    pub scale: f64,
    /// Share of the unit square that is covered.
    pub efficiency: f64,
    /// Total length of the layout's seams, in its units.
    pub layout_seams: f64,
    /// Total length of the charts' seams, in units of the layout.
    pub chart_seams: f64,
    /// Faces without area beyond rounding, in the layout or in the unit square; they lie in the charts of their neighbours, and
    /// are left out where it says that none overlap.
    pub n_degenerate: usize,
}

// SAFETY: only ever written by the library; 8-byte alignment, size first.
sized!(ricci_charts_summary, "summary");

/// Cut a layout into charts and pack them into the unit square.
///
/// Every chart is connected, and no two faces overlap (decided exactly, in the layout's coordinates and in those of the charts),
/// save degenerate ones. Charts are turned and moved, and all scaled by one factor. An injective layout is one chart.
/// Deterministic.
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT (margin), RICCI_LAYOUT (no area), RICCI_CANCELLED.
///
/// @param layout   the layout.
/// @param margin   least distance of two charts, in sides of the unit square, from 0 to below 1; 1/256 is usual.
/// @param control  progress and cancellation; NULL for neither.
/// @param charts   out: the new handle, to be released by ricci_charts_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_charts_new(
    layout: *const ricci_layout,
    margin: f64,
    control: *const ricci_control,
    charts: *mut *mut ricci_charts,
) -> ricci_status {
    guard::make("charts", charts, |door| {
        let ricci_layout { layout, positions, points, surface, .. } = door.shared(layout)?;
        let uv = |h| points[layout.corner_index[h] as usize];
        let charts = self::charts(layout.mesh(), uv, &ChartOptions { margin }, &control::of(control))?;
        Ok(ricci_charts {
            poison: Poison::default(),
            charts,
            layout: layout.clone(),
            positions: positions.clone(),
            surface: surface.clone(),
        })
    })
}

/// Release charts.
///
/// @param charts  the handle, or NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_charts_free(charts: *mut ricci_charts) {
    guard::free(charts);
}

/// The figures of charts.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE.
///
/// @param charts   the charts.
/// @param summary  out: the figures.
/// @param size     sizeof *summary.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_charts_summarise(
    charts: *const ricci_charts,
    summary: *mut ricci_charts_summary,
    size: usize,
) -> ricci_status {
    guard::with(charts, |ricci_charts { layout, charts, .. }| {
        let figures = ricci_charts_summary {
            size,
            n_charts: charts.count(),
            n_faces: layout.mesh().n_faces(),
            n_points: charts.coordinates.len(),
            n_flipped: charts.flipped.len(),
            scale: charts.scale,
            efficiency: charts.efficiency,
            layout_seams: charts.seam_length[0],
            chart_seams: charts.seam_length[1],
            n_degenerate: charts.degenerate.len(),
        };
        sized::write(figures, summary, size)
    })
}

/// The chart of every face, from 0; charts with more area come first.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
///
/// @param charts    the charts.
/// @param chart     out: n_faces chart numbers.
/// @param capacity  entries of `chart`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_charts_faces(
    charts: *const ricci_charts,
    chart: *mut u32,
    capacity: usize,
) -> ricci_status {
    guard::with(charts, |charts| copy_out("chart", &charts.charts.chart, chart, capacity))
}

/// The points of the charts, in the unit square.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
///
/// @param charts    the charts.
/// @param points    out: n_points x 2, from 0 to 1.
/// @param capacity  entries of `points`, at least 2 n_points.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_charts_points(
    charts: *const ricci_charts,
    points: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(charts, |charts| copy_out("points", &charts.charts.coordinates, points, capacity))
}

/// The point of every corner of every face: as OBJ's `vt` indices, but 0-based.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
///
/// @param charts    the charts.
/// @param corners   out: n_faces x 3 indices of points.
/// @param capacity  entries of `corners`, at least 3 n_faces.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_charts_corners(
    charts: *const ricci_charts,
    corners: *mut u32,
    capacity: usize,
) -> ricci_status {
    guard::with(charts, |charts| copy_out("corners", &charts.corners(), corners, capacity))
}

impl ricci_charts {
    /// The layout is one in the plane.
    pub(crate) fn check_plane(&self) -> Outcome {
        if self.layout.space == Space::E2 { Ok(()) } else { Err(not_projective()) }
    }

    pub(crate) fn corners(&self) -> Vec<[u32; 3]> {
        let (mesh, index) = (self.layout.mesh(), &self.charts.corner_index);
        mesh.faces().map(|f| mesh.face_halfedges(f).map(|h| index[h])).collect()
    }
}
