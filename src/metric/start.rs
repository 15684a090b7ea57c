//! Where a flow with flips starts: a triangulation and circles that depend on the surface alone.

use super::delaunay::intrinsic_delaunay;
use super::initial::{Initial, check_triangles, corner_radii, initial_metric, initial_mixed};
use super::scheme::Scheme;
use crate::control::Control;
use crate::error::Result;
use crate::geometry::Space;
use crate::mesh::{Double, EdgeId, Mesh, PerEdge, PerVertex};

/// Radii, as a share of the largest that the corners allow. Circles that touch lock their edge: it is Delaunay whatever u, never
/// flips, and its two radii bound the angles there; targets beyond that bound would be out of reach.
const APART: f64 = 0.5;

/// The initial metric of `scheme` on the (weighted) Delaunay triangulation of the surface: flips `mesh` and `lengths`, which stay
/// the same surface, and so makes the conformal class independent of the triangulation the surface came with, up to ties.
///
/// Vertex scaling: on the intrinsic Delaunay triangulation. Circles that represent the lengths exactly: with the radii from the
/// corners there, the smaller at mirrored vertices of a `double`; for inversive distance half of them, on the weighted Delaunay
/// triangulation of those circles. Thurston's and tangential packings, which are Delaunay on any triangulation, stay on the given one.
///
/// `fixed` edges are not flipped; `record` is told each edge just before its flip. Errors: those of [`initial_metric`] and [`intrinsic_delaunay`],
/// with the surface as it was, maybe on another triangulation.
pub fn delaunay_start(
    mesh: &mut Mesh,
    lengths: &mut PerEdge<f64>,
    input_geometry: Space,
    scheme: Scheme,
    space: Space,
    double: Option<&Double>,
    fixed: &[EdgeId],
    record: &mut dyn FnMut(&Mesh, EdgeId),
    control: &Control,
) -> Result<Initial> {
    if matches!(scheme, Scheme::Thurston | Scheme::Tangential) {
        return initial_metric(mesh, lengths, input_geometry, scheme, space);
    }
    intrinsic_delaunay(mesh, lengths, None, input_geometry, fixed, record, control)?;
    if scheme == Scheme::Yamabe {
        return initial_metric(mesh, lengths, input_geometry, scheme, space);
    }
    check_triangles(mesh, lengths, input_geometry)?;
    let mut radii = corner_radii(mesh, lengths).min;
    if let Some(double) = double {
        radii = PerVertex::from_fn(radii.len(), |v| radii[v].min(radii[double.mirror(v)]));
    }
    if scheme == Scheme::Inversive {
        radii.iter_mut().for_each(|r| *r *= APART);
        intrinsic_delaunay(mesh, lengths, Some(&radii), input_geometry, fixed, record, control)?;
    }
    let epsilon = PerVertex::filled(mesh.n_vertices(), scheme.epsilon());
    initial_mixed(mesh, lengths, input_geometry, epsilon, radii, space)
}
