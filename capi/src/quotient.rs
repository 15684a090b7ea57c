//! Uniformization of closed surfaces of genus 1 and more.

use crate::arrays;
use crate::choice::choose;
use crate::control::{self, ricci_control};
use crate::domain::ricci_domain;
use crate::failure::Outcome;
use crate::guard::{self, Poison, handle};
use crate::homotopy::ricci_homotopy;
use crate::mesh::{Shape, ricci_mesh};
use crate::metric::ricci_metric;
use crate::report::ricci_report;
use crate::space::ricci_space;
use crate::status::ricci_status;
use crate::uniformize_options::{read_options, ricci_uniformize_options};
use ricci::Surface;
use ricci::canonical::{Quotient, quotient_of, uniformize_quotient};
use ricci::topology::FundamentalDomain;
use std::mem::MaybeUninit;
use std::sync::Arc;

/// A closed surface of genus 1 and more with its metric of constant curvature, as the quotient of the plane (genus 1) or the hyperbolic
/// plane by its deck group: metric, layout about a base vertex, homotopy basis, deck transformations.
///
/// Faces and edges of its layout are those of ricci_quotient_mesh, on which edges may have been flipped; ricci_quotient_layout leads
/// back to the given mesh.
pub struct ricci_quotient {
    poison: Poison,
    pub(crate) quotient: Arc<Quotient>,
}

handle!(ricci_quotient, "quotient");

impl ricci_quotient {
    pub(crate) fn new(quotient: Quotient) -> ricci_quotient {
        log::info!(
            "uniformize: {} after {} iterations, max |K| = {:.1e}, side pairings within {:.1e}, relation {:.1e}",
            quotient.report.stop_reason,
            quotient.report.iterations,
            quotient.angle_defect,
            quotient.deck.side_residual,
            quotient.deck.relation_residual
        );
        ricci_quotient { poison: Poison::default(), quotient: Arc::new(quotient) }
    }
}

/// The metric of constant curvature in the conformal class of a closed surface of genus 1 and more, with its layout and deck group.
///
/// Genus 1: flat, with the area of the given surface; more: hyperbolic. Where the flow has not converged (`converged` of the summary) the
/// rest is as good as the metric is. Deterministic.
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT, RICCI_STRUCT_SIZE, RICCI_LAYOUT (a boundary, genus 0), RICCI_EDGE_LENGTH,
/// RICCI_TRIANGLE_INEQUALITY, RICCI_EDGE_WEIGHT, RICCI_DOMAIN, RICCI_FACTORISATION, RICCI_CANCELLED.
///
/// @param mesh      the mesh; lengths are measured in space, or those of an intrinsic mesh.
/// @param options   how; NULL for the defaults.
/// @param control   progress and cancellation; NULL for neither.
/// @param quotient  out: the new handle, to be released by ricci_quotient_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_quotient_new(
    mesh: *const ricci_mesh,
    options: *const ricci_uniformize_options,
    control: *const ricci_control,
    quotient: *mut *mut ricci_quotient,
) -> ricci_status {
    guard::make("quotient", quotient, |door| {
        let mesh = door.shared(mesh)?;
        uniformize(mesh.surface()?, options, control)
    })
}

/// ricci_quotient_new with lengths of the caller's in place of the mesh's own.
///
/// @return as ricci_quotient_new; RICCI_WRONG_SIZE.
///
/// @param mesh      the mesh.
/// @param lengths   n_edges lengths, finite and positive, in the order of ricci_mesh_edges.
/// @param n_edges   number of edges of the mesh.
/// @param geometry  the geometry in which the lengths are meant.
/// @param options   how; NULL for the defaults.
/// @param control   progress and cancellation; NULL for neither.
/// @param quotient  out: the new handle, to be released by ricci_quotient_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_quotient_from_lengths(
    mesh: *const ricci_mesh,
    lengths: *const f64,
    n_edges: usize,
    geometry: MaybeUninit<ricci_space>,
    options: *const ricci_uniformize_options,
    control: *const ricci_control,
    quotient: *mut *mut ricci_quotient,
) -> ricci_status {
    guard::make("quotient", quotient, |door| {
        let mesh = door.shared(mesh)?;
        let lengths = arrays::array_of("lengths", lengths, n_edges, mesh.connectivity.n_edges())?;
        let surface = mesh.surface_with(lengths, choose(geometry)?)?;
        uniformize(surface, options, control)
    })
}

fn uniformize(
    surface: Surface,
    options: *const ricci_uniformize_options,
    control: *const ricci_control,
) -> Outcome<ricci_quotient> {
    let (options, control) = (read_options(options)?, control::of(control));
    Ok(ricci_quotient::new(uniformize_quotient(&surface, &options, &control)?))
}

