//! Layouts in the plane.

use crate::arrays::{self, copy_out};
use crate::control::{self, ricci_control};
use crate::edges::copy_paths;
use crate::failure::{Failure, Outcome};
use crate::guard::{self, Poison, handle};
use crate::metric::ricci_metric;
use crate::model;
use crate::sized::{self, sized};
use crate::status::ricci_status;
use ricci::Control;
use ricci::embed::layout::bounding_diagonal;
use ricci::embed::unroll::CONE_TOLERANCE;
use ricci::embed::{self, Layout, OnInput, Quality, Scale, Seam, UnrollOptions, cones_of};
use ricci::flow::Solution;
use ricci::geometry::{Model, PlaneIsometry, Space};
use ricci::mesh::{Mesh, PerHalfedge, Point, VertexId};
use ricci::metric::Refinement;
use std::sync::Arc;

/// A surface unrolled into the plane along a cut: of a flat metric (ricci_layout_new), or of a hyperbolic one in a
/// model of the hyperbolic plane (ricci_layout_hyperbolic; ricci_quotient_layout with the sides of its fundamental domain).
///
/// What is unrolled is the mesh that the metric was made from. If edges were flipped its faces are cut by the
/// edges of the metric's triangulation: the *common refinement*, whose faces are parts of faces of both, and
/// whose vertices are those of the mesh, with their numbers, then the crossings of edges of both.
/// ricci_layout_mesh gives it; faces and points of a layout are its own.
pub struct ricci_layout {
    pub(crate) poison: Poison,
    pub(crate) layout: Arc<Layout>,
    /// Positions of the vertices of what is unrolled.
    pub(crate) positions: Option<Arc<Vec<Point>>>,
    /// In which the points are given, of a layout in H2.
    pub(crate) model: Model,
    /// The points of the layout in the plane, or in that model.
    pub(crate) points: Vec<[f64; 2]>,
    /// The layout on the mesh itself, where it is cut along edges of that.
    pub(crate) on_input: Option<OnInput>,
    /// Of the mesh itself.
    pub(crate) input_positions: Option<Arc<Vec<Point>>>,
    pub(crate) quality: Quality,
    pub(crate) surface: Arc<Solution>,
}

handle!(ricci_layout, "layout");

/// Figures of a layout.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_layout_summary {
    /// Bytes of this struct that are filled.
    pub size: usize,
    /// F of what is unrolled.
    pub n_faces: usize,
    /// Number of points in the plane: vertices count once per piece of their star between cuts.
    pub n_points: usize,
    /// Number of seams.
    pub n_seams: usize,
    /// Number of edges on all seams.
    pub n_seam_edges: usize,
    /// Faces that are not counterclockwise: by exact arithmetic; of a refinement, those that are clockwise by
    /// more than rounding.
    pub n_flipped: usize,
    /// Largest disagreement of an edge vector with the placed points, relative to `diameter`; in the hyperbolic plane the largest
    /// distance.
    pub consistency: f64,
    /// Diagonal of the bounding box.
    pub diameter: f64,
    /// Area; that of the input surface where its lengths are Euclidean; in the hyperbolic plane that of the metric.
    pub area: f64,
    /// Quasi-conformal dilatation, at least 1: mean over the input's area.
    pub qc_mean: f64,
    /// Largest quasi-conformal dilatation.
    pub qc_max: f64,
    /// Smallest area distortion: share of the layout's area over share of the input's.
    pub area_ratio_min: f64,
    /// Largest area distortion.
    pub area_ratio_max: f64,
    /// V of what is unrolled: n_given_vertices + n_crossings.
    pub n_vertices: usize,
    /// E of what is unrolled.
    pub n_edges: usize,
    /// V of the mesh that the metric was made from: these vertices come first.
    pub n_given_vertices: usize,
    /// Vertices where an edge of that mesh and one of the metric's triangulation cross; 0 if no edge was
    /// flipped.
    pub n_crossings: usize,
    /// Number of pieces: a piece is what a face of the mesh and one of the metric's triangulation have in
    /// common, cut into triangles.
    pub n_pieces: usize,
    /// Faces without area in the input or the layout, but for rounding; qc and area_ratio leave them out.
    pub n_degenerate: usize,
    /// F of the mesh that the metric was made from.
    pub n_given_faces: usize,
    /// Faces of that mesh that are not counterclockwise in ricci_layout_input_uv, where the map is made linear on them; 0 of ricci_quotient_layout,
    /// which is not cut along its edges.
    pub n_flipped_given: usize,
}

