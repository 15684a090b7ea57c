//! Hyperbolic surfaces with one triangulation: the class of the map is that in which every vertex goes to the one of the same number.
//!
//! Every face has a frame of its own, and the motions from face to face say which class is meant. No fundamental domain is laid out and no word is
//! multiplied, so that nothing loses digits, however far the domain would reach: only neighbours are ever seen from each other.

use super::balance::{BalanceReport, Freedom, balance};
use super::canonical::canonical_metric;
use super::cover::{Cover, Placed, aimed};
use super::options::{Boundary, MatchOptions};
use super::orbifold::Pair;
use super::route::Marks;
use super::walk::Seed;
use super::weights::mean_value_weights;
use crate::control::Control;
use crate::embed::apart::apart;
use crate::error::Result;
use crate::geometry::{Motion, Space};
use crate::mesh::{PerHalfedge, PerVertex, VertexId};
use crate::metric::Surface;

/// Whether two surfaces have one triangulation, one hyperbolic metric each without cones or corners, and boundary loops that go to those of the same
/// number.
pub(super) fn is_same(surfaces: [&Surface; 2], marks: [&Marks; 2], options: &MatchOptions) -> bool {
    let mesh = surfaces[0].mesh();
    let is_bare = |marks: &Marks| marks.landmarks.is_empty() && marks.corners.is_empty();
    let start = |marks: &Marks| -> Vec<Option<VertexId>> {
        marks.loops.iter().map(|around| around.iter().map(|&h| mesh.origin(h)).min()).collect()
    };
    let slides = options.boundary == Boundary::Slides || mesh.is_closed();
    mesh.euler() < 0
        && slides
        && marks.iter().all(|marks| is_bare(marks))
        && mesh == surfaces[1].mesh()
        && start(marks[0]) == start(marks[1])
}

/// Both surfaces in the target's metric, where [`is_same`].
///
/// # Errors
/// Those of [`canonical_metric`], [`apart`] and [`balance`].
pub(super) fn in_frames_of_faces(
    surfaces: [&Surface; 2],
    options: &MatchOptions,
    control: &Control,
) -> Result<Pair> {
    let own = |s: usize| in_own_metric(surfaces[s], options, control);
    let (source, target) = rayon::join(|| own(0), || own(1));
    let (source, mut target) = (source?, target?);
    let freedom = Freedom::of(surfaces[0].mesh(), options.boundary);
    let mut image = target.placed.clone();
    let settled =
        |placed: &mut Placed, weights: &PerHalfedge<f64>| balance(placed, weights, &freedom, control);
    let (first, second) =
        rayon::join(|| settled(&mut image, &source.weights), || settled(&mut target.placed, &target.weights));
    let reports: [BalanceReport; 2] = [first?, second?];
    // The own corner of a vertex lies in the same face in both, whose frame they share.
    let start = VertexId(0);
    let seeds = [Seed { vertex: start, near: target.placed.cover.own(start) }; 2];
    let flow_iterations = [source.iterations, target.iterations];
    Ok(Pair { source: image, target: target.placed, seeds, reports, flow_iterations, markings: 1 })
}

struct Own {
    placed: Placed,
    weights: PerHalfedge<f64>,
    iterations: usize,
}

fn in_own_metric(surface: &Surface, options: &MatchOptions, control: &Control) -> Result<Own> {
    let (mesh, space) = (surface.mesh(), Space::H2);
    let curvature = PerVertex::filled(mesh.n_vertices(), 0.0);
    let (metric, iterations) = canonical_metric(surface, space, curvature, &options.flow, control)?;
    let faces = apart(&metric, control)?;
    let across = |h| {
        let is_inner = !mesh.is_outside(h) && !mesh.is_outside(h.twin());
        is_inner.then(|| faces.across[h])
    };
    let cover = Cover::new(mesh, space, across, &[])?;
    let at = PerVertex::from_fn(mesh.n_vertices(), |v: VertexId| {
        let h = cover.own(v);
        match mesh.is_boundary_vertex(v) {
            // The own corner is at the boundary edge that leaves the vertex, and the boundary is straight.
            true => aimed(space, [faces.corner[h], faces.corner[mesh.next(h)]]).0,
            false => Motion::to_origin(space, faces.corner[h]).inverse(),
        }
    });
    let placed = Placed { cover, at };
    let weights = mean_value_weights(&placed, surface);
    Ok(Own { placed, weights, iterations })
}
