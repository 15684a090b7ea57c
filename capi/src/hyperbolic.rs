//! Layouts of hyperbolic metrics.

use crate::choice::choose;
use crate::control::{self, ricci_control};
use crate::drawing::{Drawing, Hyperbolic};
use crate::failure::{Failure, Outcome};
use crate::guard::{self, Poison};
use crate::layout::{cones, ricci_layout};
use crate::metric::ricci_metric;
use crate::model::{self, ricci_model};
use crate::status::ricci_status;
use ricci::Control;
use ricci::embed::{RefinedSpaceLayout, unroll_refined_in_space};
use ricci::flow::Solution;
use ricci::geometry::Space;
use ricci::geometry::model::Model;
use ricci::mesh::{HalfedgeId, Point, VertexId};
use ricci::metric::Refinement;
use std::mem::MaybeUninit;
use std::sync::Arc;

/// Unroll a hyperbolic metric, of a closed surface or one with boundary, into the hyperbolic plane about its centre.
///
/// The surface is cut open as little as its topology asks for, and through every interior vertex whose target is not 0; the metric should
/// have curvature -1 at all others, and `consistency` says how far its corners are apart, as a distance. What is unrolled is the common
/// refinement. A closed surface with its deck group: ricci_quotient_from_metric.
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_WRONG_SIZE, RICCI_ARGUMENT (RICCI_MODEL_HYPERBOLOID), RICCI_TRIANGLE_INEQUALITY,
/// RICCI_LAYOUT (not H2; points beyond the reach of doubles), RICCI_DOMAIN, RICCI_EDGE_WEIGHT, RICCI_TOO_LARGE (the refinement),
/// RICCI_CANCELLED.
///
/// @param metric      the metric, in H2.
/// @param target      the n_vertices curvatures it was made for.
/// @param n_vertices  number of vertices of the mesh that the metric was made from.
/// @param model       coordinates of the points; in the Klein disk the map is projective on every piece.
/// @param control     progress and cancellation; NULL for neither.
/// @param layout      out: the new handle, to be released by ricci_layout_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_layout_hyperbolic(
    metric: *const ricci_metric,
    target: *const f64,
    n_vertices: usize,
    model: MaybeUninit<ricci_model>,
    control: *const ricci_control,
    layout: *mut *mut ricci_layout,
) -> ricci_status {
    guard::make("layout", layout, |door| {
        let metric = door.shared(metric)?;
        let cones = cones(metric.given(), target, n_vertices)?;
        unroll(metric, &cones, choose(model)?, &control::of(control))
    })
}

fn unroll(
    metric: &ricci_metric,
    cones: &[VertexId],
    model: Model,
    control: &Control,
) -> Outcome<ricci_layout> {
    let ricci_metric { surface, positions, .. } = metric;
    let space = surface.metric().space;
    if space != Space::H2 {
        let message = format!(
            "this metric lives in {space}: ricci_layout_hyperbolic unrolls those in h2, ricci_layout_new those in e2"
        );
        return Err(Failure::new(ricci_status::RICCI_LAYOUT, message));
    }
    let curvature = surface.curvature()?;
    if let Some(f) = curvature.broken.first() {
        let message = format!("face {f} of the metric's triangulation breaks the triangle inequality");
        return Err(Failure::new(ricci_status::RICCI_TRIANGLE_INEQUALITY, message));
    }
    let refinement = surface.refinement(control)?;
    let (refined, cut) =
        unroll_refined_in_space(&refinement, surface.mesh(), surface.metric(), cones, control)?;
    in_space(surface, refinement, positions, (refined, cut.segments, curvature.area), model)
}

/// The handle of a refinement laid out in the plane or the hyperbolic plane, with the half-edges of its seams and its area.
pub(crate) fn in_space(
    surface: &Solution,
    refinement: Refinement,
    positions: &Option<Arc<Vec<Point>>>,
    (refined, seams, area): (RefinedSpaceLayout, Vec<Vec<HalfedgeId>>, f64),
    model: Model,
) -> Outcome<ricci_layout> {
    if model == Model::Hyperboloid {
        return Err(Failure::argument("a layout in the plane needs a model with two coordinates"));
    }
    let quality = refined.quality(&refinement, surface.given(), surface.surface().lengths())?;
    let in_plane = refined.space == Space::E2;
    let flat = |p: &[f64; 3]| [p[0], p[1]];
    let points: Vec<[f64; 2]> = match in_plane {
        true => refined.points.iter().map(flat).collect(),
        false => model::plane_points(model, &refined.points),
    };
    let bound = |pick: fn(f64, f64) -> f64, i: usize| points.iter().map(|p| p[i]).reduce(pick).unwrap_or(0.0);
    let span = |i| bound(f64::max, i) - bound(f64::min, i);
    let diameter = span(0).hypot(span(1));
    let positions = match positions {
        Some(positions) => Some(Arc::new(refinement.from_input_vertices(positions)?)),
        None => None,
    };
    let drawing = Drawing {
        seams,
        motions: None,
        corner_index: refined.corner_index,
        hyperbolic: (!in_plane).then_some(Hyperbolic { points: refined.points, model }),
        points,
        flipped: refined.flipped,
        consistency: refined.disagreement / if in_plane { diameter } else { 1.0 },
        diameter,
        area,
    };
    Ok(ricci_layout {
        poison: Poison::default(),
        mesh: Arc::new(refinement.mesh.clone()),
        positions,
        drawing,
        quality,
        surface: Arc::new(surface.clone()),
        refinement: Some(Arc::new(refinement)),
    })
}
