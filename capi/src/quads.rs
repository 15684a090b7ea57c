//! Quad meshes of seamless metrics.

use crate::arrays::{check_buffer, copy_out};
use crate::choice::choices;
use crate::control::{self, ricci_control};
use crate::failure::{Failure, Outcome};
use crate::guard::{self, handle, shared};
use crate::memory::{self, Reserve};
use crate::seamless::ricci_seamless;
use crate::status::*;
use crate::structs::{self, sized};
use ricci::mesh::Point;
use ricci::metric::curvature::area;
use ricci::quads::{QuadMesh, QuadOptions, QuadSize, quad_mesh};
use ricci::seamless::Seamless;
use std::sync::Arc;

/// A quad mesh, with the places of its vertices in space if the surface has positions.
pub(crate) struct QuadsState {
    pub mesh: QuadMesh,
    pub positions: Option<Vec<Point>>,
    figures: ricci_quads_summary,
}

/// Most bytes per vertex and quad for a quad mesh: 4,000 for 60,000 quads on a torus of 8,192 vertices, and for each of the 64 quads of a unit
/// square of a layout 3,400.
const QUADS: usize = 3 << 11;

pub struct ricci_quads(pub(crate) Arc<QuadsState>);
handle!(ricci_quads, "quads", |quads| quads.0.mesh.places.len());

// How the size of the quads is told.
choices!(enum Sizing, SIZINGS = "sizing", [
    RICCI_QUADS_DEFAULT => Default,
    RICCI_QUADS_NUMBER => Number,
    RICCI_QUADS_EDGE => Edge,
    RICCI_QUADS_COARSE => Coarse,
    RICCI_QUADS_AT_MOST => AtMost,
]);

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_quads_options {
    pub size: usize,
    pub sizing: u32,
    pub reserved: u32,
    pub n_quads: usize,
    pub edge: f64,
    pub threads: usize,
}
// SAFETY: numbers; 8-byte alignment, size first.
sized!(ricci_quads_options, "options", reserved);

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_quads_summary {
    pub size: usize,
    pub n_quads: usize,
    pub n_vertices: usize,
    pub n_irregular: usize,
    pub n_collapsed: usize,
    pub n_creases: usize,
    pub n_off_axis: usize,
    pub n_rectangles: usize,
    pub n_arcs: usize,
    pub euler: i64,
    pub n_bad_edges: usize,
    pub n_bad_vertices: usize,
    pub cost: f64,
    pub edge: f64,
    pub angle_mean: f64,
    pub angle_max: f64,
    pub edge_mean: f64,
    pub edge_deviation: f64,
}
// SAFETY: numbers; 8-byte alignment, size first.
sized!(ricci_quads_summary, "summary");

/// The caller's options, with this size of the quads by default.
pub(crate) fn read_options(options: *const ricci_quads_options, usual: QuadSize) -> Outcome<QuadOptions> {
    let given = structs::read(options)?;
    let size = match SIZINGS.choose(given.sizing)? {
        Sizing::Default => usual,
        Sizing::Number => QuadSize::Quads(given.n_quads),
        Sizing::Edge => QuadSize::Edge(given.edge),
        Sizing::Coarse => QuadSize::Coarse,
        Sizing::AtMost => QuadSize::AtMost(given.n_quads),
    };
    Ok(QuadOptions { size, threads: given.threads })
}

/// A reserve for work on a surface and on quads of this size, each of which is made of so many parts with the memory of a quad.
pub(crate) fn reserve(seamless: &Seamless, size: QuadSize, parts: usize) -> Outcome<Reserve> {
    let solution = &seamless.solution;
    let n_quads = match size {
        QuadSize::Quads(n) | QuadSize::AtMost(n) => n,
        QuadSize::Edge(edge) if edge > 0.0 => {
            let lengths = solution.surface().lengths();
            (area(solution.given(), solution.initial().input_geometry, lengths)? / edge / edge) as usize
        }
        QuadSize::Edge(_) => 0,
        // On samples they were up to twice as many as the cones.
        QuadSize::Coarse => 4 * seamless.cones.len(),
    };
    if n_quads > i32::MAX as usize {
        let message = format!("{n_quads} quads of this size are more than a mesh can have");
        return Err(Failure::new(RICCI_TOO_LARGE, message).needs(n_quads));
    }
    memory::work(solution.given().n_vertices() + parts * n_quads, QUADS)
}

