//! Layouts: the coordinates of a surface that is opened along a cut and unfolded in the space of its metric.

use crate::arrays::{self, CallerBuffer, check_buffer, copy_each, copy_out};
use crate::choice::choices;
use crate::control::{self, ricci_control};
use crate::failure::{Failure, Outcome};
use crate::guard::{self, handle, shared};
use crate::memory;
use crate::mesh::{SPACES, ricci_mesh};
use crate::metric::{MetricState, ON, Triangulation, ricci_metric};
use crate::paths::{copy_paths, vertex_or_none};
use crate::status::*;
use crate::structs::{self, sized};
use crate::target::vertices;
use crate::texture::TextureFile;
use ricci::embed::layout::{bounding_diagonal, distance};
use ricci::embed::{Layout, LayoutOptions, LayoutScale, OnInput, Quality, Seam};
use ricci::geometry::{Model, PlaneIsometry, Space};
use ricci::mesh::{EdgeId, FaceId, Mesh, PerEdge, PerHalfedge, Point};
use std::ffi::c_char;
use std::sync::{Arc, OnceLock};

choices!(pub(crate) MODELS: Model = "model", [
    RICCI_MODEL_POINCARE => Model::Poincare,
    RICCI_MODEL_KLEIN => Model::Klein,
    RICCI_MODEL_HALF_PLANE => Model::HalfPlane,
    RICCI_MODEL_AMBIENT => Model::Hyperboloid,
]);

choices!(SCALES: LayoutScale = "scale", [
    RICCI_SCALE_INPUT_AREA => LayoutScale::InputArea,
    RICCI_SCALE_AS_SOLVED => LayoutScale::AsSolved,
]);

pub struct ricci_layout {
    pub(crate) state: Arc<MetricState>,
    pub(crate) layout: Arc<Layout>,
    /// The model of the hyperbolic plane in which `points` are given.
    pub(crate) model: Model,
    pub(crate) points: Vec<[f64; 2]>,
    /// The layout on the caller's mesh; none if the layout is cut along edges of another triangulation.
    on_input: Option<OnInput>,
    /// The distortion against the caller's mesh; none of a layout of the metric's own triangulation after flips.
    pub(crate) quality: Option<Quality>,
    /// The distortion on the caller's mesh, found when it is first asked for.
    pub(crate) of_input: OnceLock<Option<Quality>>,
}
handle!(ricci_layout, "layout", |layout| layout.points.len() + layout.state.solution.mesh().n_vertices());

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_layout_options {
    pub size: usize,
    pub model: u32,
    pub scale: u32,
    pub cones: *const u32,
    pub n_cones: usize,
    pub root: *const u32,
    pub threads: usize,
}
// SAFETY: numbers and raw pointers; 8-byte alignment, size first.
sized!(ricci_layout_options, "options");

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_layout_summary {
    pub size: usize,
    pub space: u32,
    pub model: u32,
    pub n_vertices: usize,
    pub n_edges: usize,
    pub n_faces: usize,
    pub n_input_vertices: usize,
    pub n_input_faces: usize,
    pub n_points: usize,
    pub n_seams: usize,
    pub n_seam_edges: usize,
    pub n_flipped: usize,
    pub n_flipped_input: usize,
    pub n_degenerate: usize,
    pub consistency: f64,
    pub scale: f64,
    pub area: f64,
    pub diameter: f64,
    pub radius: f64,
    pub qc_mean: f64,
    pub qc_max: f64,
    pub area_ratio_min: f64,
    pub area_ratio_max: f64,
    pub n_degenerate_input: usize,
    pub qc_mean_input: f64,
    pub qc_max_input: f64,
    pub area_ratio_min_input: f64,
    pub area_ratio_max_input: f64,
    pub overlap: f64,
    pub symmetric_dirichlet: f64,
}
// SAFETY: numbers; 8-byte alignment, size first.
sized!(ricci_layout_summary, "summary");

const NOT_ON_INPUT: &str =
    "this layout is cut along edges of the metric's triangulation, not of the mesh: take ricci_layout_new";

/// The failure of what needs a layout that is cut along edges of the mesh.
pub(crate) fn not_on_input() -> Failure {
    Failure::new(RICCI_LAYOUT, NOT_ON_INPUT)
}

