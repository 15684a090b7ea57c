//! Finds an obstruction to a target: a set of vertices whose target is below the least curvature that the scheme can give them.

use super::Flow;
use super::evaluate::FlowState;
use super::report::Obstruction;
use crate::geometry::Space;
use crate::mesh::{FaceId, HalfedgeId, VertexId};
use crate::metric::target::full_angle;
use std::f64::consts::PI;

impl Flow {
    /// The first vertex whose target is below its own bound by more than the tolerance, which is found without a flow. (A target
    /// that is nearer to the bound can be approached.)
    pub(super) fn obstruction_at_a_vertex(&self) -> Option<Obstruction> {
        if self.metric.space == Space::S2 || self.mesh.n_vertices() == 1 {
            return None;
        }
        let mut faces: Vec<FaceId> = Vec::new();
        for v in self.mesh.vertices().filter(|v| !self.pinned[v.index()]) {
            let (curvature, mut least) = (self.target[v], full_angle(&self.mesh, v));
            faces.clear();
            for h in self.mesh.outgoing(v) {
                let Some(f) = self.mesh.face(h) else { continue };
                let corners = self.mesh.face_vertices(f).into_iter().filter(|&w| w == v).count();
                if corners == 1 {
                    least -= self.largest_angle(h);
                } else if !faces.contains(&f) {
                    // All corners of such a face have at most π together.
                    faces.push(f);
                    least -= PI;
                }
            }
            if curvature + self.options.tolerance < least {
                return Some(Obstruction { vertices: vec![v], curvature, least });
            }
        }
        None
    }

    /// The smallest obstruction among the sets of vertices whose u is below a bound, for every bound: a flow without a limit separates u at
    /// an obstruction. `None` if none of these sets is one, and in S², where angle sums have no bound.
    pub(super) fn obstruction(&self, state: &FlowState) -> Option<Obstruction> {
        let mesh = &self.mesh;
        if self.metric.space == Space::S2 {
            return None;
        }
        let mut order: Vec<VertexId> = mesh.vertices().filter(|v| !self.pinned[v.index()]).collect();
        order.sort_by(|&a, &b| state.u[a].total_cmp(&state.u[b]));
        // The set of all vertices is left out: the target's total has been checked by Gauss–Bonnet.
        let proper = order.len().min(mesh.n_vertices() - 1);
        let mut taken = vec![0.0; mesh.n_faces()];
        let (mut curvature, mut least) = (0.0, 0.0);
        for (n, &v) in order[..proper].iter().enumerate() {
            curvature += self.target[v];
            least += full_angle(mesh, v);
            for h in mesh.outgoing(v) {
                let Some(f) = mesh.face(h) else { continue };
                let face = &mut taken[f.index()];
                let now = if *face == 0.0 { self.largest_angle(h) } else { PI };
                least -= now - *face;
                *face = now;
            }
            if curvature <= least {
                let mut vertices = order[..=n].to_vec();
                vertices.sort_unstable();
                return Some(Obstruction { vertices, curvature, least });
            }
        }
        None
    }

    /// Least upper bound of the angle at the origin of `h`, over all metrics of the class.
    fn largest_angle(&self, h: HalfedgeId) -> f64 {
        let side = self.mesh.next(h);
        let eta = |h: HalfedgeId| self.metric.eta[h.edge()].high;
        let is_packing =
            |h: HalfedgeId| self.metric.epsilon[self.mesh.origin(h)] == 1 && (0.0..=1.0).contains(&eta(h));
        if [h, side, self.mesh.next(side)].into_iter().all(is_packing) { PI - eta(side).acos() } else { PI }
    }
}