/// ricci_quotient_new from where a metric is, such as another solver's result: in the metric's scheme.
///
/// @return as ricci_quotient_new; RICCI_LAYOUT also for a metric in another space than E2 (genus 1) or H2 (more).
///
/// @param metric    where the flow starts.
/// @param options   how, without `scheme`; NULL for the defaults.
/// @param control   progress and cancellation; NULL for neither.
/// @param quotient  out: the new handle, to be released by ricci_quotient_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_quotient_from_metric(
    metric: *const ricci_metric,
    options: *const ricci_uniformize_options,
    control: *const ricci_control,
    quotient: *mut *mut ricci_quotient,
) -> ricci_status {
    guard::make("quotient", quotient, |door| {
        let metric = door.shared(metric)?;
        let found = quotient_of(&metric.surface, &read_options(options)?, &control::of(control))?;
        Ok(ricci_quotient::new(found))
    })
}

/// Release a quotient. What it has handed out lives on.
///
/// @param quotient  the handle, or NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_quotient_free(quotient: *mut ricci_quotient) {
    guard::free(quotient);
}

/// The metric of constant curvature.
///
/// @return RICCI_OK, RICCI_NULL_POINTER.
///
/// @param quotient  the quotient.
/// @param metric    out: the new handle, to be released by ricci_metric_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_quotient_metric(
    quotient: *const ricci_quotient,
    metric: *mut *mut ricci_metric,
) -> ricci_status {
    guard::make("metric", metric, |door| ricci_metric::at(door.shared(quotient)?.quotient.metric.clone()))
}

/// What the flow did.
///
/// @return RICCI_OK, RICCI_NULL_POINTER.
///
/// @param quotient  the quotient.
/// @param report    out: the new handle, to be released by ricci_report_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_quotient_report(
    quotient: *const ricci_quotient,
    report: *mut *mut ricci_report,
) -> ricci_status {
    guard::make("report", report, |door| {
        Ok(ricci_report::new(door.shared(quotient)?.quotient.report.clone()))
    })
}

/// The triangulation of the metric and the layout, an intrinsic mesh with the metric's lengths: ricci_metric_mesh of its metric.
///
/// @return RICCI_OK, RICCI_NULL_POINTER.
///
/// @param quotient  the quotient.
/// @param mesh      out: the new handle, to be released by ricci_mesh_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_quotient_mesh(
    quotient: *const ricci_quotient,
    mesh: *mut *mut ricci_mesh,
) -> ricci_status {
    guard::make("mesh", mesh, |door| {
        let metric = &door.shared(quotient)?.quotient.metric;
        let lengths = Arc::new(metric.metric().lengths(metric.mesh())?);
        Ok(ricci_mesh::new(metric.mesh().clone(), Shape::Lengths(lengths, metric.metric().space)))
    })
}

/// The homotopy basis whose loops generate the deck group: on the triangulation of the metric, short in it.
///
/// @return RICCI_OK, RICCI_NULL_POINTER.
///
/// @param quotient  the quotient.
/// @param homotopy  out: the new handle, to be released by ricci_homotopy_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_quotient_homotopy(
    quotient: *const ricci_quotient,
    homotopy: *mut *mut ricci_homotopy,
) -> ricci_status {
    guard::make("homotopy", homotopy, |door| {
        let quotient = &door.shared(quotient)?.quotient;
        Ok(ricci_homotopy::new(quotient.metric.mesh().clone(), quotient.basis.clone()))
    })
}

/// The layout as a fundamental domain: its sides, in the order of ricci_quotient_sides.
///
/// @return RICCI_OK, RICCI_NULL_POINTER.
///
/// @param quotient  the quotient.
/// @param domain    out: the new handle, to be released by ricci_domain_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_quotient_domain(
    quotient: *const ricci_quotient,
    domain: *mut *mut ricci_domain,
) -> ricci_status {
    guard::make("domain", domain, |door| {
        let Quotient { metric, layout, basis, .. } = &*door.shared(quotient)?.quotient;
        Ok(ricci_domain::new(FundamentalDomain::new(metric.mesh(), &layout.cut.is_cut, basis)?))
    })
}

/// The modulus of a torus: the quotient of two periods in the fundamental domain |Re| <= 1/2, |tau| >= 1, Im > 0 of SL(2, Z); on its
/// border Re >= 0.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_LAYOUT (not a torus).
///
/// @param quotient  the quotient.
/// @param tau       out: real and imaginary part.
/// @param capacity  entries of `tau`, at least 2.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_quotient_modulus(
    quotient: *const ricci_quotient,
    tau: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::call(|door| {
        let deck = &door.shared(quotient)?.quotient.deck;
        let found = deck.modulus();
        let found = found.ok_or_else(|| {
            ricci::Error::Layout("only a torus has a modulus in the upper half-plane".into())
        })?;
        arrays::copy_out("tau", &found, tau, capacity)
    })
}
