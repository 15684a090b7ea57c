//! Corresponding trees of paths between the landmarks and boundary loops of two surfaces of genus 0: they determine the homotopy class of
//! the map.
//!
//! A surface of genus 0 that is opened along a tree through all its landmarks and loops is a disk. A homeomorphism that brings landmarks to
//! landmarks and the tree to a tree of the same shape, with the same order around each mark, is determined up to isotopy.

use crate::control::Control;
use crate::error::Result;
use crate::matching::landmarks::{MarkedSurface, Marks, PathRouter};
use crate::mesh::shapes::SplitMix64;
use crate::mesh::union_find::UnionFind;
use crate::mesh::{HalfedgeId, Mesh, PerEdge};
use crate::topology::{CutGraph, shortest_paths};

/// The tree of one surface.
#[derive(Debug, Clone)]
pub(super) struct MarkTree {
    /// The paths, in the same order on both surfaces.
    pub cut: CutGraph,
    /// Per landmark the half-edge of its own corner: the one by which the path of lowest number leaves the landmark.
    pub landmark_corners: Vec<HalfedgeId>,
    /// The parts into which the ends of paths and the corners divide the boundary loops, in the same order on both surfaces: half-edges of
    /// faces, the surface on the left.
    pub arcs: Vec<Vec<HalfedgeId>>,
}

/// Corresponding trees of two surfaces with the same numbers of landmarks and loops.
///
/// In variant 0 it is the spanning tree of the marks of least length, by the distances on both surfaces; its paths are drawn as short as
/// the order around the marks permits. A path may pass a third mark on the left on one surface and on the right on the other one: then the
/// map is twisted there, and another variant may determine a better class. Variants 1 and 2 take the distances of one surface, further ones
/// distances that are changed at random; in odd variants the paths of the target are drawn first.
///
/// # Errors
/// [`crate::Error::Matching`] if paths have no room, naming the marks; [`crate::Error::Cancelled`].
pub(super) fn trees(
    sides: [MarkedSurface; 2],
    distances: &[MarkDistances; 2],
    variant: u64,
    control: &Control,
) -> Result<[MarkTree; 2]> {
    let n = sides[0].marks.n();
    let edges = spanning(n, distances, variant);
    let mut routers =
        sides.map(|side| PathRouter::new(side.surface.mesh(), side.surface.lengths(), side.marks));
    let [first, second] = &mut routers;
    let (source, target) = if variant.is_multiple_of(2) { (first, second) } else { (second, first) };
    for &pair in &edges {
        control.check()?;
        source.join(pair, None)?;
    }
    let orders: Vec<Vec<usize>> = (0..n).map(|k| source.order(k)).collect();
    for &[a, b] in &edges {
        control.check()?;
        target.join([a, b], Some([&orders[a], &orders[b]]))?;
    }
    Ok([0, 1].map(|s| {
        let (mesh, marks, paths) = (sides[s].surface.mesh(), sides[s].marks, &routers[s].paths);
        MarkTree {
            cut: cut(mesh, paths, marks),
            landmark_corners: landmark_corners(paths, &edges, marks),
            arcs: arcs(mesh, paths, marks),
        }
    }))
}

/// The distances between the marks of a surface, mark by mark.
pub(super) type MarkDistances = Vec<Vec<f64>>;

/// The distances between the marks along edges, as shares of the largest.
///
/// # Errors
/// Those of [`shortest_paths`].
pub(super) fn distances(side: MarkedSurface, control: &Control) -> Result<MarkDistances> {
    let MarkedSurface { surface, marks } = side;
    let mesh = surface.mesh();
    let mut all = Vec::with_capacity(marks.n());
    for k in 0..marks.n() {
        let far = shortest_paths(mesh, surface.lengths(), marks.vertices(mesh, k), control)?.distance;
        let to = |j: usize| marks.vertices(mesh, j).into_iter().map(|v| far[v]).fold(f64::INFINITY, f64::min);
        all.push((0..marks.n()).map(to).collect::<Vec<_>>());
    }
    let largest = all.iter().flatten().copied().fold(f64::MIN_POSITIVE, f64::max);
    all.iter_mut().flatten().for_each(|x| *x /= largest);
    Ok(all)
}

