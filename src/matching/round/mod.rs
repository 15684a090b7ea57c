//! Surfaces with handles and boundary as closed flat or hyperbolic surfaces with round holes \[JKLLG08, Fig. 12\].
//!
//! The target becomes such a surface ([`crate::canonical::circle_domain()`]), and the source is brought into it in the class of a map that
//! is known, its loops onto the circles. A hole is not convex seen from the surface around it. So a map that puts every vertex at a mean of
//! its neighbours may fold beside it, whatever the weights are. Around faces that fold the weights are replaced by those by which the known
//! map, carried over through the target's faces, is in balance. If that map folds too, because faces are large, single vertices are moved
//! first.

mod common_boundary;

use super::balance::{
    BalanceReport, Springs, VertexFreedom, around, balance, mean_value_weights, unfold, untangle,
};
use super::canonical::{CanonicalSurface, Opening, for_both, not_found};
use super::cover::{PlacedMesh, UniversalCover, WalkSeed, logarithm, seen_from};
use super::domain_pair::DomainPair;
use super::landmarks::MarkedSurface;
use super::options::{BoundaryMatching, MatchOptions};
use super::pushed::{DomainChange, OldDomain};
use crate::archive::stored;
use crate::canonical::{CircleDomain, CircleDomainOptions, circle_domain};
use crate::control::Control;
use crate::embed::LayoutScale;
use crate::error::{Error, Result};
use crate::geometry::{conformal, worse};
use crate::mesh::{EdgeId, HalfedgeId, PerHalfedge, PerVertex, VertexId};
use crate::metric::Split;
use crate::topology::{central_vertex, cut_about_joined};
use common_boundary::CommonBoundary;
use std::sync::Arc;

/// A boundary loop of both surfaces as a circle of the domain.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RoundHole {
    /// The loop, by its place in [`crate::mesh::Mesh::boundary_loops`] of the source.
    pub boundary_loop: usize,
    /// One lift of the centre, in the plane as (x, y, 1) or on the hyperboloid.
    pub centre: [f64; 3],
    /// Radius in the metric of the domain.
    pub radius: f64,
    /// Largest difference between the radius and the distance of a vertex of the loop, of either surface, from the centre, as a share of
    /// the radius.
    pub deviation: f64,
}
stored!(sections RoundHole { boundary_loop, centre, radius, deviation });

/// Both surfaces in a domain with round holes.
pub(super) struct RoundMatching {
    pub pair: DomainPair,
    /// The given surfaces with the vertices that were added.
    pub splits: [Split; 2],
    pub holes: Vec<RoundHole>,
}

/// Most rounds in which the weights around folds are replaced, each on twice as many rings of faces as the last.
const MOST_ROUNDS: usize = 10;

/// Both surfaces in the target's domain with round holes, in the class of `pair`. On the loops each surface gets the vertices that only the
/// other one has.
///
/// # Errors
/// [`Error::Matching`] if the flow does not reach its target, and if faces fold that could not be opened; those of [`circle_domain`];
/// [`Error::Cancelled`].
pub(super) fn in_round(
    pair: &DomainPair,
    sides: [MarkedSurface; 2],
    splits: [&Split; 2],
    options: &MatchOptions,
    control: &Control,
) -> Result<RoundMatching> {
    let common = CommonBoundary::new(pair, sides, splits, control)?;
    let own = for_both(|s| with_round_holes(common.side(s), options, control))?;
    let [(source, _), (CanonicalSurface { placed: mut domain, weights, iterations }, holes)] = own;
    let second = settled(&mut domain, &weights, &common, control)?;
    let steps = [source.iterations, iterations];
    let (image, first, seeds) = image(&common, source.weights, &domain, control)?;
    let pair = DomainPair {
        source: image,
        target: domain,
        seeds,
        reports: [first, second],
        flow_iterations: [0, 1].map(|s| pair.flow_iterations[s] + steps[s]),
        markings: pair.markings,
    };
    Ok(RoundMatching { pair, splits: common.splits, holes })
}

/// The freedom of the vertices of a surface with round holes: those on the holes are held.
fn freedom(side: MarkedSurface) -> PerVertex<VertexFreedom> {
    VertexFreedom::of(side.surface.mesh(), BoundaryMatching::ArcLength)
}

/// Opens the folds of the target in its domain and brings it into balance.
fn settled(
    domain: &mut PlacedMesh,
    weights: &PerHalfedge<f64>,
    common: &CommonBoundary,
    control: &Control,
) -> Result<BalanceReport> {
    let side = common.side(1);
    unfold(domain, weights, &[], control)?;
    let weights = mean_value_weights(domain, side.surface, control)?;
    balance(domain, Springs { weights: &weights, freedom: &freedom(side) }, control)
}

