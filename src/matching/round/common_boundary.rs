//! Two matched surfaces with common vertices on their boundary loops: each surface gets the vertices that only the other one has.
//!
//! Where loops become circles, edges along them are chords. Two surfaces fill the same domain only if their chords are the same ones.

use crate::control::Control;
use crate::error::Result;
use crate::geometry::{DoubleDouble, Motion, Space};
use crate::matching::cover::{
    LocatedVertex, PlacedMesh, UniversalCover, WalkSeed, aimed, located, logarithm, moved,
};
use crate::matching::domain_pair::DomainPair;
use crate::matching::landmarks::{MarkedSurface, Marks};
use crate::matching::pushed::on_boundary;
use crate::mesh::{HalfedgeId, Mesh, PerVertex, VertexId};
use crate::metric::{Split, Surface};

/// Distance of two vertices of the two surfaces on a loop up to which they count as one, as a share of the shortest of the edges beside
/// them.
const SAME: f64 = 1e-3;

/// Two surfaces with the same vertices on their loops.
pub(super) struct CommonBoundary {
    /// Source and target in the domain where they were matched.
    pub pair: [PlacedMesh; 2],
    pub seeds: [WalkSeed; 2],
    /// From the given surfaces.
    pub splits: [Split; 2],
    pub surfaces: [Surface; 2],
    /// Every vertex of a loop is a corner.
    pub marks: [Marks; 2],
}

/// A vertex to be added on a loop.
struct AddedVertex {
    /// The number of the half-edge of the loop.
    edge: usize,
    /// The share of this half-edge before the vertex.
    share: f64,
    /// The number of the other surface's vertex on the loop.
    other: usize,
}

/// The vertices of corresponding loops.
struct MergedLoop {
    /// Numbers along the two loops of vertices that count as one.
    same: Vec<[usize; 2]>,
    /// The vertices that the source gets, and those that the target gets, in order along the loop.
    added: [Vec<AddedVertex>; 2],
}

impl CommonBoundary {
    /// The common vertices of two surfaces that lie in one domain, loops on loops.
    ///
    /// # Errors
    /// Those of [`located`], [`on_boundary`] and [`Split::part`].
    pub fn new(
        pair: &DomainPair,
        sides: [MarkedSurface; 2],
        splits: [&Split; 2],
        control: &Control,
    ) -> Result<CommonBoundary> {
        let (surfaces, marks) = (sides.map(|side| side.surface), sides.map(|side| side.marks));
        let placed = [&pair.source, &pair.target];
        let (mut found, _) = located(placed[0], placed[1], pair.seeds[0], control)?;
        let mut parted = [0, 1].map(|s| LoopRefinement::new(splits[s], surfaces[s]));
        let mut corners = [Vec::new(), Vec::new()];
        for (own, around) in marks[0].loops.iter().zip(&marks[1].loops) {
            let MergedLoop { same, added } =
                merged(surfaces[0].mesh(), placed[1], [own, around], &mut found)?;
            let loops = [own, around];
            let vertex = |s: usize, k: usize| surfaces[s].mesh().origin(loops[s][k]);
            for s in [0, 1] {
                let new = parted[s].part(loops[s], &added[s])?;
                corners[s].extend(new);
                corners[1 - s].extend(added[s].iter().map(|added| vertex(1 - s, added.other)));
                corners[s].extend(same.iter().map(|pair| vertex(s, pair[s])));
            }
        }
        let finer = [parted[0].onto.surface()?, parted[1].onto.surface()?];
        let refined = |s: usize| parted[s].refined(placed[s], finer[s].mesh());
        let seed = |s: usize| -> Result<WalkSeed> {
            let WalkSeed { vertex, near } = pair.seeds[s];
            Ok(WalkSeed { vertex, near: parted[1 - s].first(near)? })
        };
        let [first, second] = corners;
        let marks = [parted[0].marks(marks[0], first)?, parted[1].marks(marks[1], second)?];
        let (pair, seeds) = ([refined(0)?, refined(1)?], [seed(0)?, seed(1)?]);
        let splits = parted.map(|parted| parted.onto);
        Ok(CommonBoundary { pair, seeds, splits, surfaces: finer, marks })
    }

    /// One of the surfaces with its marks.
    pub fn side(&self, s: usize) -> MarkedSurface<'_> {
        MarkedSurface { surface: &self.surfaces[s], marks: &self.marks[s] }
    }
}

/// A surface whose loops get vertices.
struct LoopRefinement {
    /// The refinement of the given surface.
    onto: Split,
    /// The refinement of the surface on which the pair was found, with the same numbers.
    from: Split,
    /// Per added vertex the half-edge of the latter surface on which it lies, and the share of this half-edge before it.
    added: Vec<(HalfedgeId, f64)>,
}

impl LoopRefinement {
    fn new(onto: &Split, surface: &Surface) -> LoopRefinement {
        LoopRefinement { onto: onto.clone(), from: Split::new(surface), added: Vec::new() }
    }

