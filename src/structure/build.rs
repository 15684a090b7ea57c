//! From a surface to an atlas.

use super::align::align;
use super::atlas::{Atlas, Parts};
use super::draft::Draft;
use super::holonomy::Holonomy;
use super::options::{AtlasOptions, Charts};
use super::overlaps::Lifts;
use super::patches::Patches;
use super::sheet::Sheet;
use super::source::{Developed, developed};
use super::stars::star;
use crate::control::Control;
use crate::error::{Error, Result};
use crate::mesh::VertexId;
use crate::metric::Surface;
use crate::parallel::{self, Pool};

/// The atlas of a structure on a surface. The same for any number of threads.
///
/// # Errors
/// [`Error::Argument`] for a structure that the surface has not, options that do not belong to the structure, a singular vertex that does
/// not exist or on a surface that needs none, a radius that is not positive; [`Error::Layout`] for a surface without a regular vertex;
/// those of [`crate::canonical::uniformize()`], [`crate::flow::flow()`] and [`crate::harmonic::HarmonicForms::new`]; [`Error::Cancelled`].
pub fn atlas(surface: &Surface, options: &AtlasOptions, control: &Control) -> Result<Atlas> {
    if let Some(radius) = options.radius.filter(|r| r.is_nan() || *r <= 0.0) {
        return Err(Error::argument("radius", radius, "positive"));
    }
    let found = developed(surface, options, control)?;
    Pool::new(options.flow.threads)?.run(|| chart(found, options, control))
}

/// The charts of a developed surface.
fn chart(found: Developed, options: &AtlasOptions, control: &Control) -> Result<Atlas> {
    let (sheet, structure) = (&found.sheet, options.structure);
    let holonomy = Holonomy::new(sheet, &found.basis, control)?;
    let mut drafts = match options.charts {
        Charts::Stars => stars(sheet, options.radius, control)?,
        Charts::Patches => Patches::new(sheet, options.radius, control).cover()?,
    };
    if drafts.is_empty() {
        return Err(Error::Layout("every vertex is singular: refine the surface".into()));
    }
    let mut lifts = Lifts::new(&drafts, sheet.mesh().n_faces());
    let overlaps = lifts.find_overlaps(&drafts, control)?;
    align(&mut drafts, &overlaps, sheet);
    let mut embedded: Vec<Result<bool>> = (0..drafts.len()).map(|_| Ok(false)).collect();
    parallel::fill(&mut embedded, |i| drafts[i].is_embedded(sheet, control));
    let mut folded = Vec::new();
    for (i, embedded) in (0..).zip(embedded) {
        if !embedded? {
            folded.push(i);
        }
    }
    let transitions = overlaps.into_iter().map(|overlap| overlap.transition(structure, &drafts)).collect();
    let (space, mesh) = (sheet.steps.space, sheet.steps.mesh.clone());
    let mut atlas = Atlas::new(Parts {
        structure,
        space,
        mesh,
        drafts,
        transitions,
        lifts,
        folded,
        holonomy,
        metric: found.metric,
        refinement: found.refinement,
    });
    atlas.singular_vertices = sheet.mesh().vertices().filter(|&v| sheet.singular[v]).collect();
    atlas.excluded = sheet.mesh().faces().filter(|&f| sheet.excluded[f]).collect();
    atlas.zeros = found.zeros;
    atlas.curvature_error = found.curvature_error;
    atlas.converged = found.converged;
    Ok(atlas)
}

/// The stars of all regular vertices, and patches about the faces that these leave over.
fn stars(sheet: &Sheet, radius: Option<f64>, control: &Control) -> Result<Vec<Draft>> {
    let vertices: Vec<VertexId> = sheet.mesh().vertices().filter(|&v| !sheet.singular[v]).collect();
    let mut found: Vec<Option<Draft>> = (0..vertices.len()).map(|_| None).collect();
    parallel::fill(&mut found, |i| star(sheet, vertices[i]));
    let mut drafts: Vec<Draft> = found.into_iter().flatten().collect();
    drafts.extend(Patches::new(sheet, radius, control).cover_rest(&drafts)?);
    Ok(drafts)
}
