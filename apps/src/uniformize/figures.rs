//! The figures of a surface of genus 1 or more, or with boundary, for the reports of `ricci uniformize` and `ricci cover`.

use super::group_file::letters;
use super::lifts;
use super::quotient::Uniformized;
use crate::report::Figures;
use crate::runner::CommandRun;
use ricci::embed::{BoundaryLoop, BoundarySide};
use ricci::mesh::HalfedgeId;
use serde_json::{Value, json};

/// The figures of a quotient; `copies`: a cover was asked for.
pub fn of_quotient(u: &Uniformized, copies: bool, run: &CommandRun<'_>) -> Figures {
    let laid = u.laid().ok();
    let layout = laid.map_or(&u.layout, |laid| &laid.layout);
    let lengths = &u.lengths;
    let length = |path: &Vec<HalfedgeId>| path.iter().map(|h| lengths[h.edge()]).sum::<f64>();
    let figures = Figures::of_metric(&u.solved)
        .course(&u.report, &u.solved)
        .with("max_curvature_error", u.solved.curvature_error())
        // max |K| of the metric that was laid out, in double-double precision.
        .with("angle_defect", u.angle_defect)
        .precision(&u.report)
        .with("flipped_triangles", u.flipped().len())
        .distortion(laid)
        // The area of the metric: 4π(g − 1) in H², the area of the given surface in E².
        .with("area", u.layout.area)
        // The vertex at the origin, and the largest distance of a vertex from it.
        .with("base", u.basis.base.0)
        .with("radius", layout.radius)
        // Largest distance of the two places of a corner, see the check layout_consistency.
        .with("disagreement", layout.disagreement)
        .with("word", letters(&u.deck.group, &u.deck.group.relator()))
        .with("relation_residual", u.deck.relation_residual)
        // ‖R − I‖ of the relator's matrix, not relative to anything.
        .with("relation_error", u.deck.relation_error)
        // The distance of the isometries of the layout's sides from those of their words.
        .with("side_residual", u.deck.side_residual)
        .with("traces", u.deck.traces())
        .with("translation_lengths", u.deck.translation_lengths())
        // Total length of each generator's loop on the surface, in the metric.
        .with("loop_lengths", u.basis.loops.iter().map(length).collect::<Vec<_>>())
        .if_some("modulus", u.deck.modulus())
        .if_some("modulus", u.extremal_distance);
    crate::modulus::add_figures(figures, u.modulus.as_ref())
        .if_some(
            "boundary_lengths",
            bordered(u).then(|| u.boundary.iter().map(|b| b.length()).collect::<Vec<_>>()),
        )
        .if_some(
            "boundary",
            bordered(u).then(|| u.boundary.iter().map(|b| loop_figures(u, b)).collect::<Vec<_>>()),
        )
        .if_some("corners", (!u.corners.is_empty()).then(|| corners(u)))
        .if_some("geodesics", (!u.geodesics.is_empty()).then(|| words(u)))
        .with(
            "domain",
            u.domain().ok().map(|d| json!({"sides": d.sides.len(), "area": d.area, "radius": d.radius})),
        )
        .if_some("no_domain", u.domain.as_ref().and_then(|d| d.as_ref().err()).cloned())
        // The reason why the layout is not carried back to the given triangulation; the figures of that are null then.
        .if_some("no_refinement", u.laid.as_ref().and_then(|laid| laid.as_ref().err()).cloned())
        .if_some("copies", u.elements.as_ref().ok().filter(|_| copies).map(Vec::len))
        .if_some("lifts", lifts::figures(u))
        .missing(run)
        .with("residuals", u.report.residuals.clone())
}

fn bordered(u: &Uniformized) -> bool {
    !u.boundary.is_empty()
}

/// A boundary loop, in the order of the input's: its generator, its length, and its sides from corner to corner.
fn loop_figures(u: &Uniformized, around: &BoundaryLoop) -> Value {
    let side = |side: &BoundarySide| {
        let BoundarySide { from, length, straightness } = side;
        json!({"from": from.0, "length": length, "straightness": straightness})
    };
    json!({
        "generator": u.deck.group.name(around.generator),
        "length": around.length(),
        "sides": around.sides.iter().map(side).collect::<Vec<_>>()
    })
}

/// The corners with the angles inside, in degrees.
fn corners(u: &Uniformized) -> Value {
    u.corners.iter().map(|(v, angle)| json!({"vertex": v.0, "angle": angle.to_degrees()})).collect()
}

/// The words that were asked for, with the lengths of their closed geodesics.
fn words(u: &Uniformized) -> Value {
    u.geodesics.iter().map(|(word, length)| json!({"word": word, "length": length})).collect()
}
