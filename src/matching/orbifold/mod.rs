//! Surfaces of genus 0 with landmarks and boundary loops, as hyperbolic or flat surfaces with cones at the landmarks and straight
//! boundaries.
//!
//! The target gets the metric of constant curvature in its conformal class that has cones of angle 2π/n at the landmarks and a geodesic
//! boundary: an orbifold, covered by a surface without cones. Both triangulations are put into it by a harmonic map with positive weights,
//! which is an embedding [`super::balance`], and the map from one surface to the other is the one after the inverse of the other.

use super::balance::{BalanceReport, Freedom, Relaxed, relax, settle};
use super::canonical::canonical_metric;
use super::cover::{Cover, Placed, aimed, logarithm, moved, seen_from};
use super::options::{Boundary, MatchOptions};
use super::route::Marks;
use super::tree::{Tree, distances, trees};
use super::walk::Seed;
use super::weights::mean_value_weights;
use crate::control::Control;
use crate::embed::{UnrollOptions, unroll};
use crate::error::{Error, Result};
use crate::flow::Solution;
use crate::geometry::{DoubleDouble, Motion, Space};
use crate::mesh::{HalfedgeId, PerHalfedge, PerVertex, VertexId};
use crate::metric::{Refinement, Surface};
use crate::parallel::join;
use crate::topology::central_vertex;
use std::f64::consts::{FRAC_PI_2, TAU};
use std::sync::Arc;

/// Orders of cones that are tried, the angle being 2π over the order: the least with which the Euler characteristic is negative.
const ORDERS: [usize; 6] = [2, 3, 4, 5, 6, 7];

/// What the canonical metric of a surface of genus 0 looks like.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Shape {
    pub space: Space,
    /// Order of the cones at landmarks.
    pub order: usize,
    /// Curvature of the boundary at its corners, radians.
    corner: f64,
}

/// Of a surface of genus 0 with so many loops, landmarks and corners of the boundary; `None` where its metric would be that of a sphere.
pub(super) fn shape(loops: usize, landmarks: usize, corners: usize) -> Option<Shape> {
    match (loops, landmarks, corners) {
        (2, 0, 0) => return Some(Shape { space: Space::E2, order: 1, corner: 0.0 }),
        (1, 0, 3..) => return Some(Shape { space: Space::E2, order: 1, corner: TAU / corners as f64 }),
        _ => {}
    }
    let turned = 0.25 * corners as f64;
    let euler = |n: usize| 2.0 - loops as f64 - turned - landmarks as f64 * (1.0 - 1.0 / n as f64);
    let order = ORDERS.into_iter().find(|&n| euler(n) < -1e-9)?;
    Some(Shape { space: Space::H2, order, corner: FRAC_PI_2 })
}

/// Two triangulations in the universal cover of one surface.
pub(super) struct Pair {
    pub source: Placed,
    pub target: Placed,
    /// Where the source's vertices are searched for in the target, and the other way round.
    pub seeds: [Seed; 2],
    pub reports: [BalanceReport; 2],
    /// Steps of the flows to the two canonical metrics.
    pub flow_iterations: [usize; 2],
    /// Ways to mark the map that were compared.
    pub markings: usize,
}

impl Pair {
    /// Energy of the source in the target's domain over that of the target.
    pub fn twist(&self) -> f64 {
        self.reports[0].energy / self.reports[1].energy.max(f64::MIN_POSITIVE)
    }
}