// SAFETY: only ever written by the library; 8-byte alignment, size first.
sized!(ricci_layout_summary, "summary");

/// A layout of a metric that lives in this space, opened along edges of its mesh.
pub(crate) fn unroll(
    metric: &ricci_metric,
    cones: Vec<VertexId>,
    space: Space,
    model: Model,
    control: &Control,
) -> Outcome<ricci_layout> {
    let ricci_metric { surface, positions, .. } = metric;
    let lives = surface.metric().space;
    if lives != space {
        let message = format!(
            "this metric lives in {lives}: ricci_layout_new unrolls those in e2, ricci_layout_hyperbolic those in h2"
        );
        return Err(Failure::new(ricci_status::RICCI_LAYOUT, message));
    }
    let curvature = surface.curvature()?;
    if let (Space::H2, Some(f)) = (space, curvature.broken.first()) {
        let message = format!("face {f} of the metric's triangulation breaks the triangle inequality");
        return Err(Failure::new(ricci_status::RICCI_TRIANGLE_INEQUALITY, message));
    }
    // The area of the input, where it has one in the plane.
    let scale = match surface.initial().input_geometry {
        Space::E2 => Scale::InputArea,
        _ => Scale::AsSolved,
    };
    let options = UnrollOptions { cones: Some(cones), scale, ..UnrollOptions::default() };
    let layout = embed::unroll(surface, &options, control)?;
    ricci_layout::new(Arc::new(surface.clone()), layout, positions, model)
}

/// Interior vertices whose target, one of the n_vertices at `target`, is off flat by more than a flow's tolerance.
pub(crate) fn cones(mesh: &Mesh, target: *const f64, n_vertices: usize) -> Outcome<Vec<VertexId>> {
    let target = arrays::array_of("target", target, n_vertices, mesh.n_vertices())?;
    Ok(cones_of(mesh, &target, CONE_TOLERANCE)?)
}

/// Unroll a Euclidean metric into the plane.
///
/// The surface is cut open along edges of the mesh: its homology generators, and through every interior vertex whose target is more
/// than 1e-10 off 0. The metric should be flat at all others, and `consistency` says how far it is. Triangles are
/// counterclockwise where the mesh's are. Of a metric whose edges were flipped the common refinement is
/// unrolled.
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_WRONG_SIZE, RICCI_TRIANGLE_INEQUALITY, RICCI_LAYOUT (not E2),
/// RICCI_DOMAIN, RICCI_EDGE_WEIGHT, RICCI_TOO_LARGE (the refinement), RICCI_CANCELLED.
///
/// @param metric      the metric, in E2.
/// @param target      the n_vertices curvatures it was made for.
/// @param n_vertices  number of vertices of the mesh that the metric was made from.
/// @param control     progress and cancellation; NULL for neither.
/// @param layout      out: the new handle, to be released by ricci_layout_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_layout_new(
    metric: *const ricci_metric,
    target: *const f64,
    n_vertices: usize,
    control: *const ricci_control,
    layout: *mut *mut ricci_layout,
) -> ricci_status {
    guard::make("layout", layout, |door| {
        let metric = door.shared(metric)?;
        let cones = cones(metric.given(), target, n_vertices)?;
        unroll(metric, cones, Space::E2, Model::default(), &control::of(control))
    })
}

/// Release a layout.
///
/// @param layout  the handle, or NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_layout_free(layout: *mut ricci_layout) {
    guard::free(layout);
}

/// The number of pieces into which the given and the final triangulation cut each other.
fn n_pieces(refinement: &Refinement) -> usize {
    refinement.piece.last().map_or(0, |&last| last as usize + 1)
}

