//! Surfaces in their canonical shape: the round sphere, or a quotient of the Euclidean or the hyperbolic plane.

use crate::arrays::{array, check_buffer, copy_counted, copy_out};
use crate::boundary;
use crate::control::{self, ricci_control};
use crate::domain::ricci_domain;
use crate::failure::{Failure, Outcome};
use crate::flow::{read_options, ricci_flow_options};
use crate::guard::{self, handle, shared};
use crate::homotopy::ricci_homotopy;
use crate::layout::{MODELS, ricci_layout};
use crate::memory;
use crate::mesh::{SPACES, ricci_mesh};
use crate::metric::{ON, SCHEMES, Triangulation, ricci_metric};
use crate::paths::{copy_word, halfedges, vertex_or_none};
use crate::report::stop_reason;
use crate::status::*;
use crate::structs::{self, sized};
use ricci::canonical::{
    FlowedSphere, Quotient, QuotientOptions, Sphere, Uniformization, quotient_of, uniformize,
};
use ricci::embed::BoundaryLoop;
use ricci::mesh::{Mesh, PerVertex, Point, VertexId};
use ricci::topology::FundamentalDomain;
use std::ffi::c_char;
use std::sync::Arc;

pub struct ricci_uniform {
    pub(crate) shape: CanonicalShape,
    pub(crate) metric: ricci_metric,
}
handle!(ricci_uniform, "uniform", |uniform| uniform.metric.0.solution.mesh().n_vertices());

#[derive(Clone)]
pub(crate) enum CanonicalShape {
    Sphere(Arc<Sphere>),
    FlowedSphere(Arc<FlowedSphere>),
    Quotient(Arc<Quotient>),
}

impl ricci_uniform {
    /// The handle of a canonical shape.
    pub(crate) fn of(shape: Uniformization) -> Outcome<ricci_uniform> {
        let (metric, report) = (
            shape.metric().clone(),
            match &shape {
                Uniformization::Sphere(_) => None,
                Uniformization::FlowedSphere(sphere) => Some(sphere.report.clone()),
                Uniformization::Quotient(quotient) => Some(quotient.report.clone()),
            },
        );
        let shape = match shape {
            Uniformization::Sphere(sphere) => CanonicalShape::Sphere(Arc::from(sphere)),
            Uniformization::FlowedSphere(sphere) => CanonicalShape::FlowedSphere(Arc::from(sphere)),
            Uniformization::Quotient(quotient) => CanonicalShape::Quotient(Arc::from(quotient)),
        };
        Ok(ricci_uniform { shape, metric: ricci_metric::at(metric, report)? })
    }

    /// The vertices of a sphere.
    pub(crate) fn sphere_positions(&self) -> Outcome<&PerVertex<Point>> {
        match &self.shape {
            CanonicalShape::Sphere(sphere) => Ok(&sphere.positions),
            CanonicalShape::FlowedSphere(sphere) => Ok(&sphere.positions),
            CanonicalShape::Quotient(_) => {
                Err(Failure::new(RICCI_LAYOUT, "this surface is no sphere, but the quotient of a plane"))
            }
        }
    }

