//! Closed surfaces of genus 0 on the unit sphere.

use crate::arrays::{self, copy_out};
use crate::choice::choose;
use crate::control::{self, ricci_control};
use crate::failure::{Failure, Outcome};
use crate::guard::{self, Poison, handle, output};
use crate::homotopy::vertex_or_none;
use crate::mesh::{Shape, ricci_mesh};
use crate::metric::ricci_metric;
use crate::report::ricci_stop_reason;
use crate::sized::{self, sized};
use crate::space::ricci_space;
use crate::status::ricci_status;
use ricci::Surface;
use ricci::canonical::{Sphere, SphereOptions, uniformize_sphere};
use std::mem::MaybeUninit;
use std::sync::Arc;

/// A closed surface of genus 0 as a convex polyhedron inscribed in the unit sphere, with its spherical metric of curvature 0.
pub struct ricci_sphere {
    poison: Poison,
    sphere: Sphere,
}

handle!(ricci_sphere, "sphere");

impl ricci_sphere {
    pub(crate) fn new(sphere: Sphere) -> ricci_sphere {
        log::info!(
            "uniformize: sphere {} after {} iterations, max |K| = {:.1e}",
            sphere.report.stop_reason,
            sphere.report.iterations,
            sphere.report.spherical_curvature_error
        );
        ricci_sphere { poison: Poison::default(), sphere }
    }
}

/// How a sphere is uniformized. Let ricci_sphere_options_init fill it, then change fields.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct ricci_sphere_options {
    /// Bytes of this struct that are filled.
    pub size: usize,
    /// Largest |K| of a converged metric, radians, positive; default 1e-10.
    pub tolerance: f64,
    /// Newton steps of the whole call, over all vertices that are tried, before giving up; default 0: 500.
    pub max_iterations: usize,
    /// Threads, in a pool of the call's own; default 0: one per core. The result does not depend on it.
    pub threads: usize,
    /// The vertex that is sent to infinity, and lies at (0, 0, -1); default -1: one from which u has a small range.
    pub puncture: i64,
}

// SAFETY: numbers: any bytes are valid; 8-byte alignment, size first.
sized!(ricci_sphere_options, "options");

fn defaults() -> ricci_sphere_options {
    let SphereOptions { tolerance, max_iterations, threads, .. } = SphereOptions::default();
    let size = size_of::<ricci_sphere_options>();
    ricci_sphere_options { size, tolerance, max_iterations, threads, puncture: -1 }
}

/// Figures of a sphere.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_sphere_summary {
    /// Bytes of this struct that are filled.
    pub size: usize,
    /// 1 if plane and sphere have K = 0 to the tolerance, every edge is Delaunay and the plane's outline convex to 1e-9, else 0.
    pub converged: i32,
    /// Why the last flow stopped.
    pub stop_reason: ricci_stop_reason,
    /// V of the given mesh, and of the triangulation.
    pub n_vertices: usize,
    /// F of the triangulation.
    pub n_faces: usize,
    /// The vertex at infinity of the plane.
    pub puncture: usize,
    /// Newton steps of all flows.
    pub iterations: usize,
    /// Flows that were started.
    pub n_tried: usize,
    /// Edge flips inside the conformal class.
    pub n_flips: usize,
    /// Edge flips before them, which change no distance on the surface.
    pub n_start_flips: usize,
    /// Largest |K| in the plane, at all vertices but the puncture and its neighbours, radians.
    pub max_curvature_error: f64,
    /// Largest |K| of the spherical metric, radians.
    pub spherical_curvature_error: f64,
    /// |sum of curvatures + area - 4 pi| of the spherical metric.
    pub gauss_bonnet: f64,
    /// Largest minus smallest u in the plane. Beyond about 30 positions run out of digits, where the metric does not.
    pub u_range: f64,
    /// Length of the shortest edge of the spherical metric.
    pub smallest_edge: f64,
    /// By how much angles opposite an edge exceed pi in the plane at most, radians: 0 where all edges are Delaunay.
    pub delaunay_violation: f64,
    /// Least turning of the plane's outline, radians: not negative where it is convex.
    pub outline_turning: f64,
    /// Largest signed distance of a vertex over the plane of a neighbouring face: not positive where the polyhedron is convex.
    pub nonconvexity: f64,
    /// |sum of w x| / sum of w over the vertices, w one third of the area of the given faces at x.
    pub off_centre: f64,
}

// SAFETY: only ever written by the library; 8-byte alignment, size first.
sized!(ricci_sphere_summary, "summary");