/// The coordinates of a layout's points: two each in a model, three in ambient space.
pub(crate) fn coordinates(layout: &Layout, model: Model) -> Vec<f64> {
    match (layout.space, model) {
        (_, Model::Hyperboloid) => layout.points.as_flattened().to_vec(),
        _ => plane_points(layout, model).into_flattened(),
    }
}

fn plane_points(layout: &Layout, model: Model) -> Vec<[f64; 2]> {
    match layout.space {
        Space::H2 => layout.points.iter().map(|&p| model.plane(p)).collect(),
        _ => layout.coordinates.clone(),
    }
}

/// The index of the point of every corner of every face.
pub(crate) fn corners_of(mesh: &Mesh, index: &PerHalfedge<u32>) -> Vec<[u32; 3]> {
    mesh.faces().map(|f| mesh.face_halfedges(f).map(|h| index[h])).collect()
}

impl ricci_layout {
    pub(crate) fn new(state: Arc<MetricState>, layout: Layout, model: Model) -> Outcome<ricci_layout> {
        if model == Model::Hyperboloid {
            return Err(Failure::argument("the points of a layout need a model with two coordinates"));
        }
        let surface = state.solution.surface();
        let lies_on_input = layout.common_subdivision().is_some() || state.solution.is_unflipped();
        let quality =
            if lies_on_input { Some(layout.quality(surface.mesh(), surface.lengths())?) } else { None };
        let (points, on_input) = (plane_points(&layout, model), layout.on_input());
        let (layout, of_input) = (Arc::new(layout), OnceLock::new());
        Ok(ricci_layout { points, on_input, quality, of_input, layout, state, model })
    }

    pub(crate) fn on_input(&self) -> Outcome<&OnInput> {
        self.on_input.as_ref().ok_or_else(not_on_input)
    }

    /// The distortion on the caller's mesh; none if the layout is cut along edges of another triangulation.
    fn quality_on_input(&self) -> Outcome<Option<&Quality>> {
        if let Some(known) = self.of_input.get() {
            return Ok(known.as_ref());
        }
        let surface = self.state.solution.surface();
        let _reserve = memory::work(surface.mesh().n_vertices(), memory::LAYOUT)?;
        let found = self.layout.quality_on_input(surface.lengths())?;
        Ok(self.of_input.get_or_init(|| found).as_ref())
    }

    /// The point of every corner of every face, of the caller's mesh or of the mesh of the layout.
    pub(crate) fn corners(&self, on: Triangulation) -> Outcome<Vec<[u32; 3]>> {
        Ok(match on {
            Triangulation::Input => {
                let on_input = self.on_input()?;
                let corners = corners_of(self.state.solution.given(), &on_input.corner_index);
                corners.into_iter().map(|face| face.map(|k| on_input.points[k as usize])).collect()
            }
            _ => corners_of(self.layout.mesh(), &self.layout.corner_index),
        })
    }

    /// The positions of the vertices of the layout's mesh; none of an intrinsic surface.
    pub(crate) fn positions(&self) -> Outcome<Option<Arc<Vec<Point>>>> {
        let solution = &self.state.solution;
        Ok(match (solution.surface().positions(), self.layout.common_subdivision()) {
            (Some(positions), Some(r)) => Some(Arc::new(r.from_vertices(0, positions)?)),
            (positions, _) => positions.cloned(),
        })
    }

    /// The factor of the homogeneous weight at every point of the layout; empty in the plane, where it is 1.
    pub(crate) fn heights(&self) -> Outcome<Vec<f64>> {
        match (self.layout.space, self.model) {
            (Space::E2, _) => Ok(Vec::new()),
            (Space::H2, Model::Klein) => Ok(self.layout.points.iter().map(|p| p[2]).collect()),
            _ => {
                let message = "the map is not projective in these coordinates: take RICCI_MODEL_KLEIN in the hyperbolic plane";
                Err(Failure::new(RICCI_LAYOUT, message))
            }
        }
    }