    pub(crate) fn quotient(&self) -> Outcome<&Arc<Quotient>> {
        match &self.shape {
            CanonicalShape::Quotient(quotient) => Ok(quotient),
            CanonicalShape::Sphere(_) | CanonicalShape::FlowedSphere(_) => {
                Err(Failure::new(RICCI_LAYOUT, "this surface is a sphere, not the quotient of a plane"))
            }
        }
    }
}

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_uniform_options {
    pub size: usize,
    pub flow: *const ricci_flow_options,
    pub start: *const ricci_metric,
    pub base: *const u32,
    pub scheme: u32,
    pub reserved: u32,
    pub corners: *const u32,
    pub corner_angles: *const f64,
    pub n_corners: usize,
    pub boundary: u32,
    pub reserved_too: u32,
}
// SAFETY: numbers and raw pointers; 8-byte alignment, size first.
sized!(ricci_uniform_options, "options", reserved, reserved_too);

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_uniform_summary {
    pub size: usize,
    pub space: u32,
    pub base: u32,
    pub converged: u32,
    pub stop_reason: u32,
    pub stop_reason_text: *const c_char,
    pub genus: usize,
    pub iterations: usize,
    pub n_flips: usize,
    pub n_start_flips: usize,
    pub max_curvature_error: f64,
    pub angle_defect: f64,
    pub gauss_bonnet: f64,
    pub area: f64,
    pub n_generators: usize,
    pub n_sides: usize,
    pub n_polygon: usize,
    pub disagreement: f64,
    pub radius: f64,
    pub relation_residual: f64,
    pub side_residual: f64,
    pub base_lift: [f64; 3],
    pub modulus: [f64; 2],
    pub n_tried: usize,
    pub u_range: f64,
    pub smallest_edge: f64,
    pub delaunay_violation: f64,
    pub outline_turning: f64,
    pub nonconvexity: f64,
    pub off_centre: f64,
    pub n_boundary_sides: usize,
    pub straightness: f64,
    pub extremal_distance: f64,
}
// SAFETY: numbers and a raw pointer; 8-byte alignment, size first.
sized!(ricci_uniform_summary, "summary");

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_uniformize(
    mesh: *const ricci_mesh,
    options: *const ricci_uniform_options,
    control: *const ricci_control,
    uniform: *mut *mut ricci_uniform,
) -> ricci_status {
    guard::make(uniform, || {
        let (given, control) = (structs::read(options)?, control::of(control)?);
        let options = QuotientOptions {
            scheme: SCHEMES.choose(given.scheme)?,
            base: vertex_or_none(given.base)?,
            boundary: boundary::read(given.boundary, given.corners, given.corner_angles, given.n_corners)?,
            flow: read_options(given.flow)?,
        };
        if !given.start.is_null() {
            let start = &shared(given.start)?.0.solution;
            let _reserve = memory::work(start.mesh().n_vertices(), memory::UNIFORM)?;
            let shape = Uniformization::Quotient(Box::new(quotient_of(start, &options, &control)?));
            log_end(&shape);
            return ricci_uniform::of(shape);
        }
        let mesh = shared(mesh)?;
        let _reserve = memory::work(mesh.connectivity.n_vertices(), memory::UNIFORM)?;
        let shape = uniformize(mesh.surface()?, &options, &control)?;
        log_end(&shape);
        ricci_uniform::of(shape)
    })
}

