//! Circle domains of genus 1 and more: flat tori and hyperbolic surfaces with round holes.

use super::domain::{CircleDomain, CircleReport, DomainCircle};
use super::options::{CircleDomainOptions, DomainFrame};
use super::place::{anchor_weights, deviation, hub_edge, least_gap, loops_of_edges, rims};
use super::prepare::PreparedSurface;
use crate::control::Control;
use crate::embed::layout::distance_from_origin;
use crate::embed::{Layout, LayoutOpening, LayoutOptions, LayoutScale};
use crate::error::Result;
use crate::flow::{Flow, Solution};
use crate::geometry::motion::precise_point;
use crate::geometry::triangle::sine;
use crate::geometry::{DoubleDouble, Motion};
use crate::geometry::{Space, conformal};
use crate::mesh::{EdgeId, FilledMesh, HalfedgeId, PerVertex, VertexId};
use crate::metric::CommonSubdivision;
use crate::topology::{central_vertex, cut_about_joined};
use std::sync::Arc;

pub(super) fn solve(
    prepared: PreparedSurface,
    options: &CircleDomainOptions,
    control: &Control,
) -> Result<CircleDomain> {
    let PreparedSurface { split, filled, start, .. } = prepared;
    let mut flow = Flow::resume(&start, &options.of_flow(), control)?;
    let flat = PerVertex::filled(filled.mesh.n_vertices(), 0.0);
    let report = flow.reach(&flat, &control.part(0.0, 0.6))?.clone();
    let metric = flow.solution();
    let whole = whole_layout(&metric, &filled, &control.part(0.6, 0.8))?;
    let mut subdivision =
        metric.common_subdivision_where(&|f| filled.is_original(f), &control.part(0.8, 0.9))?;
    round_off(&mut subdivision, &metric, &filled)?;
    let subdivision = Arc::new(subdivision);
    let again = |r| whole.on_subdivision(&r, metric.metric(), &control.part(0.9, 1.0));
    let mut layout = again(subdivision)?.with_straight_sides(&metric, control, again)?;
    layout.measure_area();
    if layout.space == Space::E2 {
        layout.scale_to_area(split.given().area()?)?;
    }
    let circles = circles(&whole, &layout, &metric, &filled);
    let least_gap = least_gap(metric.mesh(), metric.metric(), &filled);
    let vertices: usize = circles.iter().map(|c| c.vertices).sum();
    let report = CircleReport {
        converged: false,
        stop_reason: report.stop_reason,
        iterations: report.iterations,
        flips: metric.flips(),
        max_curvature_error: report.max_curvature_error,
        domain_curvature_error: report.angle_defect.unwrap_or(report.max_curvature_error),
        worst_vertex: report.worst.first().map(|worst| worst.0),
        deviation: 0.0,
        worst_loop: None,
        centred_on: None,
        halved_edges: split.n_added(),
        crossed_edges: vertices - filled.loops.iter().map(Vec::len).sum::<usize>(),
        least_gap,
        puncture: None,
        seconds: report.seconds,
    };
    let torus_modulus = whole.modulus();
    Ok(CircleDomain {
        split,
        filled,
        metric,
        layout,
        circles,
        outer: None,
        modulus: None,
        torus_modulus,
        frame: DomainFrame::Auto,
        report,
    }
    .judged(options.flow.tolerance))
}

/// The closed surface laid out, opened along a cut that keeps away from the disks.
fn whole_layout(metric: &Solution, filled: &FilledMesh, control: &Control) -> Result<Layout> {
    let mesh = metric.mesh();
    let lengths = metric.metric().lengths(mesh)?;
    // Once a disk is reached, all of it is joined first, then the faces around it.
    let mut urgency = PerVertex::filled(mesh.n_vertices(), 0);
    for hub in filled.hubs() {
        mesh.outgoing(hub).for_each(|h| urgency[mesh.tip(h)] = 1);
    }
    filled.hubs().into_iter().for_each(|hub| urgency[hub] = 2);
    let root = central_vertex(mesh, &lengths, control)?;
    let joined = |e: EdgeId| mesh.ends(e).into_iter().map(|v| urgency[v]).fold(0, u8::max);
    let cut = cut_about_joined(mesh, &lengths, root, &joined, control)?;
    let options = LayoutOptions {
        opening: LayoutOpening::MetricCut(cut),
        root: Some(root),
        scale: LayoutScale::AsSolved,
        ..LayoutOptions::default()
    };
    Layout::of_solution(metric, &options, control)
}