/// Fill options with their defaults.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE.
///
/// @param options  out: the defaults.
/// @param size     sizeof *options.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_sphere_options_init(
    options: *mut ricci_sphere_options,
    size: usize,
) -> ricci_status {
    guard::call(|_| sized::write(defaults(), options, size))
}

/// A closed surface of genus 0 as a convex polyhedron inscribed in the unit sphere: the one whose edges, after flips, are chords with
/// lengths in the conformal class of the surface (vertex scaling).
///
/// Vertices are moved by the Moebius transformation after which their mean is the centre, each weighed with one third of the area of the
/// given faces at it: they are determined up to a rotation. Whether it came that far is in the summary. Deterministic.
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE, RICCI_ARGUMENT (no sphere, less than four vertices, no such vertex),
/// RICCI_LAYOUT (a vertex has half of the area; all vertices lie on one circle), RICCI_EDGE_LENGTH, RICCI_TRIANGLE_INEQUALITY,
/// RICCI_FACTORISATION, RICCI_CANCELLED.
///
/// @param mesh     the mesh; lengths are measured in space, or those of an intrinsic mesh.
/// @param options  how; NULL for the defaults.
/// @param control  progress and cancellation; NULL for neither.
/// @param sphere   out: the new handle, to be released by ricci_sphere_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_sphere_new(
    mesh: *const ricci_mesh,
    options: *const ricci_sphere_options,
    control: *const ricci_control,
    sphere: *mut *mut ricci_sphere,
) -> ricci_status {
    guard::make("sphere", sphere, |door| {
        let mesh = door.shared(mesh)?;
        uniformize(mesh.surface()?, options, control)
    })
}

/// ricci_sphere_new with lengths of the caller's in place of the mesh's own.
///
/// @return as ricci_sphere_new; RICCI_WRONG_SIZE.
///
/// @param mesh      the mesh.
/// @param lengths   n_edges lengths, finite and positive, in the order of ricci_mesh_edges.
/// @param n_edges   number of edges of the mesh.
/// @param geometry  the geometry in which the lengths are meant.
/// @param options   how; NULL for the defaults.
/// @param control   progress and cancellation; NULL for neither.
/// @param sphere    out: the new handle, to be released by ricci_sphere_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_sphere_from_lengths(
    mesh: *const ricci_mesh,
    lengths: *const f64,
    n_edges: usize,
    geometry: MaybeUninit<ricci_space>,
    options: *const ricci_sphere_options,
    control: *const ricci_control,
    sphere: *mut *mut ricci_sphere,
) -> ricci_status {
    guard::make("sphere", sphere, |door| {
        let mesh = door.shared(mesh)?;
        let lengths = arrays::array_of("lengths", lengths, n_edges, mesh.connectivity.n_edges())?;
        let surface = mesh.surface_with(lengths, choose(geometry)?)?;
        uniformize(surface, options, control)
    })
}

fn uniformize(
    surface: Surface,
    options: *const ricci_sphere_options,
    control: *const ricci_control,
) -> Outcome<ricci_sphere> {
    let ricci_sphere_options { tolerance, max_iterations, threads, puncture, .. } =
        sized::read(defaults(), options)?;
    let puncture = vertex_or_none("puncture", puncture)?;
    let options = SphereOptions { tolerance, max_iterations, threads, puncture };
    Ok(ricci_sphere::new(uniformize_sphere(&surface, &options, &control::of(control))?))
}

/// Release a sphere. What it has handed out lives on.
///
/// @param sphere  the handle, or NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_sphere_free(sphere: *mut ricci_sphere) {
    guard::free(sphere);
}

/// The figures of a sphere.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE.
///
/// @param sphere   the sphere.
/// @param summary  out: the figures.
/// @param size     sizeof *summary.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_sphere_summarise(
    sphere: *const ricci_sphere,
    summary: *mut ricci_sphere_summary,
    size: usize,
) -> ricci_status {
    guard::call(|door| {
        let Sphere { metric, report, .. } = &door.shared(sphere)?.sphere;
        let figures = ricci_sphere_summary {
            size,
            converged: report.converged.into(),
            stop_reason: report.stop_reason.into(),
            n_vertices: metric.mesh().n_vertices(),
            n_faces: metric.mesh().n_faces(),
            puncture: report.puncture.index(),
            iterations: report.iterations,
            n_tried: report.tried,
            n_flips: report.flips,
            n_start_flips: report.start_flips,
            max_curvature_error: report.max_curvature_error,
            spherical_curvature_error: report.spherical_curvature_error,
            gauss_bonnet: report.gauss_bonnet,
            u_range: report.u_range,
            smallest_edge: report.smallest_edge,
            delaunay_violation: report.delaunay_violation,
            outline_turning: report.link_turning,
            nonconvexity: report.nonconvexity,
            off_centre: report.centring,
        };
        sized::write(figures, summary, size)
    })
}

