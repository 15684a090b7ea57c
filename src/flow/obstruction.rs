//! Why a target has no metric: a set of vertices whose curvature is below what the scheme can give them.

use super::evaluate::State;
use crate::geometry::Space;
use crate::mesh::{HalfedgeId, Mesh, VertexId};
use crate::metric::Metric;
use std::f64::consts::PI;

/// A set I of vertices that violates the existence condition of its scheme: every metric of the class on this
/// triangulation has `Σ_I K > least`, and the target asks for `Σ_I K̄ = curvature ≤ least`.
///
/// A triangle with two or three corners in I has angles of at most π there; one with a single corner has less than
/// `π − arccos η` of the opposite edge in a circle packing (all η in [0, 1]: Thurston's inequality, \[Thu80, chapter
/// 13\], \[CL03\]), less than π in the other schemes. `least` is 2π per vertex of I (π on the boundary) minus these.
#[derive(Debug, Clone, PartialEq)]
pub struct Obstruction {
    /// The vertices of I, ascending.
    pub vertices: Vec<VertexId>,
    /// Σ K̄ over I, radians.
    pub curvature: f64,
    /// The bound, not attained, radians. (Both sums are formed in doubles.)
    pub least: f64,
}

/// The smallest violated set among those that a run-away flow suggests: the vertices of least u, for every bound on u.
///
/// `None` where no such set is violated, and in S², where angle sums have no bound.
pub(super) fn obstruction(
    mesh: &Mesh,
    class: &Metric,
    state: &State,
    target: &[f64],
    pinned: &[bool],
) -> Option<Obstruction> {
    if class.space == Space::S2 {
        return None;
    }
    let mut order: Vec<VertexId> = mesh.vertices().filter(|v| !pinned[v.index()]).collect();
    order.sort_by(|&a, &b| state.u[a].total_cmp(&state.u[b]));
    // The whole of a surface is Gauss–Bonnet's to judge.
    let proper = order.len().min(mesh.n_vertices() - 1);
    let mut taken = vec![0.0; mesh.n_faces()];
    let (mut curvature, mut least) = (0.0, 0.0);
    for (n, &v) in order[..proper].iter().enumerate() {
        curvature += target[v.index()];
        least += if mesh.is_boundary_vertex(v) { PI } else { 2.0 * PI };
        for h in mesh.outgoing(v) {
            let Some(f) = mesh.face(h) else { continue };
            let face = &mut taken[f.index()];
            let now = if *face == 0.0 { largest_angle(mesh, class, h) } else { PI };
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
fn largest_angle(mesh: &Mesh, class: &Metric, h: HalfedgeId) -> f64 {
    let side = mesh.next(h);
    let sides = [h, side, mesh.next(side)];
    let packing = sides
        .iter()
        .all(|&h| class.epsilon[mesh.origin(h)] == 1 && (0.0..=1.0).contains(&class.eta[h.edge()]));
    if packing { PI - class.eta[side.edge()].acos() } else { PI }
}
