//! Surfaces of genus 0 with landmarks and boundary loops, as hyperbolic or flat surfaces with cones at the landmarks and straight
//! boundaries.
//!
//! The target gets the metric of constant curvature in its conformal class that has cones of angle 2π/n at the landmarks and a geodesic
//! boundary: an orbifold, which the plane or the hyperbolic plane covers. The source is drawn in it by a harmonic map with positive
//! weights, and so is the target ([`super::balance`]); both drawings are embeddings. The homotopy class of the source's drawing is
//! determined by corresponding trees of paths ([`tree`]).

mod sides;
mod tree;

use super::balance::{EnergyMinimum, Springs, VertexFreedom, relax_both, settle_both};
use super::canonical::{CanonicalMetric, CanonicalSurface, Opening, for_both};
use super::cover::{PlacedMesh, UniversalCover, WalkSeed, aimed};
use super::domain_pair::DomainPair;
use super::landmarks::{MarkedSurface, Marks};
use super::least_energy::LeastEnergy;
use super::options::{BoundaryMatching, MatchOptions};
use crate::control::Control;
use crate::embed::LayoutScale;
use crate::error::{Error, Result};
use crate::geometry::{DoubleDouble, Motion, Space};
use crate::mesh::{HalfedgeId, PerHalfedge, PerVertex, VertexId};
use crate::metric::CommonSubdivision;
use crate::topology::central_vertex;
use sides::{length_shares, lines, own_shares, slide};
use std::f64::consts::{FRAC_PI_2, TAU};
use std::sync::Arc;
use tree::{MarkTree, distances, trees};

/// Orders n of cones of angle 2π/n that are tried: the least is taken with which the Euler characteristic is negative.
const ORDERS: [usize; 6] = [2, 3, 4, 5, 6, 7];

/// The kind of canonical metric of a surface of genus 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct OrbifoldShape {
    pub space: Space,
    /// Order of the cones at landmarks.
    pub order: usize,
    /// Curvature of the boundary at its corners, radians.
    corner: f64,
}

impl OrbifoldShape {
    /// The kind of metric for a surface of genus 0 with these marks; `None` if it would be that of a sphere.
    pub fn of(marks: &Marks) -> Option<OrbifoldShape> {
        let (loops, landmarks, corners) = (marks.loops.len(), marks.landmarks.len(), marks.corners.len());
        match (loops, landmarks, corners) {
            (2, 0, 0) => return Some(OrbifoldShape { space: Space::E2, order: 1, corner: 0.0 }),
            (1, 0, 3..) => {
                return Some(OrbifoldShape { space: Space::E2, order: 1, corner: TAU / corners as f64 });
            }
            _ => {}
        }
        let turned = 0.25 * corners as f64;
        let euler = |n: usize| 2.0 - loops as f64 - turned - landmarks as f64 * (1.0 - 1.0 / n as f64);
        let order = ORDERS.into_iter().find(|&n| euler(n) < -1e-9)?;
        Some(OrbifoldShape { space: Space::H2, order, corner: FRAC_PI_2 })
    }
}

/// Both surfaces with the kind of their metrics and how their boundaries correspond.
#[derive(Clone, Copy)]
struct OrbifoldProblem<'a> {
    sides: [MarkedSurface<'a>; 2],
    shape: OrbifoldShape,
    boundary: BoundaryMatching,
    threads: usize,
}

/// The canonical metric of a surface, prepared for layouts along several cuts.
struct OrbifoldMetric {
    metric: CanonicalMetric,
    /// The subdivision of the surface on which the metric was found, if edges were flipped.
    subdivision: Option<Arc<CommonSubdivision>>,
    /// The vertex at the origin of the layouts.
    root: VertexId,
}

/// A surface in its own metric, opened along its tree.
struct OpenedSurface {
    own: CanonicalSurface,
    /// Per path of the tree the deck transformation across it.
    pairings: Vec<Motion<DoubleDouble>>,
}

/// The map in the class of one choice of trees: the target's domain and the source in it.
struct MarkedMap {
    trees: [MarkTree; 2],
    domain: PlacedMesh,
    image: PlacedMesh,
    weights: [PerHalfedge<f64>; 2],
    freedom: [PerVertex<VertexFreedom>; 2],
    /// The energies of the source in the target's domain, and of the target.
    relaxed: [EnergyMinimum; 2],
}