/// Move the crossings on edges at hubs so that those of loops lie on their circles.
fn round_off(subdivision: &mut CommonSubdivision, metric: &Solution, filled: &FilledMesh) -> Result<()> {
    let (mesh, space) = (metric.mesh(), metric.metric().space);
    let lengths = metric.metric().lengths(mesh)?;
    let loops = loops_of_edges(filled);
    let radius = |v: VertexId| conformal::radius(space, metric.metric().epsilon[v], metric.metric().u[v]);
    for crossing in &mut subdivision.crossings {
        let e = crossing[1].edge;
        let Some(edge) = hub_edge(mesh, metric.metric(), filled, e, None) else { continue };
        let ends = mesh.ends(e);
        let own_loop = loops.get(&crossing[0].edge).copied();
        let [a, b] = anchor_weights(&edge, ends.map(|v| filled.loop_of(v)), own_loop, crossing[1].weights);
        // An anchor as a combination of the ends: a share of the way, measured by x or sinh x.
        let part = |i: usize| {
            let near = if edge.is_hub[i] { radius(ends[i]) } else { 0.0 };
            [sine(space, lengths[e] - near), sine(space, near)].map(|x| x / sine(space, lengths[e]))
        };
        let ([own, far], [other_own, other_far]) = (part(0), part(1));
        let weights = [a * own + b * other_far, a * far + b * other_own];
        let sum = weights[0] + weights[1];
        crossing[1].weights = weights.map(|w| w / sum);
    }
    Ok(())
}

/// The circles in the layout, one lift of each.
fn circles(whole: &Layout, layout: &Layout, metric: &Solution, filled: &FilledMesh) -> Vec<DomainCircle> {
    let Some(subdivision) = layout.common_subdivision() else { return Vec::new() };
    let space = layout.space;
    let factor = layout.scale / whole.scale;
    let circle = |(k, rim): (usize, Vec<HalfedgeId>)| {
        let hub = filled.hub(k);
        let [x, y, w] = whole.corner(whole.mesh().out(hub));
        let centre = if space == Space::E2 { [factor * x, factor * y, w] } else { [x, y, w] };
        let scale = if space == Space::E2 { layout.scale } else { 1.0 };
        let radius = scale * conformal::radius(space, 1, metric.metric().u[hub]);
        // If the cut runs along the loop, the surface lies at another copy of the disk.
        let copy = |g: HalfedgeId| match subdivision.halfedge(1, g) {
            Some(h) => pairing(whole, h, factor),
            None => Motion::identity(space),
        };
        let deviation = deviation(rim.len(), radius, |i| {
            let home = Motion::to_origin(space, copy(rim[i]).apply(precise_point(space, centre)));
            let seen = home.apply(precise_point(space, layout.corner(rim[i])));
            distance_from_origin(space, seen.map(f64::from))
        });
        DomainCircle {
            boundary_loop: k,
            centre: layout.flat(centre),
            radius,
            log_radius: radius.ln(),
            deviation,
            vertices: rim.len(),
        }
    };
    rims(subdivision, filled).into_iter().enumerate().map(circle).collect()
}

/// [`Layout::neighbour`] of a layout of which lengths become `factor` times as long.
fn pairing(whole: &Layout, h: HalfedgeId, factor: f64) -> Motion<DoubleDouble> {
    let mut motion = whole.neighbour(h);
    if whole.space == Space::E2 {
        motion.b = motion.b.map(|x| x * factor.into());
    }
    motion
}
