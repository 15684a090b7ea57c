//! Surfaces with handles: both in the flat or hyperbolic metric of the target, the homotopy class of the map given by the images of
//! generators of the fundamental group.
//!
//! A homotopy basis is found on each surface. Both have the same relator, so a class is given by bringing each letter of the source to the
//! same letter of the target. This correspondence of the bases is arbitrary, so twists and turns of the handles follow as long as they
//! lower the energy of the harmonic map. A class that the user names by pairs of loops ([`named_class`]) is taken as it is.

mod generators;
mod named_class;
mod search;

use super::balance::{Springs, relax, settle_both};
use super::canonical::{CanonicalMetric, CanonicalSurface, Opening, for_both};
use super::cover::{PlacedMesh, UniversalCover, WalkSeed, on_axis};
use super::domain_pair::DomainPair;
use super::landmarks::MarkedSurface;
use super::options::MatchOptions;
use crate::control::Control;
use crate::embed::LayoutScale;
use crate::error::{Error, Result};
use crate::geometry::{DoubleDouble, Motion, Space};
use crate::mesh::{HalfedgeId, Mesh, PerVertex};
use crate::metric::Surface;
use crate::topology::{CutGraph, FundamentalDomain, HomotopyBasis, crossed_halfedges, homotopy_basis};
use generators::Generators;
use named_class::{LetterImages, SurfaceWithLoops, letter_images};
use search::{ClassSearch, LeastMap};
use std::sync::Arc;

/// Energy of the source in the target's domain over that of the target itself, below which no other class is tried.
const UNTWISTED: f64 = 1.05;
/// Energy of another class over the least, up to which the map of it may be the better one for landmarks.
const SIMILAR: f64 = 1.5;

/// A surface in its own metric, opened along the cut of its homotopy basis.
struct HandleSurface {
    own: CanonicalSurface,
    basis: HomotopyBasis,
    domain: FundamentalDomain,
    /// The generators of its deck group, with the lines of its boundary, in the order of its basis.
    generators: Generators,
}

/// Both surfaces in the target's metric. With `more` also the source in other classes of about the same energy, from which landmarks may be
/// nearer to their partners.
///
/// # Errors
/// [`Error::Matching`] if a flow does not reach its target, and if no harmonic map is found; those of [`homotopy_basis`],
/// [`CanonicalMetric::new`] and [`Opening::place`]; [`Error::Cancelled`].
pub(super) fn with_handles(
    sides: [MarkedSurface; 2],
    more: bool,
    options: &MatchOptions,
    control: &Control,
) -> Result<(DomainPair, Vec<PlacedMesh>)> {
    let surfaces = sides.map(|side| side.surface);
    let space = if surfaces[0].mesh().euler() == 0 { Space::E2 } else { Space::H2 };
    let own = for_both(|s| handle_surface(sides[s], space, options, control))?;
    let own = [&own[0], &own[1]];
    let order = loop_order(sides, own);
    let named = named(surfaces, own, &options.basis, &order)?;
    let is_named = named.is_some();
    let generators = named.unwrap_or_else(|| own[1].generators.clone().reordered(&order));
    let search = ClassSearch { surfaces, own, boundary: options.boundary };
    let freedom = [0, 1].map(|s| search.freedom(s, space));
    let springs = [0, 1].map(|s| Springs { weights: &own[s].own.weights, freedom: &freedom[s] });
    let mut domain = own[1].own.placed.clone();
    search.straighten(&mut domain)?;
    let second = relax(&mut domain, springs[1], control)?;
    // Beside a class that is named no other one is tried.
    let enough = if is_named { f64::INFINITY } else { UNTWISTED * second.energy };
    let LeastMap { mut image, relaxed: first, generators, mut tried } =
        search.least(generators, springs[0], enough, control)?;
    let mut others = Vec::new();
    for next in generators.symmetric().into_iter().filter(|_| more && !is_named) {
        tried += 1;
        match search.image(&next, springs[0], control) {
            Ok((other, relaxed)) if relaxed.energy < SIMILAR * first.energy => others.push(other),
            Err(Error::Cancelled) => return Err(Error::Cancelled),
            _ => {}
        }
    }
    let reports = settle_both([&mut image, &mut domain], springs, [first, second], control)?;
    let seed = |from: &HandleSurface, to: &HandleSurface| WalkSeed {
        vertex: from.basis.base,
        near: to.own.placed.cover.own(to.basis.base),
    };
    let seeds = [seed(own[0], own[1]), seed(own[1], own[0])];
    let flow_iterations = own.map(|own| own.own.iterations);
    let pair = DomainPair { source: image, target: domain, seeds, reports, flow_iterations, markings: tried };
    Ok((pair, others))
}

