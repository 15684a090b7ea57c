//! Hyperbolic surfaces with one triangulation: the class of the map is that in which every vertex goes to the one of the same number.
//!
//! Every face has a frame of its own, and the motions from face to face say which class is meant. No fundamental domain is laid out and no
//! word is multiplied, so that nothing loses digits, however far the domain would reach: only neighbours are ever seen from each other.

use super::balance::{BalanceReport, Freedom, balance};
use super::canonical::canonical_metric;
use super::cover::{Cover, Placed, aimed};
use super::options::{Boundary, MatchOptions};
use super::orbifold::{Pair, shape};
use super::route::Marks;
use super::walk::Seed;
use super::weights::mean_value_weights;
use crate::control::Control;
use crate::embed::apart::apart;
use crate::error::Result;
use crate::geometry::{Motion, Space};
use crate::mesh::{PerHalfedge, PerVertex, VertexId};
use crate::metric::Surface;
use crate::parallel::join;
use std::f64::consts::TAU;

/// Order of the cones at landmarks on surfaces with handles.
const ORDER: usize = 2;

/// Where two surfaces have one triangulation, landmarks and boundary loops go to those of the same number, and their metric is hyperbolic
/// with straight boundaries, and no class is named by loops: the order of the cones at the landmarks in it.
pub(super) fn cones_of_same(
    surfaces: [&Surface; 2],
    marks: [&Marks; 2],
    options: &MatchOptions,
) -> Option<usize> {
    let mesh = surfaces[0].mesh();
    let start = |marks: &Marks| -> Vec<Option<VertexId>> {
        marks.loops.iter().map(|around| around.iter().map(|&h| mesh.origin(h)).min()).collect()
    };
    let is_same = options.basis.is_empty()
        && mesh == surfaces[1].mesh()
        && marks[0].landmarks == marks[1].landmarks
        && marks.iter().all(|marks| marks.corners.is_empty())
        && start(marks[0]) == start(marks[1]);
    let slides = options.boundary == Boundary::Slides || mesh.is_closed();
    let is_sphere = mesh.genus() == 0;
    let shape = shape(marks[0].loops.len(), marks[0].landmarks.len(), 0).filter(|_| is_sphere);
    let order = match is_sphere {
        true => shape.filter(|shape| shape.space == Space::H2).map(|shape| shape.order),
        false => Some(ORDER).filter(|_| mesh.euler() < 0),
    };
    order.filter(|_| is_same && slides)
}

/// Both surfaces in the target's metric, the source's vertices in the class of those of the same number, with cones of this order at the
/// landmarks ([`cones_of_same`]).
///
/// # Errors
/// Those of [`canonical_metric`], [`apart`] and [`balance`].
pub(super) fn in_frames_of_faces(
    surfaces: [&Surface; 2],
    (landmarks, order): (&[VertexId], usize),
    options: &MatchOptions,
    control: &Control,
) -> Result<Pair> {
    let mut curvature = PerVertex::filled(surfaces[0].mesh().n_vertices(), 0.0);
    landmarks.iter().for_each(|&v| curvature[v] = TAU * (1.0 - 1.0 / order as f64));
    let own = |s: usize| in_own_metric(surfaces[s], &curvature, options, control);
    let (source, target) = join(|| own(0), || own(1));
    let (source, mut target) = (source?, target?);
    let mut freedom = Freedom::of(surfaces[0].mesh(), options.boundary);
    landmarks.iter().for_each(|&v| freedom[v] = Freedom::Held);
    let mut image = target.placed.clone();
    let settled =
        |placed: &mut Placed, weights: &PerHalfedge<f64>| balance(placed, weights, &freedom, control);
    let (first, second) =
        join(|| settled(&mut image, &source.weights), || settled(&mut target.placed, &target.weights));
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

fn in_own_metric(
    surface: &Surface,
    curvature: &PerVertex<f64>,
    options: &MatchOptions,
    control: &Control,
) -> Result<Own> {
    let (mesh, space) = (surface.mesh(), Space::H2);
    let (metric, iterations) = canonical_metric(surface, space, curvature.clone(), &options.flow, control)?;
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
