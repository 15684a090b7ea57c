//! Hyperbolic surfaces with one triangulation: the map is in the class of the one that brings every vertex to the vertex of the same
//! number.
//!
//! Every face has a frame of its own, and the motions from face to face determine the class. Neither a fundamental domain is laid out nor
//! words of the fundamental group are multiplied, so no digits are lost on surfaces whose domain would reach far: only neighbouring faces
//! are ever seen from each other.

use super::balance::{Springs, VertexFreedom, balance};
use super::canonical::{CanonicalMetric, CanonicalSurface, for_both};
use super::cover::{PlacedMesh, UniversalCover, WalkSeed, aimed};
use super::domain_pair::DomainPair;
use super::landmarks::{MarkedSurface, Marks};
use super::options::{BoundaryMatching, MatchOptions};
use super::orbifold::OrbifoldShape;
use crate::control::Control;
use crate::embed::SeparateFaces;
use crate::error::Result;
use crate::geometry::{Motion, Space};
use crate::mesh::{PerVertex, VertexId};
use crate::metric::Surface;
use std::f64::consts::TAU;

/// Order of the cones at landmarks on surfaces with handles.
const ORDER: usize = 2;

/// The order of the cones at the landmarks, if the strategy applies: both surfaces have one triangulation, landmarks and boundary loops go
/// to those of the same number, the metric is hyperbolic with straight boundaries, and no class is named by loops.
pub(super) fn cone_order(sides: [MarkedSurface; 2], options: &MatchOptions) -> Option<usize> {
    let (mesh, marks) = (sides[0].surface.mesh(), sides.map(|side| side.marks));
    let start = |marks: &Marks| -> Vec<Option<VertexId>> {
        marks.loops.iter().map(|around| around.iter().map(|&h| mesh.origin(h)).min()).collect()
    };
    let is_same = options.basis.is_empty()
        && mesh == sides[1].surface.mesh()
        && marks[0].landmarks == marks[1].landmarks
        && marks.iter().all(|marks| marks.corners.is_empty())
        && start(marks[0]) == start(marks[1]);
    let slides = options.boundary == BoundaryMatching::Slides || mesh.is_closed();
    let order = if mesh.genus() == 0 {
        let shape = OrbifoldShape::of(marks[0]).filter(|shape| shape.space == Space::H2);
        shape.map(|shape| shape.order)
    } else {
        Some(ORDER).filter(|_| mesh.euler() < 0)
    };
    order.filter(|_| is_same && slides)
}

/// Both surfaces in the target's metric with cones of this order at the landmarks ([`cone_order`]), the source in the class of the map that
/// keeps the vertices' numbers.
///
/// # Errors
/// Those of [`CanonicalMetric::new`], [`SeparateFaces::of_solution`] and [`balance`].
pub(super) fn in_frames_of_faces(
    sides: [MarkedSurface; 2],
    order: usize,
    options: &MatchOptions,
    control: &Control,
) -> Result<DomainPair> {
    let (mesh, landmarks) = (sides[0].surface.mesh(), &sides[0].marks.landmarks);
    let mut curvature = PerVertex::filled(mesh.n_vertices(), 0.0);
    landmarks.iter().for_each(|&v| curvature[v] = TAU * (1.0 - 1.0 / order as f64));
    let [source, target] =
        for_both(|s| canonical_surface(sides[s].surface, &curvature, options, &control.part(0.0, 0.6)))?;
    let mut freedom = VertexFreedom::of(mesh, options.boundary);
    landmarks.iter().for_each(|&v| freedom[v] = VertexFreedom::Held);
    let settled = for_both(|s| {
        control.check()?;
        let mut placed = target.placed.clone();
        let weights = &[&source, &target][s].weights;
        let report = balance(&mut placed, Springs { weights, freedom: &freedom }, &control.part(0.6, 1.0))?;
        Ok((placed, report))
    })?;
    let [(image, first), (domain, second)] = settled;
    // The own corner of a vertex lies in the same face of both surfaces, whose frame they share.
    let start = VertexId(0);
    let seeds = [WalkSeed { vertex: start, near: domain.cover.own(start) }; 2];
    let flow_iterations = [source.iterations, target.iterations];
    Ok(DomainPair {
        source: image,
        target: domain,
        seeds,
        reports: [first, second],
        flow_iterations,
        markings: 1,
    })
}

/// A surface in its hyperbolic metric with this curvature at the vertices, every face in a frame of its own.
fn canonical_surface(
    surface: &Surface,
    curvature: &PerVertex<f64>,
    options: &MatchOptions,
    control: &Control,
) -> Result<CanonicalSurface> {
    let (mesh, space) = (surface.mesh(), Space::H2);
    let metric = CanonicalMetric::new(surface, space, curvature.clone(), &options.flow, control)?;
    let faces = SeparateFaces::of_solution(&metric.solution, control)?;
    let across = |h| {
        let is_inner = !mesh.is_outside(h) && !mesh.is_outside(h.twin());
        is_inner.then(|| faces.across[h])
    };
    control.check()?;
    let cover = UniversalCover::new(mesh, space, across, &[])?;
    control.check()?;
    let at = PerVertex::from_fn(mesh.n_vertices(), |v: VertexId| {
        let h = cover.own(v);
        if mesh.is_boundary_vertex(v) {
            // The own corner is at the boundary edge that leaves the vertex, and the boundary is straight.
            aimed(space, [faces.corner[h], faces.corner[mesh.next(h)]]).0
        } else {
            Motion::to_origin(space, faces.corner[h]).inverse()
        }
    });
    control.check()?;
    CanonicalSurface::new(surface, PlacedMesh { cover, at }, metric.iterations, control)
}