/// A surface in its flat or hyperbolic metric; the base of its homotopy basis is its landmark, if it has one.
fn handle_surface(
    side: MarkedSurface,
    space: Space,
    options: &MatchOptions,
    control: &Control,
) -> Result<HandleSurface> {
    let MarkedSurface { surface, marks } = side;
    let mesh = surface.mesh();
    let basis = homotopy_basis(mesh, surface.lengths(), marks.landmarks.first().copied(), control)?;
    let cut = CutGraph::around(mesh, basis.cut(mesh));
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
    let mut generators = generators(&basis, &domain, &placed, mesh)?;
    if let Some(closed) = generators.clone().closed() {
        placed.cover = cover_by_words(mesh, &basis, &domain, &closed)?;
        generators = closed;
    }
    add_lines(&mut generators, &basis, &placed, mesh)?;
    Ok(HandleSurface {
        own: CanonicalSurface::new(surface, placed, metric.iterations),
        basis,
        domain,
        generators,
    })
}

/// The cover of a surface that is opened along the cut of its homotopy basis, if the letters go to these motions.
fn cover_by_words(
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

/// For each letter of the source's boundary the number of the target's letter to whose loop its loop goes.
fn loop_order(sides: [MarkedSurface; 2], own: [&HandleSurface; 2]) -> Vec<usize> {
    let of = |s: usize, rim: &HalfedgeId| {
        let mesh = sides[s].surface.mesh();
        let v = mesh.tip(*rim);
        sides[s].marks.loops.iter().position(|around| around.iter().any(|&h| mesh.origin(h) == v))
    };
    let second: Vec<_> = own[1].basis.rims.iter().map(|rim| of(1, rim)).collect();
    own[0].basis.rims.iter().filter_map(|rim| second.iter().position(|k| *k == of(0, rim))).collect()
}

/// The images of the source's letters in the class that pairs of loops name; `None` without loops.
///
/// # Errors
/// [`Error::Matching`] if the loops bring a boundary loop to another one than `order` does; those of [`letter_images`].
fn named(
    surfaces: [&Surface; 2],
    own: [&HandleSurface; 2],
    pairs: &[[Vec<HalfedgeId>; 2]],
    order: &[usize],
) -> Result<Option<Generators>> {
    if pairs.is_empty() {
        return Ok(None);
    }
    let with_loops = |s: usize| SurfaceWithLoops {
        mesh: surfaces[s].mesh(),
        basis: &own[s].basis,
        generators: &own[s].generators,
        at_base: own[s].own.placed.at[own[s].basis.base],
        loops: pairs.iter().map(|pair| &pair[s][..]).collect(),
    };
    let LetterImages { handles, rims } = letter_images([&with_loops(0), &with_loops(1)])?;
    let target = &own[1].generators;
    let mut motions = handles.iter().map(|word| target.motion(word)).collect::<Result<Vec<_>>>()?;
    let mut lines = Vec::with_capacity(rims.len());
    for (j, (k, by)) in rims.iter().enumerate() {
        if order[j] != *k {
            return Err(other_loop(surfaces, own, [j, *k]));
        }
        let by = target.motion(by)?;
        motions.push(target.motions[2 * target.genus + k].conjugated_by(&by).normalised());
        lines.push(by.compose(&target.lines[*k]).normalised());
    }
    Ok(Some(Generators { motions, lines, ..target.clone() }))
}

/// The error of a basis that brings the boundary loop of a letter of the source to that of a letter of the target which the order of the
/// loops does not permit.
fn other_loop(surfaces: [&Surface; 2], own: [&HandleSurface; 2], letters: [usize; 2]) -> Error {
    let number = |s: usize| {
        let (mesh, rim) = (surfaces[s].mesh(), own[s].basis.rims[letters[s]]);
        let runs = |around: &Vec<HalfedgeId>| around.contains(&rim.twin());
        mesh.boundary_loops().iter().position(runs).unwrap_or_default()
    };
    Error::Matching(format!(
        "the loops of the basis bring boundary loop {} of the source to boundary loop {} of the target, which is not the one that was asked for or, \
         by default, the one of the same rank by length",
        number(0),
        number(1)
    ))
}