/// The source in the target's domain, in balance by `weights`, those of its own metric, wherever no face folds.
fn image(
    common: &CommonBoundary,
    mut weights: PerHalfedge<f64>,
    domain: &PlacedMesh,
    control: &Control,
) -> Result<(PlacedMesh, BalanceReport, [WalkSeed; 2])> {
    let old = OldDomain { source: &common.pair[0], target: &common.pair[1], seed: common.seeds[0] };
    let sides = [common.side(0), common.side(1)];
    let (mut carried, seeds) = DomainChange::new(old, domain, sides, 0, control)?.image()?;
    let (mesh, freedom) = (carried.cover.mesh.clone(), freedom(sides[0]));
    let mut other: Option<PerHalfedge<f64>> = None;
    let (mut rings, mut folded) = (1, Vec::new());
    for _ in 0..MOST_ROUNDS {
        let mut image = carried.clone();
        let report = balance(&mut image, Springs { weights: &weights, freedom: &freedom }, control)?;
        folded = image.flipped();
        log::debug!("{} faces fold beside round holes; next {rings} rings", folded.len());
        if folded.is_empty() {
            return Ok((image, report, seeds));
        }
        let other = match &other {
            Some(other) => other,
            None => {
                untangle(&mut carried, &freedom, control)?;
                other.insert(mean_value_weights(&carried, sides[0].surface, control)?)
            }
        };
        let is_changed = around(&image, &folded, rings);
        for v in mesh.vertices().filter(|&v| is_changed[v]) {
            mesh.outgoing(v).for_each(|h| weights[h] = other[h]);
        }
        rings *= 2;
    }
    Err(Error::Matching(format!(
        "{} faces of the source fold beside round holes and could not be opened, the first in face {}: refine the surface (`ricci refine --edge L`), or let its loops become geodesics",
        folded.len(),
        folded.first().map_or(0, |&f| common.splits[0].place(f).0.index())
    )))
}

/// A surface in the flat or hyperbolic metric in which its loops are circles, opened along a cut that keeps away from these, and the
/// circles.
fn with_round_holes(
    side: MarkedSurface,
    options: &MatchOptions,
    control: &Control,
) -> Result<(CanonicalSurface, Vec<RoundHole>)> {
    let surface = side.surface;
    let wanted = CircleDomainOptions { flow: options.flow.clone(), ..CircleDomainOptions::default() };
    let domain = circle_domain(surface, &wanted, control)?;
    if !domain.report.converged {
        return Err(not_found(domain.report.iterations, domain.report.stop_reason));
    }
    let closed = closed(&domain, options.flow.threads, control)?;
    let part = |h: HalfedgeId| Ok(*domain.split.path(h)?.first().unwrap_or(&h));
    let mesh = surface.mesh();
    let mut parts = Vec::with_capacity(mesh.n_halfedges());
    for h in mesh.halfedges() {
        parts.push(if mesh.is_outside(h) { h } else { part(h)? });
    }
    let is_inner = |h: HalfedgeId| !mesh.is_outside(h) && !mesh.is_outside(h.twin());
    let across = |h: HalfedgeId| closed.cover.across(parts[h.index()]).copied().filter(|_| is_inner(h));
    let cover = UniversalCover::new(mesh, closed.cover.space, across, &[])?;
    let at =
        PerVertex::from_fn(mesh.n_vertices(), |v: VertexId| closed.frame_at(parts[cover.own(v).index()]));
    let rims = side
        .marks
        .loops
        .iter()
        .map(|around| around.iter().map(|h| parts[h.index()].twin()).collect::<Vec<_>>());
    let holes = rims.enumerate().map(|(k, rim)| hole(&domain, &closed, k, &rim)).collect();
    let placed = PlacedMesh { cover, at };
    Ok((CanonicalSurface::new(surface, placed, domain.report.iterations, control)?, holes))
}

/// The closed surface that has its holes filled, placed in the plane or the hyperbolic plane.
fn closed(domain: &CircleDomain, threads: usize, control: &Control) -> Result<PlacedMesh> {
    let filled = &domain.filled;
    let mesh = Arc::new(filled.mesh.clone());
    let lengths = domain.metric.surface().lengths();
    // The disk that grows about the root takes in a hole as a whole once it is reached, then the faces around it.
    let mut urgency = PerVertex::filled(mesh.n_vertices(), 0);
    for hub in filled.hubs() {
        mesh.outgoing(hub).for_each(|h| urgency[mesh.tip(h)] = 1);
    }
    filled.hubs().into_iter().for_each(|hub| urgency[hub] = 2);
    let root = central_vertex(&mesh, lengths, control)?;
    let joined = |e: EdgeId| mesh.ends(e).into_iter().map(|v| urgency[v]).fold(0, u8::max);
    let cut = cut_about_joined(&mesh, lengths, root, &joined, control)?;
    let opening = Opening {
        cut: &cut,
        root,
        cones: &[],
        own_corners: &[],
        scale: LayoutScale::AsSolved,
        subdivision: None,
        threads,
    };
    Ok(opening.place(&domain.metric, &mesh, control)?.0)
}

/// The circle of the boundary loop of this number, given by half-edges in the faces that fill it.
fn hole(domain: &CircleDomain, closed: &PlacedMesh, boundary_loop: usize, rim: &[HalfedgeId]) -> RoundHole {
    let (mesh, space) = (&closed.cover.mesh, closed.cover.space);
    let hub = |g: HalfedgeId| closed.frame_at(mesh.prev(g));
    let centre = rim.first().map_or([0.0, 0.0, 1.0], |&g| hub(g).origin().map(f64::from));
    let number = rim.first().map_or(VertexId(0), |&g| mesh.origin(mesh.prev(g)));
    let radius = conformal::radius(space, 1, domain.metric.metric().u[number]);
    let off = |&g: &HalfedgeId| {
        let [x, y] = logarithm(space, seen_from(&hub(g), &closed.frame_at(mesh.next(g))));
        (x.hypot(y) - radius).abs() / radius
    };
    RoundHole { boundary_loop, centre, radius, deviation: rim.iter().map(off).fold(0.0, worse) }
}
