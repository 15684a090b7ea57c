//! Circle domains: surfaces with boundary whose boundary loops are circles.

use crate::arrays::{array, copy_out};
use crate::choice::choices;
use crate::control::{self, ricci_control};
use crate::failure::{Failure, Outcome};
use crate::flow::{read_options, ricci_flow_options};
use crate::guard::{self, handle, shared};
use crate::layout::{MODELS, ricci_layout};
use crate::memory;
use crate::mesh::{SPACES, ricci_mesh};
use crate::metric::{MetricState, ricci_metric};
use crate::paths::vertex_or_none;
use crate::report::stop_reason;
use crate::status::*;
use crate::structs::{self, sized};
use ricci::canonical::{CircleDomain, CircleDomainOptions, DomainFrame, Normalisation, circle_domain};
use ricci::flow::Solution;
use ricci::geometry::Space;
use ricci::mesh::VertexId;
use ricci::{Class, Surface};
use std::ffi::c_char;
use std::sync::Arc;

choices!(FRAMES: DomainFrame = "frame", [
    RICCI_FRAME_AUTO => DomainFrame::Auto,
    RICCI_FRAME_DISK => DomainFrame::Disk,
    RICCI_FRAME_STRIP => DomainFrame::Strip,
]);

pub struct ricci_circle_domain {
    pub(crate) domain: CircleDomain,
    /// The surface with the vertices that were added to its boundary loops.
    surface: Surface,
    /// The initial metric of that surface, which layouts need.
    state: Arc<MetricState>,
}
impl ricci_circle_domain {
    /// The handle of a domain, with the surface of its split and the initial metric of that, which are made again.
    pub(crate) fn of(domain: CircleDomain) -> Outcome<ricci_circle_domain> {
        let surface = domain.split.surface()?;
        let given = Solution::initial_of(surface.clone(), Class::yamabe(Space::E2))?;
        let state = ricci_metric::at(given, None)?.0;
        Ok(ricci_circle_domain { domain, surface, state })
    }
}
handle!(ricci_circle_domain, "circle domain", |domain| domain.surface.mesh().n_vertices());

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_circle_domain_options {
    pub size: usize,
    pub flow: *const ricci_flow_options,
    pub outer: *const u32,
    pub centre: *const u32,
    pub three: *const u32,
    pub angles: *const f64,
    pub least_loop: usize,
    pub frame: u32,
    pub reserved: u32,
}
// SAFETY: numbers and raw pointers; 8-byte alignment, size first.
sized!(ricci_circle_domain_options, "options", reserved);

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_circle_domain_summary {
    pub size: usize,
    pub space: u32,
    pub converged: u32,
    pub stop_reason: u32,
    pub outer: u32,
    pub stop_reason_text: *const c_char,
    pub n_circles: usize,
    pub n_overlapping: usize,
    pub iterations: usize,
    pub n_flips: usize,
    pub n_halved: usize,
    pub n_crossed: usize,
    pub max_curvature_error: f64,
    pub deviation: f64,
    pub modulus: [f64; 2],
    pub frame: u32,
    pub worst_loop: u32,
    pub worst_vertex: u32,
    pub centred_on: u32,
}
// SAFETY: numbers and a raw pointer; 8-byte alignment, size first.
sized!(ricci_circle_domain_summary, "summary");

