//! Features that are given up where no metric is reached with all of them straight.

use super::corner_choice::Neighbours;
use super::holonomy_state::{HolonomyState, HolonomyTarget, largest};
use crate::mesh::{EdgeId, Mesh, PerEdge, VertexId};

/// Features near angles that are off by this share of the largest error are given up together.
const BAD_SHARE: f64 = 0.3;

/// The features that stay once those nearest to the sectors that are furthest off are given up, each with all others in line with it up to the
/// next corner or end.
pub(super) fn without_worst(state: &HolonomyState, target: &HolonomyTarget) -> Vec<EdgeId> {
    let (mesh, sectors) = (&state.mesh, &*state.sectors);
    let off = state.sector_angles().into_iter().zip(&target.angles).map(|(is, wanted)| (is - wanted).abs());
    let errors: Vec<f64> = off.collect();
    let inner = sectors.inner_features(mesh);
    let top = largest(&errors);
    let mut is_given_up = PerEdge::filled(mesh.n_edges(), false);
    let neighbours = Neighbours::new(mesh, sectors);
    let at = |v: VertexId| mesh.outgoing(v).map(|h| h.edge()).filter(|e| inner.binary_search(e).is_ok());
    for (sector, _) in errors.iter().enumerate().filter(|(_, error)| **error >= BAD_SHARE * top) {
        let has_features = |s: usize| at(sectors.vertex[s]).next().is_some();
        let nearest =
            if has_features(sector) { Some(sector) } else { neighbours.nearest(sector, has_features) };
        let Some(nearest) = nearest else { continue };
        for e in at(sectors.vertex[nearest]).collect::<Vec<_>>() {
            give_up_line(mesh, &inner, e, &mut is_given_up);
        }
    }
    inner.into_iter().filter(|&e| !is_given_up[e]).collect()
}

/// Marks a feature and those that go on from it where exactly two meet.
fn give_up_line(mesh: &Mesh, inner: &[EdgeId], first: EdgeId, is_given_up: &mut PerEdge<bool>) {
    let mut waiting = vec![first];
    while let Some(e) = waiting.pop() {
        if std::mem::replace(&mut is_given_up[e], true) {
            continue;
        }
        for v in mesh.ends(e) {
            let mut others = mesh.outgoing(v).map(|h| h.edge()).filter(|x| inner.binary_search(x).is_ok());
            let both = [others.next(), others.next()];
            if let ([Some(a), Some(b)], None) = (both, others.next()) {
                waiting.extend([a, b]);
            }
        }
    }
}