/// The figures of a layout.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE.
///
/// @param layout   the layout.
/// @param summary  out: the figures.
/// @param size     sizeof *summary.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_layout_summarise(
    layout: *const ricci_layout,
    summary: *mut ricci_layout_summary,
    size: usize,
) -> ricci_status {
    guard::with(layout, |ricci_layout { layout, points, quality, surface, on_input, .. }| {
        let (mesh, given) = (layout.mesh(), surface.given());
        let figures = ricci_layout_summary {
            size,
            n_faces: mesh.n_faces(),
            n_points: points.len(),
            n_seams: layout.seams.len(),
            n_seam_edges: layout.cut.segments.iter().map(Vec::len).sum(),
            n_flipped: layout.flipped.len(),
            consistency: layout.consistency(),
            diameter: bounding_diagonal(points),
            area: layout.area,
            qc_mean: quality.qc_mean,
            qc_max: quality.qc_max,
            area_ratio_min: quality.area_ratio_min,
            area_ratio_max: quality.area_ratio_max,
            n_vertices: mesh.n_vertices(),
            n_edges: mesh.n_edges(),
            n_given_vertices: given.n_vertices(),
            n_crossings: mesh.n_vertices() - given.n_vertices(),
            n_pieces: layout.refinement().map_or(mesh.n_faces(), |r| n_pieces(r)),
            n_degenerate: quality.degenerate.len(),
            n_given_faces: given.n_faces(),
            n_flipped_given: on_input.as_ref().map_or(0, |on_input| on_input.flipped.len()),
        };
        sized::write(figures, summary, size)
    })
}

/// The points of the layout.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
///
/// @param layout    the layout.
/// @param points    out: n_points x 2.
/// @param capacity  entries of `points`, at least 2 n_points.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_layout_points(
    layout: *const ricci_layout,
    points: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(layout, |layout| copy_out("points", &layout.points, points, capacity))
}

/// The point of every corner of every face: as OBJ's `vt` indices, but 0-based.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
///
/// @param layout    the layout.
/// @param corners   out: n_faces x 3 indices of points.
/// @param capacity  entries of `corners`, at least 3 n_faces.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_layout_corners(
    layout: *const ricci_layout,
    corners: *mut u32,
    capacity: usize,
) -> ricci_status {
    guard::with(layout, |layout| copy_out("corners", &layout.corners(), corners, capacity))
}

/// The coordinates of every corner of every face.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
///
/// @param layout    the layout.
/// @param uv        out: n_faces x 3 x 2.
/// @param capacity  entries of `uv`, at least 6 n_faces.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_layout_uv(
    layout: *const ricci_layout,
    uv: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(layout, |layout| {
        let corners: Vec<[[f64; 2]; 3]> =
            layout.corners().into_iter().map(|f| f.map(|k| layout.points[k as usize])).collect();
        copy_out("uv", &corners, uv, capacity)
    })
}

/// The motion of the plane that carries the left side of every seam onto its right side.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_LAYOUT (in the hyperbolic plane).
///
/// @param layout    the layout.
/// @param seams     out: n_seams x 4: rotation (radians), translation x, y, residual relative to the
///                  diameter.
/// @param capacity  entries of `seams`, at least 4 n_seams.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_layout_seams(
    layout: *const ricci_layout,
    seams: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::call(|door| {
        let layout = &door.shared(layout)?.layout;
        if layout.space != Space::E2 {
            let message =
                "the sides of these seams are paired by isometries of h2: ricci_quotient_sides has them";
            return Err(Failure::new(ricci_status::RICCI_LAYOUT, message));
        }
        let row = |seam: &Seam| {
            let PlaneIsometry { rotation, translation: [x, y] } = seam.isometry();
            [rotation, x, y, seam.residual]
        };
        let rows: Vec<[f64; 4]> = layout.seams.iter().map(row).collect();
        copy_out("seams", &rows, seams, capacity)
    })
}