    /// Adds vertices on a loop, those of each half-edge in order from its origin. Returns the vertices.
    fn part(&mut self, around: &[HalfedgeId], added: &[AddedVertex]) -> Result<Vec<VertexId>> {
        let mut vertices = vec![VertexId(0); added.len()];
        let mut from = 0;
        while from < added.len() {
            let k = added[from].edge;
            let to = from + added[from..].iter().take_while(|next| next.edge == k).count();
            let h = around[k];
            let is_along = h == h.edge().halfedge();
            // The first part keeps the number of the edge, the rest gets a new one.
            let (mut edge, mut before) = (h.edge(), 0.0);
            for i in 0..to - from {
                let i = if is_along { from + i } else { to - 1 - i };
                let share = if is_along { added[i].share } else { 1.0 - added[i].share };
                let rest = (share - before) / (1.0 - before);
                self.onto.part(edge, rest)?;
                edge = self.from.part(edge, rest)?;
                before = share;
                vertices[i] = VertexId::from(self.from.given().mesh().n_vertices() + self.added.len());
                self.added.push((h, added[i].share));
            }
            from = to;
        }
        Ok(vertices)
    }

    /// The first part of a half-edge.
    fn first(&self, h: HalfedgeId) -> Result<HalfedgeId> {
        Ok(*self.from.path(h)?.first().unwrap_or(&h))
    }

    /// The marks on the refined surface, with these corners.
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
    fn refined(&self, placed: &PlacedMesh, finer: &std::sync::Arc<Mesh>) -> Result<PlacedMesh> {
        let (mesh, space) = (&placed.cover.mesh, placed.cover.space);
        let mut across: Vec<Option<Motion<DoubleDouble>>> = vec![None; finer.n_halfedges()];
        for h in mesh.halfedges().filter(|&h| !mesh.is_outside(h)) {
            across[h.index()] = placed.cover.across(h).copied();
        }
        let own = mesh.vertices().map(|v| self.first(placed.cover.own(v)));
        let own: Vec<HalfedgeId> = own.collect::<Result<_>>()?;
        let cover = UniversalCover::new(finer, space, |h| across[h.index()], &own)?;
        let mut at: Vec<Motion<DoubleDouble>> = placed.at.iter().copied().collect();
        for &(h, share) in &self.added {
            let (line, far) = aimed(space, [placed.corner(h), placed.corner(mesh.next(h))]);
            at.push(moved(&line, [share * far, 0.0]));
        }
        Ok(PlacedMesh { cover, at: PerVertex::from(at) })
    }
}

/// The vertices of corresponding loops: those that count as one, and the places of those that only one of the loops has.
fn merged(
    source: &Mesh,
    target: &PlacedMesh,
    [own, around]: [&[HalfedgeId]; 2],
    found: &mut [LocatedVertex],
) -> Result<MergedLoop> {
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
    // The places of the source's vertices along the target's loop, ascending even beyond its end.
    let mut at: Vec<f64> = Vec::with_capacity(own.len());
    for &h in own {
        let (k, share) = on_boundary(around, target, &mut found[source.origin(h).index()])?;
        let mut x = before[k] + part_of(space, lengths[k], share);
        while at.last().is_some_and(|last| x < *last) {
            x += total;
        }
        at.push(x);
    }
    // The distance around the loop from one place to another one.
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
        if off.abs() <= SAME * beside.into_iter().fold(f64::INFINITY, f64::min) {
            (is_same[0][i], is_same[1][k % n]) = (true, true);
            same.push([i, k % n]);
        }
    }
    for &[i, k] in &same {
        at[i] -= past(at[i], before[k]);
    }
    Ok(MergedLoop { same, added: missing(&at, &lengths, &before, &is_same) })
}

/// The vertices that the source gets from the target, and those that the target gets from the source. `at`: the places of the source's
/// vertices along the target's loop, whose edges have these lengths and start at the distances `before`.
fn missing(at: &[f64], lengths: &[f64], before: &[f64], is_same: &[Vec<bool>; 2]) -> [Vec<AddedVertex>; 2] {
    let total = before[lengths.len()];
    let mut added = [Vec::new(), Vec::new()];
    for i in (0..at.len()).filter(|&i| !is_same[0][i]) {
        let x = at[i] % total;
        let k = before.partition_point(|y| *y <= x).clamp(1, lengths.len()) - 1;
        added[1].push(AddedVertex { edge: k, share: (x - before[k]) / lengths[k], other: i });
    }
    for k in (0..lengths.len()).filter(|&k| !is_same[1][k]) {
        let x = at[0] + (before[k] - at[0]).rem_euclid(total);
        let i = at.partition_point(|y| *y <= x).max(1) - 1;
        let end = if i + 1 < at.len() { at[i + 1] } else { at[0] + total };
        added[0].push(AddedVertex { edge: i, share: (x - at[i]) / (end - at[i]), other: k });
    }
    let order = |a: &AddedVertex, b: &AddedVertex| a.edge.cmp(&b.edge).then(a.share.total_cmp(&b.share));
    added.iter_mut().for_each(|added| added.sort_by(order));
    added
}

/// The number of the vertex of a loop that is nearest to a place x along it, by the places of its vertices, the first repeated at the end.
fn nearest(before: &[f64], x: f64) -> usize {
    let k = before.partition_point(|y| *y < x).clamp(1, before.len() - 1);
    if x - before[k - 1] <= before[k] - x { k - 1 } else { k }
}

/// The distance along an edge of the point with this barycentric coordinate of its end, in the coordinates of the space.
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
