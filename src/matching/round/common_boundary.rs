//! Boundary loops of two matched surfaces with the same vertices: each surface gets those that only the other one has.
//!
//! Where loops become circles, edges along them are chords. Two surfaces fill the same domain only if their chords are the same ones.

use super::cover::{Cover, Placed, aimed, logarithm, moved};
use super::orbifold::Pair;
use super::rims::put;
use super::route::Marks;
use super::walk::{Found, Seed, located};
use crate::control::Control;
use crate::error::Result;
use crate::geometry::{DoubleDouble, Motion, Space};
use crate::mesh::{HalfedgeId, Mesh, PerVertex, VertexId};
use crate::metric::{Split, Surface};

/// Distance of two vertices of the two surfaces on a loop up to which they are taken as one: share of the shortest of the edges beside
/// them.
const ONE: f64 = 1e-3;

/// Two surfaces with the same vertices on their loops.
pub(super) struct Shared {
    /// Source and target in the domain where they were matched.
    pub pair: [Placed; 2],
    pub seeds: [Seed; 2],
    /// From the given surfaces.
    pub splits: [Split; 2],
    pub surfaces: [Surface; 2],
    /// Every vertex of a loop is a corner.
    pub marks: [Marks; 2],
}

/// A vertex to be added on the half-edge of this number of a loop, at this share of it, for the other surface's vertex of this number on
/// the loop.
type Added = (usize, f64, usize);

/// The vertices of corresponding loops.
struct Merged {
    /// Numbers of vertices along the loops that are one.
    same: Vec<[usize; 2]>,
    /// What the source gets, and what the target gets, in order.
    added: [Vec<Added>; 2],
}

impl Shared {
    /// From surfaces that lie in one domain, loops on loops.
    ///
    /// # Errors
    /// Those of [`located`], [`put`] and [`Split::part`].
    pub fn new(
        pair: &Pair,
        (surfaces, marks): ([&Surface; 2], [&Marks; 2]),
        splits: [&Split; 2],
        control: &Control,
    ) -> Result<Shared> {
        let placed = [&pair.source, &pair.target];
        let (mut found, _) = located(placed[0], placed[1], pair.seeds[0], control)?;
        let mut parted = [0, 1].map(|s| Parted::new(splits[s], surfaces[s]));
        let mut corners = [Vec::new(), Vec::new()];
        for (own, around) in marks[0].loops.iter().zip(&marks[1].loops) {
            let Merged { same, added } = merged(surfaces[0].mesh(), placed[1], (own, around), &mut found)?;
            let loops = [own, around];
            let vertex = |s: usize, k: usize| surfaces[s].mesh().origin(loops[s][k]);
            for s in [0, 1] {
                let new = parted[s].part(loops[s], &added[s])?;
                corners[s].extend(new);
                corners[1 - s].extend(added[s].iter().map(|&(.., other)| vertex(1 - s, other)));
                corners[s].extend(same.iter().map(|pair| vertex(s, pair[s])));
            }
        }
        let finer = [parted[0].onto.surface()?, parted[1].onto.surface()?];
        let refined = |s: usize| parted[s].refined(placed[s], finer[s].mesh());
        let seed = |s: usize| -> Result<Seed> {
            let Seed { vertex, near } = pair.seeds[s];
            Ok(Seed { vertex, near: parted[1 - s].first(near)? })
        };
        let [first, second] = corners;
        let marks = [parted[0].marks(marks[0], first)?, parted[1].marks(marks[1], second)?];
        let (pair, seeds) = ([refined(0)?, refined(1)?], [seed(0)?, seed(1)?]);
        let splits = parted.map(|parted| parted.onto);
        Ok(Shared { pair, seeds, splits, surfaces: finer, marks })
    }
}

/// A surface whose loops get vertices.
struct Parted {
    /// From the given surface.
    onto: Split,
    /// From that on which the pair was found: with the same numbers.
    from: Split,
    /// Half-edges of the latter on which vertices were added, and at which shares, vertex by vertex.
    added: Vec<(HalfedgeId, f64)>,
}

impl Parted {
    fn new(onto: &Split, surface: &Surface) -> Parted {
        Parted { onto: onto.clone(), from: Split::new(surface), added: Vec::new() }
    }

    /// Adds vertices on a loop, each half-edge's in order from its origin; the vertices.
    fn part(&mut self, around: &[HalfedgeId], added: &[Added]) -> Result<Vec<VertexId>> {
        let mut vertices = vec![VertexId(0); added.len()];
        let mut from = 0;
        while from < added.len() {
            let k = added[from].0;
            let to = from + added[from..].iter().take_while(|next| next.0 == k).count();
            let h = around[k];
            let is_along = h == h.edge().halfedge();
            // The first part keeps the number of the edge, the rest gets a new one.
            let (mut edge, mut before) = (h.edge(), 0.0);
            for i in 0..to - from {
                let i = if is_along { from + i } else { to - 1 - i };
                let share = if is_along { added[i].1 } else { 1.0 - added[i].1 };
                let rest = (share - before) / (1.0 - before);
                self.onto.part(edge, rest)?;
                edge = self.from.part(edge, rest)?;
                before = share;
                vertices[i] = VertexId::from(self.from.given().mesh().n_vertices() + self.added.len());
                self.added.push((h, added[i].1));
            }
            from = to;
        }
        Ok(vertices)
    }

    /// The first part of a half-edge.
    fn first(&self, h: HalfedgeId) -> Result<HalfedgeId> {
        Ok(*self.from.path(h)?.first().unwrap_or(&h))
    }

