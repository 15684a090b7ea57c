//! Uniformizes closed surfaces of genus 0: puts them on the unit sphere [Riv94; Spr20; BPS15].
//!
//! ```
//! use ricci::canonical::{SphereOptions, uniformize_sphere};
//! use ricci::{Control, Surface, mesh::shapes};
//! let surface = Surface::from_soup(&shapes::ellipsoid([1.0, 2.0, 3.0], 4)?)?;
//! let sphere = uniformize_sphere(&surface, &SphereOptions::default(), &Control::new())?;
//! assert!(sphere.report.converged);
//! assert!(sphere.positions.iter().all(|[x, y, z]| (x * x + y * y + z * z - 1.0).abs() < 1e-14));
//! # Ok::<(), ricci::Error>(())
//! ```

use super::candidates::range;
use super::lift::{lifted, nonconvexity, off_centre};
use super::puncture::PlaneSolver;
use super::star::{NEARLY_FLAT, PuncturedSurface};
use super::tries::{FoundPlane, PunctureSearch, on_a_circle, said};
use crate::archive::stored;
use crate::control::Control;
use crate::error::{Error, Result, check_size};
use crate::flow::{Flow, FlowSeconds, Options, Solution, StopReason};
use crate::geometry::double_double::two_sum;
use crate::geometry::{DoubleDouble, Space, largest, triangle};
use crate::mesh::{Mesh, PerVertex, Point, VertexId};
use crate::metric::lengths::face_lengths;
use crate::metric::{Class, Curvature, Metric, Surface};
use crate::parallel::Pool;
use crate::topology::check_vertex;
use std::sync::Arc;

/// Radians. The angles opposite an edge of a result may exceed π by this, and its outline may turn the wrong way by this: it is far above
/// rounding, and far below the excess at a wrong edge.
const DELAUNAY: f64 = 1e-9;
/// Largest number of Newton steps on the sphere after the lift. One or two correct the rounding of the plane.
const POLISH_STEPS: usize = 10;

/// Options of [`uniformize_sphere`].
#[derive(Debug, Clone, PartialEq)]
pub struct SphereOptions {
    /// Largest |K| inside the plane, radians. Default 1e-10.
    pub tolerance: f64,
    /// Newton steps of the whole call, over all vertices that are tried, before giving up; 0 (default) means 500.
    pub max_iterations: usize,
    /// The vertex to send to infinity. Default `None`: one from which u has a small range.
    pub puncture: Option<VertexId>,
    /// Threads; 0 (default) is one per core. The result does not depend on it.
    pub threads: usize,
}

impl Default for SphereOptions {
    fn default() -> Self {
        SphereOptions { tolerance: 1e-10, max_iterations: 0, puncture: None, threads: 0 }
    }
}

/// The report of [`uniformize_sphere`].
#[derive(Debug, Clone, PartialEq)]
pub struct SphereReport {
    /// True if plane and sphere have K = 0 to the tolerance, every edge is Delaunay and the outline is convex, these two to 1e-9.
    pub converged: bool,
    /// Why the last flow stopped; `stalled` also if it reached its target, but the polyhedron is not convex.
    pub stop_reason: StopReason,
    /// Newton steps of the whole call.
    pub iterations: usize,
    /// Seconds of the flows; the rest of the call is neither in the phases nor in `total`.
    pub seconds: FlowSeconds,
    /// Flips inside the class, on the way to the result.
    pub flips: usize,
    /// Isometric flips before them.
    pub start_flips: usize,
    /// The vertex at infinity of the plane, at (0, 0, −1) on the sphere.
    pub puncture: VertexId,
    /// Flows that were started.
    pub tried: usize,
    /// max |K| of the plane at all vertices but the puncture and its link, radians.
    pub max_curvature_error: f64,
    /// max |K| of the spherical metric, radians, measured from its variables.
    pub spherical_curvature_error: f64,
    /// max |Σ K + area − 4π| of the spherical metric.
    pub gauss_bonnet: f64,
    /// Largest minus smallest u of the plane. Beyond about 30 positions on the sphere run out of digits (edges near 1e-14); the metric does
    /// not.
    pub u_range: f64,
    /// Length of the shortest edge of the spherical metric.
    pub smallest_edge: f64,
    /// Largest excess over π of the planar angles opposite an edge, radians: 0 if all edges are Delaunay.
    pub delaunay_violation: f64,
    /// Least turning of the planar outline, the link of the puncture, radians: not negative if it is convex.
    pub link_turning: f64,
    /// Largest signed distance of a vertex over the plane of a neighbouring face: not positive where the positions are convex.
    pub nonconvexity: f64,
    /// `|Σ w x|/Σ w` of the positions, w one third of the area of the given faces at a vertex.
    pub centring: f64,
}
stored!(sections SphereReport { converged, stop_reason, iterations, flips, start_flips, puncture, tried,
    max_curvature_error, spherical_curvature_error, gauss_bonnet, u_range, smallest_edge,
    delaunay_violation, link_turning, nonconvexity, centring } without { seconds });

