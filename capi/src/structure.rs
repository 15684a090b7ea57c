//! Geometric structures of surfaces: atlases of charts with transitions.

use crate::arrays::{check_buffer, copy_out};
use crate::choice::choices;
use crate::control::{self, ricci_control};
use crate::failure::{FailureElement, no_such};
use crate::flow::{read_options, ricci_flow_options};
use crate::guard::{self, handle, shared};
use crate::memory;
use crate::mesh::{SPACES, ricci_mesh};
use crate::paths::vertex_or_none;
use crate::status::*;
use crate::structs::{self, sized};
use ricci::structure::{AffineSource, Atlas, AtlasOptions, ChartKind, GroupElement, Structure, atlas};

pub struct ricci_structure {
    pub(crate) atlas: Atlas,
}
handle!(ricci_structure, "structure", |structure| {
    let charts = structure.atlas.charts.iter();
    structure.atlas.transitions.len() + charts.map(|chart| chart.faces.len()).sum::<usize>()
});

choices!(KINDS: Structure = "kind of structure", [
    RICCI_STRUCTURE_CONFORMAL => Structure::Conformal,
    RICCI_STRUCTURE_SPHERICAL => Structure::Spherical,
    RICCI_STRUCTURE_AFFINE => Structure::Affine,
    RICCI_STRUCTURE_HYPERBOLIC => Structure::Hyperbolic,
    RICCI_STRUCTURE_PROJECTIVE => Structure::Projective,
    RICCI_STRUCTURE_INTEGER => Structure::Integer,
]);

choices!(CHARTS: ChartKind = "charts", [
    RICCI_CHARTS_STARS => ChartKind::Stars,
    RICCI_CHARTS_PATCHES => ChartKind::Patches,
]);

choices!(SOURCES: AffineSource = "source", [
    RICCI_AFFINE_FLOW => AffineSource::Flow,
    RICCI_AFFINE_FORM => AffineSource::Form,
]);

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_structure_options {
    pub size: usize,
    pub flow: *const ricci_flow_options,
    pub singular: *const u32,
    pub radius: f64,
    pub charts: u32,
    pub source: u32,
    pub n_quads: usize,
}
// SAFETY: numbers and raw pointers; 8-byte alignment, size first.
sized!(ricci_structure_options, "options");

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_structure_summary {
    pub size: usize,
    pub kind: u32,
    pub space: u32,
    pub converged: u32,
    pub n_matrix: u32,
    pub n_vertices: usize,
    pub n_faces: usize,
    pub n_charts: usize,
    pub n_transitions: usize,
    pub n_generators: usize,
    pub n_singular: usize,
    pub n_excluded: usize,
    pub n_zeros: usize,
    pub n_folded: usize,
    pub n_triples: usize,
    pub transition_residual: f64,
    pub cocycle_residual: f64,
    pub relation_residual: f64,
    pub max_curvature_error: f64,
}
// SAFETY: numbers; 8-byte alignment, size first.
sized!(ricci_structure_summary, "summary");

/// The count of numbers of a transition's matrix, which is complex 2 × 2 or real 3 × 3.
fn matrix_size(structure: Structure) -> usize {
    if structure.is_complex() { 8 } else { 9 }
}

/// The entries of a matrix by rows, complex ones as real and imaginary part.
fn entries(element: &GroupElement) -> impl Iterator<Item = f64> + use<> {
    let parts = if matches!(element, GroupElement::Mobius(_)) { 2 } else { 1 };
    element.rows().into_iter().flatten().flat_map(move |entry| entry.into_iter().take(parts))
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_structure_new(
    mesh: *const ricci_mesh,
    kind: u32,
    options: *const ricci_structure_options,
    control: *const ricci_control,
    structure: *mut *mut ricci_structure,
) -> ricci_status {
    guard::make(structure, || {
        let (mesh, given, control) = (shared(mesh)?, structs::read(options)?, control::of(control)?);
        let _reserve = memory::work(mesh.connectivity.n_vertices(), memory::UNIFORM)?;
        let options = AtlasOptions {
            structure: KINDS.choose(kind)?,
            charts: CHARTS.choose(given.charts)?,
            radius: (given.radius != 0.0).then_some(given.radius),
            source: SOURCES.choose(given.source)?,
            singular: vertex_or_none(given.singular)?,
            quads: (given.n_quads != 0).then_some(given.n_quads),
            flow: read_options(given.flow)?,
        };
        Ok(ricci_structure { atlas: atlas(mesh.surface()?, &options, &control)? })
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_structure_free(structure: *mut ricci_structure) {
    guard::free(structure);
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_structure_summarise(
    structure: *const ricci_structure,
    summary: *mut ricci_structure_summary,
    size: usize,
) -> ricci_status {
    guard::with(structure, |ricci_structure { atlas }| {
        let figures = ricci_structure_summary {
            size,
            kind: KINDS.number(atlas.structure)?,
            space: SPACES.number(atlas.space)?,
            converged: atlas.converged.into(),
            n_matrix: matrix_size(atlas.structure) as u32,
            n_vertices: atlas.mesh.n_vertices(),
            n_faces: atlas.mesh.n_faces(),
            n_charts: atlas.charts.len(),
            n_transitions: atlas.transitions.len(),
            n_generators: atlas.holonomy.generators.len(),
            n_singular: atlas.singular_vertices.len(),
            n_excluded: atlas.excluded.len(),
            n_zeros: atlas.zeros.len(),
            n_folded: atlas.folded.len(),
            n_triples: atlas.cocycles.triples,
            transition_residual: atlas.transition_residual(),
            cocycle_residual: atlas.cocycles.residual,
            relation_residual: atlas.holonomy.relation_residual,
            max_curvature_error: atlas.curvature_error,
        };
        structs::write(figures, summary, size)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_structure_transitions(
    structure: *const ricci_structure,
    charts: *mut u32,
    charts_capacity: usize,
    matrices: *mut f64,
    matrices_capacity: usize,
) -> ricci_status {
    guard::with(structure, |ricci_structure { atlas }| {
        let all = &atlas.transitions;
        let numbers: Vec<f64> = all.iter().flat_map(|t| entries(&t.element)).collect();
        check_buffer("matrices", numbers.len(), matrices, matrices_capacity)?;
        let ends: Vec<[u32; 2]> = all.iter().map(|t| [t.from, t.to]).collect();
        copy_out("charts", &ends, charts, charts_capacity)?;
        copy_out("matrices", &numbers, matrices, matrices_capacity)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_structure_holonomy(
    structure: *const ricci_structure,
    matrices: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(structure, |ricci_structure { atlas }| {
        let generators = atlas.holonomy.generators.iter();
        let elements = generators.map(|motion| GroupElement::of_motion(atlas.structure, motion));
        let numbers: Vec<f64> = elements.flat_map(|element| entries(&element)).collect();
        copy_out("matrices", &numbers, matrices, capacity)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_structure_coordinates(
    structure: *const ricci_structure,
    chart: usize,
    coordinates: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(structure, |ricci_structure { atlas }| match atlas.charts.get(chart) {
        Some(chart) => copy_out("coordinates", &chart.coordinates, coordinates, capacity),
        None => Err(no_such(FailureElement::Entry, "chart", chart, atlas.charts.len())),
    })
}
