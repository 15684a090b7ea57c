//! Why a target has no metric: a set of vertices whose curvature is below what the scheme can give them.

use super::evaluate::State;
use crate::geometry::Space;
use crate::mesh::{FaceId, HalfedgeId, Mesh, VertexId};
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

/// The first vertex whose target is below its own bound by more than `tolerance`: found without a flow. (A target nearer to the
/// bound can be approached.)
pub(super) fn obstruction_at_a_vertex(
    mesh: &Mesh,
    class: &Metric,
    target: &[f64],
    pinned: &[bool],
    tolerance: f64,
) -> Option<Obstruction> {
    if class.space == Space::S2 || mesh.n_vertices() == 1 {
        return None;
    }
    let mut faces: Vec<FaceId> = Vec::new();
    for v in mesh.vertices().filter(|v| !pinned[v.index()]) {
        let (curvature, mut least) = (target[v.index()], full_angle(mesh, v));
        faces.clear();
        for h in mesh.outgoing(v) {
            let Some(f) = mesh.face(h) else { continue };
            let corners = mesh.face_vertices(f).into_iter().filter(|&w| w == v).count();
            if corners == 1 {
                least -= largest_angle(mesh, class, h);
            } else if !faces.contains(&f) {
                // All corners of such a face have at most π together.
                faces.push(f);
                least -= PI;
            }
        }
        if curvature + tolerance < least {
            return Some(Obstruction { vertices: vec![v], curvature, least });
        }
    }
    None
}

/// 2π inside, π on the boundary.
fn full_angle(mesh: &Mesh, v: VertexId) -> f64 {
    if mesh.is_boundary_vertex(v) { PI } else { 2.0 * PI }
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
        least += full_angle(mesh, v);
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
        .all(|&h| class.epsilon[mesh.origin(h)] == 1 && (0.0..=1.0).contains(&class.eta[h.edge()].high));
    if packing { PI - class.eta[side.edge()].high.acos() } else { PI }
}