/// A surface on the unit sphere.
#[derive(Debug, Clone)]
pub struct Sphere {
    /// The spherical metric, K = 0 at every vertex, with its triangulation and the way back to the given one: geodesic triangles
    /// over the faces of a convex polyhedron.
    pub metric: Solution,
    /// Unit vectors (V entries). Faces are counterclockwise from outside.
    pub positions: PerVertex<Point>,
    /// The plane under them by stereographic projection from (0, 0, −1) ([`crate::geometry::sphere::lift`]); (∞, ∞) at the puncture.
    pub plane: PerVertex<[f64; 2]>,
    /// The report.
    pub report: SphereReport,
}
stored!(sections Sphere { metric, positions, plane, report } check Sphere::check_parts);

impl Sphere {
    /// Checks that the parts of an archive fit each other.
    fn check_parts(&self) -> Result<()> {
        let n = self.metric.mesh().n_vertices();
        check_size("positions", self.positions.len(), n)?;
        check_size("points of the plane", self.plane.len(), n)
    }
}

/// A surface of genus 0 as a convex polyhedron in the unit sphere: the one whose edges, after flips inside the conformal class, are chords
/// of lengths in that class. A Möbius transformation makes `Σ w x = 0`, where w is one third of the area of the given faces at a vertex;
/// the positions are then determined up to a rotation.
///
/// One vertex is sent to infinity, the others flow to the plane, and the plane is lifted to the sphere.
///
/// # Errors
///
/// [`Error::Argument`] for a surface that is no sphere, or of fewer than four vertices; lengths and triangles as for [`Flow::new`];
/// [`Error::Layout`] where all vertices come to lie on one circle (the double of a polygon without inner vertices), where one has half
/// of the area or more, and where no plane was found; [`Error::Cancelled`].
pub fn uniformize_sphere(surface: &Surface, options: &SphereOptions, control: &Control) -> Result<Sphere> {
    control.check()?;
    check(surface.mesh(), options)?;
    Pool::new(options.threads)?.run(|| uniformize(surface, options, control))
}

fn check(given: &Mesh, options: &SphereOptions) -> Result<()> {
    if !given.is_closed() || given.euler() != 2 || given.n_vertices() < 4 {
        let kind = if given.is_closed() { "closed" } else { "with boundary" };
        let value =
            format!("{kind}, of {} vertices and Euler characteristic {}", given.n_vertices(), given.euler());
        let need = "one closed surface of genus 0 with at least four vertices (cut each triangle into four, `ricci refine --levels 1`)";
        return Err(Error::argument("surface", value, need));
    }
    flow(options).check()?;
    options.puncture.map_or(Ok(()), |v| check_vertex(given, v))
}

/// Options of all flows of a call.
fn flow(options: &SphereOptions) -> Options {
    let &SphereOptions { tolerance, max_iterations, threads, .. } = options;
    Options { tolerance, max_iterations, threads, ..Options::default() }
}

fn uniformize(surface: &Surface, options: &SphereOptions, control: &Control) -> Result<Sphere> {
    let from = Solution::delaunay(surface.clone(), Class::yamabe(Space::S2), &[], control)?;
    let (mesh, metric, followed) = from.parts();
    let n = mesh.n_vertices();
    let mut metric = Metric { space: Space::E2, u: PerVertex::filled(n, 0.0), ..metric };
    let unit = unit(&metric);
    Arc::make_mut(&mut metric.eta).iter_mut().for_each(|eta| *eta = scaled_by(*eta, 1.0 / unit));
    let weights = vertex_areas(surface, unit);
    let begin = PuncturedSurface { mesh, metric, at: VertexId(0), followed, flips: 0 };
    let flow = flow(options);
    let mut tried = PunctureSearch::new(&weights, PlaneSolver::new(&begin, &flow, control)?);
    let flat = match options.puncture {
        Some(v) => tried.punctured_at(&begin, v)?,
        None => tried.best(&begin)?,
    };
    let nearly_flat = flat.surface.is_flat(NEARLY_FLAT)?.then(|| on_a_circle(&flat.surface.mesh));
    let (stop_reason, error) = (flat.found.stop_reason, flat.found.error);
    match (raised(flat, from, unit, &mut tried), nearly_flat) {
        (Err(Error::Cancelled), _) => Err(Error::Cancelled),
        (Ok(sphere), why) if why.is_none() || sphere.report.converged => Ok(sphere),
        (_, Some(why)) => Err(why),
        (end, None) => end.map_err(|why| {
            let (steps, why) = (tried.solver.iterations, said(why));
            Error::Layout(format!(
                "no sphere over the plane that was found (max |K| = {error:.1e} after {steps} steps: {stop_reason}): {why}"
            ))
        }),
    }
}

