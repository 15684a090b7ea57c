//! Surfaces with handles: both in the flat or hyperbolic metric of the target, the homotopy class of the map given by the images of
//! generators of the fundamental group.
//!
//! A homotopy basis is found on each surface. Both have the same relator, so a class is given by bringing each letter of the source to the
//! same letter of the target. This correspondence of the bases is arbitrary, so twists and turns of the handles follow as long as they
//! lower the energy of the harmonic map; of tori the energies of all classes are known from the lattices. A class that the user names by
//! pairs of loops ([`named_class`]) is taken as it is.

mod generators;
mod handle_surface;
mod named_class;
mod nearest_torus;
mod search;

use super::balance::{Springs, relax, settle_both};
use super::canonical::for_both;
use super::cover::{PlacedMesh, WalkSeed};
use super::domain_pair::DomainPair;
use super::landmarks::MarkedSurface;
use super::options::MatchOptions;
use crate::control::Control;
use crate::error::{Error, Result};
use crate::geometry::Space;
use crate::mesh::HalfedgeId;
use crate::metric::Surface;
use generators::Generators;
use handle_surface::{HandleSurface, handle_surface};
use named_class::{LetterImages, SurfaceWithLoops, letter_images};
use nearest_torus::nearest_class;
use search::{ClassSearch, LeastMap};

/// Energy of the source in the target's domain over that of the target itself, below which no other class is tried.
const UNTWISTED: f64 = 1.05;
/// Energy of another class over the least, up to which the map of it may be the better one for landmarks.
const SIMILAR: f64 = 1.5;

/// Both surfaces in the target's metric. With `more` also the source in other classes of about the same energy, from which landmarks may be
/// nearer to their partners.
///
/// # Errors
/// [`Error::Matching`] if a flow does not reach its target, and if no harmonic map is found; those of [`handle_surface`]; [`Error::Cancelled`].
pub(super) fn with_handles(
    sides: [MarkedSurface; 2],
    more: bool,
    options: &MatchOptions,
    control: &Control,
) -> Result<(DomainPair, Vec<PlacedMesh>)> {
    let surfaces = sides.map(|side| side.surface);
    let space = if surfaces[0].mesh().euler() == 0 { Space::E2 } else { Space::H2 };
    let own = for_both(|s| handle_surface(sides[s], space, options, &control.part(0.0, 0.5)))?;
    let own = [&own[0], &own[1]];
    let order = loop_order(sides, own);
    let named = named(surfaces, own, &options.basis, &order)?;
    let is_named = named.is_some();
    let is_torus = space == Space::E2;
    let (generators, compared) = match named {
        Some(named) => (named, 0),
        None if is_torus => nearest_class(&own[0].generators, own[1].generators.clone()),
        None => (own[1].generators.clone().reordered(&order), 0),
    };
    let search = ClassSearch { surfaces, own, boundary: options.boundary };
    let freedom = [0, 1].map(|s| search.freedom(s, space));
    let springs = [0, 1].map(|s| Springs { weights: &own[s].own.weights, freedom: &freedom[s] });
    let mut domain = own[1].own.placed.clone();
    search.straighten(&mut domain)?;
    let second = relax(&mut domain, springs[1], &control.part(0.5, 0.6))?;
    // Beside a class that is named, or the best one of tori, no other one is tried.
    let enough = if is_named || is_torus { f64::INFINITY } else { UNTWISTED * second.energy };
    let LeastMap { mut image, relaxed: first, generators, mut tried } =
        search.least(generators, springs[0], enough, &control.part(0.6, 0.8))?;
    tried = tried.max(compared);
    let mut others = Vec::new();
    for next in generators.symmetric().into_iter().filter(|_| more && !is_named) {
        tried += 1;
        match search.image(&next, springs[0], control) {
            Ok((other, relaxed)) if relaxed.energy < SIMILAR * first.energy => others.push(other),
            Err(Error::Cancelled) => return Err(Error::Cancelled),
            _ => {}
        }
    }
    let reports = settle_both([&mut image, &mut domain], springs, [first, second], &control.part(0.8, 1.0))?;
    let seed = |from: &HandleSurface, to: &HandleSurface| WalkSeed {
        vertex: from.basis.base,
        near: to.own.placed.cover.own(to.basis.base),
    };
    let seeds = [seed(own[0], own[1]), seed(own[1], own[0])];
    let flow_iterations = own.map(|own| own.own.iterations);
    let pair = DomainPair { source: image, target: domain, seeds, reports, flow_iterations, markings: tried };
    Ok((pair, others))
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
