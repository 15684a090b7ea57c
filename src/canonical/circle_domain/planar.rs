//! Circle domains of genus 0: from the plane of a punctured sphere into the unit disk.

use super::super::puncture::{PlaneReport, PlaneSolver};
use super::super::star::PuncturedSurface;
use super::super::tries::{FoundPlane, PunctureSearch};
use super::disk::DomainInDisk;
use super::domain::{CircleDomain, CircleReport, DomainCircle};
use super::options::{CircleDomainOptions, DomainFrame, Normalisation, ROUND};
use super::place::{anchor_weights, deviation, hub_edge, least_gap, loops_of_edges, rims};
use super::precise_map::PrecisePlanePoint;
use super::prepare::PreparedSurface;
use super::verdict::largest_curvature;
use super::view::DiskView;
use crate::control::Control;
use crate::embed::{Layout, PlanarPlaces};
use crate::error::Result;
use crate::flow::{FlowSeconds, Solution};
use crate::geometry::complex::{Complex, add, norm, scale, sub};
use crate::geometry::double_double::two_sum;
use crate::geometry::mobius::PlaneCircle;
use crate::geometry::{DoubleDouble, Space, triangle, worse};
use crate::mesh::{EdgeId, FilledMesh, Mesh, PerEdge, PerVertex, VertexId};
use crate::metric::lengths::face_lengths;
use crate::metric::target::longest_loop;
use crate::metric::{CommonSubdivision, Metric, Split, Surface};
use std::f64::consts::TAU;
use std::sync::Arc;

pub(super) fn solve(
    prepared: PreparedSurface,
    options: &CircleDomainOptions,
    control: &Control,
) -> Result<CircleDomain> {
    let PreparedSurface { split, surface, filled, start } = prepared;
    let outer = options.outer.unwrap_or_else(|| longest_loop(&surface));
    let weights = vertex_areas(&surface, &filled);
    let (flow, tolerance) = (options.of_flow(), options.flow.tolerance);
    let (mesh, mut metric, followed) = start.parts();
    let unit = unit(&metric);
    in_units(&mesh, &mut metric, unit);
    shift(&mut metric, 1, -unit.ln());
    let begin = PuncturedSurface { mesh, metric, at: VertexId(0), followed, flips: 0 };
    let may = inside(&begin.mesh, surface.mesh(), &filled);
    let mut tried = PunctureSearch::new(&weights, PlaneSolver::new(&begin, &flow, control)?).only(may);
    let FoundPlane { surface: on, found, .. } = tried.best(&begin)?;
    let plane = on.unfold_precisely(&control.part(0.6, 0.7))?;
    let (iterations, seconds) = (tried.solver.iterations, tried.solver.seconds);
    drop(tried);
    let view = DiskView::new(&on, &plane, &filled, outer);
    let inner = |view: &DiskView| -> Vec<PlaneCircle> {
        (0..filled.loops.len()).filter(|&k| k != outer).map(|k| view.circle(k)).collect()
    };
    let rim = rim_of(surface.mesh(), outer);
    let points = view.apply(&plane);
    let disk = DomainInDisk { points: &points, weights: &weights, inner: &inner(&view), rim: &rim };
    let mut view = view.then(&disk.normalised(&options.normalisation)?);
    let is_centred = options.normalisation == Normalisation::Centred;
    if let ([only], true) = (&inner(&view)[..], is_centred) {
        // The first transformation was rounded, to a share of the unit disk and not of the circle.
        view = view.then(&only.to_centre());
    }
    let found = PlanarSolution { split, surface, filled, start, on, plane, found, outer, unit, tolerance };
    let mut domain = found.seen(view.clone(), &control.part(0.7, 0.9))?;
    (domain.report.iterations, domain.report.seconds) = (iterations, seconds);
    let domain = domain.judged(tolerance);
    let is_lost = domain.report.worst_loop.is_some_and(|k| k != outer) && domain.report.deviation > ROUND;
    if is_lost && is_centred { found.about_worst(view, domain, &control.part(0.9, 1.0)) } else { Ok(domain) }
}

/// A planar surface in the plane, with all that a domain is made of.
struct PlanarSolution {
    split: Split,
    surface: Surface,
    filled: FilledMesh,
    start: Solution,
    /// The surface whose metric the plane has.
    on: PuncturedSurface,
    plane: PerVertex<PrecisePlanePoint>,
    found: PlaneReport,
    outer: usize,
    /// The unit of length of that metric.
    unit: f64,
    /// Largest |K| of a converged domain.
    tolerance: f64,
}

