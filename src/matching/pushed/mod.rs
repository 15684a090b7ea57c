//! Landmarks on surfaces with handles: the harmonic map without them is found first, then each landmark is pushed along a path to its
//! partner. That determines the class of the map, and the map of this class is found in the target's metric with cones of angle π at the
//! landmarks.
//!
//! As on surfaces of genus 0 ([`super::orbifold`]) this orbifold is covered by the hyperbolic plane without cones, and a map with positive
//! weights that holds the landmarks is an embedding.

mod boundary;
mod domain_change;
mod slits;

use super::balance::{EnergyMinimum, Springs, VertexFreedom, mean_value_weights, relax, settle_both};
use super::canonical::{CanonicalMetric, Opening};
use super::cover::{PlacedMesh, UniversalCover, WalkSeed};
use super::domain_pair::DomainPair;
use super::handles::with_handles;
use super::landmarks::{MarkedSurface, Marks};
use super::least_energy::LeastEnergy;
use super::options::MatchOptions;
use crate::control::Control;
use crate::embed::LayoutScale;
use crate::error::Result;
use crate::geometry::Space;
use crate::mesh::PerVertex;
use crate::topology::{central_vertex, cut_graph};
pub(super) use boundary::on_boundary;
use boundary::straighten;
pub(super) use domain_change::{DomainChange, OldDomain};
use std::f64::consts::{FRAC_PI_2, PI};

/// Distance between two deck transformations up to which they count as equal: different ones are apart by the size of the surface.
const SAME: f64 = 1e-6;
/// Most sets of paths whose maps are compared, from the map without landmarks that is best for the first of them.
const MOST_PATHS: u64 = 8;
/// Energy of the source in the target's domain over that of the target itself, below which no other paths are tried.
const UNTWISTED: f64 = 1.1;

/// Both surfaces in the target's orbifold metric, all landmarks at their partners.
///
/// # Errors
/// [`crate::Error::Matching`] for landmarks in conflict, named, and if a flow does not reach its target or no harmonic map is found; those
/// of [`Opening::place`]; [`crate::Error::Cancelled`].
pub(super) fn with_pushed_landmarks(
    sides: [MarkedSurface; 2],
    options: &MatchOptions,
    control: &Control,
) -> Result<DomainPair> {
    let bare = sides.map(without_landmarks);
    let bare_sides = [0, 1].map(|s| MarkedSurface { marks: &bare[s], ..sides[s] });
    let (pair, others) = with_handles(bare_sides, true, options, &control.part(0.0, 0.4))?;
    let [(source, first), (mut domain, second)] = [
        in_own_orbifold(sides[0], options, &control.part(0.4, 0.5))?,
        in_own_orbifold(sides[1], options, &control.part(0.5, 0.6))?,
    ];
    let weights = [
        mean_value_weights(&source, sides[0].surface, control)?,
        mean_value_weights(&domain, sides[1].surface, control)?,
    ];
    drop(source);
    let freedom = sides.map(|MarkedSurface { surface, marks }| {
        let mut freedom = VertexFreedom::of(surface.mesh(), options.boundary);
        marks.landmarks.iter().chain(&marks.corners).for_each(|&v| freedom[v] = VertexFreedom::Held);
        freedom
    });
    let springs = [0, 1].map(|s| Springs { weights: &weights[s], freedom: &freedom[s] });
    straighten(&mut domain, sides[1].marks);
    let target_relaxed = relax(&mut domain, springs[1], &control.part(0.6, 0.7))?;
    let sources: Vec<&PlacedMesh> = std::iter::once(&pair.source).chain(&others).collect();
    let mut known: Vec<UniversalCover> = Vec::new();
    let image = |source: usize, variant: u64| -> Result<Option<PushedImage>> {
        let old = OldDomain { source: sources[source], target: &pair.target, seed: pair.seeds[0] };
        let (mut image, seeds) = DomainChange::new(old, &domain, sides, variant, control)?.image()?;
        if known.iter().any(|cover| is_same_class(cover, &image.cover)) {
            return Ok(None);
        }
        known.push(image.cover.clone());
        let relaxed = relax(&mut image, springs[0], &control.part(0.7, 0.8))?;
        Ok(Some(PushedImage { image, seeds, relaxed }))
    };
    let enough = UNTWISTED * target_relaxed.energy;
    let (best, tried) = least(sources.len(), image, enough)?;
    let PushedImage { mut image, seeds, relaxed } = best;
    let reports =
        settle_both([&mut image, &mut domain], springs, [relaxed, target_relaxed], &control.part(0.8, 1.0))?;
    let flow_iterations = [first, second];
    let markings = pair.markings + tried - 1;
    Ok(DomainPair { source: image, target: domain, seeds, reports, flow_iterations, markings })
}

