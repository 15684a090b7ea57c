//! Flows that hold the lengths of a surface's outer loop and close its other loops while they solve ([`Target::Outer`]).
//!
//! A hole whose loop develops to a closed polygon of the plane, as every hole of a flat plate does, is closed by triangles of that polygon: a
//! surface that is flat already then keeps u = 0. Any other hole is closed by a hub at equal distances from its loop. With its caps the
//! surface is a disk. On it the flow leads to K̄ = 0 everywhere inside. Since the disk is flat, the surface unrolls around every hole to where
//! it began: its layout is one piece without a seam.
//!
//! At first the edges of the loops are kept from being flipped: the metric of the disk restricted to the surface is then one of the
//! surface's own class. If a triangle breaks that way, the flow runs again with all edges inside the disk free, so that only those at its
//! boundary can break: Delaunay triangles do not [GLSW18]. If one does, the outer loop gets flaps, which are equilateral triangles outside
//! of its edges, and these may be flipped too; u is then still held at its vertices, but its edges need not be straight any more. Such a
//! solution lives on the surface with its caps ([`Solution::caps`]), and its layout on the common subdivision of the surface with that.

use super::Flow;
use super::cones::with_cones_placed;
use super::hubs::start_radius;
use super::options::{Flips, Options};
use super::origin::FlowOrigin;
use super::report::{Report, StopReason};
use super::solution::Solution;
use crate::control::Control;
use crate::error::{Error, Result};
use crate::geometry::complex::{Complex, add, distance, norm};
use crate::geometry::polygon_triangles::polygon_triangles;
use crate::geometry::{DoubleDouble, Space, triangle, worse};
use crate::mesh::caps::{Cap, CappedMesh};
use crate::mesh::{EdgeId, HalfedgeId, Mesh, PerEdge, PerVertex, VertexId};
use crate::metric::initial::weight_of_length;
use crate::metric::target::longest_loop;
use crate::metric::{Class, Metric, Surface, Target};
use std::f64::consts::TAU;
use std::sync::Arc;

/// Largest distance of the ends of a developed loop, as a share of its length, and largest difference in radians of its turning from 2π, with
/// which it counts as closed. The polygon only has to be near: what it misses is curvature that the flow removes.
const CLOSED: f64 = 1e-3;
/// Least `r₁ r₂ r₃ / s³` of a triangle of a cap, r half the differences of its sides and s half their sum: thinner ones are all rounding.
const THINNEST: f64 = 1e-14;

/// The end of the flow on a surface with its caps.
struct CappedEnd {
    report: Report,
    u: PerVertex<f64>,
    u_low: PerVertex<f64>,
}

/// The curvature of every vertex that a target asks of a surface: [`Target::resolve`] with the cones of `Auto` placed, and for `Outer` the
/// curvature of the boundary that a flow in this class finds.
///
/// # Errors
/// Those of [`super::with_cones_placed`] and [`Target::resolve`]; for `Outer` those of [`super::flow`], and [`Error::TargetKind`] if it does
/// not get there, or flips edges of loops on the way, which then bend between vertices.
pub fn prescribed_curvature(
    target: &Target,
    surface: &Surface,
    class: Class,
    control: &Control,
) -> Result<PerVertex<f64>> {
    if let Target::Outer(_) = target {
        target.check(surface, class)?;
        let end = super::flow(surface.clone(), class, target, &Options::default(), control)?;
        return curvature_at_vertices(&end, target);
    }
    with_cones_placed(target, surface, class.space, control)?.resolve(surface, class)
}

/// The target of the end of a flow to [`Target::Outer`], if values at vertices prescribe it.
fn curvature_at_vertices(end: &Solution, target: &Target) -> Result<PerVertex<f64>> {
    let refused = |message: String| Error::TargetKind { target: target.name(), message };
    let reached = end.report().filter(|report| report.is_reached());
    let Some(curvature) = end.target().filter(|_| reached.is_some()) else {
        let stop = end.report().map_or("not begun", |report| report.stop_reason.name());
        return Err(refused(format!("the flow that finds its curvature ended with: {stop}; use `boundary`")));
    };
    if end.caps().is_some() {
        let message = "edges of boundary loops are flipped on the way, so that loops bend between vertices and no values at vertices prescribe \
                       it; solve for it without values, or use `boundary`";
        return Err(refused(message.into()));
    }
    Ok(curvature.clone())
}