/// The sphere over a plane: the polyhedron, and its metric as one of the surface `from` which the flows started, whose lengths are `unit`
/// times those of the plane's class.
fn raised(flat: FoundPlane, from: Solution, unit: f64, tried: &mut PunctureSearch) -> Result<Sphere> {
    let FoundPlane { surface, plane, found } = flat;
    let tolerance = tried.solver.options.tolerance;
    let view = surface.centre(&plane, tried.weights)?;
    let plane = PerVertex::from_fn(plane.len(), |v| view.apply(plane[v]));
    let (positions, spherical) = (lifted(&plane), surface.spherical(&plane, view.scale.ln()));
    let (mut metric, curvature) = polished(&surface.mesh, spherical, &mut tried.solver)?;
    let (delaunay_violation, error) = (surface.delaunay_violation()?, largest(curvature.at.iter()));
    let is_whole = curvature.broken.is_empty();
    let is_convex = delaunay_violation <= DELAUNAY && found.turning >= -DELAUNAY;
    let converged = found.converged && is_whole && is_convex && error <= tolerance;
    let report = SphereReport {
        converged,
        stop_reason: match found.stop_reason {
            // The flow reached its target, but the polyhedron is not convex.
            StopReason::Converged if !is_whole => StopReason::BrokenTriangles,
            StopReason::Converged if !converged => StopReason::Stalled,
            reason => reason,
        },
        iterations: tried.solver.iterations,
        seconds: tried.solver.seconds,
        flips: surface.flips,
        start_flips: from.start_flips(),
        puncture: surface.at,
        tried: tried.flows,
        max_curvature_error: found.error,
        spherical_curvature_error: error,
        gauss_bonnet: curvature.gauss_bonnet,
        u_range: range(&surface.metric.u, surface.at),
        smallest_edge: metric.lengths(&surface.mesh)?.iter().copied().fold(f64::INFINITY, f64::min),
        delaunay_violation,
        link_turning: found.turning,
        nonconvexity: nonconvexity(&surface.mesh, &positions),
        centring: off_centre(&positions, tried.weights),
    };
    Arc::make_mut(&mut metric.eta).iter_mut().for_each(|eta| *eta = scaled_by(*eta, unit));
    for (u, low) in metric.u.iter_mut().zip(metric.u_low.iter_mut()) {
        let (sum, lost) = two_sum(*u, -unit.ln());
        (*u, *low) = two_sum(sum, lost + *low);
    }
    let PuncturedSurface { mesh, followed, flips, .. } = surface;
    Ok(Sphere { metric: from.at(mesh, metric, followed, flips), positions, plane, report })
}

/// The spherical metric with K = 0 to the tolerance, and its curvature. The lifted metric is that up to the rounding of needles in the
/// plane, which Newton steps on the sphere correct.
fn polished(mesh: &Mesh, lifted: Metric, solver: &mut PlaneSolver) -> Result<(Metric, Curvature)> {
    let (flow, left) = (solver.options, solver.left());
    let curvature = lifted.curvature(mesh)?;
    if largest(curvature.at.iter()) <= flow.tolerance || left == 0 {
        return Ok((lifted, curvature));
    }
    let options = Options { max_iterations: POLISH_STEPS.min(left), ..flow.clone() };
    let mut flow = Flow::from_metric(mesh.clone(), lifted.clone(), &options)?;
    let report = flow.reach(&PerVertex::filled(mesh.n_vertices(), 0.0), solver.control)?.clone();
    let better = report.max_curvature_error < largest(curvature.at.iter());
    let metric = if better { flow.metric().clone() } else { lifted };
    let curvature = metric.curvature(mesh)?;
    solver.add(&report);
    Ok((metric, curvature))
}

/// A power of two of about the size of the longest edge. With η divided by its square no result depends on the size of the surface, and
/// the division rounds nothing.
fn unit(metric: &Metric) -> f64 {
    let largest = metric.eta.iter().map(|eta| eta.high).fold(f64::MIN_POSITIVE, f64::max);
    2f64.powi((0.5 * largest.log2()).round() as i32)
}

/// η times the square of a unit, which is a power of two.
fn scaled_by(eta: DoubleDouble, unit: f64) -> DoubleDouble {
    DoubleDouble { high: eta.high * unit * unit, low: eta.low * unit * unit }
}

/// One third of the area of the faces at each vertex; in E² in units of `unit²`.
fn vertex_areas(surface: &Surface, unit: f64) -> PerVertex<f64> {
    let (mesh, geometry) = (surface.mesh(), surface.geometry());
    let unit = if geometry == Space::E2 { unit } else { 1.0 };
    let mut areas = PerVertex::filled(mesh.n_vertices(), 0.0);
    for f in mesh.faces() {
        let lengths = face_lengths(mesh, surface.lengths(), f).map(|l| l / unit);
        let third = triangle::area(geometry, lengths) / 3.0;
        mesh.face_vertices(f).into_iter().for_each(|v| areas[v] += third);
    }
    areas
}