/// The spherical metric.
///
/// @return RICCI_OK, RICCI_NULL_POINTER.
///
/// @param sphere  the sphere.
/// @param metric  out: the new handle, to be released by ricci_metric_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_sphere_metric(
    sphere: *const ricci_sphere,
    metric: *mut *mut ricci_metric,
) -> ricci_status {
    guard::make("metric", metric, |door| ricci_metric::at(door.shared(sphere)?.sphere.metric.clone()))
}

/// The polyhedron: unit vectors as positions, the metric's triangulation as faces, counterclockwise from outside.
///
/// @return RICCI_OK, RICCI_NULL_POINTER.
///
/// @param sphere  the sphere.
/// @param mesh    out: the new handle, to be released by ricci_mesh_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_sphere_mesh(
    sphere: *const ricci_sphere,
    mesh: *mut *mut ricci_mesh,
) -> ricci_status {
    guard::make("mesh", mesh, |door| {
        let Sphere { metric, positions, .. } = &door.shared(sphere)?.sphere;
        let shape = Shape::Positions(Arc::new(positions.to_vec()));
        Ok(ricci_mesh::new(metric.mesh().clone(), shape))
    })
}

/// The unit vector of every vertex of the given mesh.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
///
/// @param sphere     the sphere.
/// @param positions  out: n_vertices x 3.
/// @param capacity   entries of `positions`, at least 3 n_vertices.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_sphere_positions(
    sphere: *const ricci_sphere,
    positions: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(sphere, |sphere| copy_out("positions", &sphere.sphere.positions, positions, capacity))
}

/// The plane under the sphere (ricci_stereographic_project), in which far more digits are left near (0, 0, 1) than on the sphere.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
///
/// @param sphere    the sphere.
/// @param points    out: n_vertices x 2; infinite at the puncture.
/// @param capacity  entries of `points`, at least 2 n_vertices.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_sphere_plane(
    sphere: *const ricci_sphere,
    points: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(sphere, |sphere| copy_out("points", &sphere.sphere.plane, points, capacity))
}

/// The common refinement of the given mesh and the polyhedron: faces that are parts of faces of both. Its vertices are those of the mesh,
/// then the crossings of edges; both meshes have the same faces.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT (the given mesh is intrinsic: pass NULL for `on_surface`), RICCI_DOMAIN,
/// RICCI_EDGE_WEIGHT, RICCI_TOO_LARGE, RICCI_CANCELLED.
///
/// @param sphere      the sphere.
/// @param control     progress and cancellation; NULL for neither.
/// @param on_surface  out: it on the given surface, to be released by ricci_mesh_free; NULL if not wanted.
/// @param on_sphere   out: it on the unit sphere, to be released by ricci_mesh_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_sphere_refined(
    sphere: *const ricci_sphere,
    control: *const ricci_control,
    on_surface: *mut *mut ricci_mesh,
    on_sphere: *mut *mut ricci_mesh,
) -> ricci_status {
    guard::call(|door| {
        let image = output("on_sphere", on_sphere)?;
        let sphere = &door.shared(sphere)?.sphere;
        let positions = sphere.metric.surface().positions();
        let given = match (output("on_surface", on_surface), positions) {
            (Err(_), _) => None,
            (Ok(place), Some(positions)) => Some((place, positions)),
            (Ok(_), None) => {
                return Err(Failure::argument("the given mesh is intrinsic: it has lengths, no positions"));
            }
        };
        let refinement = sphere.metric.refinement(&control::of(control))?;
        // A combination of the ends of an edge, as vectors, has the direction of its point on the arc between them.
        let mut points = refinement.from_final_vertices(&sphere.positions)?;
        for p in points.iter_mut().skip(refinement.n_input_vertices) {
            let norm = p[0].hypot(p[1]).hypot(p[2]);
            *p = p.map(|x| x / norm);
        }
        let mesh = Arc::new(refinement.mesh.clone());
        let surface = match given {
            Some((place, positions)) => Some((place, refinement.from_input_vertices(positions)?)),
            None => None,
        };
        if let Some((place, positions)) = surface {
            place.hand_over(ricci_mesh::new(mesh.clone(), Shape::Positions(Arc::new(positions))));
        }
        image.hand_over(ricci_mesh::new(mesh, Shape::Positions(Arc::new(points))));
        Ok(())
    })
}
