//! The layout of a quotient, on the metric's triangulation and on the given surface.

use crate::arrays::{check_buffer, copy_out};
use crate::choice::{choose, name};
use crate::control::{self, ricci_control};
use crate::deck::ricci_deck;
use crate::edges::{copy_paths, halfedges};
use crate::failure::Outcome;
use crate::guard;
use crate::layout::ricci_layout;
use crate::model::{self, ricci_model};
use crate::quotient::ricci_quotient;
use crate::report::ricci_stop_reason;
use crate::sized::{self, sized};
use crate::space::ricci_space;
use crate::status::ricci_status;
use ricci::Control;
use ricci::canonical::Quotient;
use ricci::geometry::model::Model;
use std::mem::MaybeUninit;
use std::sync::Arc;

/// Figures of a quotient.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_quotient_summary {
    /// Bytes of this struct that are filled.
    pub size: usize,
    /// RICCI_SPACE_E2 for a torus, RICCI_SPACE_H2 for genus 2 and more.
    pub space: ricci_space,
    /// The base vertex, at the origin.
    pub base: u32,
    /// Why the flow stopped.
    pub stop_reason: ricci_stop_reason,
    /// 1 if the curvature is within the tolerance and no triangle is broken, else 0.
    pub converged: i32,
    /// g.
    pub genus: usize,
    /// Largest |K| after corrections with twice the digits of doubles, radians.
    pub angle_defect: f64,
    /// F of ricci_quotient_mesh.
    pub n_faces: usize,
    /// Number of points of the layout: vertices on the cut count once per piece of their star.
    pub n_points: usize,
    /// Number of segments of the cut.
    pub n_segments: usize,
    /// Number of edges of all segments.
    pub n_cut_edges: usize,
    /// Number of sides of the layout as a fundamental domain, two per segment.
    pub n_sides: usize,
    /// Number of generators, 2 g.
    pub n_generators: usize,
    /// Corners of ricci_quotient_polygon, 4 g.
    pub n_polygon: usize,
    /// Faces of the layout that are not counterclockwise, by exact arithmetic on the points.
    pub n_flipped: usize,
    /// Faces whose lengths break the triangle inequality.
    pub n_broken: usize,
    /// Largest distance between where a face has its corner and where the corner lies, also across the cut by the side pairings.
    pub disagreement: f64,
    /// Largest distance of a point from the origin.
    pub radius: f64,
    /// Area, by a formula without angles: of a torus that of the given surface, else 4 pi (g - 1).
    pub area: f64,
    /// |R - I| / max |P_k|^2 of the relation's matrix R over its partial products P_k, Frobenius norms of 2 x 2 matrices.
    pub relation_residual: f64,
    /// The same of each side's pairing against its word; the largest.
    pub side_residual: f64,
    /// Ambient coordinates of the base lift, from which deck transformations are counted: the origin, up to a loop of the base on the cut.
    pub base_lift: [f64; 3],
}

// SAFETY: only ever written by the library; 8-byte alignment, size first.
sized!(ricci_quotient_summary, "summary");

/// The figures of a quotient.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE.
///
/// @param quotient  the quotient.
/// @param summary   out: the figures.
/// @param size      sizeof *summary.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_quotient_summarise(
    quotient: *const ricci_quotient,
    summary: *mut ricci_quotient_summary,
    size: usize,
) -> ricci_status {
    guard::call(|door| {
        let Quotient { report, angle_defect, metric, layout, basis, deck } =
            &*door.shared(quotient)?.quotient;
        let figures = ricci_quotient_summary {
            size,
            space: name(layout.space)?,
            base: basis.base.0,
            stop_reason: report.stop_reason.into(),
            converged: report.converged().into(),
            genus: basis.group.genus,
            angle_defect: *angle_defect,
            n_faces: metric.mesh().n_faces(),
            n_points: layout.points.len(),
            n_segments: layout.cut.segments.len(),
            n_cut_edges: layout.cut.segments.iter().map(Vec::len).sum(),
            n_sides: deck.sides.len(),
            n_generators: deck.generators.len(),
            n_polygon: deck.group.relator().len(),
            n_flipped: layout.flipped.len(),
            n_broken: layout.broken.len(),
            disagreement: layout.disagreement,
            radius: layout.radius,
            area: layout.area,
            relation_residual: deck.relation_residual,
            side_residual: deck.side_residual,
            base_lift: layout.corner(deck.corner),
        };
        sized::write(figures, summary, size)
    })
}

