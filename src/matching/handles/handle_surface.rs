//! A surface with handles in its own metric, with the generators of its deck group.

use super::generators::Generators;
use crate::control::Control;
use crate::embed::LayoutScale;
use crate::error::Result;
use crate::geometry::{DoubleDouble, Motion, Space};
use crate::matching::canonical::{CanonicalMetric, CanonicalSurface, Opening};
use crate::matching::cover::{PlacedMesh, UniversalCover, on_axis};
use crate::matching::landmarks::MarkedSurface;
use crate::matching::options::MatchOptions;
use crate::mesh::{HalfedgeId, Mesh, PerVertex};
use crate::topology::{CutGraph, FundamentalDomain, HomotopyBasis, crossed_halfedges, homotopy_basis};
use std::sync::Arc;

/// A surface in its own metric, opened along the cut of its homotopy basis.
pub(crate) struct HandleSurface {
    pub own: CanonicalSurface,
    pub basis: HomotopyBasis,
    pub domain: FundamentalDomain,
    /// The generators of its deck group, with the lines of its boundary, in the order of its basis.
    pub generators: Generators,
}

/// A surface in its flat or hyperbolic metric; the base of its homotopy basis is its landmark, if it has one.
pub(crate) fn handle_surface(
    side: MarkedSurface,
    space: Space,
    options: &MatchOptions,
    control: &Control,
) -> Result<HandleSurface> {
    let MarkedSurface { surface, marks } = side;
    let mesh = surface.mesh();
    let basis = homotopy_basis(mesh, surface.lengths(), marks.landmarks.first().copied(), control)?;
    let cut = CutGraph::around(mesh, basis.cut(mesh));
    control.check()?;
    let domain = FundamentalDomain::new(mesh, &cut.is_cut, &basis)?;
    let curvature = PerVertex::filled(mesh.n_vertices(), 0.0);
    let metric = CanonicalMetric::new(surface, space, curvature, &options.flow, control)?;
    let opening = Opening {
        cut: &cut,
        root: basis.base,
        cones: &[],
        own_corners: &[domain.base_corner],
        scale: LayoutScale::default(),
        subdivision: None,
        threads: options.flow.threads,
    };
    let (mut placed, _) = opening.place(&metric.solution, mesh, control)?;
    control.check()?;
    let mut generators = generators(&basis, &domain, &placed, mesh)?;
    if let Some(closed) = generators.clone().closed() {
        placed.cover = cover_by_words(mesh, &basis, &domain, &closed)?;
        generators = closed;
    }
    add_lines(&mut generators, &basis, &placed, mesh)?;
    control.check()?;
    Ok(HandleSurface {
        own: CanonicalSurface::new(surface, placed, metric.iterations, control)?,
        basis,
        domain,
        generators,
    })
}

/// The cover of a surface that is opened along the cut of its homotopy basis, if the letters go to these motions.
pub(crate) fn cover_by_words(
    mesh: &Arc<Mesh>,
    basis: &HomotopyBasis,
    domain: &FundamentalDomain,
    generators: &Generators,
) -> Result<UniversalCover> {
    let mut words: Vec<Option<Motion<DoubleDouble>>> = vec![None; mesh.n_halfedges()];
    for h in mesh.halfedges().filter(|&h| !mesh.is_outside(h)) {
        let word = basis.transition(mesh, h);
        if !word.is_empty() {
            words[h.index()] = Some(generators.motion(&word)?);
        }
    }
    UniversalCover::new(mesh, generators.space, |h| words[h.index()], &[domain.base_corner])
}

/// The motions of a surface's own generators, without lines.
fn generators(
    basis: &HomotopyBasis,
    domain: &FundamentalDomain,
    placed: &PlacedMesh,
    mesh: &Mesh,
) -> Result<Generators> {
    let cover = &placed.cover;
    let motion = |path: &Vec<HalfedgeId>| {
        let crossed = crossed_halfedges(mesh, domain.base_corner, path)?;
        let through = crossed.into_iter().filter_map(|h| cover.across(h));
        Ok(through.fold(Motion::identity(cover.space), |all, step| all.compose(step)).normalised())
    };
    let motions: Vec<Motion<DoubleDouble>> = basis.loops.iter().map(motion).collect::<Result<_>>()?;
    Ok(Generators { space: cover.space, genus: basis.group.genus, motions, lines: Vec::new() })
}

/// Adds the lines of the boundary: the axes of its generators.
fn add_lines(
    generators: &mut Generators,
    basis: &HomotopyBasis,
    placed: &PlacedMesh,
    mesh: &Mesh,
) -> Result<()> {
    for (j, &rim) in basis.rims.iter().enumerate() {
        let start = mesh.tip(rim);
        let tree = generators.motion(&basis.corner_word(placed.cover.own(start)))?.inverse();
        let along = &generators.motions[2 * generators.genus + j];
        let line = on_axis(along, &tree.compose(&placed.at[start]));
        generators.lines.push(line);
    }
    Ok(())
}