/// The edges of every seam, in order.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
///
/// @param layout           the layout.
/// @param edges            out: n_seam_edges edge numbers, 1-based, negative where the seam runs against the
///                         edge's direction; seam after seam.
/// @param edges_capacity   entries of `edges`.
/// @param starts           out: n_seams + 1 offsets: seam i is edges[starts[i] .. starts[i + 1]).
/// @param starts_capacity  entries of `starts`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_layout_seam_edges(
    layout: *const ricci_layout,
    edges: *mut i32,
    edges_capacity: usize,
    starts: *mut usize,
    starts_capacity: usize,
) -> ricci_status {
    guard::call(|door| {
        let seams = &door.shared(layout)?.layout.cut.segments;
        copy_paths(seams, (edges, edges_capacity), (starts, starts_capacity))
    })
}

/// The faces that are not counterclockwise, as `n_flipped` counts them.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
///
/// @param layout    the layout.
/// @param faces     out: n_flipped face indices.
/// @param capacity  entries of `faces`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_layout_flipped(
    layout: *const ricci_layout,
    faces: *mut u32,
    capacity: usize,
) -> ricci_status {
    guard::call(|door| {
        let flipped: Vec<u32> = door.shared(layout)?.layout.flipped.iter().map(|f| f.0).collect();
        copy_out("faces", &flipped, faces, capacity)
    })
}

/// The quasi-conformal dilatation of every face: 1 is conformal.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
///
/// @param layout    the layout.
/// @param qc        out: n_faces values, at least 1.
/// @param capacity  entries of `qc`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_layout_qc(
    layout: *const ricci_layout,
    qc: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(layout, |layout| copy_out("qc", &layout.quality.qc, qc, capacity))
}

/// The area distortion of every face: its share of the layout's area over its share of the input's.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
///
/// @param layout    the layout.
/// @param ratio     out: n_faces values.
/// @param capacity  entries of `ratio`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_layout_area_ratio(
    layout: *const ricci_layout,
    ratio: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(layout, |layout| copy_out("ratio", &layout.quality.area_ratio, ratio, capacity))
}

impl ricci_layout {
    /// A layout in the plane or, in a model with two coordinates, in the hyperbolic plane.
    pub(crate) fn new(
        surface: Arc<Solution>,
        layout: Layout,
        input_positions: &Option<Arc<Vec<Point>>>,
        model: Model,
    ) -> Outcome<ricci_layout> {
        if model == Model::Hyperboloid {
            return Err(Failure::argument("a layout in the plane needs a model with two coordinates"));
        }
        let positions = match (input_positions, layout.refinement()) {
            (Some(positions), Some(r)) => Some(Arc::new(r.from_input_vertices(positions)?)),
            (positions, _) => positions.clone(),
        };
        Ok(ricci_layout {
            poison: Poison::default(),
            quality: layout.quality(surface.given(), surface.surface().lengths())?,
            points: match layout.space {
                Space::H2 => model::plane_points(model, &layout.points),
                _ => layout.coordinates.clone(),
            },
            on_input: layout.on_input(),
            input_positions: input_positions.clone(),
            layout: Arc::new(layout),
            positions,
            model,
            surface,
        })
    }

    pub(crate) fn corners(&self) -> Vec<[u32; 3]> {
        corners_of(self.layout.mesh(), &self.layout.corner_index)
    }

    /// It lies in the Euclidean plane.
    pub(crate) fn check_plane(&self) -> Outcome {
        if self.layout.space == Space::E2 { Ok(()) } else { Err(not_projective()) }
    }

    /// What homogeneous weights of vertices are multiplied with at every point; nothing in the Euclidean plane.
    pub(crate) fn heights(&self) -> Outcome<Vec<f64>> {
        match (self.layout.space, self.model) {
            (Space::E2, _) => Ok(Vec::new()),
            (_, Model::Klein) => Ok(self.layout.points.iter().map(|p| p[2]).collect()),
            _ => Err(not_projective()),
        }
    }
}

pub(crate) fn corners_of(mesh: &Mesh, index: &PerHalfedge<u32>) -> Vec<[u32; 3]> {
    mesh.faces().map(|f| mesh.face_halfedges(f).map(|h| index[h])).collect()
}

pub(crate) fn not_projective() -> Failure {
    let message =
        "the map is not projective in these coordinates: take RICCI_MODEL_KLEIN in the hyperbolic plane";
    Failure::new(ricci_status::RICCI_LAYOUT, message)
}
