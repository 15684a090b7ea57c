//! Landmarks on surfaces with handles: the harmonic map without them is found first, then they are pushed to their goals, which fixes the
//! class of the map, and the map of that class is found in the target's metric with cones of angle π at the landmarks.
//!
//! As on surfaces of genus 0 ([`super::orbifold`]) this orbifold is covered by the hyperbolic plane without cones, and a map with positive
//! weights that holds the landmarks is an embedding.

use super::balance::{Freedom, Relaxed, relax, settle};
use super::canonical::canonical_metric;
use super::cover::{Cover, Placed, moved};
use super::options::MatchOptions;
use super::orbifold::Pair;
use super::rims::{Rims, straighten};
use super::route::Marks;
use super::slits::{Inside, Push, Slits, Start};
use super::walk::{Found, Seed, located};
use super::weights::mean_value_weights;
use crate::control::Control;
use crate::embed::{UnrollOptions, unroll};
use crate::error::{Error, Result};
use crate::geometry::{DoubleDouble, Motion, Space};
use crate::mesh::{HalfedgeId, Mesh, PerHalfedge, PerVertex, VertexId};
use crate::metric::Surface;
use crate::topology::{central_vertex, cut_graph};
use std::f64::consts::{FRAC_PI_2, PI};

/// Weight of a corner with which a point counts as that corner.
const AT_CORNER: f64 = 1.0 - 1e-9;
/// Largest distance from the identity of the transformations around a face together: rounding.
const CLOSED: f64 = 1e-6;
/// Distance from the identity below which a transformation is the identity up to rounding.
const IDENTITY: f64 = 1e-12;
/// Distance between two deck transformations below which they are the same up to rounding: others are farther apart by the size of the
/// surface.
const SAME: f64 = 1e-6;

/// The pair of a map without landmarks, with all landmarks where they should be. `others`: the source in other classes, which may be nearer
/// to the landmarks.
///
/// # Errors
/// [`Error::Matching`] for landmarks in conflict, named, and where a flow does not come to its target or no harmonic map is found; those of
/// [`unroll`]; [`Error::Cancelled`].
pub(super) fn pushed(
    (pair, others): (&Pair, &[Placed]),
    surfaces: [&Surface; 2],
    marks: [&Marks; 2],
    options: &MatchOptions,
    control: &Control,
) -> Result<Pair> {
    let own = |s: usize| in_own_orbifold(surfaces[s], marks[s], options, control);
    let [(source, first), (mut domain, second)] = [own(0)?, own(1)?];
    let weights = [mean_value_weights(&source, surfaces[0]), mean_value_weights(&domain, surfaces[1])];
    drop(source);
    let freedom = [0, 1].map(|s| {
        let mut freedom = Freedom::of(surfaces[s].mesh(), options.boundary);
        marks[s].landmarks.iter().chain(&marks[s].corners).for_each(|&v| freedom[v] = Freedom::Held);
        freedom
    });
    straighten(&mut domain, marks[1]);
    let target_relaxed = relax(&mut domain, &weights[1], &freedom[1], control)?;
    let sources: Vec<&Placed> = std::iter::once(&pair.source).chain(others).collect();
    let mut known: Vec<Cover> = Vec::new();
    let image = |source: usize, variant: u64| -> Result<Option<Image>> {
        let old = [sources[source], &pair.target];
        let (found, _) = located(old[0], old[1], pair.seeds[0], control)?;
        let way = Way::new(old, (&domain, found), (surfaces[0], marks), (variant, control))?;
        let (mut image, seeds) = way.image()?;
        if known.iter().any(|cover| is_same_class(cover, &image.cover)) {
            return Ok(None);
        }
        known.push(image.cover.clone());
        let relaxed = relax(&mut image, &weights[0], &freedom[0], control)?;
        Ok(Some(Image { image, seeds, relaxed }))
    };
    let enough = UNTWISTED * target_relaxed.1;
    let (Image { mut image, seeds, relaxed }, tried) = least(sources.len(), image, enough)?;
    let reports = [
        settle(&mut image, &weights[0], &freedom[0], relaxed, control)?,
        settle(&mut domain, &weights[1], &freedom[1], target_relaxed, control)?,
    ];
    let flow_iterations = [first, second];
    let markings = pair.markings + tried - 1;
    Ok(Pair { source: image, target: domain, seeds, reports, flow_iterations, markings })
}

