//! Which vertex to send to infinity.
//!
//! The plane seen from one vertex tells what it is from any other: an inversion away, on the same triangulation. With u of the centred
//! sphere, `u' = u_i + u_v − 2 log(|x_i − x_v|/2)` in the plane seen from v. The neighbours of v come to lie at −log(2 η),
//! whatever u; the far side at about u_i + u_v ≥ min u + u_v; what lies deep beyond v, in a finger whose tip is crowded on the
//! sphere, at u_i − u_v. So the best v has long edges, and lies half way down the deepest finger. One vertex for each depth is looked at.
//!
//! Where the angles at an arc from v add up to nearly π, the outline seen from v is nearly straight there, and whether the arc
//! belongs there turns on rounding: its angle's logarithm is as good as digits of u.

use super::star::Punctured;
use crate::error::Result;
use crate::mesh::{PerVertex, VertexId};

/// Depths looked at, in steps of 1 of u.
const DEPTHS: usize = 64;
/// And so many vertices at any depth.
const ANYWHERE: usize = 8;
/// Angles below this are the same.
const LEAST_ANGLE: f64 = 1e-12;

impl Punctured {
    /// Vertices to puncture, the best one first: by the range of u in the plane seen from them, and the digits lost in narrow angles.
    /// `plane` is the present layout, `u` that of the centred sphere.
    pub fn candidates(&self, plane: &PerVertex<[f64; 2]>, u: &PerVertex<f64>) -> Result<Vec<VertexId>> {
        // Least exterior angle of the polyhedron at the edges of a vertex.
        let mut narrow = PerVertex::filled(self.mesh.n_vertices(), f64::INFINITY);
        let mut note = |v: VertexId, angle: f64| narrow[v] = narrow[v].min(angle);
        let excess = self.excess()?;
        for e in self.mesh.edges().filter(|&e| !self.mesh.ends(e).contains(&self.at)) {
            self.mesh.ends(e).into_iter().for_each(|v| note(v, -excess[e]));
        }
        for (arc, turning) in self.star().into_iter().zip(self.turning()?) {
            [self.at, self.mesh.tip(arc)].into_iter().for_each(|v| note(v, turning));
        }
        let lost = |v: VertexId| -narrow[v].max(LEAST_ANGLE).ln();
        let near = |v| self.mesh.outgoing(v).map(|arc| self.bound(arc)).fold(f64::NEG_INFINITY, f64::max);
        let top = u.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let depth = |v: VertexId| ((top - u[v]) as usize).min(DEPTHS - 1);
        let mut all: Vec<(f64, VertexId)> = self.mesh.vertices().map(|v| (near(v) + lost(v), v)).collect();
        all.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let mut seen = [false; DEPTHS];
        let mut chosen: Vec<VertexId> = Vec::new();
        for (rank, &(_, v)) in all.iter().enumerate() {
            if !std::mem::replace(&mut seen[depth(v)], true) || rank < ANYWHERE {
                chosen.push(v);
            }
        }
        let cost = |v| (range(&self.seen_from(v, plane), v) + lost(v), v);
        let mut ranked: Vec<(f64, VertexId)> = chosen.into_iter().map(cost).collect();
        ranked.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        Ok(ranked.into_iter().map(|(_, v)| v).collect())
    }
}

/// Largest minus smallest u of all vertices but the puncture.
pub(super) fn range(u: &PerVertex<f64>, puncture: VertexId) -> f64 {
    let others = u.iter().enumerate().filter(|(v, _)| *v != puncture.index());
    let (low, high) =
        others.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), (_, &u)| (low.min(u), high.max(u)));
    high - low
}