impl QuadsState {
    pub fn mesh(&self) -> &QuadMesh {
        &self.mesh
    }

    /// The quad mesh of a seamless metric.
    pub fn of_seamless(mesh: QuadMesh, seamless: &Seamless) -> QuadsState {
        let positions = mesh.positions(&seamless.solution);
        QuadsState::new(mesh, positions)
    }

    /// A quad mesh with the positions of its vertices.
    pub fn new(mesh: QuadMesh, positions: Option<Vec<Point>>) -> QuadsState {
        let topology = mesh.topology();
        let shape = positions.as_ref().map(|positions| mesh.shape(positions));
        let [n_rectangles, n_arcs] = mesh.t_mesh_size;
        let figures = ricci_quads_summary {
            size: 0,
            n_quads: mesh.quads.len(),
            n_vertices: mesh.places.len(),
            n_irregular: topology.irregular.len(),
            n_collapsed: mesh.collapsed,
            n_creases: mesh.creases.len(),
            n_off_axis: mesh.off_axis.len(),
            n_rectangles,
            n_arcs,
            euler: topology.euler,
            n_bad_edges: topology.bad_edges,
            n_bad_vertices: topology.bad_vertices,
            cost: mesh.cost,
            edge: mesh.edge,
            angle_mean: shape.map_or(f64::NAN, |shape| shape.angle_mean),
            angle_max: shape.map_or(f64::NAN, |shape| shape.angle_max),
            edge_mean: shape.map_or(f64::NAN, |shape| shape.edge_mean),
            edge_deviation: shape.map_or(f64::NAN, |shape| shape.edge_deviation),
        };
        QuadsState { mesh, positions, figures }
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_quads_new(
    seamless: *const ricci_seamless,
    options: *const ricci_quads_options,
    control: *const ricci_control,
    quads: *mut *mut ricci_quads,
) -> ricci_status {
    guard::make(quads, || {
        let ricci_seamless { found, .. } = shared(seamless)?;
        let options = read_options(options, QuadOptions::default().size)?;
        let _reserve = reserve(found, options.size, 1)?;
        let mesh = quad_mesh(found, &options, &control::of(control)?)?;
        log::info!("quads: {} in {} rectangles", mesh.quads.len(), mesh.t_mesh_size[0]);
        Ok(ricci_quads(Arc::new(QuadsState::of_seamless(mesh, found))))
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_quads_free(quads: *mut ricci_quads) {
    guard::free(quads);
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_quads_summarise(
    quads: *const ricci_quads,
    summary: *mut ricci_quads_summary,
    size: usize,
) -> ricci_status {
    guard::with(quads, |ricci_quads(state)| {
        structs::write(ricci_quads_summary { size, ..state.figures }, summary, size)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_quads_faces(
    quads: *const ricci_quads,
    faces: *mut u32,
    capacity: usize,
) -> ricci_status {
    guard::with(quads, |ricci_quads(state)| copy_out("faces", &state.mesh.quads, faces, capacity))
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_quads_places(
    quads: *const ricci_quads,
    faces: *mut u32,
    faces_capacity: usize,
    weights: *mut f64,
    weights_capacity: usize,
) -> ricci_status {
    guard::with(quads, |ricci_quads(state)| {
        let (found, at): (Vec<u32>, Vec<[f64; 3]>) =
            state.mesh.places.iter().map(|(face, weights)| (face.0, *weights)).unzip();
        check_buffer("weights", 3 * at.len(), weights, weights_capacity)?;
        copy_out("faces", &found, faces, faces_capacity)?;
        copy_out("weights", &at, weights, weights_capacity)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_quads_positions(
    quads: *const ricci_quads,
    positions: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(quads, |ricci_quads(state)| {
        let none = || Failure::argument("quads have positions on a mesh with positions alone");
        copy_out("positions", state.positions.as_ref().ok_or_else(none)?, positions, capacity)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_quads_creases(
    quads: *const ricci_quads,
    vertices: *mut u32,
    capacity: usize,
) -> ricci_status {
    guard::with(quads, |ricci_quads(state)| copy_out("vertices", &state.mesh.creases, vertices, capacity))
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_quads_rectangles(
    quads: *const ricci_quads,
    rectangles: *mut u32,
    capacity: usize,
) -> ricci_status {
    guard::with(quads, |ricci_quads(state)| {
        copy_out("rectangles", &state.mesh.rectangle, rectangles, capacity)
    })
}