/// Both surfaces in the target's canonical metric.
///
/// Several choices of trees are compared, and the map with the least energy is taken.
///
/// # Errors
/// [`Error::Matching`] if a flow does not reach its target, paths have no room or no harmonic map is found; those of
/// [`CanonicalMetric::new`] and [`Opening::place`]; [`Error::Cancelled`].
pub(super) fn in_orbifold(
    sides: [MarkedSurface; 2],
    options: &MatchOptions,
    control: &Control,
) -> Result<DomainPair> {
    let marks = sides[0].marks;
    let Some(shape) = OrbifoldShape::of(marks) else {
        return Err(Error::Matching(format!(
            "{} landmarks inside and {} on the boundary leave the map open on a surface of genus 0 with {} boundary loops",
            marks.landmarks.len(),
            marks.corners.len(),
            marks.loops.len()
        )));
    };
    let (boundary, threads) = (options.boundary, options.flow.threads);
    let problem = OrbifoldProblem { sides, shape, boundary, threads };
    let metrics = for_both(|s| orbifold_metric(sides[s], shape, options, &control.part(0.0, 0.5)))?;
    let (marked, markings) = best_marking(problem, &metrics, &control.part(0.5, 0.8))?;
    let MarkedMap { trees, mut domain, mut image, weights, freedom, relaxed } = marked;
    let springs = [0, 1].map(|s| Springs { weights: &weights[s], freedom: &freedom[s] });
    let reports = settle_both([&mut image, &mut domain], springs, relaxed, &control.part(0.8, 1.0))?;
    let start = |s: usize| -> Option<(VertexId, HalfedgeId)> {
        let h = *trees[s].landmark_corners.first().or_else(|| trees[s].arcs.first()?.first())?;
        Some((sides[s].surface.mesh().origin(h), h))
    };
    let (Some(from), Some(to)) = (start(0), start(1)) else {
        return Err(Error::Matching("no landmark and no loop to start from".into()));
    };
    let seeds = [WalkSeed { vertex: from.0, near: to.1 }, WalkSeed { vertex: to.0, near: from.1 }];
    let flow_iterations = [metrics[0].metric.iterations, metrics[1].metric.iterations];
    Ok(DomainPair { source: image, target: domain, seeds, reports, flow_iterations, markings })
}

/// Number of marks up to which all trees determine the same class: maps of a sphere that fix three points are isotopic.
const RIGID: usize = 3;
/// Most choices of trees that are compared.
const MOST_MARKINGS: u64 = 10;
/// Energy of the source in the target's domain over that of the target itself, below which no other trees are tried: without a twist it is
/// near 1 for surfaces of similar shape.
const UNTWISTED: f64 = 1.1;

/// The map of least energy, and the number of maps that were compared.
fn best_marking(
    problem: OrbifoldProblem,
    metrics: &[OrbifoldMetric; 2],
    control: &Control,
) -> Result<(MarkedMap, usize)> {
    let OrbifoldProblem { sides, .. } = problem;
    let distances = [distances(sides[0], control)?, distances(sides[1], control)?];
    let most = if sides[0].marks.n() <= RIGID { 1 } else { MOST_MARKINGS };
    let mut least = LeastEnergy::new(UNTWISTED);
    for variant in 0..most {
        let marked = trees(sides, &distances, variant, control)
            .and_then(|trees| marking(problem, metrics, trees, control))
            .map(|marked| (marked.relaxed[0].energy / marked.relaxed[1].energy, marked));
        if let Ok((ratio, _)) = &marked {
            log::debug!("marking {variant}: energy {ratio} of the target's");
        }
        if least.offer(marked)? {
            break;
        }
    }
    let compared = least.compared;
    Ok((least.into_best("no way to mark the map")?, compared))
}

/// The target in its domain and the source in it in the class of these trees, both at the minimum of the energy.
fn marking(
    problem: OrbifoldProblem,
    metrics: &[OrbifoldMetric; 2],
    trees: [MarkTree; 2],
    control: &Control,
) -> Result<MarkedMap> {
    let OrbifoldProblem { sides, .. } = problem;
    let [source, target] = for_both(|s| opened(problem, s, &trees[s], &metrics[s], control))?;
    let lines = [lines(&source.own.placed, &trees[0]), lines(&target.own.placed, &trees[1])];
    let freedom = [0, 1].map(|s| freedom(problem, s, &trees[s]));
    let along = [0, 1].map(|s| match problem.boundary {
        BoundaryMatching::Slides => {
            own_shares(&[&source, &target][s].own.placed, &trees[s], &lines[s], &lines[1])
        }
        BoundaryMatching::ArcLength => length_shares(sides[s], &trees[s], &lines[1]),
    });
    let mut image = brought(sides[0], &source, &target, [&trees[0], &trees[1]])?;
    for (&from, &to) in sides[0].marks.landmarks.iter().zip(&sides[1].marks.landmarks) {
        image.at[from] = target.own.placed.at[to];
    }
    slide(&mut image, &trees[0], &lines[1], &along[0]);
    let (weights, mut domain) = ([source.own.weights, target.own.weights], target.own.placed);
    slide(&mut domain, &trees[1], &lines[1], &along[1]);
    let springs = [0, 1].map(|s| Springs { weights: &weights[s], freedom: &freedom[s] });
    let relaxed = relax_both([&mut image, &mut domain], springs, control)?;
    Ok(MarkedMap { trees, domain, image, weights, freedom, relaxed })
}

