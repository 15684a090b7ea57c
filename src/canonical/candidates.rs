//! Chooses candidates for the vertex that is sent to infinity.
//!
//! The planes seen from two vertices differ by an inversion, on the same triangulation. With u of the centred sphere, the plane seen
//! from v has `u' = u_i + u_v − 2 log(|x_i − x_v|/2)`. This is −log(2 η) at the neighbours of v, whatever u; about u_i + u_v on the far
//! side of the sphere; and about u_i − u_v in a long finger of the surface beyond v, whose vertices are crowded on the sphere. So the
//! range of u' is smallest for a vertex with long edges half way down the deepest finger. The depth of a vertex is the largest u minus
//! its own, and one vertex of each depth is tried.
//!
//! If the angles opposite an edge at v add up to nearly π, the outline seen from v is nearly straight there, and rounding decides which
//! way it turns. The logarithm of that small angle is counted as lost digits of u.

use super::star::PuncturedSurface;
use crate::control::Control;
use crate::error::Result;
use crate::mesh::{PerVertex, VertexId};
use crate::topology::spanning::Key;

/// Number of depths, in steps of 1 of u, at each of which the best vertex is tried. The range of u is smaller on surfaces that f64 can represent.
const DEPTHS: usize = 64;
/// Number of the best vertices that are tried whatever their depth.
const BEST_ANYWHERE: usize = 8;
/// Radians. Smaller angles count as this one: they consist of rounding.
const LEAST_ANGLE: f64 = 1e-12;

impl PuncturedSurface {
    /// Vertices to puncture, the best one first: by the range of u in the plane seen from them, and the digits lost in narrow angles.
    /// `plane` is the present layout, `u` that of the centred sphere. Only vertices that `may` be punctured are returned.
    pub fn candidates(
        &self,
        plane: &PerVertex<[f64; 2]>,
        u: &PerVertex<f64>,
        may: &PerVertex<bool>,
        control: &Control,
    ) -> Result<Vec<VertexId>> {
        // Per vertex, the least exterior angle of the polyhedron at its edges.
        let mut narrow = PerVertex::filled(self.mesh.n_vertices(), f64::INFINITY);
        let mut note = |v: VertexId, angle: f64| narrow[v] = narrow[v].min(angle);
        let excess = self.excess()?;
        for e in self.mesh.edges().filter(|&e| !self.mesh.ends(e).contains(&self.at)) {
            self.mesh.ends(e).into_iter().for_each(|v| note(v, -excess[e]));
        }
        for (arc, turning) in self.star().into_iter().zip(self.turning()?) {
            [self.at, self.mesh.tip(arc)].into_iter().for_each(|v| note(v, turning));
        }
        control.check()?;
        let lost = |v: VertexId| -narrow[v].max(LEAST_ANGLE).ln();
        let top = u.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let depth = |v: VertexId| ((top - u[v]) as usize).min(DEPTHS - 1);
        let all =
            ranked(self.mesh.vertices().filter(|&v| may[v]).map(|v| (Key(self.height(v) + lost(v)), v)));
        let mut seen = [false; DEPTHS];
        let mut chosen: Vec<VertexId> = Vec::new();
        for (rank, v) in all.into_iter().enumerate() {
            if !std::mem::replace(&mut seen[depth(v)], true) || rank < BEST_ANYWHERE {
                chosen.push(v);
            }
        }
        let cost = |v| {
            control.check()?;
            Ok((Key(range(&self.seen_from(v, plane), v) + lost(v)), v))
        };
        let costs = chosen.into_iter().map(cost).collect::<Result<Vec<_>>>()?;
        Ok(ranked(costs.into_iter()))
    }

    /// The vertex whose shortest edge is the longest, of those that `may` be punctured.
    pub fn widest(&self, may: &PerVertex<bool>) -> VertexId {
        let better =
            |(best, least), v| if self.height(v) < least { (v, self.height(v)) } else { (best, least) };
        self.mesh.vertices().filter(|&v| may[v]).fold((VertexId(0), f64::INFINITY), better).0
    }

    /// The largest bound of a neighbour of v, if v is the puncture: that at its shortest edge.
    fn height(&self, v: VertexId) -> f64 {
        self.mesh.outgoing(v).map(|arc| self.bound(arc)).fold(f64::NEG_INFINITY, f64::max)
    }
}

/// Vertices in the order of their costs, and of their numbers where these are equal.
fn ranked(costs: impl Iterator<Item = (Key, VertexId)>) -> Vec<VertexId> {
    let mut costs: Vec<_> = costs.collect();
    costs.sort_unstable();
    costs.into_iter().map(|(_, v)| v).collect()
}

/// Largest minus smallest u of all vertices but the puncture.
pub(super) fn range(u: &PerVertex<f64>, puncture: VertexId) -> f64 {
    let others = u.iter().enumerate().filter(|(v, _)| *v != puncture.index());
    let (low, high) =
        others.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), (_, &u)| (low.min(u), high.max(u)));
    high - low
}