/// Tells the log how a uniformization ended.
fn log_end(shape: &Uniformization) {
    match shape {
        Uniformization::Quotient(quotient) => log::info!(
            "uniformize: {} after {} iterations, max |K| = {:.1e}, side pairings within {:.1e}, relation {:.1e}",
            quotient.report.stop_reason,
            quotient.report.iterations,
            quotient.angle_defect,
            quotient.deck.side_residual,
            quotient.deck.relation_residual
        ),
        Uniformization::Sphere(sphere) => log::info!(
            "uniformize: sphere {} after {} iterations, max |K| = {:.1e}",
            sphere.report.stop_reason,
            sphere.report.iterations,
            sphere.report.spherical_curvature_error
        ),
        Uniformization::FlowedSphere(sphere) => log::info!(
            "uniformize: flow in S2 {} after {} iterations, max |K| = {:.1e}",
            sphere.report.stop_reason,
            sphere.report.iterations,
            sphere.report.max_curvature_error
        ),
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_uniform_free(uniform: *mut ricci_uniform) {
    guard::free(uniform);
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_uniform_summarise(
    uniform: *const ricci_uniform,
    summary: *mut ricci_uniform_summary,
    size: usize,
) -> ricci_status {
    guard::with(uniform, |uniform| {
        let solution = &uniform.metric.0.solution;
        let space = SPACES.number(solution.metric().space)?;
        // SAFETY: zeros are valid (`Sized64`).
        let mut figures: ricci_uniform_summary = unsafe { std::mem::zeroed() };
        (figures.modulus, figures.extremal_distance) = ([f64::NAN; 2], f64::NAN);
        let stop = match &uniform.shape {
            CanonicalShape::Sphere(sphere) => {
                sphere_figures(sphere, &mut figures);
                sphere.report.stop_reason
            }
            CanonicalShape::FlowedSphere(sphere) => {
                flowed_sphere_figures(sphere, &mut figures)?;
                sphere.report.stop_reason
            }
            CanonicalShape::Quotient(quotient) => {
                quotient_figures(quotient, &mut figures);
                quotient.report.stop_reason
            }
        };
        let (stop_reason, stop_reason_text) = stop_reason(stop)?;
        figures.n_start_flips = solution.start_flips();
        figures.n_flips = solution.flips() - figures.n_start_flips;
        structs::write(
            ricci_uniform_summary { space, stop_reason, stop_reason_text, ..figures },
            summary,
            size,
        )
    })
}

fn sphere_figures(sphere: &Sphere, figures: &mut ricci_uniform_summary) {
    let report = &sphere.report;
    *figures = ricci_uniform_summary {
        base: report.puncture.0,
        converged: report.converged.into(),
        iterations: report.iterations,
        max_curvature_error: report.max_curvature_error,
        angle_defect: report.spherical_curvature_error,
        gauss_bonnet: report.gauss_bonnet,
        area: 4.0 * std::f64::consts::PI,
        n_tried: report.tried,
        u_range: report.u_range,
        smallest_edge: report.smallest_edge,
        delaunay_violation: report.delaunay_violation,
        outline_turning: report.link_turning,
        nonconvexity: report.nonconvexity,
        off_centre: report.centring,
        ..*figures
    };
}

fn flowed_sphere_figures(sphere: &FlowedSphere, figures: &mut ricci_uniform_summary) -> Outcome<()> {
    let FlowedSphere { metric, report, root, .. } = sphere;
    *figures = ricci_uniform_summary {
        base: root.0,
        converged: report.converged().into(),
        iterations: report.iterations,
        max_curvature_error: report.max_curvature_error,
        angle_defect: report.max_curvature_error,
        gauss_bonnet: report.gauss_bonnet,
        area: 4.0 * std::f64::consts::PI,
        smallest_edge: metric.metric().lengths(metric.mesh())?.iter().copied().fold(f64::INFINITY, f64::min),
        ..*figures
    };
    Ok(())
}

fn quotient_figures(quotient: &Quotient, figures: &mut ricci_uniform_summary) {
    let Quotient { report, angle_defect, layout, basis, deck, boundary, .. } = quotient;
    let sides = || boundary.iter().flat_map(|around| &around.sides);
    *figures = ricci_uniform_summary {
        base: basis.base.0,
        converged: report.converged().into(),
        genus: basis.group.genus,
        iterations: report.iterations,
        max_curvature_error: report.max_curvature_error,
        angle_defect: *angle_defect,
        gauss_bonnet: report.gauss_bonnet,
        area: layout.area,
        n_generators: deck.generators.len(),
        n_sides: deck.sides.len(),
        n_polygon: deck.group.relator().len(),
        disagreement: layout.disagreement,
        radius: layout.radius,
        relation_residual: deck.relation_residual,
        side_residual: deck.side_residual,
        base_lift: layout.corner(deck.corner),
        modulus: deck.modulus().unwrap_or([f64::NAN; 2]),
        n_boundary_sides: sides().count(),
        straightness: sides().map(|side| side.straightness).fold(0.0, f64::max),
        extremal_distance: quotient.extremal_distance().unwrap_or(f64::NAN),
        ..*figures
    };
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_uniform_metric(
    uniform: *const ricci_uniform,
    metric: *mut *mut ricci_metric,
) -> ricci_status {
    guard::make(metric, || Ok(ricci_metric(shared(uniform)?.metric.0.clone())))
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_uniform_sides(
    uniform: *const ricci_uniform,
    from: *mut u32,
    lengths: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(uniform, |uniform| {
        let quotient = uniform.quotient()?;
        let number = |around: &BoundaryLoop| around.generator as u32 + 1;
        let sides = quotient.boundary.iter().flat_map(|b| b.sides.iter().map(move |side| (number(b), side)));
        let (starts, values): (Vec<[u32; 2]>, Vec<[f64; 2]>) =
            sides.map(|(c, side)| ([c, side.from.0], [side.length, side.straightness])).unzip();
        check_buffer("lengths", values.len(), lengths, capacity)?;
        copy_out("from", &starts, from, capacity.saturating_mul(2))?;
        copy_out("lengths", &values, lengths, capacity.saturating_mul(2))
    })
}

/// The mesh that the homotopy basis of a quotient lies on.
fn mesh_of(quotient: &Quotient) -> Arc<Mesh> {
    match quotient.layout.common_subdivision() {
        Some(subdivision) => Arc::new(subdivision.mesh.clone()),
        None => quotient.metric.mesh().clone(),
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_uniform_homotopy(
    uniform: *const ricci_uniform,
    homotopy: *mut *mut ricci_homotopy,
) -> ricci_status {
    guard::make(homotopy, || {
        let quotient = shared(uniform)?.quotient()?;
        Ok(ricci_homotopy { mesh: mesh_of(quotient), basis: quotient.basis.clone() })
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_uniform_domain(
    uniform: *const ricci_uniform,
    domain: *mut *mut ricci_domain,
) -> ricci_status {
    guard::make(domain, || {
        let Quotient { layout, basis, .. } = &**shared(uniform)?.quotient()?;
        Ok(ricci_domain(FundamentalDomain::new(layout.mesh(), &layout.cut.is_cut, basis)?))
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_uniform_layout(
    uniform: *const ricci_uniform,
    on: u32,
    model: u32,
    control: *const ricci_control,
    layout: *mut *mut ricci_layout,
) -> ricci_status {
    guard::make(layout, || {
        let (uniform, control) = (shared(uniform)?, control::of(control)?);
        let _reserve = memory::work(uniform.metric.0.solution.mesh().n_vertices(), memory::LAYOUT)?;
        let (quotient, state) = (uniform.quotient()?, &uniform.metric.0);
        let laid = match ON.choose(on)? {
            Triangulation::Metric if quotient.layout.common_subdivision().is_some() => {
                let message = "the metric lives on the double of the surface: take RICCI_ON_REFINEMENT";
                return Err(Failure::new(RICCI_LAYOUT, message));
            }
            Triangulation::Subdivision if quotient.layout.common_subdivision().is_some() => {
                quotient.layout.clone()
            }
            Triangulation::Metric => quotient.layout.clone(),
            Triangulation::Subdivision => quotient.layout.on_subdivision(
                state.subdivision(&control)?,
                quotient.metric.metric(),
                &control,
            )?,
            Triangulation::Input => {
                let message = "a quotient is opened along edges of the metric's triangulation: take RICCI_ON_REFINEMENT";
                return Err(Failure::new(RICCI_LAYOUT, message));
            }
        };
        ricci_layout::new(state.clone(), laid, MODELS.choose(model)?)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_uniform_polygon(
    uniform: *const ricci_uniform,
    corners: *mut f64,
    angles: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(uniform, |uniform| {
        let Quotient { layout, deck, .. } = &**uniform.quotient()?;
        let base = layout.corner(deck.corner);
        let (points, inside) = (deck.canonical_polygon(base)?, deck.canonical_angles(base)?);
        check_buffer("angles", inside.len(), angles, capacity)?;
        copy_out("corners", &points, corners, capacity.saturating_mul(3))?;
        copy_out("angles", &inside, angles, capacity)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_uniform_lift(
    uniform: *const ricci_uniform,
    path: *const i32,
    n_path: usize,
    points: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(uniform, |uniform| {
        let Quotient { layout, deck, .. } = &**uniform.quotient()?;
        let path = halfedges(layout.mesh(), path, n_path)?;
        copy_out("points", &layout.lift(deck.corner, &path)?, points, capacity)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_uniform_lift_loop(
    uniform: *const ricci_uniform,
    layout: *const ricci_layout,
    vertices: *const u32,
    n_vertices: usize,
    points: *mut f64,
    capacity: usize,
    n_points: *mut usize,
    letters: *mut i32,
    letters_capacity: usize,
    n_letters: *mut usize,
) -> ricci_status {
    guard::with(uniform, |uniform| {
        let (deck, layout) = (&uniform.quotient()?.deck, &shared(layout)?.layout);
        let around: Vec<VertexId> =
            array("vertices", vertices, n_vertices)?.into_iter().map(VertexId).collect();
        let lifted = deck.lift_loop(layout, &around)?;
        if !letters.is_null() || letters_capacity > 0 {
            check_buffer("letters", lifted.element.word.len(), letters, letters_capacity)?;
        }
        copy_counted("points", lifted.points.as_flattened(), points, capacity, n_points)?;
        copy_word(&lifted.element.word, letters, letters_capacity, n_letters)
    })
}