impl Flow {
    /// The solve for [`Target::Outer`].
    ///
    /// # Errors
    /// Those of [`Target::check`]; [`Error::Cancelled`], [`Error::Factorisation`]: the flow is then where it was before.
    pub(super) fn solve_outer(&mut self, outer: Option<usize>, control: &Control) -> Result<Solution> {
        let given = self.given().clone();
        Target::Outer(outer).check(self.surface(), Class::yamabe(self.metric.space))?;
        let outer = outer.unwrap_or_else(|| longest_loop(self.surface()));
        let pinned = given.vertices().filter(|&v| given.is_boundary_vertex(v)).collect();
        let options = Options { pinned, ..self.options.clone() };
        let mut open = match self.double() {
            None => Flow::go_on(self.now.at_start(), &options, self.pool.clone())?,
            Some(_) => Flow::new(self.surface().clone(), self.scheme_class()?, &options, control)?,
        };
        let mut first = None;
        if given.boundary_loops().len() > 1 {
            let CappedEnd { report, u, u_low } = open.flow_with_caps(outer, control)?;
            if self.may_cross(&report) {
                return self.solve_across_loops(outer, report, control);
            }
            open.set_start(u, u_low)?;
            first = Some(report);
        }
        let report = open.reach(&PerVertex::filled(given.n_vertices(), 0.0), control)?.clone();
        if self.may_cross(&report) {
            return self.solve_across_loops(outer, report, control);
        }
        open.options.pinned = self.options.pinned.clone();
        open.holds_outer = true;
        if let Some(reached) = &mut open.now.reached {
            let rest = std::mem::replace(&mut reached.report, Report::new(options.tolerance));
            reached.report = match first {
                Some(first) => first.with_holes_open(rest),
                None => rest,
            };
            reached.is_one_piece = reached.report.is_reached();
        }
        *self = open;
        Ok(self.solution())
    }

    /// The flow to K̄ = 0 on the surface whose loops but `outer` are capped ([`capped`]), with u held at that loop.
    fn flow_with_caps(&self, outer: usize, control: &Control) -> Result<CappedEnd> {
        let n = self.mesh.n_vertices();
        let (mesh, metric, rims) = capped(&self.mesh, &self.metric, outer, &Cap::Open)?;
        let pinned = self.vertices_of_loop(outer);
        let fixed_edges = self.options.fixed_edges.iter().copied().chain(rims).collect();
        let flips = if self.flips_allowed { Flips::Auto } else { Flips::Never };
        let options = Options { pinned, fixed_edges, flips, ..self.options.clone() };
        let origin = FlowOrigin::of_metric(mesh, &metric, self.flips_allowed)?;
        let mut flow = Flow::go_on(Solution::start(origin), &options, self.pool.clone())?;
        let flat = PerVertex::filled(flow.mesh.n_vertices(), 0.0);
        let mut report = flow.reach(&flat, control)?.clone();
        report.worst.retain(|(v, _)| v.index() < n);
        if let Some(obstruction) = &mut report.obstruction {
            obstruction.vertices.retain(|v| v.index() < n);
        }
        let first = |values: &PerVertex<f64>| values.iter().take(n).copied().collect::<Vec<_>>().into();
        Ok(CappedEnd { report, u: first(&flow.metric.u), u_low: first(&flow.metric.u_low) })
    }

    fn vertices_of_loop(&self, k: usize) -> Vec<VertexId> {
        let given = self.given();
        given.boundary_loops()[k].iter().map(|&h| given.origin(h)).collect()
    }

    /// True for a flow that ended with broken triangles, which flips of edges of loops may mend.
    fn may_cross(&self, report: &Report) -> bool {
        let is_broken = matches!(report.stop_reason, StopReason::BrokenTriangles);
        is_broken && self.flips_allowed && self.class().is_some() && self.surface().geometry() == Space::E2
    }

    /// The solve for [`Target::Outer`] with the edges of capped loops free to be flipped, then, if that fails too, with those of the outer
    /// loop free as well, after one with all of them kept, which ended with this report.
    fn solve_across_loops(&mut self, outer: usize, kept: Report, control: &Control) -> Result<Solution> {
        let mut flow = self.flow_across_loops(outer, Cap::Open, kept, control)?;
        if let Some(report) = flow.report().filter(|report| self.may_cross(report)).cloned() {
            flow = self.flow_across_loops(outer, Cap::Flaps, report, control)?;
        }
        *self = flow;
        Ok(self.solution())
    }

