//! An annulus in log coordinates: the flat cylinder with straight ends, opened into the strip `[0, 2π] × [0, 2π m]`.
//!
//! In the unit disk the inner circle of an annulus of modulus m has the radius e^(−2π m), which f64s do not hold beyond m = 118, and sees the
//! outer one from a distance that costs digits long before. In the strip both are lines, and all triangles have comparable sizes.

use super::domain::{CircleDomain, CircleReport, DomainCircle};
use super::options::{CircleDomainOptions, DomainFrame};
use super::place::rims;
use super::prepare::PreparedSurface;
use super::verdict::largest_curvature;
use crate::control::Control;
use crate::embed::{Layout, LayoutOptions, LayoutScale};
use crate::error::{Error, Result};
use crate::flow::Flow;
use crate::geometry::Space;
use crate::geometry::complex::norm;
use crate::geometry::{DoubleDouble, Motion, worse};
use crate::mesh::{HalfedgeId, PerVertex, VertexId};
use crate::metric::target::longest_loop;
use crate::metric::{Class, Surface};
use crate::topology::shortest_paths;
use std::f64::consts::TAU;
use std::sync::Arc;

pub(super) fn solve(
    prepared: PreparedSurface,
    options: &CircleDomainOptions,
    control: &Control,
) -> Result<CircleDomain> {
    let PreparedSurface { split, surface, filled, .. } = prepared;
    let outer = options.outer.unwrap_or_else(|| longest_loop(&surface));
    let mut flow = Flow::new(surface.clone(), Class::yamabe(Space::E2), &options.of_flow(), control)?;
    let flat = PerVertex::filled(surface.mesh().n_vertices(), 0.0);
    let report = flow.reach(&flat, &control.part(0.0, 0.6))?.clone();
    if report.is_reached() {
        flow.flatten(control)?;
    }
    let metric = flow.solution();
    let curvature = metric.metric().angle_defects(metric.mesh())?;
    let (domain_curvature_error, worst_vertex) = largest_curvature(&curvature, |_| true);
    let subdivision = Arc::new(metric.common_subdivision(&control.part(0.6, 0.8))?);
    let rims = rims(&subdivision, &filled);
    let layout_options = LayoutOptions {
        subdivision: Some(subdivision),
        scale: LayoutScale::AsSolved,
        ..LayoutOptions::default()
    };
    let layout = Layout::of_solution(&metric, &layout_options, &control.part(0.8, 1.0))?;
    let layout = upright(layout, &rims[outer], &rims[1 - outer])?;
    let circles = circles(&layout, &rims, outer);
    let vertices: usize = circles.iter().map(|c| c.vertices).sum();
    let modulus = layout.area / (TAU * TAU);
    let report = CircleReport {
        converged: false,
        stop_reason: report.stop_reason,
        iterations: report.iterations,
        flips: metric.flips(),
        max_curvature_error: report.max_curvature_error,
        domain_curvature_error,
        worst_vertex,
        deviation: 0.0,
        worst_loop: None,
        centred_on: None,
        halved_edges: split.n_added(),
        crossed_edges: vertices - filled.loops.iter().map(Vec::len).sum::<usize>(),
        least_gap: f64::INFINITY,
        puncture: None,
        seconds: report.seconds,
    };
    let frame = DomainFrame::Strip;
    let (outer, modulus) = (Some(outer), Some(modulus));
    let domain = CircleDomain {
        split,
        filled,
        metric,
        frame,
        layout,
        circles,
        outer,
        modulus,
        torus_modulus: None,
        report,
    };
    Ok(domain.judged(options.flow.tolerance))
}

/// A number that the modulus of an annulus is at least, up to a factor of about 2: the squared distance of its loops over its area. The distance
/// is measured along edges, which is too long.
pub(super) fn modulus_estimate(surface: &Surface, control: &Control) -> Result<f64> {
    let (mesh, loops) = (surface.mesh(), surface.mesh().boundary_loops());
    let [first, second] = &loops[..] else { return Ok(0.0) };
    let from: Vec<VertexId> = first.iter().map(|&h| mesh.origin(h)).collect();
    let distance = shortest_paths(mesh, surface.lengths(), from, control)?.distance;
    let apart = second.iter().map(|&h| distance[mesh.origin(h)]).fold(f64::INFINITY, f64::min);
    Ok(apart * apart / surface.area()?)
}

/// The layout of a flat cylinder with the circumference 2π, its first loop along y = 0, with a vertex at x = 0, and the second one above it.
fn upright(mut layout: Layout, first: &[HalfedgeId], second: &[HalfedgeId]) -> Result<Layout> {
    let around = match &layout.seams[..] {
        [seam] => seam.isometry().translation,
        seams => {
            let n = seams.len();
            return Err(Error::Layout(format!("a cylinder is cut along one path, this one along {n}")));
        }
    };
    let length = norm(around);
    let area = layout.area / (length * length) * TAU * TAU;
    layout.scale_to_area(area)?;
    let zero = [DoubleDouble::from(0.0); 2];
    let [x, y] = around.map(|x| x / length);
    layout.move_by(&Motion::in_plane([x, -y].map(DoubleDouble::from), zero).normalised())?;
    let [below, above] = [first, second].map(|rim| mean_height(&layout, rim));
    if below > above {
        layout.move_by(&Motion::in_plane([-1.0, 0.0].map(DoubleDouble::from), zero))?;
    }
    let x = first.first().map_or(0.0, |&h| layout.uv(h)[0]);
    let home = [-x, -mean_height(&layout, first)].map(DoubleDouble::from);
    layout.move_by(&Motion::in_plane([1.0, 0.0].map(DoubleDouble::from), home))?;
    Ok(layout)
}

/// The mean height of the vertices of a loop.
fn mean_height(layout: &Layout, rim: &[HalfedgeId]) -> f64 {
    rim.iter().map(|&h| layout.uv(h)[1]).sum::<f64>() / rim.len().max(1) as f64
}

/// The circles in the unit disk, whose radii are e^(−y). A difference of heights is one of radii as a share of them.
fn circles(layout: &Layout, rims: &[Vec<HalfedgeId>], outer: usize) -> Vec<DomainCircle> {
    let circle = |(k, rim): (usize, &Vec<HalfedgeId>)| {
        let height = if k == outer { 0.0 } else { mean_height(layout, rim) };
        let deviation = rim.iter().map(|&h| (layout.uv(h)[1] - height).abs()).fold(0.0, worse);
        let (centre, radius, log_radius) = ([0.0; 2], (-height).exp(), 0.0 - height);
        DomainCircle { boundary_loop: k, centre, radius, log_radius, deviation, vertices: rim.len() }
    };
    rims.iter().enumerate().map(circle).collect()
}
