//! Layouts on the faces of the caller's mesh, with edges split where faces fold.

use crate::arrays::{self, copy_each, copy_out};
use crate::control::{self, ricci_control};
use crate::failure::{Failure, Outcome};
use crate::guard::{self, handle, shared};
use crate::layout::{corners_of, not_on_input, ricci_layout};
use crate::memory;
use crate::mesh::ricci_mesh;
use crate::metric::MetricState;
use crate::status::*;
use crate::structs::{self, sized};
use crate::texture::TextureFile;
use ricci::embed::{Quality, RepairedInput};
use ricci::mesh::Point;
use std::ffi::c_char;
use std::sync::Arc;

pub struct ricci_repaired_input {
    state: Arc<MetricState>,
    repaired: RepairedInput,
    /// The points of the opened surface, in the model of the layout.
    points: Vec<[f64; 2]>,
    quality: Quality,
}
handle!(ricci_repaired_input, "repaired", |repaired| repaired.points.len());

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_repaired_input_summary {
    pub size: usize,
    pub n_vertices: usize,
    pub n_edges: usize,
    pub n_faces: usize,
    pub n_input_vertices: usize,
    pub n_split_edges: usize,
    pub n_points: usize,
    pub n_flipped: usize,
    pub n_degenerate: usize,
    pub qc_mean: f64,
    pub qc_max: f64,
    pub area_ratio_min: f64,
    pub area_ratio_max: f64,
}
// SAFETY: numbers; 8-byte alignment, size first.
sized!(ricci_repaired_input_summary, "summary");

impl ricci_repaired_input {
    fn corners(&self) -> Vec<[u32; 3]> {
        corners_of(self.repaired.mesh(), &self.repaired.corner_index)
    }

    /// The positions of the vertices; none of an intrinsic surface.
    fn positions(&self) -> Outcome<Option<Arc<Vec<Point>>>> {
        let Some(given) = self.state.solution.surface().positions() else { return Ok(None) };
        Ok(Some(Arc::new(self.repaired.refinement.from_vertices(0, given)?)))
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_repaired_input_new(
    layout: *const ricci_layout,
    control: *const ricci_control,
    repaired: *mut *mut ricci_repaired_input,
) -> ricci_status {
    guard::make(repaired, || {
        let ricci_layout { layout, points, state, .. } = shared(layout)?;
        let surface = state.solution.surface();
        let _reserve = memory::work(surface.mesh().n_vertices(), memory::LAYOUT)?;
        let repaired = layout.repaired_input(&control::of(control)?)?.ok_or_else(not_on_input)?;
        let quality = layout.quality_of_repaired(&repaired, surface.lengths())?;
        let points = repaired.points.iter().map(|&k| points[k as usize]).collect();
        Ok(ricci_repaired_input { state: state.clone(), repaired, points, quality })
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_repaired_input_free(repaired: *mut ricci_repaired_input) {
    guard::free(repaired);
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_repaired_input_summarise(
    repaired: *const ricci_repaired_input,
    summary: *mut ricci_repaired_input_summary,
    size: usize,
) -> ricci_status {
    guard::with(repaired, |ricci_repaired_input { repaired, points, quality, .. }| {
        let mesh = repaired.mesh();
        let figures = ricci_repaired_input_summary {
            size,
            n_vertices: mesh.n_vertices(),
            n_edges: mesh.n_edges(),
            n_faces: mesh.n_faces(),
            n_input_vertices: mesh.n_vertices() - repaired.n_added(),
            n_split_edges: repaired.split_edges.len(),
            n_points: points.len(),
            n_flipped: repaired.flipped.len(),
            n_degenerate: quality.degenerate.len(),
            qc_mean: quality.qc_mean,
            qc_max: quality.qc_max,
            area_ratio_min: quality.area_ratio_min,
            area_ratio_max: quality.area_ratio_max,
        };
        structs::write(figures, summary, size)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_repaired_input_mesh(
    repaired: *const ricci_repaired_input,
    mesh: *mut *mut ricci_mesh,
) -> ricci_status {
    guard::make(mesh, || {
        let repaired = shared(repaired)?;
        let positions = repaired.positions()?.ok_or_else(|| {
            Failure::argument("the given mesh is intrinsic: there are no positions for the added vertices")
        })?;
        Ok(ricci_mesh::in_space(Arc::new(repaired.repaired.mesh().clone()), positions))
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_repaired_input_faces(
    repaired: *const ricci_repaired_input,
    faces: *mut u32,
    capacity: usize,
) -> ricci_status {
    guard::with(repaired, |ricci_repaired_input { repaired, .. }| {
        let of = &repaired.refinement.faces[0];
        copy_each("faces", of.len(), of.iter().map(|f| f.0), faces, capacity)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_repaired_input_barycentric(
    repaired: *const ricci_repaired_input,
    weights: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(repaired, |ricci_repaired_input { repaired, .. }| {
        let r = &repaired.refinement;
        let all = r.mesh.faces().map(|f| r.barycentric(0, f));
        copy_each("weights", r.mesh.n_faces(), all, weights, capacity)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_repaired_input_split_edges(
    repaired: *const ricci_repaired_input,
    edges: *mut u32,
    capacity: usize,
) -> ricci_status {
    guard::with(repaired, |ricci_repaired_input { repaired, .. }| {
        let split = &repaired.split_edges;
        copy_each("edges", split.len(), split.iter().map(|e| e.0), edges, capacity)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_repaired_input_points(
    repaired: *const ricci_repaired_input,
    points: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(repaired, |repaired| copy_out("points", &repaired.points, points, capacity))
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_repaired_input_corners(
    repaired: *const ricci_repaired_input,
    corners: *mut u32,
    capacity: usize,
) -> ricci_status {
    guard::with(repaired, |repaired| copy_out("corners", &repaired.corners(), corners, capacity))
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_repaired_input_write(
    repaired: *const ricci_repaired_input,
    path: *const c_char,
) -> ricci_status {
    guard::with(repaired, |repaired| {
        let (mesh, positions) = (repaired.repaired.mesh(), repaired.positions()?);
        TextureFile { mesh, positions, points: &repaired.points, corners: repaired.corners() }
            .write(&arrays::path(path)?, None)
    })
}
