//! Trees of paths between landmarks and boundary loops, the same on two surfaces of genus 0: they mark which map is meant.
//!
//! A surface of genus 0 that is opened along a tree through all its landmarks and loops is a disk. A homeomorphism that brings landmarks to
//! landmarks and the tree to a tree of the same shape, with the same order around each mark, is determined up to isotopy.

use super::route::{Marks, Router};
use crate::control::Control;
use crate::error::Result;
use crate::mesh::shapes::SplitMix64;
use crate::mesh::union_find::UnionFind;
use crate::mesh::{HalfedgeId, Mesh, PerEdge};
use crate::metric::Surface;
use crate::topology::{CutGraph, shortest_paths};

/// One surface's tree.
#[derive(Debug, Clone)]
pub(super) struct Tree {
    /// Path by path, in the same order on both surfaces.
    pub cut: CutGraph,
    /// Per landmark, the half-edge of its own corner: that of the path of lowest number there, which leaves the landmark.
    pub landmark_corners: Vec<HalfedgeId>,
    /// The arcs between the ends of paths and corners on boundary loops, in the same order on both surfaces: half-edges of faces, the
    /// surface on the left.
    pub arcs: Vec<Vec<HalfedgeId>>,
}

/// The trees of two surfaces with the same numbers of landmarks and loops, of variant 0: of all trees on the marks that of the least
/// length, by distances on both, its paths drawn as short as the order around the marks leaves them. Variants may mark other maps: where a
/// path passes a third mark on one side on one surface and on the other side on the other one, the map is twisted there. In 1 and 2 the
/// distances of one surface count, in others they are changed at random, and in odd ones it is the target whose paths are drawn first.
///
/// # Errors
/// [`crate::Error::Matching`] where paths have no room, naming the marks; [`crate::Error::Cancelled`].
pub(super) fn trees(
    surfaces: [&Surface; 2],
    marks: [&Marks; 2],
    (distances, variant): (&[Distances; 2], u64),
    control: &Control,
) -> Result<[Tree; 2]> {
    let n = marks[0].n();
    let edges = spanning(n, distances, variant);
    let mut routers = [0, 1].map(|s| Router::new(surfaces[s].mesh(), surfaces[s].lengths(), marks[s]));
    let [first, second] = &mut routers;
    let (source, target) = if variant % 2 == 0 { (first, second) } else { (second, first) };
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
        let mesh = surfaces[s].mesh();
        Tree {
            cut: cut(mesh, &routers[s].paths, marks[s]),
            landmark_corners: landmark_corners(&routers[s].paths, &edges, marks[s]),
            arcs: arcs(mesh, &routers[s].paths, marks[s]),
        }
    }))
}

/// Distances between the marks of a surface.
pub(super) type Distances = Vec<Vec<f64>>;

/// Distances between the marks along edges, as shares of the largest.
///
/// # Errors
/// Those of [`shortest_paths`].
pub(super) fn distances(surface: &Surface, marks: &Marks, control: &Control) -> Result<Distances> {
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

/// The least spanning tree of a variant, its edges by ascending length.
fn spanning(n: usize, [first, second]: &[Distances; 2], variant: u64) -> Vec<[usize; 2]> {
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

/// The arcs: first those from ends of paths, by the number of the path, its first end before its last; then those from corners.
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
