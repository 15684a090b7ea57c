//! Layouts cut into charts that do not overlap, packed into the unit square.

use crate::arrays::{self, copy_each, copy_out};
use crate::control::{self, ricci_control};
use crate::failure::Failure;
use crate::guard::{self, handle, shared};
use crate::layout::{corners_of, ricci_layout};
use crate::memory;
use crate::metric::MetricState;
use crate::status::*;
use crate::structs::{self, sized};
use crate::texture::TextureFile;
use ricci::embed::{ChartOptions, Charts, Layout, charts};
use ricci::geometry::Space;
use ricci::mesh::Point;
use std::ffi::c_char;
use std::sync::Arc;

pub struct ricci_charts {
    pub(crate) state: Arc<MetricState>,
    /// The layout that was cut into charts.
    pub(crate) layout: Arc<Layout>,
    /// The positions of its vertices; none of an intrinsic surface.
    pub(crate) positions: Option<Arc<Vec<Point>>>,
    pub(crate) charts: Charts,
}
handle!(ricci_charts, "charts", |packed| packed.layout.mesh().n_vertices());

impl ricci_charts {
    /// The point of every corner of every face.
    fn corners(&self) -> Vec<[u32; 3]> {
        corners_of(self.layout.mesh(), &self.charts.corner_index)
    }
}

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_charts_summary {
    pub size: usize,
    pub n_charts: usize,
    pub n_faces: usize,
    pub n_points: usize,
    pub n_flipped: usize,
    pub n_degenerate: usize,
    pub scale: f64,
    pub efficiency: f64,
    pub layout_seams: f64,
    pub chart_seams: f64,
}
// SAFETY: numbers; 8-byte alignment, size first.
sized!(ricci_charts_summary, "summary");

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_charts_new(
    layout: *const ricci_layout,
    margin: f64,
    control: *const ricci_control,
    packed: *mut *mut ricci_charts,
) -> ricci_status {
    guard::make(packed, || {
        let handle = shared(layout)?;
        let ricci_layout { layout, points, state, .. } = handle;
        let _reserve = memory::work(layout.mesh().n_vertices(), memory::LAYOUT)?;
        let uv = |h| points[layout.corner_index[h] as usize];
        let charts = charts(layout.mesh(), uv, &ChartOptions { margin }, &control::of(control)?)?;
        let positions = handle.positions()?;
        Ok(ricci_charts { state: state.clone(), layout: layout.clone(), positions, charts })
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_charts_free(packed: *mut ricci_charts) {
    guard::free(packed);
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_charts_summarise(
    packed: *const ricci_charts,
    summary: *mut ricci_charts_summary,
    size: usize,
) -> ricci_status {
    guard::with(packed, |ricci_charts { layout, charts, .. }| {
        let figures = ricci_charts_summary {
            size,
            n_charts: charts.count(),
            n_faces: layout.mesh().n_faces(),
            n_points: charts.coordinates.len(),
            n_flipped: charts.flipped.len(),
            n_degenerate: charts.degenerate.len(),
            scale: charts.scale,
            efficiency: charts.efficiency,
            layout_seams: charts.seam_length[0],
            chart_seams: charts.seam_length[1],
        };
        structs::write(figures, summary, size)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_charts_faces(
    packed: *const ricci_charts,
    charts: *mut u32,
    capacity: usize,
) -> ricci_status {
    guard::with(packed, |packed| copy_out("charts", &packed.charts.chart, charts, capacity))
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_charts_points(
    packed: *const ricci_charts,
    points: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(packed, |packed| copy_out("points", &packed.charts.coordinates, points, capacity))
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_charts_corners(
    packed: *const ricci_charts,
    corners: *mut u32,
    capacity: usize,
) -> ricci_status {
    guard::with(packed, |packed| copy_out("corners", &packed.corners(), corners, capacity))
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_charts_motions(
    packed: *const ricci_charts,
    motions: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(packed, |ricci_charts { charts, .. }| {
        let rows = charts.motions.iter().map(|m| [m.rotation, m.translation[0], m.translation[1]]);
        copy_each("motions", charts.motions.len(), rows, motions, capacity)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_charts_write(
    packed: *const ricci_charts,
    homogeneous: u32,
    path: *const c_char,
) -> ricci_status {
    guard::with(packed, |packed| {
        let ricci_charts { state, layout, positions, charts } = packed;
        let weights = match (homogeneous, layout.space) {
            (0, _) => None,
            (_, Space::E2) => Some((crate::map::weights(state, layout.common_subdivision())?, Vec::new())),
            _ => return Err(not_projective()),
        };
        let (corners, positions) = (packed.corners(), positions.clone());
        TextureFile { mesh: layout.mesh(), positions, points: &charts.coordinates, corners }
            .write(&arrays::path(path)?, weights)
    })
}

fn not_projective() -> Failure {
    Failure::new(RICCI_LAYOUT, "charts of a layout in the hyperbolic plane are not projective")
}