fn read(given: ricci_circle_domain_options) -> Outcome<CircleDomainOptions> {
    let usual = CircleDomainOptions::default();
    let normalisation = match (given.three.is_null(), vertex_or_none(given.centre)?) {
        (true, None) => Normalisation::Centred,
        (true, Some(v)) => Normalisation::Vertex(v),
        (false, Some(_)) => return Err(Failure::argument("centre and three: give one of them, or none")),
        (false, None) => {
            let vertices = array("three", given.three, 3)?;
            let angles = if given.angles.is_null() {
                [0.0, 1.0, 2.0].map(|k| k * std::f64::consts::TAU / 3.0).to_vec()
            } else {
                array("angles", given.angles, 3)?
            };
            Normalisation::Three([0, 1, 2].map(|k| VertexId(vertices[k])), [angles[0], angles[1], angles[2]])
        }
    };
    Ok(CircleDomainOptions {
        outer: vertex_or_none(given.outer)?.map(VertexId::index),
        normalisation,
        frame: FRAMES.choose(given.frame)?,
        least_loop: if given.least_loop == 0 { usual.least_loop } else { given.least_loop },
        flow: read_options(given.flow)?,
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_circle_domain_new(
    mesh: *const ricci_mesh,
    options: *const ricci_circle_domain_options,
    control: *const ricci_control,
    domain: *mut *mut ricci_circle_domain,
) -> ricci_status {
    guard::make(domain, || {
        let (options, control) = (read(structs::read(options)?)?, control::of(control)?);
        let mesh = shared(mesh)?;
        let _reserve = memory::work(mesh.connectivity.n_vertices(), memory::UNIFORM)?;
        let domain = circle_domain(mesh.surface()?, &options, &control)?;
        log::info!(
            "circle domain: {} circles, {} after {} iterations, max |K| = {:.1e}",
            domain.circles.len(),
            domain.report.stop_reason,
            domain.report.iterations,
            domain.report.domain_curvature_error
        );
        ricci_circle_domain::of(domain)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_circle_domain_free(domain: *mut ricci_circle_domain) {
    guard::free(domain);
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_circle_domain_summarise(
    domain: *const ricci_circle_domain,
    summary: *mut ricci_circle_domain_summary,
    size: usize,
) -> ricci_status {
    guard::with(domain, |ricci_circle_domain { domain, .. }| {
        let report = &domain.report;
        let (stop_reason, stop_reason_text) = stop_reason(report.stop_reason)?;
        let modulus = domain.torus_modulus.or(domain.modulus.map(|m| [0.0, m]));
        let figures = ricci_circle_domain_summary {
            size,
            space: SPACES.number(domain.layout.space)?,
            converged: report.converged.into(),
            stop_reason,
            outer: domain.outer.map_or(u32::MAX, |k| k as u32),
            stop_reason_text,
            n_circles: domain.circles.len(),
            n_overlapping: domain.overlapping().len(),
            iterations: report.iterations,
            n_flips: report.flips,
            n_halved: report.halved_edges,
            n_crossed: report.crossed_edges,
            max_curvature_error: report.domain_curvature_error,
            deviation: report.deviation,
            modulus: modulus.unwrap_or([f64::NAN; 2]),
            frame: FRAMES.number(domain.frame)?,
            worst_loop: report.worst_loop.map_or(u32::MAX, |k| k as u32),
            worst_vertex: report.worst_vertex.map_or(u32::MAX, |v| v.0),
            centred_on: report.centred_on.map_or(u32::MAX, |k| k as u32),
        };
        structs::write(figures, summary, size)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_circle_domain_circles(
    domain: *const ricci_circle_domain,
    circles: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(domain, |ricci_circle_domain { domain, .. }| {
        let figures = domain.circles.iter().map(|c| [c.centre[0], c.centre[1], c.radius, c.deviation]);
        copy_out("circles", &figures.collect::<Vec<_>>(), circles, capacity)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_circle_domain_log_radii(
    domain: *const ricci_circle_domain,
    log_radii: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(domain, |ricci_circle_domain { domain, .. }| {
        let logs: Vec<f64> = domain.circles.iter().map(|c| c.log_radius).collect();
        copy_out("log_radii", &logs, log_radii, capacity)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_circle_domain_mesh(
    domain: *const ricci_circle_domain,
    mesh: *mut *mut ricci_mesh,
) -> ricci_status {
    guard::make(mesh, || {
        let surface = &shared(domain)?.surface;
        Ok(match surface.positions() {
            Some(positions) => ricci_mesh::in_space(surface.mesh().clone(), positions.clone()),
            None => {
                ricci_mesh::intrinsic(surface.mesh().clone(), surface.lengths().clone(), surface.geometry())
            }
        })
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_circle_domain_layout(
    domain: *const ricci_circle_domain,
    model: u32,
    layout: *mut *mut ricci_layout,
) -> ricci_status {
    guard::make(layout, || {
        let ricci_circle_domain { domain, state, surface, .. } = shared(domain)?;
        let _reserve = memory::work(surface.mesh().n_vertices(), memory::LAYOUT)?;
        ricci_layout::new(state.clone(), domain.layout.clone(), MODELS.choose(model)?)
    })
}
