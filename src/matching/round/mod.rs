//! Surfaces with handles and boundary as closed flat or hyperbolic surfaces with round holes \[JKLLG08, Fig. 12\].
//!
//! The target becomes such a surface ([`crate::canonical::circle_domain()`]), and the source is brought into it in the class of a map that
//! is known, its loops onto the circles. A hole bends away from the surface around it. So a map that puts every vertex at a mean of its
//! neighbours may fold beside it, whatever the weights are: faces are looked at, and around those that fold the weights become those by
//! which the known map, carried over through the target's faces, is in balance. That one may fold too where faces are large; there single
//! vertices are moved first.

use super::balance::{BalanceReport, Freedom, balance};
use super::canonical::not_found;
use super::cover::{Cover, Placed, logarithm, seen_from};
use super::options::{Boundary, MatchOptions};
use super::orbifold::Pair;
use super::pushed::Way;
use super::repair::{around, unfold};
use super::route::Marks;
use super::shared::Shared;
use super::untangle::untangle;
use super::walk::{Seed, located};
use super::weights::mean_value_weights;
use crate::canonical::{CircleDomain, CircleDomainOptions, circle_domain};
use crate::control::Control;
use crate::embed::{Scale, UnrollOptions, unroll};
use crate::error::{Error, Result};
use crate::geometry::{conformal, worse};
use crate::mesh::{EdgeId, HalfedgeId, PerHalfedge, PerVertex, VertexId};
use crate::metric::{Split, Surface};
use crate::parallel::join;
use crate::topology::{central_vertex, cut_about_joined};
use std::sync::Arc;

/// A boundary loop of both surfaces as a circle of the domain.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RoundHole {
    /// The loop, by its place in [`crate::mesh::Mesh::boundary_loops`] of the source.
    pub boundary_loop: usize,
    /// Centre, in the plane as (x, y, 1) or on the hyperboloid: one lift.
    pub center: [f64; 3],
    /// Radius in the metric of the domain.
    pub radius: f64,
    /// Largest difference between the radius and the distance of a vertex of the loop, of either surface, from the centre, as a share of
    /// the radius.
    pub deviation: f64,
}

/// Both surfaces in a domain with round holes.
pub(super) struct InRound {
    pub pair: Pair,
    /// The given surfaces with the vertices that were added.
    pub splits: [Split; 2],
    pub holes: Vec<RoundHole>,
}

/// Times that the weights around folds are changed, each time on twice as many rings of faces.
const MOST_ROUNDS: usize = 10;

/// Both surfaces in the target's domain with round holes, in the class of `pair`. On the loops either surface gets the vertices that only
/// the other one has.
///
/// # Errors
/// [`Error::Matching`] where the flow does not come to its target, and where faces fold that could not be
/// opened; those of [`circle_domain`]; [`Error::Cancelled`].
pub(super) fn in_round(
    pair: &Pair,
    (surfaces, marks): ([&Surface; 2], [&Marks; 2]),
    splits: [&Split; 2],
    options: &MatchOptions,
    control: &Control,
) -> Result<InRound> {
    let shared = Shared::new(pair, (surfaces, marks), splits, control)?;
    let own = |s: usize| in_own_metric(&shared.surfaces[s], &shared.marks[s].loops, options, control);
    let (first, second) = join(|| own(0), || own(1));
    let (source, Own { placed: mut domain, holes, iterations }) = (first?, second?);
    let second = settled(&mut domain, &shared, control)?;
    let (image, first, seeds) = image(&shared, &source.placed, &domain, control)?;
    let steps = [source.iterations, iterations];
    let pair = Pair {
        source: image,
        target: domain,
        seeds,
        reports: [first, second],
        flow_iterations: [0, 1].map(|s| pair.flow_iterations[s] + steps[s]),
        markings: pair.markings,
    };
    Ok(InRound { pair, splits: shared.splits, holes })
}

/// Where the vertices of a surface with round holes may go.
fn freedom(shared: &Shared, s: usize) -> PerVertex<Freedom> {
    Freedom::of(shared.surfaces[s].mesh(), Boundary::ArcLength)
}

/// The target drawn with its own edges, folds opened.
fn settled(domain: &mut Placed, shared: &Shared, control: &Control) -> Result<BalanceReport> {
    let weights = mean_value_weights(domain, &shared.surfaces[1]);
    unfold(domain, &weights, &[], control)?;
    let weights = mean_value_weights(domain, &shared.surfaces[1]);
    balance(domain, &weights, &freedom(shared, 1), control)
}

