//! Finds hubs on the final triangulation, and loops on the common subdivision.

use super::anchors::HubEdge;
use crate::geometry::Space;
use crate::geometry::worse;
use crate::mesh::{EdgeId, FilledMesh, HalfedgeId, Mesh};
use crate::metric::{CommonSubdivision, Metric};
use std::collections::BTreeMap;

/// The edges of the final triangulation between two hubs, with their loops.
pub(super) fn hub_pairs<'a>(
    mesh: &'a Mesh,
    filled: &'a FilledMesh,
) -> impl Iterator<Item = (EdgeId, [usize; 2])> + 'a {
    mesh.edges().filter_map(|e| match mesh.ends(e).map(|v| filled.loop_of(v)) {
        [Some(a), Some(b)] => Some((e, [a, b])),
        _ => None,
    })
}

/// The edge of the final triangulation at a hub, in the frame of a metric; none for an edge between points. `outside`: the hub whose
/// circle has the surface inside.
pub(super) fn hub_edge(
    mesh: &Mesh,
    metric: &Metric,
    filled: &FilledMesh,
    e: EdgeId,
    outer: Option<usize>,
) -> Option<HubEdge> {
    let ends = mesh.ends(e);
    let loops = ends.map(|v| filled.loop_of(v));
    let scale = |i: usize| {
        let vertex = metric.vertex(ends[i]);
        let size =
            if metric.space == Space::E2 { metric.u[ends[i]].exp() } else { 2.0 * vertex.scale / vertex.d };
        if loops[i].is_some() && loops[i] == outer { -size } else { size }
    };
    let is_hub = loops.map(|k| k.is_some());
    is_hub.contains(&true).then(|| HubEdge { eta: metric.eta[e].high, is_hub, scale: [scale(0), scale(1)] })
}

/// Weights of anchors ([`HubEdge::weights`]) of a crossing; one on a loop lies at the anchor of its hub.
pub(super) fn anchor_weights(
    edge: &HubEdge,
    ends: [Option<usize>; 2],
    own_loop: Option<usize>,
    weights: [f64; 2],
) -> [f64; 2] {
    match own_loop {
        Some(k) if ends[0] == Some(k) && edge.is_hub[0] => [1.0, 0.0],
        Some(k) if ends[1] == Some(k) && edge.is_hub[1] => [0.0, 1.0],
        _ => edge.weights(weights),
    }
}

/// The loop of each edge of a loop, in the numbering of the surface that was filled.
pub(super) fn loops_of_edges(filled: &FilledMesh) -> BTreeMap<EdgeId, usize> {
    let along = filled.loops.iter().enumerate();
    along.flat_map(|(k, rim)| rim.iter().map(move |h| (h.edge(), k))).collect()
}

/// Per loop the half-edges of the subdivision along it, in its faces.
pub(super) fn rims(subdivision: &CommonSubdivision, filled: &FilledMesh) -> Vec<Vec<HalfedgeId>> {
    let (mesh, loops) = (&subdivision.mesh, loops_of_edges(filled));
    let mut rims = vec![Vec::new(); filled.loops.len()];
    for rim in mesh.boundary_loops() {
        let first = rim.first().and_then(|h| subdivision.edge(0, h.edge()));
        if let Some(&k) = first.and_then(|e| loops.get(&e)) {
            rims[k] = rim.into_iter().map(HalfedgeId::twin).collect();
        }
    }
    rims
}

/// Largest difference of the radius from the distances of `n` points from the centre, as a share of it.
pub(super) fn deviation(n: usize, radius: f64, distance: impl Fn(usize) -> f64) -> f64 {
    (0..n).map(|i| (distance(i) - radius).abs() / radius).fold(0.0, worse)
}

/// Least `η − 1` over the edges between two hubs; infinite where there are none.
pub(super) fn least_gap(mesh: &Mesh, metric: &Metric, filled: &FilledMesh) -> f64 {
    hub_pairs(mesh, filled).map(|(e, _)| metric.eta[e].high - 1.0).fold(f64::INFINITY, f64::min)
}
