//! Closed surfaces of genus 0 on the unit sphere [Spr20; BPS15].

use super::candidates::range;
use super::lift::{lifted, nonconvexity, off_centre};
use super::puncture::Found;
use super::star::Punctured;
use crate::control::Control;
use crate::error::{Error, Result};
use crate::flow::{Options, StopReason};
use crate::geometry::{Space, triangle};
use crate::mesh::{Mesh, PerEdge, PerVertex, Point, VertexId};
use crate::metric::lengths::face_lengths;
use crate::metric::{Metric, Scheme, SurfaceMetric};
use crate::parallel::Pool;
use crate::topology::spanning::shortest_paths_under;
use crate::topology::{check_vertex, farthest_vertices};
use std::sync::Arc;

/// Outlines of the first plane may turn the wrong way by this: it is only to see from which vertex the plane is best.
const ROUGHLY: f64 = 1e-4;
/// Outlines turn by minus this at least: rounding.
const STRAIGHT: f64 = 1e-12;
/// Edges of a result are Delaunay, and its outline convex, to this (radians).
const DELAUNAY: f64 = 1e-9;
/// Vertices that are tried, until the flow from one ends well: first from a guess, then from the plane that was found.
const TRIES: usize = 8;
/// Newton steps from a plane that is known to the plane seen from another vertex: 1, and some where angles are narrow.
const STEPS: usize = 60;