/// The source in the target's domain, in balance by weights that are those of its own metric wherever no face folds.
fn image(
    shared: &Shared,
    own: &Placed,
    domain: &Placed,
    control: &Control,
) -> Result<(Placed, BalanceReport, [Seed; 2])> {
    let old = [&shared.pair[0], &shared.pair[1]];
    let (found, _) = located(old[0], old[1], shared.seeds[0], control)?;
    let marks = [&shared.marks[0], &shared.marks[1]];
    let way = Way::new(old, (domain, found), (&shared.surfaces[0], marks), (0, control))?;
    let (mut carried, seeds) = way.image()?;
    let (mesh, freedom) = (carried.cover.mesh.clone(), freedom(shared, 0));
    let mut weights = mean_value_weights(own, &shared.surfaces[0]);
    let mut other: Option<PerHalfedge<f64>> = None;
    let (mut rings, mut folded) = (1, Vec::new());
    for _ in 0..MOST_ROUNDS {
        let mut image = carried.clone();
        let report = balance(&mut image, &weights, &freedom, control)?;
        folded = image.flipped();
        log::debug!("{} faces fold beside round holes; next {rings} rings", folded.len());
        if folded.is_empty() {
            return Ok((image, report, seeds));
        }
        let other = match &other {
            Some(other) => other,
            None => {
                untangle(&mut carried, &freedom, control)?;
                other.insert(mean_value_weights(&carried, &shared.surfaces[0]))
            }
        };
        let is_changed = around(&image, &folded, rings);
        for v in mesh.vertices().filter(|&v| is_changed[v]) {
            mesh.outgoing(v).for_each(|h| weights[h] = other[h]);
        }
        rings *= 2;
    }
    Err(Error::Matching(format!(
        "{} faces of the source fold beside round holes and could not be opened, the first in face {}: refine the surface there, or let its loops become geodesics",
        folded.len(),
        folded.first().map_or(0, |&f| shared.splits[0].place(f).0.index())
    )))
}

/// A surface with round holes.
struct Own {
    placed: Placed,
    holes: Vec<RoundHole>,
    iterations: usize,
}

/// The flat or hyperbolic metric in which the loops are circles, opened along a cut that keeps away from the holes.
fn in_own_metric(
    surface: &Surface,
    loops: &[Vec<HalfedgeId>],
    options: &MatchOptions,
    control: &Control,
) -> Result<Own> {
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
    let cover = Cover::new(mesh, closed.cover.space, across, &[])?;
    let at =
        PerVertex::from_fn(mesh.n_vertices(), |v: VertexId| closed.frame_at(parts[cover.own(v).index()]));
    let rims = loops.iter().map(|around| around.iter().map(|h| parts[h.index()].twin()).collect::<Vec<_>>());
    let holes = rims.enumerate().map(|(k, rim)| hole(&domain, &closed, (k, &rim))).collect();
    Ok(Own { placed: Placed { cover, at }, holes, iterations: domain.report.iterations })
}

/// The closed surface, its holes filled, as it lies in the plane or the hyperbolic plane.
fn closed(domain: &CircleDomain, threads: usize, control: &Control) -> Result<Placed> {
    let filled = &domain.filled;
    let mesh = Arc::new(filled.mesh.clone());
    let lengths = domain.metric.surface().lengths();
    // A hole is taken in as a whole once it is reached, then the faces around it.
    let mut urgency = PerVertex::filled(mesh.n_vertices(), 0);
    for hub in filled.hubs() {
        mesh.outgoing(hub).for_each(|h| urgency[mesh.tip(h)] = 1);
    }
    filled.hubs().into_iter().for_each(|hub| urgency[hub] = 2);
    let root = central_vertex(&mesh, lengths, control)?;
    let joined = |e: EdgeId| mesh.ends(e).into_iter().map(|v| urgency[v]).fold(0, u8::max);
    let cut = cut_about_joined(&mesh, lengths, root, &joined, control)?;
    let unrolling = UnrollOptions {
        cones: Some(Vec::new()),
        root: Some(root),
        scale: Scale::AsSolved,
        cut: Some(cut.clone()),
        threads,
        ..UnrollOptions::default()
    };
    let layout = unroll(&domain.metric, &unrolling, control)?;
    let pairings: Vec<_> = layout.seams.iter().map(|seam| seam.pairing).collect();
    let cover = Cover::along_cut(&mesh, layout.space, (&cut, &pairings), &[])?;
    Placed::of_layout(cover, &layout)
}

/// The circle of a loop, given by half-edges in the faces that fill it.
fn hole(domain: &CircleDomain, closed: &Placed, (boundary_loop, rim): (usize, &[HalfedgeId])) -> RoundHole {
    let (mesh, space) = (&closed.cover.mesh, closed.cover.space);
    let hub = |g: HalfedgeId| closed.frame_at(mesh.prev(g));
    let center = rim.first().map_or([0.0, 0.0, 1.0], |&g| hub(g).origin().map(f64::from));
    let number = rim.first().map_or(VertexId(0), |&g| mesh.origin(mesh.prev(g)));
    let radius = conformal::radius(space, 1, domain.metric.metric().u[number]);
    let off = |&g: &HalfedgeId| {
        let [x, y] = logarithm(space, seen_from(&hub(g), &closed.frame_at(mesh.next(g))));
        (x.hypot(y) - radius).abs() / radius
    };
    RoundHole { boundary_loop, center, radius, deviation: rim.iter().map(off).fold(0.0, worse) }
}