    /// The flow on the surface with its caps, among which the outer loop has this one.
    fn flow_across_loops(&self, outer: usize, cap: Cap, before: Report, control: &Control) -> Result<Flow> {
        let (class, surface) = (self.scheme_class()?, self.surface().clone());
        let options = Options { pinned: self.vertices_of_loop(outer), ..self.options.clone() };
        let n = surface.mesh().n_vertices();
        let origin = self.pool.run(|| {
            let metric = surface.initial(class)?.metric;
            let (mesh, metric, _) = capped(surface.mesh(), &metric, outer, &cap)?;
            let lengths = metric.lengths(&mesh)?;
            FlowOrigin::with_caps(
                surface,
                Surface::intrinsic(mesh, lengths, Space::E2)?,
                class,
                &options,
                control,
            )
        })?;
        let mut flow = Flow::go_on(Solution::start(origin), &options, self.pool.clone())?;
        let mesh = flow.now.mesh.clone();
        // The tips of flaps are held, too.
        mesh.vertices()
            .skip(n)
            .filter(|&v| mesh.is_boundary_vertex(v))
            .for_each(|v| flow.pinned[v.index()] = true);
        flow.reach(&PerVertex::filled(n, 0.0), control)?;
        flow.options.pinned = self.options.pinned.clone();
        flow.holds_outer = true;
        let curvature = flow.curvature()?.at;
        let given = flow.given().clone();
        if let Some(reached) = &mut flow.now.reached {
            let across = std::mem::replace(&mut reached.report, Report::new(options.tolerance));
            reached.report = before.then(across);
            reached.report.worst.retain(|(v, _)| v.index() < n);
            reached.is_one_piece = reached.report.is_reached();
            let on_loops = given.vertices().filter(|&v| given.is_boundary_vertex(v));
            on_loops.for_each(|v| reached.target[v] = curvature[v]);
        }
        Ok(flow)
    }
}

impl Report {
    /// The report of a flow with capped holes, and of the `rest` on the open surface with u held at the loops, which has little left to do.
    fn with_holes_open(self, rest: Report) -> Report {
        let Report { stop_reason, max_curvature_error, rounding_floor, unknowns, factor_entries, .. } = self;
        let (is_reached, worst, obstruction) =
            (self.is_reached(), self.worst.clone(), self.obstruction.clone());
        let joined = self.then(rest);
        let error = worse(joined.max_curvature_error, max_curvature_error);
        let (unknowns, factor_entries) =
            (joined.unknowns.max(unknowns), joined.factor_entries.max(factor_entries));
        let joined = Report { max_curvature_error: error, unknowns, factor_entries, ..joined };
        if is_reached && !matches!(stop_reason, StopReason::RoundingFloor { .. }) {
            return joined;
        }
        Report { stop_reason, rounding_floor, worst, obstruction, ..joined }
    }
}

/// The surface with all loops capped, the `outer` one by the cap that is given; its metric, which is that of the open surface off the caps,
/// and the edges of the loops with caps.
fn capped(
    open: &Mesh,
    metric: &Metric,
    outer: usize,
    outer_cap: &Cap,
) -> Result<(Mesh, Metric, Vec<EdgeId>)> {
    let lengths = metric.lengths(open)?;
    let curvature = metric.curvature(open)?.at;
    let loops = open.boundary_loops();
    let polygons: Vec<Option<CapPolygon>> = (0..loops.len())
        .map(|k| CapPolygon::of_loop(open, &lengths, &curvature, &loops[k]).filter(|_| k != outer))
        .collect();
    let cap = |(k, polygon): (usize, &Option<CapPolygon>)| match polygon {
        _ if k == outer => outer_cap.clone(),
        Some(polygon) => Cap::Triangles(polygon.triangles.clone()),
        None => Cap::Hub,
    };
    let capped = CappedMesh::new(open, polygons.iter().enumerate().map(cap).collect())?;
    let new = CapLengths::new(open, &lengths, &capped, &polygons);
    let n_new = capped.mesh.n_vertices() - open.n_vertices();
    let with = |values: &[f64]| -> PerVertex<f64> {
        values.iter().copied().chain(std::iter::repeat_n(0.0, n_new)).collect::<Vec<_>>().into()
    };
    let epsilon: Vec<i8> = metric.epsilon.iter().copied().chain(std::iter::repeat_n(0, n_new)).collect();
    let mut metric =
        Metric { epsilon: epsilon.into(), u: with(&metric.u), u_low: with(&metric.u_low), ..metric.clone() };
    let mut eta: Vec<DoubleDouble> = metric.eta.iter().copied().collect();
    for e in (open.n_edges()..capped.mesh.n_edges()).map(EdgeId::from) {
        let ends = capped.mesh.ends(e);
        eta.push(weight_of_length(metric.space, new.length(ends), ends.map(|v| metric.vertex(v))));
    }
    metric.eta = Arc::new(PerEdge::from(eta));
    Ok((capped.mesh, metric, capped.rims))
}