/// Options of [`uniformize_sphere`].
#[derive(Debug, Clone, PartialEq)]
pub struct SphereOptions {
    /// Largest |K| inside the plane, radians. Default 1e-10.
    pub tolerance: f64,
    /// Newton steps of one flow before giving up; 0 (default) means 500.
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

/// What became of a sphere.
#[derive(Debug, Clone, PartialEq)]
pub struct SphereReport {
    /// The plane is flat to the tolerance, every edge Delaunay and the outline convex to 1e-9.
    pub converged: bool,
    /// Why the last flow stopped.
    pub stop_reason: StopReason,
    /// Newton steps of all flows.
    pub iterations: usize,
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
    /// Largest minus smallest u of the plane. Beyond about 30 positions on the sphere run out of digits (edges near 1e-14), where
    /// the metric does not.
    pub u_range: f64,
    /// Length of the shortest edge of the spherical metric.
    pub smallest_edge: f64,
    /// By how much the planar angles opposite an edge exceed π at most, radians: 0 where all are Delaunay.
    pub delaunay_violation: f64,
    /// Least turning of the planar outline, the link of the puncture, radians: not negative where it is convex.
    pub link_turning: f64,
    /// Largest signed distance of a vertex over the plane of a neighbouring face: not positive where the positions are convex.
    pub nonconvexity: f64,
    /// `|Σ w x|/Σ w` of the positions, w one third of the area of the given faces at a vertex.
    pub centring: f64,
}

/// A surface on the unit sphere.
#[derive(Debug, Clone)]
pub struct Sphere {
    /// The spherical metric, K = 0 at every vertex, with its triangulation and the way back to the given one: geodesic triangles
    /// over the faces of a convex polyhedron.
    pub metric: SurfaceMetric,
    /// Unit vectors (V entries). Faces are counterclockwise from outside.
    pub positions: PerVertex<Point>,
    /// The plane under them by stereographic projection from (0, 0, −1) ([`crate::geometry::sphere::lift`]); (∞, ∞) at the puncture.
    pub plane: PerVertex<[f64; 2]>,
    /// How it went.
    pub report: SphereReport,
}

/// The surface of genus 0 with these `lengths` (E entries, read in `geometry`) as a convex polyhedron in the unit sphere: the one whose
/// edges are, after flips inside the conformal class, chords of lengths in that class. Its vertices are moved by the Möbius transformation
/// after which `Σ w x = 0`, w one third of the area of the given faces at a vertex; they are determined up to a rotation.
///
/// A vertex is sent to infinity, the rest flows to the plane ([`super::puncture`]), and is lifted. Errors: a surface that is
/// no sphere, or of fewer than four vertices; sizes, lengths and triangles as for
/// [`SurfaceMetric::delaunay`]; a vertex with half of the area or more; [`Error::Layout`] where
/// all vertices lie on one circle (the double of a polygon); [`Error::Cancelled`].
pub fn uniformize_sphere(
    given: Arc<Mesh>,
    lengths: Arc<PerEdge<f64>>,
    geometry: Space,
    options: &SphereOptions,
    control: &Control,
) -> Result<Sphere> {
    control.check()?;
    check(&given, options)?;
    Pool::new(options.threads)?.run(|| uniformize(given, lengths, geometry, options, control))
}

fn check(given: &Mesh, options: &SphereOptions) -> Result<()> {
    if !given.is_closed() || given.euler() != 2 || given.n_vertices() < 4 {
        let kind = if given.is_closed() { "closed" } else { "with boundary" };
        let value =
            format!("{kind}, of {} vertices and Euler characteristic {}", given.n_vertices(), given.euler());
        let need = "one closed surface of genus 0 with at least four vertices";
        return Err(Error::Argument { what: "surface", value, need });
    }
    options.puncture.map_or(Ok(()), |v| check_vertex(given, v))
}

fn uniformize(
    given: Arc<Mesh>,
    lengths: Arc<PerEdge<f64>>,
    geometry: Space,
    options: &SphereOptions,
    control: &Control,
) -> Result<Sphere> {
    let (scheme, space) = (Scheme::Yamabe, Space::S2);
    let from = SurfaceMetric::delaunay(
        given.clone(),
        lengths.clone(),
        geometry,
        scheme,
        space,
        false,
        &[],
        control,
    )?;
    let weights = vertex_areas(&given, &lengths, geometry);
    let (start, mesh, metric, followed, start_flips) = from.into_parts();
    let n = mesh.n_vertices();
    let metric = Metric { space: Space::E2, u: PerVertex::filled(n, 0.0), ..metric };
    let begin = Punctured { mesh, metric, at: VertexId(0), followed, flips: 0 };
    let flow = Options {
        tolerance: options.tolerance,
        max_iterations: options.max_iterations,
        threads: options.threads,
        ..Options::default()
    };
    let mut tried = Tried { flows: 0, iterations: 0 };
    let (surface, plane, found) = match options.puncture {
        Some(v) => {
            let rough = tried.from_guess(&begin, &[v], ROUGHLY, &flow, control)?;
            tried.first_good(
                [Ok(rough.0.clone())].into_iter(),
                Some(rough),
                STRAIGHT,
                STEPS,
                &flow,
                control,
            )?
        }
        None => {
            let first = begin.widest();
            let rough = tried.from_guess(&begin, &[first], ROUGHLY, &flow, control);
            let rough = match rough {
                Ok(rough) if rough.2.converged => rough,
                Err(Error::Cancelled) => return Err(Error::Cancelled),
                _ => {
                    let lengths = begin.metric.lengths(&begin.mesh)?;
                    let others = farthest_vertices(&begin.mesh, &lengths, first, TRIES)?;
                    tried.from_guess(&begin, &others[1..], ROUGHLY, &flow, control)?
                }
            };
            tried.from_plane(rough, &weights, &flow, control)?
        }
    };
    let view = surface.centre(&plane, &weights)?;
    let plane = PerVertex::from_fn(n, |v| view.apply(plane[v]));
    let (positions, spherical) = (lifted(&plane), surface.spherical(&plane, view.scale.ln()));
    let curvature = spherical.curvature(&surface.mesh)?;
    let delaunay_violation = surface.delaunay_violation();
    let largest = |x: &[f64]| x.iter().fold(0.0f64, |m, x| m.max(x.abs()));
    let report = SphereReport {
        converged: found.converged && delaunay_violation <= DELAUNAY && found.turning >= -DELAUNAY,
        stop_reason: found.stop_reason,
        iterations: tried.iterations,
        flips: surface.flips,
        start_flips,
        puncture: surface.at,
        tried: tried.flows,
        max_curvature_error: found.error,
        spherical_curvature_error: largest(&curvature.at),
        gauss_bonnet: curvature.gauss_bonnet,
        u_range: range(&surface.metric.u, surface.at),
        smallest_edge: spherical.lengths(&surface.mesh)?.iter().copied().fold(f64::INFINITY, f64::min),
        delaunay_violation,
        link_turning: found.turning,
        nonconvexity: nonconvexity(&surface.mesh, &positions),
        centring: off_centre(&positions, &weights),
    };
    let Punctured { mesh, followed, flips, .. } = surface;
    let metric = SurfaceMetric::at(start, mesh, spherical, followed, start_flips + flips);
    Ok(Sphere { metric, positions, plane, report })
}

/// A punctured surface, its plane, and how it was found.
type Flat = (Punctured, PerVertex<[f64; 2]>, Found);

/// What was done so far.
struct Tried {
    flows: usize,
    iterations: usize,
}

impl Tried {
    fn flow(
        &mut self,
        mut surface: Punctured,
        straight: f64,
        most: usize,
        flow: &Options,
        control: &Control,
    ) -> Result<Flat> {
        self.flows += 1;
        let found = surface.flatten(straight, straight < ROUGHLY, most, flow, control)?;
        self.iterations += found.iterations;
        let plane = surface.lay_out(control)?;
        Ok((surface, plane, found))
    }