/// The points of the layout in a model.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT.
///
/// @param quotient  the quotient.
/// @param model     coordinates of the hyperbolic plane; of a torus all two-dimensional models are the plane itself, and
///                  RICCI_MODEL_HYPERBOLOID is (x, y, 1).
/// @param points    out: n_points x 2; n_points x 3 for RICCI_MODEL_HYPERBOLOID, the ambient coordinates that ricci_deck_apply takes.
/// @param capacity  entries of `points`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_quotient_points(
    quotient: *const ricci_quotient,
    model: MaybeUninit<ricci_model>,
    points: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::call(|door| {
        let layout = &door.shared(quotient)?.quotient.layout;
        copy_out(
            "points",
            &model::coordinates(layout.space, choose(model)?, &layout.points),
            points,
            capacity,
        )
    })
}

/// The point of every corner of every face of ricci_quotient_mesh.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
///
/// @param quotient  the quotient.
/// @param corners   out: n_faces x 3 indices of points.
/// @param capacity  entries of `corners`, at least 3 n_faces.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_quotient_corners(
    quotient: *const ricci_quotient,
    corners: *mut u32,
    capacity: usize,
) -> ricci_status {
    guard::call(|door| {
        let Quotient { metric, layout, .. } = &*door.shared(quotient)?.quotient;
        let mesh = metric.mesh();
        let indices = |f| mesh.face_halfedges(f).map(|h| layout.corner_index[h]);
        let rows: Vec<[u32; 3]> = mesh.faces().map(indices).collect();
        copy_out("corners", &rows, corners, capacity)
    })
}

/// The cut along which the layout is opened: chains of edges of ricci_quotient_mesh.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
///
/// @param quotient         the quotient.
/// @param edges            out: n_cut_edges edge numbers, 1-based, negative against the edge's direction; segment after segment.
/// @param edges_capacity   entries of `edges`.
/// @param starts           out: n_segments + 1 offsets: segment i is edges[starts[i] .. starts[i + 1]).
/// @param starts_capacity  entries of `starts`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_quotient_cut(
    quotient: *const ricci_quotient,
    edges: *mut i32,
    edges_capacity: usize,
    starts: *mut usize,
    starts_capacity: usize,
) -> ricci_status {
    guard::call(|door| {
        let segments = &door.shared(quotient)?.quotient.layout.cut.segments;
        copy_paths(segments, (edges, edges_capacity), (starts, starts_capacity))
    })
}

/// The lift of an edge path of ricci_quotient_mesh that starts at the base, from the base lift, in ambient coordinates: the start, then
/// the end of each edge. That of a loop ends where the loop's element carries the base lift.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT (no such edges, no path, or not from the base).
///
/// @param quotient  the quotient.
/// @param path      n_path edges: 1-based, negative where the path runs against the edge's direction.
/// @param n_path    number of edges.
/// @param points    out: (n_path + 1) x 3.
/// @param capacity  entries of `points`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_quotient_lift(
    quotient: *const ricci_quotient,
    path: *const i32,
    n_path: usize,
    points: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::call(|door| {
        let Quotient { metric, layout, deck, .. } = &*door.shared(quotient)?.quotient;
        let path = halfedges("path", metric.mesh(), path, n_path)?;
        copy_out("points", &layout.lift(deck.corner, &path)?, points, capacity)
    })
}