    fn quality(&self) -> Outcome<&Quality> {
        let message =
            "the metric's own triangulation has no distortion against the mesh: lay the refinement out";
        self.quality.as_ref().ok_or_else(|| Failure::new(RICCI_LAYOUT, message))
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_layout_new(
    metric: *const ricci_metric,
    options: *const ricci_layout_options,
    control: *const ricci_control,
    layout: *mut *mut ricci_layout,
) -> ricci_status {
    guard::make(layout, || {
        let (state, control) = (&shared(metric)?.0, control::of(control)?);
        let given = structs::read(options)?;
        let _reserve = memory::work(state.solution.mesh().n_vertices(), memory::LAYOUT)?;
        let surface = state.solution.surface();
        let cones = if given.cones.is_null() && given.n_cones == 0 {
            None
        } else {
            Some(vertices(surface, given.cones, given.n_cones)?)
        };
        let options = LayoutOptions {
            cones,
            root: vertex_or_none(given.root)?,
            scale: SCALES.choose(given.scale)?,
            subdivision: state.subdivision_if_flipped(&control)?.cloned(),
            threads: given.threads,
            ..LayoutOptions::default()
        };
        let model = MODELS.choose(given.model)?;
        ricci_layout::new(state.clone(), Layout::of_solution(&state.solution, &options, &control)?, model)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_layout_free(layout: *mut ricci_layout) {
    guard::free(layout);
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_layout_summarise(
    layout: *const ricci_layout,
    summary: *mut ricci_layout_summary,
    size: usize,
) -> ricci_status {
    guard::with(layout, |handle| {
        let ricci_layout { layout, points, quality, state, on_input, model, .. } = handle;
        let (mesh, given) = (layout.mesh(), state.solution.given());
        let (quality, of_input) = (quality.as_ref(), handle.quality_on_input()?);
        let figure = |of: fn(&Quality) -> f64| quality.map_or(f64::NAN, of);
        let input_figure = |of: fn(&Quality) -> f64| of_input.map_or(f64::NAN, of);
        let figures = ricci_layout_summary {
            size,
            space: SPACES.number(layout.space)?,
            model: MODELS.number(*model)?,
            n_vertices: mesh.n_vertices(),
            n_edges: mesh.n_edges(),
            n_faces: mesh.n_faces(),
            n_input_vertices: given.n_vertices(),
            n_input_faces: given.n_faces(),
            n_points: points.len(),
            n_seams: layout.seams.len(),
            n_seam_edges: layout.cut.segments.iter().map(Vec::len).sum(),
            n_flipped: handle.layout.flipped.len(),
            n_flipped_input: on_input.as_ref().map_or(0, |on_input| on_input.flipped.len()),
            n_degenerate: quality.map_or(0, |quality| quality.degenerate.len()),
            consistency: layout.consistency(),
            scale: layout.scale,
            area: layout.area,
            diameter: bounding_diagonal(points),
            radius: layout.radius,
            qc_mean: figure(|q| q.qc_mean),
            qc_max: figure(|q| q.qc_max),
            area_ratio_min: figure(|q| q.area_ratio_min),
            area_ratio_max: figure(|q| q.area_ratio_max),
            n_degenerate_input: of_input.map_or(0, |quality| quality.degenerate.len()),
            qc_mean_input: input_figure(|q| q.qc_mean),
            qc_max_input: input_figure(|q| q.qc_max),
            area_ratio_min_input: input_figure(|q| q.area_ratio_min),
            area_ratio_max_input: input_figure(|q| q.area_ratio_max),
            overlap: layout.overlap().unwrap_or(f64::NAN),
            symmetric_dirichlet: figure(|q| q.symmetric_dirichlet),
        };
        structs::write(figures, summary, size)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_layout_points(
    layout: *const ricci_layout,
    model: u32,
    points: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(layout, |layout| {
        copy_out("points", &coordinates(&layout.layout, MODELS.choose(model)?), points, capacity)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_layout_corners(
    layout: *const ricci_layout,
    on: u32,
    corners: *mut u32,
    capacity: usize,
) -> ricci_status {
    guard::with(layout, |layout| copy_out("corners", &layout.corners(ON.choose(on)?)?, corners, capacity))
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_layout_uv(
    layout: *const ricci_layout,
    on: u32,
    uv: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(layout, |layout| {
        let corners = layout.corners(ON.choose(on)?)?;
        let places = corners.iter().map(|face| face.map(|k| layout.points[k as usize]));
        copy_each("uv", corners.len(), places, uv, capacity)
    })
}

/// The isometry from the left side of a seam to its right side as a Möbius transformation, and its residual.
fn seam_row(space: Space, seam: &Seam) -> [f64; 9] {
    let [[a, b], [c, d]] = match space {
        Space::E2 => {
            let PlaneIsometry { rotation, translation } = seam.isometry();
            [[[rotation.cos(), rotation.sin()], translation], [[0.0, 0.0], [1.0, 0.0]]]
        }
        _ => seam.pairing.inverse().mobius(),
    };
    [a[0], a[1], b[0], b[1], c[0], c[1], d[0], d[1], seam.residual]
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_layout_seams(
    layout: *const ricci_layout,
    seams: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(layout, |ricci_layout { layout, .. }| {
        let rows = layout.seams.iter().map(|seam| seam_row(layout.space, seam));
        copy_each("seams", layout.seams.len(), rows, seams, capacity)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_layout_seam_edges(
    layout: *const ricci_layout,
    on: u32,
    edges: *mut i32,
    edges_capacity: usize,
    starts: *mut usize,
    starts_capacity: usize,
) -> ricci_status {
    guard::with(layout, |layout| {
        let cut = match ON.choose(on)? {
            Triangulation::Input => &layout.on_input()?.cut,
            _ => &layout.layout.cut,
        };
        copy_paths(&cut.segments, CallerBuffer(edges, edges_capacity), CallerBuffer(starts, starts_capacity))
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_layout_flipped(
    layout: *const ricci_layout,
    on: u32,
    faces: *mut u32,
    capacity: usize,
) -> ricci_status {
    guard::with(layout, |layout| {
        let flipped: &[FaceId] = match ON.choose(on)? {
            Triangulation::Input => &layout.on_input()?.flipped,
            _ => &layout.layout.flipped,
        };
        copy_each("faces", flipped.len(), flipped.iter().map(|f| f.0), faces, capacity)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_layout_distortion(
    layout: *const ricci_layout,
    on: u32,
    qc: *mut f64,
    area_ratio: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(layout, |layout| {
        let quality = match ON.choose(on)? {
            Triangulation::Input => layout.quality_on_input()?.ok_or_else(not_on_input)?,
            _ => layout.quality()?,
        };
        check_buffer("area_ratio", quality.area_ratio.len(), area_ratio, capacity)?;
        copy_out("qc", &quality.qc, qc, capacity)?;
        copy_out("area_ratio", &quality.area_ratio, area_ratio, capacity)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_layout_mesh(
    layout: *const ricci_layout,
    mesh: *mut *mut ricci_mesh,
) -> ricci_status {
    guard::make(mesh, || {
        let handle = shared(layout)?;
        let (layout, mesh) = (&handle.layout, Arc::new(handle.layout.mesh().clone()));
        if let Some(positions) = handle.positions()? {
            return Ok(ricci_mesh::in_space(mesh, positions));
        }
        let length = |e: EdgeId| {
            let [h, twin] = [e.halfedge(), e.halfedge().twin()];
            let h = if mesh.is_outside(h) { twin } else { h };
            distance(layout.space, layout.corner(h), layout.corner(mesh.next(h)))
        };
        let lengths = Arc::new(PerEdge::from_fn(mesh.n_edges(), length));
        Ok(ricci_mesh::intrinsic(mesh, lengths, layout.space))
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_layout_write(
    layout: *const ricci_layout,
    on: u32,
    homogeneous: u32,
    path: *const c_char,
) -> ricci_status {
    guard::with(layout, |layout| {
        let (on, solution) = (ON.choose(on)?, &layout.state.solution);
        let (mesh, positions) = match on {
            Triangulation::Input => (&**solution.given(), solution.surface().positions().cloned()),
            _ => (layout.layout.mesh(), layout.positions()?),
        };
        let weights = match (homogeneous, on) {
            (0, _) => None,
            (_, Triangulation::Input) => {
                return Err(Failure::argument(
                    "on the input's own faces the map is linear: take homogeneous 0",
                ));
            }
            _ => Some((
                crate::map::weights(&layout.state, layout.layout.common_subdivision())?,
                layout.heights()?,
            )),
        };
        TextureFile { mesh, positions, points: &layout.points, corners: layout.corners(on)? }
            .write(&arrays::path(path)?, weights)
    })
}