impl PlanarSolution {
    /// The domain in the disk as a view shows it; steps and seconds are 0, and it is not judged yet.
    fn seen(&self, view: DiskView, control: &Control) -> Result<CircleDomain> {
        let PlanarSolution { on, plane, filled, outer, unit, .. } = self;
        let mut metric = view.metric(on, plane);
        in_units(&on.mesh, &mut metric, 1.0 / unit);
        shift(&mut metric, 0, -unit.ln());
        let solution = self.start.clone().at(on.mesh.clone(), metric, on.followed.clone(), on.flips);
        let domain = PlanarDomain { view, plane, solution: &solution, filled, outer: *outer };
        let subdivision = Arc::new(solution.common_subdivision_where(&|f| filled.is_original(f), control)?);
        let layout = domain.layout(self.surface.mesh(), subdivision)?;
        let circles = domain.circles(&layout);
        let vertices: usize = circles.iter().map(|c| c.vertices).sum();
        let (domain_curvature_error, worst_vertex) = domain.curvature_error()?;
        let report = CircleReport {
            converged: false,
            stop_reason: self.found.stop_reason,
            iterations: 0,
            flips: solution.flips(),
            max_curvature_error: self.found.error,
            domain_curvature_error,
            worst_vertex,
            deviation: 0.0,
            worst_loop: None,
            centred_on: None,
            halved_edges: self.split.n_added(),
            crossed_edges: vertices - filled.loops.iter().map(Vec::len).sum::<usize>(),
            least_gap: least_gap(solution.mesh(), solution.metric(), filled),
            puncture: Some(on.at),
            seconds: FlowSeconds::default(),
        };
        let modulus = (filled.loops.len() == 2).then(|| modulus_of(&domain));
        Ok(CircleDomain {
            split: self.split.clone(),
            circles,
            modulus,
            layout,
            outer: Some(*outer),
            torus_modulus: None,
            frame: DomainFrame::Disk,
            report,
            metric: solution,
            filled: filled.clone(),
        })
    }

    /// The domain with the circle of the worst loop of `other` about 0, where f64s are dense, if it is rounder than `other`; else that one.
    fn about_worst(&self, view: DiskView, other: CircleDomain, control: &Control) -> Result<CircleDomain> {
        let Some(k) = other.report.worst_loop else { return Ok(other) };
        let view = view.then(&view.circle(k).to_centre());
        let view = view.then(&view.circle(k).to_centre());
        let mut domain = self.seen(view, control)?;
        let CircleReport { iterations, seconds, .. } = other.report;
        (domain.report.iterations, domain.report.seconds) = (iterations, seconds);
        domain.report.centred_on = Some(k);
        let domain = domain.judged(self.tolerance);
        Ok(if domain.report.deviation < other.report.deviation { domain } else { other })
    }
}

/// One third of the area of the given faces at each vertex, in units of the whole; 0 at hubs.
fn vertex_areas(surface: &Surface, filled: &FilledMesh) -> PerVertex<f64> {
    let (mesh, space) = (surface.mesh(), surface.geometry());
    let longest = surface.lengths().iter().fold(0.0, |m: f64, &l| m.max(l));
    let unit = if space == Space::E2 { longest } else { 1.0 };
    let mut areas = PerVertex::filled(filled.mesh.n_vertices(), 0.0);
    for f in mesh.faces() {
        let third = triangle::area(space, face_lengths(mesh, surface.lengths(), f).map(|l| l / unit)) / 3.0;
        mesh.face_vertices(f).into_iter().for_each(|v| areas[v] += third);
    }
    areas
}

/// The vertices that may be sent to infinity: interior ones, without those next to a loop if others exist.
fn inside(mesh: &Mesh, open: &Mesh, filled: &FilledMesh) -> PerVertex<bool> {
    let is_inside = |v: VertexId| filled.loop_of(v).is_none() && !open.is_boundary_vertex(v);
    let is_far = |v: VertexId| is_inside(v) && mesh.outgoing(v).all(|h| is_inside(mesh.tip(h)));
    let far = PerVertex::from_fn(mesh.n_vertices(), is_far);
    if far.contains(&true) { far } else { PerVertex::from_fn(mesh.n_vertices(), is_inside) }
}

/// A power of two of about the size of the longest edge.
fn unit(metric: &Metric) -> f64 {
    let largest = metric.eta.iter().map(|eta| eta.high).fold(f64::MIN_POSITIVE, f64::max);
    2f64.powi((0.5 * largest.log2()).round() as i32)
}

/// η with the vectors of points divided by `unit`, a power of two.
fn in_units(mesh: &Mesh, metric: &mut Metric, unit: f64) {
    let Metric { epsilon, eta, .. } = metric;
    let eta = Arc::make_mut(eta);
    for e in mesh.edges() {
        let points = mesh.ends(e).into_iter().filter(|&v| epsilon[v] == 0).count();
        let factor = unit.powi(-(points as i32));
        eta[e] = DoubleDouble { high: eta[e].high * factor, low: eta[e].low * factor };
    }
}

/// Add a constant to u at all vertices of a type.
fn shift(metric: &mut Metric, epsilon: i8, by: f64) {
    for v in
        (0..metric.u.len()).map(VertexId::from).filter(|&v| metric.epsilon[v] == epsilon).collect::<Vec<_>>()
    {
        let (sum, lost) = two_sum(metric.u[v], by);
        (metric.u[v], metric.u_low[v]) = two_sum(sum, lost + metric.u_low[v]);
    }
}