/// Most sets of paths whose maps are compared, from the map without landmarks that is best for the first of them.
const MOST_PATHS: u64 = 8;
/// Energy of the source in the target's domain over that of the target itself, below which no other paths are looked for.
const UNTWISTED: f64 = 1.1;

/// The source in the target's domain, by one set of paths.
struct Image {
    image: Placed,
    seeds: [Seed; 2],
    relaxed: Relaxed,
}

/// The map with the least energy, and how many there were: from each of the maps without landmarks by the shortest paths, and from the best
/// of these by others.
fn least(
    sources: usize,
    mut image: impl FnMut(usize, u64) -> Result<Option<Image>>,
    enough: f64,
) -> Result<(Image, usize)> {
    let (mut best, mut failure, mut count) = (None::<(Image, usize)>, None, 0);
    let mut all: Vec<(Option<usize>, u64)> = (0..sources).map(|source| (Some(source), 0)).collect();
    all.extend((1..MOST_PATHS).map(|variant| (None, variant)));
    for (source, variant) in all {
        let source = source.or(best.as_ref().map(|best| best.1)).unwrap_or(0);
        match image(source, variant) {
            Ok(None) => {}
            Ok(Some(next)) => {
                count += 1;
                log::debug!("map {source}, paths {variant}: energy {}, enough is {enough}", next.relaxed.1);
                if best.as_ref().is_none_or(|(best, _)| next.relaxed.1 < best.relaxed.1) {
                    best = Some((next, source));
                }
            }
            Err(Error::Cancelled) => return Err(Error::Cancelled),
            Err(why) => failure = failure.or(Some(why)),
        }
        if best.as_ref().is_some_and(|(best, _)| best.relaxed.1 < enough) {
            break;
        }
    }
    match (best, failure) {
        (Some((best, _)), _) => Ok((best, count)),
        (None, Some(why)) => Err(why),
        (None, None) => Err(Error::Matching("no paths for the landmarks".into())),
    }
}

/// Whether two maps that are opened from the same landmark go to the target in one class: with the same deck transformations.
fn is_same_class(first: &Cover, second: &Cover) -> bool {
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
    surface: &Surface,
    marks: &Marks,
    options: &MatchOptions,
    control: &Control,
) -> Result<(Placed, usize)> {
    let mesh = surface.mesh();
    let mut curvature = PerVertex::filled(mesh.n_vertices(), 0.0);
    marks.landmarks.iter().for_each(|&v| curvature[v] = PI);
    marks.corners.iter().for_each(|&v| curvature[v] = FRAC_PI_2);
    let (metric, iterations) = canonical_metric(surface, Space::H2, curvature, &options.flow, control)?;
    let cut = cut_graph(mesh, surface.lengths(), &marks.landmarks, control)?;
    let unrolling = UnrollOptions {
        cones: Some(marks.landmarks.clone()),
        root: Some(central_vertex(mesh, surface.lengths(), control)?),
        cut: Some(cut.clone()),
        threads: options.flow.threads,
        ..UnrollOptions::default()
    };
    let layout = unroll(&metric, &unrolling, control)?;
    let pairings: Vec<_> = layout.seams.iter().map(|seam| seam.pairing).collect();
    let cover = Cover::along_cut(mesh, Space::H2, (&cut, &pairings), &[])?;
    Ok((Placed::of_layout(cover, &layout)?, iterations))
}

