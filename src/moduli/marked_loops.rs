//! Fenchel–Nielsen coordinates of a surface whose canonical loops are given as edge paths.

use super::fenchel_nielsen::{PantsCurve, fenchel_nielsen};
use crate::canonical::Quotient;
use crate::control::Control;
use crate::embed::DeckGroup;
use crate::error::{Error, Result};
use crate::mesh::{HalfedgeId, Mesh, VertexId};
use crate::metric::common_subdivision::CommonSubdivision;
use std::collections::HashMap;
use std::sync::Arc;

/// [`fenchel_nielsen`] in the marking of given loops: the canonical generators a1, b1, …, ag, bg, c1, …, cb as edge paths on the given mesh that start and
/// end at one vertex.
///
/// Edges that have been flipped are followed across the metric's triangulation.
///
/// # Errors
/// Those of [`fenchel_nielsen`] and [`DeckGroup::of_loops`]; [`Error::Argument`] for half-edges that the mesh does not have.
pub fn fenchel_nielsen_of_loops(
    quotient: &Quotient,
    loops: &[Vec<HalfedgeId>],
    control: &Control,
) -> Result<Vec<PantsCurve>> {
    let metric = &quotient.metric;
    let most = metric.given().n_halfedges();
    if let Some(h) = loops.iter().flatten().find(|h| h.index() >= most) {
        return Err(Error::argument("edge of a loop", h, "one of the mesh"));
    }
    let refined;
    let (layout, both) = match quotient.layout.common_subdivision() {
        Some(both) => (&quotient.layout, both.clone()),
        None => {
            let both = Arc::new(metric.common_subdivision(&control.part(0.0, 0.4))?);
            refined = quotient.layout.on_subdivision(&both, metric.metric(), &control.part(0.4, 0.8))?;
            (&refined, both)
        }
    };
    let parts = parts_of_edges(&both, layout.mesh(), loops);
    let paths: Vec<Vec<HalfedgeId>> =
        loops.iter().map(|path| path.iter().flat_map(|h| &parts[h]).copied().collect()).collect();
    let group = quotient.deck.group;
    fenchel_nielsen(&DeckGroup::of_loops(metric, layout, group, &paths, &control.part(0.8, 1.0))?)
}

/// Per half-edge of the given triangulation on one of some paths, its parts in the common subdivision, in its direction.
pub fn parts_of_edges(
    both: &CommonSubdivision,
    mesh: &Mesh,
    paths: &[Vec<HalfedgeId>],
) -> HashMap<HalfedgeId, Vec<HalfedgeId>> {
    let mut parts: HashMap<HalfedgeId, Vec<HalfedgeId>> =
        paths.iter().flatten().map(|&h| (h, Vec::new())).collect();
    for part in mesh.halfedges() {
        if let Some(of_edge) = both.halfedge(0, part).and_then(|h| parts.get_mut(&h)) {
            of_edge.push(part);
        }
    }
    for of_edge in parts.values_mut() {
        // Between the ends of the edge there are crossings, each the tip of one part.
        let from: HashMap<VertexId, HalfedgeId> = of_edge.iter().map(|&h| (mesh.origin(h), h)).collect();
        let is_crossing = |v: VertexId| v.index() >= both.n_vertices[0];
        let first = of_edge.iter().copied().find(|&h| !is_crossing(mesh.origin(h)));
        let next = |h: &HalfedgeId| from.get(&mesh.tip(*h)).copied().filter(|_| is_crossing(mesh.tip(*h)));
        *of_edge = std::iter::successors(first, next).collect();
    }
    parts
}
