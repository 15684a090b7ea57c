//! The metrics and forms from which the charts of each structure are developed.

use super::developable::DevelopableSurface;
use super::flat_source::{StructureSource, source_of_flat};
use super::kind::Structure;
use super::options::{AffineSource, AtlasOptions};
use super::singular::singular_vertex;
use crate::canonical::{QuotientOptions, Sphere, SphereOptions, uniformize_quotient, uniformize_sphere};
use crate::control::Control;
use crate::embed::FaceTransitions;
use crate::error::{Error, Result};
use crate::flow::flow;
use crate::geometry::Space;
use crate::geometry::complex::{cross, dot, neg};
use crate::harmonic::{Domain, FormsOptions, HarmonicForms, even_combination, with_conjugate, zeros};
use crate::mesh::{Mesh, PerEdge, PerVertex, VertexId};
use crate::metric::{Class, Surface, Target};
use crate::parallel::Pool;
use crate::topology::homotopy_basis;
use std::f64::consts::TAU;
use std::sync::Arc;

/// Develops a surface for the charts of a structure.
pub(super) fn structure_source(
    surface: &Surface,
    options: &AtlasOptions,
    control: &Control,
) -> Result<StructureSource> {
    let mesh = surface.mesh();
    check(mesh, options)?;
    let (closed, euler) = (mesh.is_closed(), mesh.euler());
    match (options.structure, options.source) {
        #[cfg(feature = "quads")]
        (Structure::Integer, _) => super::integer::of_quads(surface, options, control),
        (Structure::Affine, AffineSource::Form) => of_form(surface, options, control),
        (Structure::Affine, _) if closed && euler == 2 => of_plane(surface, options, control),
        (Structure::Affine, _) if closed && euler < 0 => {
            let v = singular_vertex(surface, options.singular, options.flow.threads, control)?;
            of_flow(surface, &Target::Single(v), options, control)
        }
        (Structure::Affine, _) if !closed => of_flow(surface, &Target::Boundary, options, control),
        (Structure::Conformal, _) if !closed && euler > 0 => {
            of_flow(surface, &Target::Boundary, options, control)
        }
        _ if closed && euler == 2 => {
            let sphere = sphere(surface, options, control)?;
            let developed = DevelopableSurface::new(FaceTransitions::new(&sphere.metric, None)?);
            simply_connected(developed, &sphere, control)
        }
        _ => of_quotient(surface, options, control),
    }
}

/// Checks that a surface has a structure, and that options belong to it.
fn check(mesh: &Mesh, options: &AtlasOptions) -> Result<()> {
    let (closed, euler, structure) = (mesh.is_closed(), mesh.euler(), options.structure);
    if structure == Structure::Integer && !cfg!(feature = "quads") {
        return Err(Error::argument(
            "structure",
            structure,
            "another one: this library was built without quads",
        ));
    }
    if let Some(n) = options.quads.filter(|&n| n == 0 || structure != Structure::Integer) {
        return Err(Error::argument("quads", n, "positive, and left out for structures other than integer"));
    }
    let need = match structure {
        Structure::Spherical if !closed || euler != 2 => "closed of genus 0 for a spherical structure",
        Structure::Hyperbolic if euler >= 0 => "of negative Euler characteristic for a hyperbolic structure",
        Structure::Projective if euler >= 0 => {
            "of negative Euler characteristic for the projective structure of the Klein disk (a flat surface has its affine one)"
        }
        Structure::Affine if options.source == AffineSource::Form && (!closed || euler > 0) => {
            "closed of genus at least 1 for an affine structure from a holomorphic form"
        }
        _ => "",
    };
    if !need.is_empty() {
        let kind = if closed { "closed" } else { "with boundary" };
        let value = format!("{kind}, of genus {} and Euler characteristic {euler}", mesh.genus());
        return Err(Error::Argument { what: "surface", value, need });
    }
    if options.source == AffineSource::Form && structure != Structure::Affine {
        return Err(Error::argument("structure from a form", structure, "affine"));
    }
    let Some(v) = options.singular else { return Ok(()) };
    let one_cone = structure == Structure::Affine && options.source == AffineSource::Flow;
    if !one_cone || !closed || euler == 0 {
        let need =
            "left out: only affine structures by the flow on closed surfaces of genus other than 1 have one";
        return Err(Error::argument("singular vertex", v, need));
    }
    if v.index() >= mesh.n_vertices() {
        return Err(Error::argument("singular vertex", v, "a vertex of the surface, numbered from 0"));
    }
    Ok(())
}

fn sphere(surface: &Surface, options: &AtlasOptions, control: &Control) -> Result<Sphere> {
    let flow = &options.flow;
    let sphere = SphereOptions {
        tolerance: flow.tolerance,
        max_iterations: flow.max_iterations,
        puncture: options.singular,
        threads: flow.threads,
    };
    uniformize_sphere(surface, &sphere, control)
}