    /// Punctured at the first vertex from which the flow ends well, or else from which it came closest: as `−2 log(distance)`, the
    /// inversion of a surface that is nearly a plane.
    fn from_guess(
        &mut self,
        begin: &Punctured,
        vertices: &[VertexId],
        straight: f64,
        flow: &Options,
        control: &Control,
    ) -> Result<Flat> {
        let lengths = begin.metric.lengths(&begin.mesh)?;
        let surface = |&v: &VertexId| {
            let distance = shortest_paths_under(&begin.mesh, &lengths, [v], control)?.distance;
            if let Some(other) = begin.mesh.vertices().find(|&i| i != v && distance[i] == 0.0) {
                let value = format!("in pieces: no way from vertex {v} to vertex {other}");
                return Err(Error::Argument {
                    what: "surface",
                    value,
                    need: "one closed surface of genus 0",
                });
            }
            let mut surface = Punctured { at: v, ..begin.clone() };
            surface.metric.u =
                PerVertex::from_fn(distance.len(), |i| if i == v { 0.0 } else { -2.0 * distance[i].ln() });
            Ok(surface)
        };
        self.first_good(vertices.iter().map(surface), None, straight, flow.iteration_limit(), flow, control)
    }

    /// From a plane to the best one.
    fn from_plane(
        &mut self,
        (surface, plane, found): Flat,
        weights: &PerVertex<f64>,
        flow: &Options,
        control: &Control,
    ) -> Result<Flat> {
        let view = surface.centre(&plane, weights)?;
        let centred = PerVertex::from_fn(plane.len(), |v| view.apply(plane[v]));
        let u = surface.spherical(&centred, view.scale.ln()).u;
        let moved = |v: VertexId| {
            let mut moved = surface.clone();
            if v != surface.at {
                moved.puncture(v, &plane);
            }
            Ok(moved)
        };
        let best = surface.candidates(&plane, &u).into_iter().take(TRIES).map(moved);
        self.first_good(best, Some((surface.clone(), plane.clone(), found)), STRAIGHT, STEPS, flow, control)
    }

    /// The first flow that ends well, or the best of them and of what was known.
    fn first_good(
        &mut self,
        surfaces: impl Iterator<Item = Result<Punctured>>,
        known: Option<Flat>,
        straight: f64,
        most: usize,
        flow: &Options,
        control: &Control,
    ) -> Result<Flat> {
        let (mut best, off) = (known, |found: &Found| found.error.max(-found.turning));
        let mut failure = Error::Layout("there is no vertex to send to infinity".into());
        for surface in surfaces {
            match self.flow(surface?, straight, most, flow, control) {
                Ok(flat) if flat.2.converged => return Ok(flat),
                Ok(flat) => {
                    let closer = |best: &Flat| off(&flat.2) < off(&best.2);
                    if best.as_ref().is_none_or(closer) {
                        best = Some(flat);
                    }
                }
                Err(Error::Cancelled) => return Err(Error::Cancelled),
                Err(error) => failure = error,
            }
        }
        best.ok_or(failure)
    }
}

impl Punctured {
    /// The vertex whose shortest edge is the longest.
    fn widest(&self) -> VertexId {
        let near = |v| self.mesh.outgoing(v).map(|arc| self.bound(arc)).fold(f64::NEG_INFINITY, f64::max);
        let better = |(best, least), v| if near(v) < least { (v, near(v)) } else { (best, least) };
        self.mesh.vertices().fold((VertexId(0), f64::INFINITY), better).0
    }
}

/// One third of the area of the faces at each vertex.
fn vertex_areas(mesh: &Mesh, lengths: &PerEdge<f64>, geometry: Space) -> PerVertex<f64> {
    let mut areas = PerVertex::filled(mesh.n_vertices(), 0.0);
    for f in mesh.faces() {
        let third = triangle::area(geometry, face_lengths(mesh, lengths, f)) / 3.0;
        mesh.face_vertices(f).into_iter().for_each(|v| areas[v] += third);
    }
    areas
}
