//! The construction of an atlas from a surface and options.

use super::align::align;
use super::atlas::{Atlas, Chart};
use super::cocycle::check_cocycle_condition;
use super::developable::DevelopableSurface;
use super::draft::ChartDraft;
use super::flat_source::StructureSource;
use super::growth::AtlasCover;
use super::holonomy::Holonomy;
use super::options::{AtlasOptions, ChartKind};
use super::overlaps::{FaceLifts, Transition};
use super::source::structure_source;
use super::stars::star;
use crate::control::Control;
use crate::error::{Error, Result};
use crate::mesh::VertexId;
use crate::metric::Surface;
use crate::parallel::{self, Pool};

/// The atlas of a structure on a surface; it is the same for any number of threads.
///
/// # Errors
/// [`Error::Argument`] for a structure that the surface does not have, options that do not belong to the structure, a singular vertex that
/// does not exist or on a surface that needs none, a radius that is not positive; [`Error::Layout`] for a surface without a regular vertex;
/// those of [`crate::canonical::uniformize()`], [`crate::flow::flow()`] and [`crate::harmonic::HarmonicForms::new`]; [`Error::Cancelled`].
pub fn atlas(surface: &Surface, options: &AtlasOptions, control: &Control) -> Result<Atlas> {
    if let Some(radius) = options.radius.filter(|r| r.is_nan() || *r <= 0.0) {
        return Err(Error::argument("radius", radius, "positive"));
    }
    let found = structure_source(surface, options, &control.part(0.0, 0.6))?;
    Pool::new(options.flow.threads)?.run(|| chart(found, options, &control.part(0.6, 1.0)))
}

/// The atlas of a developed surface.
fn chart(found: StructureSource, options: &AtlasOptions, control: &Control) -> Result<Atlas> {
    let (surface, structure) = (&found.developed, options.structure);
    let holonomy = Holonomy::new(surface, &found.basis, control)?;
    let mut drafts = match options.charts {
        ChartKind::Stars => stars(surface, options.radius, &control.part(0.0, 0.5))?,
        ChartKind::Patches => AtlasCover::new(surface, options.radius, &control.part(0.0, 0.5)).cover()?,
    };
    if drafts.is_empty() {
        return Err(Error::Layout(
            "every vertex is singular: refine the surface (`ricci refine --levels 1`)".into(),
        ));
    }
    let mut lifts = FaceLifts::new(&drafts, surface.mesh().n_faces());
    let overlaps = lifts.find_overlaps(&drafts, &control.part(0.5, 1.0))?;
    align(&mut drafts, &overlaps, surface, control)?;
    let mut embedded: Vec<Result<bool>> = (0..drafts.len()).map(|_| Ok(false)).collect();
    parallel::fill(&mut embedded, |i| drafts[i].is_embedded(surface, control));
    let mut folded = Vec::new();
    for (i, embedded) in (0..).zip(embedded) {
        if !embedded? {
            folded.push(i);
        }
    }
    let transitions: Vec<_> =
        overlaps.into_iter().map(|overlap| overlap.transition(structure, &drafts)).collect();
    let transitions = if surface.turns { off_singular(transitions, surface, &drafts) } else { transitions };
    control.check()?;
    let (space, mesh) = (surface.faces.space, surface.faces.mesh.clone());
    Ok(Atlas {
        structure,
        space,
        charts: drafts.into_iter().map(|draft| Chart::new(draft, structure, space)).collect(),
        cocycles: check_cocycle_condition(&lifts, &transitions, mesh.n_faces()),
        transitions,
        singular_vertices: mesh.vertices().filter(|&v| surface.singular[v]).collect(),
        excluded: mesh.faces().filter(|&f| surface.excluded[f]).collect(),
        zeros: found.zeros,
        curvature_error: found.curvature_error,
        converged: found.converged,
        holonomy,
        folded,
        lifts,
        mesh,
        metric: found.metric,
        subdivision: found.subdivision,
        on_given: found.on_given,
    })
}

/// Transitions without the singular vertices of their overlaps, where any others are left: charts that meet in such a vertex alone, on
/// different sides, have other transitions.
fn off_singular(
    mut transitions: Vec<Transition>,
    surface: &DevelopableSurface,
    drafts: &[ChartDraft],
) -> Vec<Transition> {
    for transition in &mut transitions {
        let vertices = &drafts[transition.from as usize].vertices;
        let is_regular = |pair: &&[u32; 2]| !surface.singular[vertices[pair[0] as usize]];
        let regular: Vec<[u32; 2]> = transition.pairs.iter().filter(is_regular).copied().collect();
        if !regular.is_empty() {
            transition.pairs = regular;
        }
    }
    transitions
}

/// The stars of all regular vertices, and grown charts over the faces that are in none of them.
fn stars(surface: &DevelopableSurface, radius: Option<f64>, control: &Control) -> Result<Vec<ChartDraft>> {
    let vertices: Vec<VertexId> = surface.mesh().vertices().filter(|&v| !surface.singular[v]).collect();
    let mut found: Vec<Option<ChartDraft>> = (0..vertices.len()).map(|_| None).collect();
    parallel::fill(&mut found, |i| star(surface, vertices[i]));
    let mut drafts: Vec<ChartDraft> = found.into_iter().flatten().collect();
    drafts.extend(AtlasCover::new(surface, radius, control).cover_rest(&drafts)?);
    Ok(drafts)
}