/// Both surfaces with their landmarks, loops and corners.
#[derive(Clone, Copy)]
struct Problem<'a> {
    surfaces: [&'a Surface; 2],
    marks: [&'a Marks; 2],
    shape: Shape,
    boundary: Boundary,
    threads: usize,
}

/// A surface's canonical metric.
struct Canonical {
    metric: Solution,
    refinement: Option<Arc<Refinement>>,
    root: VertexId,
    iterations: usize,
}

/// A surface in its own metric, opened along its tree.
struct Own {
    placed: Placed,
    pairings: Vec<Motion<DoubleDouble>>,
}

/// One way to mark the map: the trees, the target's domain and the source in it.
struct Marked {
    trees: [Tree; 2],
    domain: Placed,
    image: Placed,
    weights: [PerHalfedge<f64>; 2],
    freedom: [PerVertex<Freedom>; 2],
    /// Of the source in the target's domain, and of the target.
    relaxed: [Relaxed; 2],
}

impl Marked {
    /// Energy of the source in the target's domain over that of the target.
    fn ratio(&self) -> f64 {
        self.relaxed[0].1 / self.relaxed[1].1
    }
}

/// Both surfaces in the target's canonical metric.
///
/// Of several ways to mark the map the one with the least energy is taken.
///
/// # Errors
/// [`Error::Matching`] where a flow does not come to its target, paths have no room or no harmonic map is found; those of
/// [`canonical_metric`] and [`unroll`]; [`Error::Cancelled`].
pub(super) fn in_orbifold(
    surfaces: [&Surface; 2],
    marks: [&Marks; 2],
    options: &MatchOptions,
    control: &Control,
) -> Result<Pair> {
    let (loops, landmarks, corners) =
        (marks[0].loops.len(), marks[0].landmarks.len(), marks[0].corners.len());
    let Some(shape) = shape(loops, landmarks, corners) else {
        return Err(Error::Matching(format!(
            "{loops} loops, {landmarks} landmarks and {corners} corners admit no flat or hyperbolic metric"
        )));
    };
    let (boundary, threads) = (options.boundary, options.flow.threads);
    let problem = Problem { surfaces, marks, shape, boundary, threads };
    let canonical = |s: usize| canonical(surfaces[s], marks[s], shape, options, control);
    let (first, second) = join(|| canonical(0), || canonical(1));
    let metrics = [first?, second?];
    let (mut marked, markings) = best_marking(problem, &metrics, control)?;
    let Marked { image, domain, weights, freedom, relaxed, .. } = &mut marked;
    let (first, second) = join(
        || settle(image, &weights[0], &freedom[0], relaxed[0], control),
        || settle(domain, &weights[1], &freedom[1], relaxed[1], control),
    );
    let reports = [first?, second?];
    let start = |s: usize| -> Option<(VertexId, HalfedgeId)> {
        let tree = &marked.trees[s];
        let h = *tree.landmark_corners.first().or_else(|| tree.arcs.first()?.first())?;
        Some((surfaces[s].mesh().origin(h), h))
    };
    let (Some(from), Some(to)) = (start(0), start(1)) else {
        return Err(Error::Matching("no landmark and no loop to start from".into()));
    };
    let seeds = [Seed { vertex: from.0, near: to.1 }, Seed { vertex: to.0, near: from.1 }];
    let flow_iterations = [metrics[0].iterations, metrics[1].iterations];
    Ok(Pair { source: marked.image, target: marked.domain, seeds, reports, flow_iterations, markings })
}

/// Marks with which there is one way to mark the map up to isotopy: three.
const RIGID: usize = 3;
/// Most ways to mark a map that are compared.
const MOST_MARKINGS: u64 = 10;
/// Energy of the source in the target's domain over that of the target itself, below which no other way to mark the map is looked for:
/// without a twist it is near 1 for surfaces of similar shape.
const UNTWISTED: f64 = 1.1;

fn best_marking(problem: Problem, metrics: &[Canonical; 2], control: &Control) -> Result<(Marked, usize)> {
    let Problem { surfaces, marks, .. } = problem;
    let of = |s: usize| distances(surfaces[s], marks[s], control);
    let distances = [of(0)?, of(1)?];
    let most = if marks[0].n() <= RIGID { 1 } else { MOST_MARKINGS };
    let (mut best, mut failure, mut count) = (None::<Marked>, None, 0);
    for variant in 0..most {
        let marked = trees(surfaces, marks, (&distances, variant), control)
            .and_then(|trees| marking(problem, metrics, trees, control));
        match marked {
            Ok(marked) => {
                count += 1;
                log::debug!("marking {variant}: energy {} of the target's", marked.ratio());
                if best.as_ref().is_none_or(|least| marked.ratio() < least.ratio()) {
                    best = Some(marked);
                }
            }
            Err(Error::Cancelled) => return Err(Error::Cancelled),
            Err(why) => failure = failure.or(Some(why)),
        }
        if best.as_ref().is_some_and(|best| best.ratio() < UNTWISTED) {
            break;
        }
    }
    match (best, failure) {
        (Some(best), _) => Ok((best, count)),
        (None, Some(why)) => Err(why),
        (None, None) => Err(Error::Matching("no way to mark the map".into())),
    }
}

/// The target in its domain and the source in it, both at the minimum of the energy.
fn marking(
    problem: Problem,
    metrics: &[Canonical; 2],
    trees: [Tree; 2],
    control: &Control,
) -> Result<Marked> {
    let Problem { surfaces, marks, .. } = problem;
    let own = |s: usize| opened(problem, s, &trees[s], &metrics[s], control);
    let (source, target) = join(|| own(0), || own(1));
    let (source, target) = (source?, target?);
    let weights =
        [mean_value_weights(&source.placed, surfaces[0]), mean_value_weights(&target.placed, surfaces[1])];
    let lines = [lines(&source.placed, &trees[0]), lines(&target.placed, &trees[1])];
    let freedom = [0, 1].map(|s| freedom(problem, s, &trees[s]));
    let mut domain = target.placed.clone();
    let along = [0, 1].map(|s| match problem.boundary {
        Boundary::Slides => own_shares([&source, &target][s], &trees[s], &lines[s], &lines[1]),
        Boundary::ArcLength => length_shares(surfaces[s], marks[s], &trees[s], &lines[1]),
    });
    slide(&mut domain, &trees[1], &lines[1], &along[1]);
    let mut image = brought(surfaces[0], &source.placed, &target, [&trees[0], &trees[1]])?;
    for (&from, &to) in marks[0].landmarks.iter().zip(&marks[1].landmarks) {
        image.at[from] = target.placed.at[to];
    }
    slide(&mut image, &trees[0], &lines[1], &along[0]);
    let (first, second) = join(
        || relax(&mut image, &weights[0], &freedom[0], control),
        || relax(&mut domain, &weights[1], &freedom[1], control),
    );
    Ok(Marked { trees, domain, image, weights, freedom, relaxed: [first?, second?] })
}

/// The metric with cones at the landmarks and straight boundaries between corners.
fn canonical(
    surface: &Surface,
    marks: &Marks,
    shape: Shape,
    options: &MatchOptions,
    control: &Control,
) -> Result<Canonical> {
    let mesh = surface.mesh();
    let mut curvature = PerVertex::filled(mesh.n_vertices(), 0.0);
    marks.landmarks.iter().for_each(|&v| curvature[v] = TAU * (1.0 - 1.0 / shape.order as f64));
    marks.corners.iter().for_each(|&v| curvature[v] = shape.corner);
    let (metric, iterations) = canonical_metric(surface, shape.space, curvature, &options.flow, control)?;
    let refinement = match metric.is_unflipped() {
        true => None,
        false => Some(Arc::new(metric.refinement(control)?)),
    };
    let root = central_vertex(mesh, surface.lengths(), control)?;
    Ok(Canonical { metric, refinement, root, iterations })
}

/// One of the surfaces in its canonical metric, laid out along its tree.
fn opened(problem: Problem, s: usize, tree: &Tree, canonical: &Canonical, control: &Control) -> Result<Own> {
    let (surface, space) = (problem.surfaces[s], problem.shape.space);
    let unrolling = UnrollOptions {
        cones: Some(problem.marks[s].landmarks.clone()),
        root: Some(canonical.root),
        cut: Some(tree.cut.clone()),
        refinement: canonical.refinement.clone(),
        threads: problem.threads,
        ..UnrollOptions::default()
    };
    let layout = unroll(&canonical.metric, &unrolling, control)?;
    let pairings: Vec<_> = layout.seams.iter().map(|seam| seam.pairing).collect();
    let placed = Placed::of_layout(tree_cover(surface, space, tree, &pairings)?, &layout)?;
    Ok(Own { placed, pairings })
}

/// The cover of a surface that is opened along its tree, with these transformations across the paths.
fn tree_cover(
    surface: &Surface,
    space: Space,
    tree: &Tree,
    pairings: &[Motion<DoubleDouble>],
) -> Result<Cover> {
    Cover::along_cut(surface.mesh(), space, (&tree.cut, pairings), &tree.landmark_corners)
}

/// The source's positions in its own metric, moved so that the first path starts where the target's does, in its direction, with the deck
/// transformations of the target: from there the harmonic map is sought.
fn brought(surface: &Surface, source: &Placed, target: &Own, trees: [&Tree; 2]) -> Result<Placed> {
    let space = source.cover.space;
    let along = |placed: &Placed, tree: &Tree| {
        let path = tree.cut.segments.first().or(tree.arcs.first())?;
        let ends = [placed.corner(*path.first()?), placed.corner(placed.cover.mesh.next(*path.last()?))];
        Some(aimed(space, ends).0)
    };
    let (Some(from), Some(to)) = (along(source, trees[0]), along(&target.placed, trees[1])) else {
        return Err(Error::Matching("no path between landmarks".into()));
    };
    let by = to.compose(&from.inverse());
    let cover = tree_cover(surface, space, trees[0], &target.pairings)?;
    let at = PerVertex::from_fn(source.at.len(), |v: VertexId| by.compose(&source.at[v]).normalised());
    Ok(Placed { cover, at })
}

/// The frame at the start of an arc of the boundary, with the x axis along it, and the arc's length.
type Line = (Motion<DoubleDouble>, f64);

/// The straight line of each arc of the boundary: the frame at its start, with the x axis along it, and its length.
fn lines(target: &Placed, tree: &Tree) -> Vec<Line> {
    let space = target.cover.space;
    let line = |arc: &Vec<HalfedgeId>| {
        let ends = arc
            .first()
            .zip(arc.last())
            .map(|(&h, &last)| [target.corner(h), target.corner(target.cover.mesh.next(last))]);
        aimed(space, ends.unwrap_or_else(|| [Motion::<DoubleDouble>::identity(space).origin(); 2]))
    };
    tree.arcs.iter().map(line).collect()
}

/// Where the vertices of each arc go on its line in the target: by their share of the arc's length where the surface lies in its own
/// metric.
fn own_shares(own: &Own, tree: &Tree, lines: &[Line], target: &[Line]) -> Vec<Vec<f64>> {
    let space = own.placed.cover.space;
    let of = |((arc, (start, length)), to): ((&Vec<HalfedgeId>, &Line), &Line)| {
        let longer = to.1 / length.max(f64::MIN_POSITIVE);
        let along = |h: &HalfedgeId| {
            let [x, _] = logarithm(space, seen_from(start, &own.placed.frame_at(*h)));
            longer * x
        };
        let mut all: Vec<f64> = arc.iter().map(along).collect();
        all.iter_mut().take(1).for_each(|x| *x = 0.0);
        all
    };
    tree.arcs.iter().zip(lines).zip(target).map(of).collect()
}

/// The same by shares of the length in the surface as it came: from corner to corner, around a loop without any from the start of its first
/// arc.
fn length_shares(surface: &Surface, marks: &Marks, tree: &Tree, lines: &[Line]) -> Vec<Vec<f64>> {
    let (mesh, lengths) = (surface.mesh(), surface.lengths());
    let start = |k: usize| tree.arcs[k].first().map(|&h| mesh.origin(h));
    let after = |k: usize| {
        let end = tree.arcs[k].last().map(|&h| mesh.tip(h));
        (0..tree.arcs.len()).find(|&j| start(j) == end)
    };
    let is_corner = |k: usize| start(k).is_some_and(|v| marks.corners.contains(&v));
    let mut shares: Vec<Vec<f64>> = vec![Vec::new(); tree.arcs.len()];
    let (corners, others): (Vec<usize>, Vec<usize>) = (0..tree.arcs.len()).partition(|&k| is_corner(k));
    for first in corners.into_iter().chain(others) {
        if !shares[first].is_empty() {
            continue;
        }
        let mut side = vec![first];
        while let Some(next) = side.last().and_then(|&k| after(k)).filter(|&k| k != first && !is_corner(k)) {
            side.push(next);
        }
        let total: f64 = side.iter().flat_map(|&k| &tree.arcs[k]).map(|h| lengths[h.edge()]).sum();
        let length: f64 = side.iter().map(|&k| lines[k].1).sum();
        let (mut before, mut start) = (0.0, 0.0);
        for k in side {
            for h in &tree.arcs[k] {
                shares[k].push(length * (before / total) - start);
                before += lengths[h.edge()];
            }
            start += lines[k].1;
        }
    }
    shares
}

/// Puts the vertices of each arc on its line, so far from its start.
fn slide(placed: &mut Placed, tree: &Tree, lines: &[Line], along: &[Vec<f64>]) {
    for ((arc, (start, _)), along) in tree.arcs.iter().zip(lines).zip(along) {
        for (&h, &x) in arc.iter().zip(along) {
            let v = placed.cover.mesh.origin(h);
            placed.at[v] = moved(start, [x, 0.0]);
        }
    }
}

fn freedom(problem: Problem, s: usize, tree: &Tree) -> PerVertex<Freedom> {
    let Problem { surfaces, marks, shape, boundary, .. } = problem;
    let (mesh, marks) = (surfaces[s].mesh(), marks[s]);
    let mut freedom = Freedom::of(mesh, boundary);
    marks.landmarks.iter().for_each(|&v| freedom[v] = Freedom::Held);
    marks.corners.iter().for_each(|&v| freedom[v] = Freedom::Held);
    // A flat annulus can turn: the end of its path is held.
    if let (Space::E2, Some(&h)) = (shape.space, tree.arcs.first().and_then(|arc| arc.first())) {
        freedom[mesh.origin(h)] = Freedom::Held;
    }
    freedom
}