/// The marks that the map without pushed landmarks has: the loops, and on a torus without boundary the first landmark, which a shift brings
/// to its partner.
fn without_landmarks(side: MarkedSurface) -> Marks {
    let MarkedSurface { surface, marks } = side;
    let is_torus = surface.mesh().euler() == 0;
    Marks {
        landmarks: marks.landmarks.iter().take(usize::from(is_torus)).copied().collect(),
        loops: marks.loops.clone(),
        corners: Vec::new(),
    }
}

/// The source in the target's domain in the class of one set of paths.
struct PushedImage {
    image: PlacedMesh,
    seeds: [WalkSeed; 2],
    relaxed: EnergyMinimum,
}

/// The map with the least energy, and the number of maps that were compared: by the shortest paths from each of the maps without landmarks
/// (`sources` of them), and from the best of these by other paths. `image` returns `None` for a class that was compared before.
fn least(
    sources: usize,
    mut image: impl FnMut(usize, u64) -> Result<Option<PushedImage>>,
    enough: f64,
) -> Result<(PushedImage, usize)> {
    let mut least = LeastEnergy::new(enough);
    let mut all: Vec<(Option<usize>, u64)> = (0..sources).map(|source| (Some(source), 0)).collect();
    all.extend((1..MOST_PATHS).map(|variant| (None, variant)));
    for (source, variant) in all {
        let source = source.or(least.best().map(|&(_, source)| source)).unwrap_or(0);
        let Some(next) = image(source, variant).transpose() else { continue };
        if let Ok(next) = &next {
            let energy = next.relaxed.energy;
            log::debug!("map {source}, paths {variant}: energy {energy}, enough is {enough}");
        }
        if least.offer(next.map(|next| (next.relaxed.energy, (next, source))))? {
            break;
        }
    }
    let compared = least.compared;
    let (best, _) = least.into_best("no paths for the landmarks")?;
    Ok((best, compared))
}

/// True if two maps that are opened from the same landmark go to the target in one class: their deck transformations are equal.
fn is_same_class(first: &UniversalCover, second: &UniversalCover) -> bool {
    let mesh = &first.mesh;
    let inside = mesh.halfedges().filter(|&h| !mesh.is_outside(h));
    inside.map(|h| [first.across(h), second.across(h)]).all(|pair| match pair {
        [None, None] => true,
        [Some(a), Some(b)] => a.compose(&b.inverse()).distance_from_identity() < SAME,
        _ => false,
    })
}

/// A surface in its hyperbolic metric with cones of angle π at its landmarks and right angles at its corners, and the steps of the flow.
fn in_own_orbifold(
    side: MarkedSurface,
    options: &MatchOptions,
    control: &Control,
) -> Result<(PlacedMesh, usize)> {
    let MarkedSurface { surface, marks } = side;
    let mesh = surface.mesh();
    let mut curvature = PerVertex::filled(mesh.n_vertices(), 0.0);
    marks.landmarks.iter().for_each(|&v| curvature[v] = PI);
    marks.corners.iter().for_each(|&v| curvature[v] = FRAC_PI_2);
    let metric = CanonicalMetric::new(surface, Space::H2, curvature, &options.flow, control)?;
    let opening = Opening {
        cut: &cut_graph(mesh, surface.lengths(), &marks.landmarks, control)?,
        root: central_vertex(mesh, surface.lengths(), control)?,
        cones: &marks.landmarks,
        own_corners: &[],
        scale: LayoutScale::default(),
        subdivision: None,
        threads: options.flow.threads,
    };
    Ok((opening.place(&metric.solution, mesh, control)?.0, metric.iterations))
}