/// The metric with cones at the landmarks and straight boundaries between corners.
fn orbifold_metric(
    side: MarkedSurface,
    shape: OrbifoldShape,
    options: &MatchOptions,
    control: &Control,
) -> Result<OrbifoldMetric> {
    let MarkedSurface { surface, marks } = side;
    let mut curvature = PerVertex::filled(surface.mesh().n_vertices(), 0.0);
    marks.landmarks.iter().for_each(|&v| curvature[v] = TAU * (1.0 - 1.0 / shape.order as f64));
    marks.corners.iter().for_each(|&v| curvature[v] = shape.corner);
    let metric = CanonicalMetric::new(surface, shape.space, curvature, &options.flow, control)?;
    let subdivision = if metric.solution.is_unflipped() {
        None
    } else {
        Some(Arc::new(metric.solution.common_subdivision(control)?))
    };
    let root = central_vertex(surface.mesh(), surface.lengths(), control)?;
    Ok(OrbifoldMetric { metric, subdivision, root })
}

/// One of the surfaces in its canonical metric, laid out along its tree.
fn opened(
    problem: OrbifoldProblem,
    s: usize,
    tree: &MarkTree,
    of: &OrbifoldMetric,
    control: &Control,
) -> Result<OpenedSurface> {
    let MarkedSurface { surface, marks } = problem.sides[s];
    let opening = Opening {
        cut: &tree.cut,
        root: of.root,
        cones: &marks.landmarks,
        own_corners: &tree.landmark_corners,
        scale: LayoutScale::default(),
        subdivision: of.subdivision.clone(),
        threads: problem.threads,
    };
    let (placed, pairings) = opening.place(&of.metric.solution, surface.mesh(), control)?;
    let own = CanonicalSurface::new(surface, placed, of.metric.iterations, control)?;
    Ok(OpenedSurface { own, pairings })
}

/// The start of the harmonic map: the source as it lies in its own metric, moved so that its first path starts where the target's does and
/// in the same direction, with the deck transformations of the target.
fn brought(
    side: MarkedSurface,
    source: &OpenedSurface,
    target: &OpenedSurface,
    trees: [&MarkTree; 2],
) -> Result<PlacedMesh> {
    let placed = &source.own.placed;
    let space = placed.cover.space;
    let along = |placed: &PlacedMesh, tree: &MarkTree| {
        let path = tree.cut.segments.first().or(tree.arcs.first())?;
        let ends = [placed.corner(*path.first()?), placed.corner(placed.cover.mesh.next(*path.last()?))];
        Some(aimed(space, ends).0)
    };
    let (Some(from), Some(to)) = (along(placed, trees[0]), along(&target.own.placed, trees[1])) else {
        return Err(Error::Matching("no path between landmarks".into()));
    };
    let by = to.compose(&from.inverse());
    let (cut, corners) = (&trees[0].cut, &trees[0].landmark_corners);
    let cover = UniversalCover::along_cut(side.surface.mesh(), space, cut, &target.pairings, corners)?;
    let at = PerVertex::from_fn(placed.at.len(), |v: VertexId| by.compose(&placed.at[v]).normalised());
    Ok(PlacedMesh { cover, at })
}

fn freedom(problem: OrbifoldProblem, s: usize, tree: &MarkTree) -> PerVertex<VertexFreedom> {
    let MarkedSurface { surface, marks } = problem.sides[s];
    let mesh = surface.mesh();
    let mut freedom = VertexFreedom::of(mesh, problem.boundary);
    marks.landmarks.iter().for_each(|&v| freedom[v] = VertexFreedom::Held);
    marks.corners.iter().for_each(|&v| freedom[v] = VertexFreedom::Held);
    // A flat annulus can turn: the end of its path is held.
    if let (Space::E2, Some(&h)) = (problem.shape.space, tree.arcs.first().and_then(|arc| arc.first())) {
        freedom[mesh.origin(h)] = VertexFreedom::Held;
    }
    freedom
}