/// The source as it lies in the old domain of the target, and the new one.
pub(super) struct Way<'a> {
    /// Source and target in the old domain.
    old: [&'a Placed; 2],
    new: &'a Placed,
    marks: [&'a Marks; 2],
    found: Vec<Found>,
    /// Per vertex of the source: its landmark.
    landmark: PerVertex<Option<u32>>,
    /// Per vertex its place in the old domain.
    inside: Vec<Inside>,
    /// Of the vertices on the boundary: where they go in the new domain.
    rims: Rims,
    slits: Slits<'a>,
}

impl<'a> Way<'a> {
    pub fn new(
        old: [&'a Placed; 2],
        (new, mut found): (&'a Placed, Vec<Found>),
        (surface, marks): (&Surface, [&'a Marks; 2]),
        (variant, control): (u64, &Control),
    ) -> Result<Way<'a>> {
        let mesh = surface.mesh();
        let mut landmark = PerVertex::filled(mesh.n_vertices(), None);
        let mut pushes = Vec::with_capacity(marks[0].landmarks.len());
        for (k, (&from, &to)) in marks[0].landmarks.iter().zip(&marks[1].landmarks).enumerate() {
            landmark[from] = Some(k as u32);
            let place = found[from.index()].place;
            let corners = new.cover.mesh.face_halfedges(place.face);
            let there =
                (0..3).find(|&c| place.weights[c] > AT_CORNER && new.cover.mesh.origin(corners[c]) == to);
            let start = match there {
                Some(c) => Start::There(corners[c]),
                None => Start::At(Inside::new(old[1], place.face, place.weights)),
            };
            pushes.push(Push { start, to, name: format!("landmark {k} (vertices {from} and {to})") });
        }
        let slits = Slits::new([old[1], new], &pushes, &marks[1].loops, (variant, control))?;
        let rims = Rims::new(surface, (old[1], new), marks, (&mut found, &slits))?;
        let inside = found.iter().map(|f| Inside::new(old[1], f.place.face, f.place.weights)).collect();
        Ok(Way { old, new, marks, found, landmark, inside, rims, slits })
    }

    /// The source in the new domain, and where to look for it.
    pub fn image(&self) -> Result<(Placed, [Seed; 2])> {
        let mesh = &self.old[0].cover.mesh;
        let space = self.new.cover.space;
        let mut along = PerHalfedge::filled(mesh.n_halfedges(), Motion::identity(space));
        for e in mesh.edges() {
            let h = e.halfedge();
            along[h] = self.along(h)?;
            along[h.twin()] = along[h].inverse();
        }
        let at = self.places();
        let first = |marks: &Marks| marks.landmarks.first().or(marks.corners.first()).copied();
        let (Some(first), Some(to)) = (first(self.marks[0]), first(self.marks[1])) else {
            return Err(Error::Matching("no landmark to start from".into()));
        };
        let start = mesh.fan(first)[0];
        let corners = self.corners(mesh, &along, (start, &at))?;
        let across = |h: HalfedgeId| {
            let origin = mesh.origin(h);
            // Seen from a landmark the surface around it is not determined: from the other end it is.
            let is_turned = self.landmark[origin].is_some();
            let (own, other) = if is_turned { (mesh.next(h), h.twin()) } else { (h, mesh.next(h.twin())) };
            if mesh.is_outside(h.twin()) {
                return None;
            }
            let motion = corners[own].compose(&corners[other].inverse()).normalised();
            (motion.distance_from_identity() > IDENTITY).then_some(motion)
        };
        let cover = Cover::new(mesh, space, across, &[start])?;
        let at = PerVertex::from_fn(mesh.n_vertices(), |v: VertexId| {
            corners[cover.own(v)].compose(&at[v]).normalised()
        });
        let seeds = [Seed { vertex: first, near: self.new.cover.own(to) }, Seed { vertex: to, near: start }];
        Ok((Placed { cover, at }, seeds))
    }

    /// The transformation of the new domain along a half-edge, from the place of its origin to that of its tip.
    fn along(&self, h: HalfedgeId) -> Result<Motion<DoubleDouble>> {
        let cover = &self.old[0].cover;
        let [u, w] = [cover.mesh.origin(h), cover.mesh.tip(h)];
        let reverse = self.landmark[w].is_some();
        let (from, to, along) = match reverse {
            true => (w, u, cover.along(h).map(|m| m.inverse())),
            false => (u, w, cover.along(h)),
        };
        // From the place of the one to that of the other in the opened old domain.
        let copy = self.found[from.index()].copy;
        let deck = along.map_or(copy, |along| copy.compose(&along));
        let deck = deck.compose(&self.found[to.index()].copy.inverse()).normalised();
        let end = deck.apply(self.inside[to.index()].point);
        let motion = match self.landmark[from] {
            Some(k) => self.slits.landmark_to(k as usize, end)?,
            None => {
                let motion = self.slits.between(self.inside[from.index()], end)?;
                match self.rims.way(from) {
                    Some(way) => way.inverse().compose(&motion),
                    None => motion,
                }
            }
        };
        let motion = match self.rims.way(to) {
            Some(way) => motion.compose(way),
            None => motion,
        };
        Ok(if reverse { motion.inverse() } else { motion })
    }

    /// Frames at the places of the vertices in the opened new domain: where they were in their faces.
    fn places(&self) -> PerVertex<Motion<DoubleDouble>> {
        let mut at = PerVertex::from_fn(self.found.len(), |v: VertexId| {
            let place = self.found[v.index()].place;
            let corners = self.new.corners(place.face).map(|p| p.map(f64::from));
            let [x, y, w] = [0, 1, 2].map(|i| (0..3).map(|k| place.weights[k] * corners[k][i]).sum::<f64>());
            let size = match self.new.cover.space {
                Space::H2 => ((w - x) * (w + x) - y * y).max(f64::MIN_POSITIVE).sqrt(),
                _ => w,
            };
            Placed::frame(self.new.cover.space, [x / size, y / size, w / size])
        });
        for (&from, &to) in self.marks[0].landmarks.iter().zip(&self.marks[1].landmarks) {
            at[from] = self.new.at[to];
        }
        for (v, (x, ahead)) in &self.rims.places {
            at[*v] = moved(&self.new.at[*x], [*ahead, 0.0]);
        }
        at
    }

    /// Per half-edge of a face the transformation from the place of its origin to where it lies in the face, as the source is opened: face
    /// by face, every one seen from one of its corners that is no landmark. In the face of `start` a landmark lies at its place.
    fn corners(
        &self,
        mesh: &Mesh,
        along: &PerHalfedge<Motion<DoubleDouble>>,
        (start, at): (HalfedgeId, &PerVertex<Motion<DoubleDouble>>),
    ) -> Result<PerHalfedge<Motion<DoubleDouble>>> {
        let space = self.new.cover.space;
        let mut corners = PerHalfedge::filled(mesh.n_halfedges(), Motion::identity(space));
        for f in mesh.faces() {
            let sides = mesh.face_halfedges(f);
            let is_free = |h: &HalfedgeId| self.landmark[mesh.origin(*h)].is_none();
            let Some(base) = sides.iter().position(is_free) else {
                return Err(Error::Matching(format!("face {f} of the source has three landmarks")));
            };
            let [a, b, c] = [0, 1, 2].map(|k| sides[(base + k) % 3]);
            let (to_b, to_c) = (along[a], along[c].inverse());
            let closed = to_b.compose(&along[b]);
            // Landmarks stay where they are when the surface is turned about them.
            let tip = at[mesh.origin(c)].origin();
            let [p, q] = [closed.apply(tip), to_c.apply(tip)]
                .map(|p| at[mesh.origin(a)].inverse().apply(p).map(f64::from));
            let off = (0..2).map(|k| (p[k] - q[k]).abs() / p[2].abs().max(1.0)).fold(0.0, f64::max);
            if self.landmark[mesh.origin(b)].is_none() && (off.is_nan() || off > CLOSED) {
                return Err(Error::Matching(format!(
                    "the sides of face {f} of the source do not close in the target's domain (by {off:.1e}): the landmarks lie too close together"
                )));
            }
            (corners[b], corners[c]) = (to_b, to_c);
            if sides.contains(&start) {
                let back = corners[start].inverse();
                sides.into_iter().for_each(|h| corners[h] = back.compose(&corners[h]));
            }
        }
        Ok(corners)
    }
}