    fn marks(&self, marks: &Marks, corners: Vec<VertexId>) -> Result<Marks> {
        let finer = |around: &Vec<HalfedgeId>| -> Result<Vec<HalfedgeId>> {
            let parts: Vec<Vec<HalfedgeId>> =
                around.iter().map(|&h| self.from.path(h)).collect::<Result<_>>()?;
            Ok(parts.concat())
        };
        let loops = marks.loops.iter().map(finer).collect::<Result<_>>()?;
        Ok(Marks { landmarks: marks.landmarks.clone(), loops, corners })
    }

    /// The surface in its domain with the added vertices on its straight boundary.
    fn refined(&self, placed: &Placed, finer: &std::sync::Arc<Mesh>) -> Result<Placed> {
        let (mesh, space) = (&placed.cover.mesh, placed.cover.space);
        let mut across: Vec<Option<Motion<DoubleDouble>>> = vec![None; finer.n_halfedges()];
        for h in mesh.halfedges().filter(|&h| !mesh.is_outside(h)) {
            across[h.index()] = placed.cover.across(h).copied();
        }
        let own = mesh.vertices().map(|v| self.first(placed.cover.own(v)));
        let own: Vec<HalfedgeId> = own.collect::<Result<_>>()?;
        let cover = Cover::new(finer, space, |h| across[h.index()], &own)?;
        let mut at: Vec<Motion<DoubleDouble>> = placed.at.iter().copied().collect();
        for &(h, share) in &self.added {
            let (line, far) = aimed(space, [placed.corner(h), placed.corner(mesh.next(h))]);
            at.push(moved(&line, [share * far, 0.0]));
        }
        Ok(Placed { cover, at: PerVertex::from(at) })
    }
}

/// Which vertices of corresponding loops are one, and where those lie that only one of them has.
fn merged(
    source: &Mesh,
    target: &Placed,
    (own, around): (&[HalfedgeId], &[HalfedgeId]),
    found: &mut [Found],
) -> Result<Merged> {
    let space = target.cover.space;
    let length = |&h: &HalfedgeId| {
        let [x, y] =
            logarithm(space, target.frame_at(h).inverse().apply(target.corner(target.cover.mesh.next(h))));
        x.hypot(y)
    };
    let lengths: Vec<f64> = around.iter().map(length).collect();
    let mut before = vec![0.0];
    lengths.iter().for_each(|l| before.push(before[before.len() - 1] + l));
    let (n, total) = (around.len(), before[around.len()]);
    // Where the source's vertices lie along the target's loop, counted on around it.
    let mut at: Vec<f64> = Vec::with_capacity(own.len());
    for &h in own {
        let (k, share) = put(around, target, &mut found[source.origin(h).index()])?;
        let mut x = before[k] + part_of(space, lengths[k], share);
        while at.last().is_some_and(|last| x < *last) {
            x += total;
        }
        at.push(x);
    }
    // How far one place lies past another one, around the loop.
    let past = |x: f64, y: f64| {
        let off = (x - y).rem_euclid(total);
        if off > 0.5 * total { off - total } else { off }
    };
    let gap = |i: usize| if i + 1 < at.len() { at[i + 1] - at[i] } else { at[0] + total - at[i] };
    let mut same = Vec::new();
    let mut is_same = [vec![false; own.len()], vec![false; n]];
    for i in 0..own.len() {
        let k = nearest(&before, at[i] % total);
        let off = past(at[i], before[k]);
        let beside = [gap(i), gap((i + own.len() - 1) % own.len()), lengths[k % n], lengths[(k + n - 1) % n]];
        if off.abs() <= ONE * beside.into_iter().fold(f64::INFINITY, f64::min) {
            (is_same[0][i], is_same[1][k % n]) = (true, true);
            same.push([i, k % n]);
        }
    }
    for &[i, k] in &same {
        at[i] -= past(at[i], before[k]);
    }
    Ok(Merged { same, added: missing((&at, &lengths, &before), &is_same) })
}

/// Where the vertices lie that only the other surface has: what the source gets, and what the target gets. `at`: of the source's vertices
/// along the target's loop, whose edges have these lengths.
fn missing((at, lengths, before): (&[f64], &[f64], &[f64]), is_same: &[Vec<bool>; 2]) -> [Vec<Added>; 2] {
    let total = before[lengths.len()];
    let mut added = [Vec::new(), Vec::new()];
    for i in (0..at.len()).filter(|&i| !is_same[0][i]) {
        let x = at[i] % total;
        let k = before.partition_point(|y| *y <= x).clamp(1, lengths.len()) - 1;
        added[1].push((k, (x - before[k]) / lengths[k], i));
    }
    for k in (0..lengths.len()).filter(|&k| !is_same[1][k]) {
        let x = at[0] + (before[k] - at[0]).rem_euclid(total);
        let i = at.partition_point(|y| *y <= x).max(1) - 1;
        let end = if i + 1 < at.len() { at[i + 1] } else { at[0] + total };
        added[0].push((i, (x - at[i]) / (end - at[i]), k));
    }
    let order = |a: &Added, b: &Added| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1));
    added.iter_mut().for_each(|added| added.sort_by(order));
    added
}

/// The number of the vertex of a loop that is nearest, its last one being its first.
fn nearest(before: &[f64], x: f64) -> usize {
    let k = before.partition_point(|y| *y < x).clamp(1, before.len() - 1);
    if x - before[k - 1] <= before[k] - x { k - 1 } else { k }
}

/// How far along an edge the point lies that has the share of it in coordinates of the space.
fn part_of(space: Space, length: f64, share: f64) -> f64 {
    match space {
        Space::H2 => {
            let rest = 1.0 - share;
            let size = (rest * rest + share * share + 2.0 * rest * share * length.cosh()).sqrt();
            (share * length.sinh() / size).asinh()
        }
        _ => share * length,
    }
}