/// The lengths of the edges of caps.
struct CapLengths {
    /// Per vertex of a polygon its corner.
    corner: PerVertex<Complex>,
    /// Per hub its distance from the vertices of its loop, and per tip of a flap the length of the edge below it, as flaps are equilateral;
    /// 0 elsewhere.
    radius: PerVertex<f64>,
}

impl CapLengths {
    fn new(
        open: &Mesh,
        lengths: &PerEdge<f64>,
        capped: &CappedMesh,
        polygons: &[Option<CapPolygon>],
    ) -> CapLengths {
        let n = capped.mesh.n_vertices();
        let mut corner = PerVertex::filled(n, [0.0; 2]);
        let mut radius = PerVertex::filled(n, 0.0);
        for (k, rim) in open.boundary_loops().iter().enumerate() {
            if let Some(polygon) = &polygons[k] {
                rim.iter().zip(&polygon.corners).for_each(|(&h, &p)| corner[open.origin(h)] = p);
            }
            if let Some(hub) = capped.hubs[k] {
                radius[hub] = start_radius(lengths, rim);
            }
            let flaps = capped.flaps[k].iter().zip(rim);
            flaps.for_each(|(&tip, h)| radius[tip] = lengths[h.edge()]);
        }
        CapLengths { corner, radius }
    }

    /// The length of an edge of a cap between these vertices.
    fn length(&self, [a, b]: [VertexId; 2]) -> f64 {
        let hub = self.radius[a].max(self.radius[b]);
        if hub > 0.0 { hub } else { distance(self.corner[a], self.corner[b]) }
    }
}

/// A hole as a polygon of the plane, to which its loop develops.
struct CapPolygon {
    /// Per half-edge of the loop its origin.
    corners: Vec<Complex>,
    triangles: Vec<[u32; 3]>,
}

impl CapPolygon {
    /// `curvature`: π minus the angles at vertices of the boundary. None for a loop that does not develop to a closed simple polygon.
    fn of_loop(
        open: &Mesh,
        lengths: &PerEdge<f64>,
        curvature: &PerVertex<f64>,
        rim: &[HalfedgeId],
    ) -> Option<CapPolygon> {
        let turning: f64 = rim.iter().map(|&h| -curvature[open.origin(h)]).sum();
        let around: f64 = rim.iter().map(|h| lengths[h.edge()]).sum();
        if (turning - TAU).abs() > CLOSED {
            return None;
        }
        let (mut at, mut direction) = ([0.0; 2], 0.0f64);
        let mut corners = Vec::with_capacity(rim.len());
        for &h in rim {
            if !corners.is_empty() {
                direction -= curvature[open.origin(h)];
            }
            corners.push(at);
            at = add(at, [direction.cos(), direction.sin()].map(|x| lengths[h.edge()] * x));
        }
        if norm(at) > CLOSED * around {
            return None;
        }
        let triangles = polygon_triangles(&corners)?;
        let side = |i: u32, j: u32| {
            let [i, j] = [i as usize, j as usize];
            if (i + 1) % rim.len() == j { lengths[rim[i].edge()] } else { distance(corners[i], corners[j]) }
        };
        let is_sound = |&[a, b, c]: &[u32; 3]| is_triangle([side(b, c), side(c, a), side(a, b)]);
        triangles.iter().all(is_sound).then_some(CapPolygon { corners, triangles })
    }
}

/// True for lengths of a triangle that is not nearly a line.
fn is_triangle(sides: [f64; 3]) -> bool {
    let r = triangle::half_differences(sides);
    let s: f64 = r.iter().sum();
    r.iter().all(|&r| r > 0.0) && r.iter().map(|r| r / s).product::<f64>() > THINNEST
}