/// A sphere as the plane with one vertex at infinity.
fn of_plane(surface: &Surface, options: &AtlasOptions, control: &Control) -> Result<StructureSource> {
    let sphere = sphere(surface, options, control)?;
    let mut developed = DevelopableSurface::of_points(sphere.metric.mesh(), Space::E2, |v| {
        let [x, y] = sphere.plane[VertexId::from(v)];
        [x, y, 1.0]
    });
    developed.singular[sphere.report.puncture] = true;
    let found = simply_connected(developed, &sphere, control)?;
    Ok(StructureSource { curvature_error: sphere.report.max_curvature_error, ..found })
}

fn simply_connected(
    developed: DevelopableSurface,
    sphere: &Sphere,
    control: &Control,
) -> Result<StructureSource> {
    let ones = PerEdge::filled(developed.mesh().n_edges(), 1.0);
    Ok(StructureSource {
        basis: homotopy_basis(developed.mesh(), &ones, None, control)?,
        developed,
        metric: Arc::new(sphere.metric.clone()),
        subdivision: None,
        zeros: Vec::new(),
        curvature_error: sphere.report.spherical_curvature_error,
        converged: sphere.report.converged,
        on_given: None,
    })
}

/// The surface with the metric of constant curvature and geodesic boundary.
fn of_quotient(surface: &Surface, options: &AtlasOptions, control: &Control) -> Result<StructureSource> {
    let asked = QuotientOptions { flow: options.flow.clone(), ..QuotientOptions::default() };
    let quotient = uniformize_quotient(surface, &asked, control)?;
    let subdivision = quotient.layout.common_subdivision().cloned();
    let faces = FaceTransitions::new(&quotient.metric, subdivision.as_ref())?;
    let factor = if faces.space == Space::E2 { (surface.area()? / faces.area).sqrt() } else { 1.0 };
    Ok(StructureSource {
        developed: DevelopableSurface::new(faces).scaled(factor),
        zeros: Vec::new(),
        curvature_error: quotient.angle_defect,
        converged: quotient.report.converged(),
        basis: quotient.basis,
        metric: Arc::new(quotient.metric),
        subdivision,
        on_given: None,
    })
}

/// The surface with a flat metric whose curvature is at one vertex or on the boundary.
fn of_flow(
    surface: &Surface,
    target: &Target,
    options: &AtlasOptions,
    control: &Control,
) -> Result<StructureSource> {
    let metric =
        flow(surface.clone(), Class::yamabe(Space::E2), target, &options.flow, &control.part(0.0, 0.7))?;
    // Of a doubled surface, or one with caps, only what was given is taken.
    let subdivision =
        metric.goes_beyond_given().then(|| metric.common_subdivision(control).map(Arc::new)).transpose()?;
    let faces = FaceTransitions::new(&metric, subdivision.as_ref())?;
    let factor = (surface.area()? / faces.area).sqrt();
    let mut developed = DevelopableSurface::new(faces).scaled(factor);
    target.named().into_iter().for_each(|v| developed.singular[v] = true);
    Ok(StructureSource { subdivision, ..source_of_flat(developed, metric, control)? })
}

/// The surface developed to the plane by a holomorphic 1-form.
fn of_form(surface: &Surface, options: &AtlasOptions, control: &Control) -> Result<StructureSource> {
    let domain = Domain::new(surface, control)?;
    Pool::new(options.flow.threads)?.run(|| {
        let forms = HarmonicForms::new(&domain, &FormsOptions::default(), control)?;
        let form = with_conjugate(&forms, &forms, &even_combination(&forms, control)?)?;
        let mesh = domain.mesh();
        let mut developed = DevelopableSurface::of_form(mesh, &form)?;
        let mut turned = PerVertex::filled(mesh.n_vertices(), 0.0);
        for f in mesh.faces() {
            let sides = mesh.face_halfedges(f).map(|h| form.along(h));
            for (k, v) in mesh.face_vertices(f).into_iter().enumerate() {
                let [z, w] = [sides[k], neg(sides[(k + 2) % 3])];
                turned[v] += cross(z, w).atan2(dot(z, w));
                developed.singular[v] |= developed.excluded[f];
            }
        }
        mesh.vertices().for_each(|v| developed.singular[v] |= (turned[v] / TAU).round() != 1.0);
        let area: f64 = mesh
            .faces()
            .map(|f| {
                let [_, p, q] = developed.faces.corners[f];
                0.5 * (p[0] * q[1] - p[1] * q[0])
            })
            .sum();
        let factor = (surface.area()? / area).sqrt();
        Ok(StructureSource {
            zeros: zeros(mesh, &form),
            metric: domain.metric().clone(),
            subdivision: None,
            basis: forms.basis.clone(),
            developed: developed.scaled(factor),
            curvature_error: 0.0,
            converged: true,
            on_given: None,
        })
    })
}