/// The canonical polygon: geodesics from lift to lift of the base along the relation. Its sides a1, b1, a1^-1, b1^-1, ... are paired by
/// the generators; its corners are one point of the surface, so its angles add up to 2 pi. It need not be convex.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
///
/// @param quotient  the quotient.
/// @param corners   out: n_polygon x 3, ambient coordinates; corner k is where the first k letters of the relation carry the base lift.
/// @param angles    out: n_polygon angles inside, radians, from 0 to below 2 pi.
/// @param capacity  rows of `corners` and entries of `angles`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_quotient_polygon(
    quotient: *const ricci_quotient,
    corners: *mut f64,
    angles: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::call(|door| {
        let Quotient { layout, deck, .. } = &*door.shared(quotient)?.quotient;
        let base = layout.corner(deck.corner);
        let (points, inside) = (deck.canonical_polygon(base)?, deck.canonical_angles(base)?);
        check_buffer("angles", inside.len(), angles, capacity)?;
        copy_out("corners", &points, corners, capacity.saturating_mul(3))?;
        copy_out("angles", &inside, angles, capacity)
    })
}

/// The generators of the deck group: M(g) carries the base lift to the end of the lift of g's loop, M(g h) = M(g) M(h).
///
/// @return RICCI_OK, RICCI_NULL_POINTER.
///
/// @param quotient  the quotient.
/// @param deck      out: the new handle, n_generators elements, to be released by ricci_deck_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_quotient_generators(
    quotient: *const ricci_quotient,
    deck: *mut *mut ricci_deck,
) -> ricci_status {
    guard::make("deck", deck, |door| Ok(ricci_deck::generators(&door.shared(quotient)?.quotient.deck)))
}

/// The sides of the layout as a fundamental domain, counterclockwise: the elements that carry it onto its neighbours.
///
/// @return RICCI_OK, RICCI_NULL_POINTER.
///
/// @param quotient  the quotient.
/// @param deck      out: the new handle, n_sides elements, to be released by ricci_deck_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_quotient_sides(
    quotient: *const ricci_quotient,
    deck: *mut *mut ricci_deck,
) -> ricci_status {
    guard::make("deck", deck, |door| {
        let group = &door.shared(quotient)?.quotient.deck;
        Ok(ricci_deck::new(group, group.sides.clone()))
    })
}

/// The layout on the given surface: the common refinement of its mesh and of the metric's triangulation, whose vertices are those of the
/// mesh, then the crossings. All functions on layouts take it.
///
/// Its seams are the segments of ricci_quotient_cut. The dilatations are those of Poincare coordinates.
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT (RICCI_MODEL_HYPERBOLOID), RICCI_TRIANGLE_INEQUALITY, RICCI_DOMAIN,
/// RICCI_EDGE_WEIGHT, RICCI_TOO_LARGE (the refinement), RICCI_CANCELLED.
///
/// @param quotient  the quotient.
/// @param model     coordinates of the points; in the Klein disk the map is projective on every piece. A torus has one model.
/// @param control   progress and cancellation; NULL for neither.
/// @param layout    out: the new handle, to be released by ricci_layout_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_quotient_layout(
    quotient: *const ricci_quotient,
    model: MaybeUninit<ricci_model>,
    control: *const ricci_control,
    layout: *mut *mut ricci_layout,
) -> ricci_status {
    guard::make("layout", layout, |door| {
        let quotient = door.shared(quotient)?;
        refined(quotient, choose(model)?, &control::of(control))
    })
}

fn refined(quotient: &ricci_quotient, model: Model, control: &Control) -> Outcome<ricci_layout> {
    let Quotient { metric, layout, .. } = &*quotient.quotient;
    let refined = layout.refined(&Arc::new(metric.refinement(control)?), metric.metric(), control)?;
    ricci_layout::new(Arc::new(metric.clone()), refined, &metric.surface().positions().cloned(), model)
}