/// The vertices of a loop, with the surface on their left.
fn rim_of(open: &Mesh, k: usize) -> Vec<VertexId> {
    let mut rim: Vec<VertexId> = open.boundary_loops()[k].iter().map(|&h| open.origin(h)).collect();
    rim[1..].reverse();
    rim
}

/// A planar circle domain: its view, its metric and its hubs.
struct PlanarDomain<'a> {
    view: DiskView,
    plane: &'a PerVertex<PrecisePlanePoint>,
    solution: &'a Solution,
    filled: &'a FilledMesh,
    outer: usize,
}

impl PlanarDomain<'_> {
    /// The layout on the subdivision of the open surface.
    fn layout(&self, open: &Arc<Mesh>, subdivision: Arc<CommonSubdivision>) -> Result<Layout> {
        let points = self.view.apply(self.plane);
        let (mesh, metric) = (self.solution.mesh(), self.solution.metric());
        let loops = loops_of_edges(self.filled);
        let place = |e: EdgeId, input: EdgeId, weights: [f64; 2]| {
            let ends = mesh.ends(e);
            let Some(edge) = hub_edge(mesh, metric, self.filled, e, Some(self.outer)) else {
                return add(scale(weights[0], points[ends[0]]), scale(weights[1], points[ends[1]]));
            };
            let hubs = ends.map(|v| self.filled.loop_of(v));
            let [a, b] = anchor_weights(&edge, hubs, loops.get(&input).copied(), weights);
            let anchor = |i: usize| match hubs[i] {
                Some(k) => self.view.anchor(self.plane, k, ends[1 - i]),
                None => points[ends[i]],
            };
            add(scale(a, anchor(0)), scale(b, anchor(1)))
        };
        let mut places: Vec<Complex> = points.iter().take(subdivision.n_vertices[0]).copied().collect();
        places.extend(subdivision.crossings.iter().map(|c| place(c[1].edge, c[0].edge, c[1].weights)));
        let [disagreement, local_consistency] = self.misses(&points)?;
        let places = PlanarPlaces { plane: places.into(), disagreement, local_consistency };
        Layout::of_planar_domain(open, subdivision, places)
    }

    /// True if a face of the metric's triangulation has the shape in the disk that the metric gives it: false at the outer hub.
    fn is_inside(&self, vertices: [VertexId; 3]) -> bool {
        !vertices.contains(&self.filled.hub(self.outer))
    }

    /// Largest difference of a length in the disk from that of the metric; and relative to the longest side of a face.
    fn misses(&self, points: &PerVertex<Complex>) -> Result<[f64; 2]> {
        let mesh = self.solution.mesh();
        let lengths = self.solution.metric().lengths(mesh)?;
        let off = PerEdge::from_fn(mesh.n_edges(), |e| {
            let [a, b] = mesh.ends(e).map(|v| points[v]);
            (norm(sub(a, b)) - lengths[e]).abs()
        });
        let inside = mesh.faces().filter(|&f| self.is_inside(mesh.face_vertices(f)));
        Ok(inside.fold([0.0; 2], |[all, local], f| {
            let sides = mesh.opposite_edges(f);
            let miss = sides.iter().map(|&e| off[e]).fold(0.0, worse);
            let longest = sides.iter().map(|&e| lengths[e]).fold(0.0, f64::max);
            [worse(all, miss), worse(local, miss / longest)]
        }))
    }

    /// Largest |K| of the disk's metric off the outer hub and its neighbours, and where it is.
    fn curvature_error(&self) -> Result<(f64, Option<VertexId>)> {
        let mesh = self.solution.mesh();
        let mut counts = PerVertex::filled(mesh.n_vertices(), true);
        let hub = self.filled.hub(self.outer);
        counts[hub] = false;
        mesh.outgoing(hub).for_each(|h| counts[mesh.tip(h)] = false);
        let curvature = self.solution.metric().curvature(mesh)?.at;
        Ok(largest_curvature(&curvature, |v| counts[v]))
    }

    fn circles(&self, layout: &Layout) -> Vec<DomainCircle> {
        let Some(subdivision) = layout.common_subdivision() else { return Vec::new() };
        let all = rims(subdivision, self.filled).into_iter().enumerate();
        let circle = |(k, rim): (usize, Vec<crate::mesh::HalfedgeId>)| {
            let PlaneCircle { centre, radius } = self.view.circle(k);
            let deviation = deviation(rim.len(), radius, |i| norm(sub(layout.uv(rim[i]), centre)));
            let log_radius = radius.ln();
            DomainCircle { boundary_loop: k, centre, radius, log_radius, deviation, vertices: rim.len() }
        };
        all.map(circle).collect()
    }
}

/// Height over circumference of the cylinder that an annulus is.
fn modulus_of(domain: &PlanarDomain) -> f64 {
    let k = 1 - domain.outer;
    let centred = domain.view.then(&domain.view.circle(k).to_centre());
    -centred.circle(k).radius.ln() / TAU
}