/// Largest factor by which a distance is changed at random.
const CHANGE: f64 = 3.0;

/// The minimal spanning tree of a variant, its edges by ascending length.
fn spanning(n: usize, [first, second]: &[MarkDistances; 2], variant: u64) -> Vec<[usize; 2]> {
    let mut random = SplitMix64::new(variant);
    let mut pairs: Vec<([usize; 2], f64)> = Vec::with_capacity(n * n / 2);
    for a in 0..n {
        for b in a + 1..n {
            let length = match variant {
                1 => second[a][b],
                2 => first[a][b],
                _ => first[a][b] + second[a][b],
            };
            let change = if variant > 2 { CHANGE.powf(2.0 * random.unit() - 1.0) } else { 1.0 };
            pairs.push(([a, b], change * length));
        }
    }
    pairs.sort_by(|p, q| p.1.total_cmp(&q.1).then(p.0.cmp(&q.0)));
    let mut parts = UnionFind::new(n);
    pairs.into_iter().map(|pair| pair.0).filter(|&[a, b]| parts.join(a as u32, b as u32)).collect()
}

/// The paths of a tree as a cut.
fn cut(mesh: &Mesh, paths: &[Vec<HalfedgeId>], marks: &Marks) -> CutGraph {
    let mut is_cut = PerEdge::filled(mesh.n_edges(), false);
    paths.iter().flatten().for_each(|h| is_cut[h.edge()] = true);
    let ends = paths.iter().filter_map(|path| Some([mesh.origin(*path.first()?), mesh.tip(*path.last()?)]));
    let mut nodes: Vec<_> = ends.flatten().chain(marks.landmarks.iter().copied()).collect();
    nodes.sort_unstable();
    nodes.dedup();
    CutGraph { is_cut, nodes, segments: paths.to_vec() }
}

fn landmark_corners(paths: &[Vec<HalfedgeId>], edges: &[[usize; 2]], marks: &Marks) -> Vec<HalfedgeId> {
    let leaving = |k: usize| {
        let number = edges.iter().position(|pair| pair.contains(&k))?;
        let path = &paths[number];
        if edges[number][0] == k { path.first().copied() } else { path.last().map(|h| h.twin()) }
    };
    (0..marks.landmarks.len()).filter_map(leaving).collect()
}

/// The arcs: first those that start at ends of paths, by the number of the path, its first end before its last; then those that start at
/// corners.
fn arcs(mesh: &Mesh, paths: &[Vec<HalfedgeId>], marks: &Marks) -> Vec<Vec<HalfedgeId>> {
    let mut is_end = vec![false; mesh.n_vertices()];
    let ends = paths.iter().filter_map(|path| Some([mesh.origin(*path.first()?), mesh.tip(*path.last()?)]));
    let ends: Vec<_> = ends.flatten().filter(|&v| mesh.is_boundary_vertex(v)).collect();
    let ends: Vec<_> = ends.into_iter().chain(marks.corners.iter().copied()).collect();
    ends.iter().for_each(|v| is_end[v.index()] = true);
    let mut next = std::collections::HashMap::new();
    for around in &marks.loops {
        for (k, &h) in around.iter().enumerate() {
            next.insert(mesh.origin(h), (h, around[(k + 1) % around.len()]));
        }
    }
    let from = |v| {
        let mut arc: Vec<HalfedgeId> = Vec::new();
        let mut at = next.get(&v).map(|pair: &(HalfedgeId, HalfedgeId)| pair.0);
        while let Some(h) = at {
            arc.push(h);
            let tip = mesh.tip(h);
            at = next.get(&tip).map(|pair| pair.0).filter(|_| !is_end[tip.index()]);
        }
        arc
    };
    ends.into_iter().map(from).collect()
}
